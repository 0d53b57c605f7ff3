/// A forest cut into segments where it forks, and what they measure. (A segment is called a branch in here:
/// vn_segment is a piece of a line.)
#ifndef VN_NETWORK_BRANCHES_H
#define VN_NETWORK_BRANCHES_H

#include "network/network.h"

/// The edges from a root or a fork (a node with two children or more) to the next fork or tip.
typedef struct vn_branch {
    int32_t before; ///< the branch that leads to it, always a lower number; -1 from a root
    int32_t first;  ///< the node whose edge is its first one
    int32_t level;  ///< forks on the way from the root, which does not count
    int32_t edges;
    double length;
    double weighted; ///< Σ diameter · length
    double sum;      ///< Σ diameter, for branches without a length
} vn_branch;

typedef struct vn_branches {
    VN_ARRAY(vn_branch) list;
    VN_ARRAY(int32_t) of; ///< the branch that each node's edge is part of; 0 at roots
} vn_branches;

/// Of the forest: joins are nobody's children. Into an empty @p out; free it also after a failure.
vn_status vn_branches_find(vn_branches *out, const vn_network *network);
void vn_branches_free(vn_branches *branches);

bool vn_network_forks(const vn_network *network, int32_t node);

/// The mean of the edges' diameters by their lengths.
static inline double vn_branch_diameter(const vn_branch *branch) {
    return branch->length > 0 ? branch->weighted / branch->length : branch->sum / branch->edges;
}

/// From a node's parent to the node.
void vn_edge_direction(const vn_network *network, int32_t node, double d[3]);

/// Whether two directions have an angle, which neither does that is no direction, and how many degrees.
bool vn_angle_between(const double u[3], const double v[3], double *degrees);

#endif
