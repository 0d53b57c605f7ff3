/// What a node of a vessel perceives (Rauch & Harders 2021, Equations 1 to 3; READINGS R15 to R17).
#ifndef VN_COLONIZE_PERCEPTION_H
#define VN_COLONIZE_PERCEPTION_H

#include "network/network.h"
#include "venule/attractors.h"

enum { VN_TABLED_TIPS = 256 };

/// The options of all nodes, made ready.
typedef struct vn_gaze {
    vn_perception perception;
    double exponent;                    ///< Murray's
    double half_cos, half_sin;          ///< of γ/2
    double lateral_cos[VN_TABLED_TIPS]; ///< of α, by the tips of the child that is there; [0] is unused
} vn_gaze;

/// Make it ready. @p changed: it was not already. VN_INVALID where the network has no law to take α
/// from, or one without such an angle.
vn_status vn_gaze_prepare(vn_gaze *gaze, const vn_network *network, const vn_perception *perception,
                          bool *changed);

static inline bool vn_gaze_is_open(const vn_gaze *gaze) {
    return gaze->perception.angle > 0;
}

/// Whether the node may still get a child: a leaf, a root without one, or, with laterals, an inter-node.
static inline bool vn_gaze_may_grow(const vn_gaze *gaze, const vn_network *network, int32_t node) {
    int32_t child = network->first_child.data[node];
    return child < 0 || (gaze->perception.lateral && network->parent.data[node] >= 0 &&
                         network->next_child.data[child] < 0);
}

/// The perception volume of one node, as the tips above it stood when they were last counted.
typedef struct vn_zone {
    vn_zone_kind kind;
    double e[3];              ///< direction of the parent edge, or the root's heading
    double cosine, sine;      ///< of α; 1 and 0 in a cone
    double low_cos, high_cos; ///< of the angle to e: what is perceived lies between
} vn_zone;
void vn_zone_find(vn_zone *zone, const vn_gaze *gaze, const vn_network *network, int32_t node);

/// Turn an inter-node's zone to where it is when the child has so many tips.
void vn_zone_turn(vn_zone *zone, const vn_gaze *gaze, int32_t tips);

/// Whether the direction @p d, of any length above 0, lies in the zone, @p slack in cosines beyond it
/// included.
bool vn_zone_holds(const vn_zone *zone, const double d[3], double slack);

#endif
