/// Points that each remember a squared distance: "which of them is this new point nearer to than what
/// they remember?" A forest of boxes over the points along a space-filling curve answers in time
/// proportional to the answer.
#ifndef VN_SPACE_REACH_TREE_H
#define VN_SPACE_REACH_TREE_H

#include "base/sort.h"
#include "space/points.h"

enum { VN_REACH_FAN = 8, VN_REACH_LEVELS = 12 };

/// The boxes of eight runs of points, or of eight smaller packs, side by side so that they are tested
/// together; and the largest squared distance that each run remembers: an upper bound, negative when nothing
/// in it can answer any more.
typedef struct vn_reach_pack {
    float low[3][VN_REACH_FAN], high[3][VN_REACH_FAN];
    float reach2[VN_REACH_FAN];
} vn_reach_pack;

typedef struct vn_reach_tree {
    int dim;
    VN_ARRAY(int32_t) items; ///< the points along the curve, in runs of eight
    VN_ARRAY(vn_reach_pack) packs;
    int32_t
        starts[VN_REACH_LEVELS + 1]; ///< level l has the packs [starts[l], starts[l + 1]); level 0 boxes runs
    int levels;
} vn_reach_tree;

void vn_reach_tree_free(vn_reach_tree *tree);

/// Rebuild over the points [0, count) that still remember something (reach2 >= 0).
vn_status vn_reach_tree_build(vn_reach_tree *tree, int dim, const vn_points *points, const double *reach2,
                              int32_t count);

/// The point at @p p remembers more than it did: @p reach2. (Remembering less needs no word.)
void vn_reach_tree_raise(vn_reach_tree *tree, const double p[3], double reach2);

typedef struct vn_reach_hit {
    int32_t point;
    double distance2;
} vn_reach_hit;
typedef VN_ARRAY(vn_reach_hit) vn_reach_hits;

/// Append to @p hits each point i of the tree with |p - i|² <= reach2[i].
vn_status vn_reach_tree_query(vn_reach_tree *tree, const vn_points *points, const double *reach2,
                              const double p[3], vn_reach_hits *hits);

#endif
