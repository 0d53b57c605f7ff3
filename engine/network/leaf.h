/// What a leaf's measures are made of.
#ifndef VN_NETWORK_LEAF_H
#define VN_NETWORK_LEAF_H

#include "base/sort.h"
#include "domain/domain.h"
#include "network/faces.h"

extern const vn_schema vn_leaf_schema;

/// Numbers as keys that sort like them.
static inline uint64_t vn_sortable(double value) {
    uint64_t bits;
    value += 0.0; // no -0
    memcpy(&bits, &value, sizeof bits);
    return bits >> 63 ? ~bits : bits | UINT64_C(1) << 63;
}

/// Whether no coordinate is so large that its square, or a distance's, is none; @p what begins the message.
vn_status vn_check_places(const vn_network *network, const char *what);

vn_status vn_statistics_of(vn_statistics *out, const double *values, int32_t count);

/// The convex hull of a 2D network's nodes as a domain; NULL when it has no area.
vn_status vn_network_hull(vn_domain **out, const vn_network *network);

/// The merges are allocated as `areoles` of them.
vn_status vn_loops_decompose(vn_loop_hierarchy *out, const vn_faces *faces);

void vn_faces_measure_angles(vn_branching_angles *out, const vn_faces *faces);

/// @p resolution 0: chosen by the area.
vn_status vn_faces_measure_distance(vn_vein_distance *out, const vn_faces *faces, const vn_domain *area,
                                    double resolution);

#endif
