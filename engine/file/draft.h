/// A network as a file tells it, piece by piece: nodes with parents, or nodes and edges between them.
#ifndef VN_FILE_DRAFT_H
#define VN_FILE_DRAFT_H

#include "file/format.h"
#include "file/slice.h"

typedef VN_ARRAY(double) vn_numbers;

typedef struct vn_draft_edge {
    int32_t from, to;    ///< nodes; directed edges lead away from the root
    double radius, flow; ///< NAN where the file does not say
    bool join;           ///< the file says that it closes a loop
} vn_draft_edge;

typedef struct vn_draft {
    int dim;       ///< 0: 2 where all z are 0, else 3
    bool overlaps; ///< edges may repeat others, and are then passed over
    char unit[32];
    vn_numbers x, y, z;
    VN_ARRAY(int32_t) parent;
    VN_ARRAY(int32_t) birth;           ///< empty: unknown
    vn_numbers radius, flow, pressure; ///< NAN where the file does not say
    VN_ARRAY(vn_draft_edge) edges;
    VN_ARRAY(vn_join) joins;
} vn_draft;

/// A new node, a root of which no more is known than its place.
vn_status vn_draft_node(vn_draft *draft, const double p[3]);
vn_status vn_draft_edge_add(vn_draft *draft, const vn_draft_edge *edge);
void vn_draft_unit(vn_draft *draft, vn_slice unit);

/// Find the parents from the edges: each edge makes its near node the parent of the far one, unless that has
/// a parent already or a loop would close; then it is a join. Where @p directed is false the edges may run
/// either way: then each tree is rooted in its first node that no edge leads to.
vn_status vn_draft_link(vn_draft *draft, bool directed);

/// What only some nodes have is refused. At roots, whose edges do not exist, the flow is the sum of the
/// children's unless the file says otherwise.
vn_status vn_draft_finish(vn_draft *draft, vn_network_set *set);
void vn_draft_free(vn_draft *draft);

#endif
