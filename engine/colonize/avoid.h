/// Networks that keep clear of each other as round tubes, now and as they grow thicker.
#ifndef VN_COLONIZE_AVOID_H
#define VN_COLONIZE_AVOID_H

#include "network/berth.h"
#include "venule/attractors.h"

/// Of one call of vn_extend().
typedef struct vn_avoidance {
    vn_network *network;
    vn_network *const *others;
    int32_t count;
    double gap;
    bool refused; ///< something since the caller last said otherwise
    bool buried;  ///< a root that nothing can grow from, as it is within a tube of others
    int32_t root;
    double away, needed; ///< how far it is, and how far it had to be
    // Whether one tip more below a node fits: the last answer.
    int32_t tip_node;
    uint64_t tip_version;
    bool tip_fits;
} vn_avoidance;

/// Check the options, and bring what all know of their edges up to date.
vn_status vn_avoid_begin(vn_avoidance *v, vn_network *network, const vn_extend_def *def);

/// Whether an edge from @p node to @p p would keep clear of others, and with it all that grow thicker for it;
/// @p forks: the node gets another child besides. Notes a refusal.
bool vn_avoid_allows(vn_avoidance *v, int32_t node, const double p[3], bool forks);

/// The newest node is a child of @p node: give it room, and those that have grown thicker.
vn_status vn_avoid_grown(vn_avoidance *v, int32_t node);

/// VN_INVALID when a root was found buried.
vn_status vn_avoid_end(const vn_avoidance *v);

#endif
