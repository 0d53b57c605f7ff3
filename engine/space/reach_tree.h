/// Points that each remember a squared distance: "which of them is this new point nearer to than what they
/// remember?" A forest of boxes over the points along a space-filling curve answers in time proportional to the answer.
#ifndef VN_SPACE_REACH_TREE_H
#define VN_SPACE_REACH_TREE_H

#include "base/sort.h"
#include "space/points.h"

/// A run of points, or of smaller blocks, and the largest distance that any of them remembers.
typedef struct vn_reach_block {
    float low[3], high[3];
    float reach2; ///< an upper bound; negative when nothing in it can answer any more
} vn_reach_block;

enum { VN_REACH_LEVELS = 12 };

typedef struct vn_reach_tree {
    int dim;
    VN_ARRAY(int32_t) items; ///< the points along the curve
    VN_ARRAY(vn_reach_block) blocks;
    int32_t starts[VN_REACH_LEVELS + 1]; ///< level l has the blocks [starts[l], starts[l + 1]); level 0 holds items
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
