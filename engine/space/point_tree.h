/// A growing set of points in a tree of square boxes: is there a point in some region, however large or far
/// off it is, in time that depends on its border alone.
#ifndef VN_SPACE_POINT_TREE_H
#define VN_SPACE_POINT_TREE_H

#include "space/points.h"

/// A box: halved along each axis into `children`, 2^dim cells from that index on; or, where that is -1, a
/// leaf with `count` points in a chain of benches.
typedef struct vn_tree_cell {
    int32_t children, head, count;
} vn_tree_cell;

enum { VN_BENCH = 4 };

/// Some points of a leaf; their places are apart, as many coordinates as there are dimensions.
typedef struct vn_tree_bench {
    int32_t points[VN_BENCH];
    int32_t next; ///< the next of its leaf, which is full; or of those not in use; or -1
} vn_tree_bench;

/// Holds the points 0 .. count-1 of columns that the caller keeps. Their places are copied, leaf by leaf:
/// points in one box were mostly born far apart, and to fetch each from the columns takes most of a query.
typedef struct vn_point_tree {
    int dim;
    int32_t count;
    double low[3], size; ///< of the root's box
    VN_ARRAY(vn_tree_cell) cells;
    VN_ARRAY(vn_tree_bench) benches;
    VN_ARRAY(double) places; ///< of each bench VN_BENCH x, then as many y, and z
    int32_t idle;            ///< the first bench not in use, or -1
} vn_point_tree;

void vn_point_tree_free(vn_point_tree *tree);
/// Insert the points up to @p count that are not yet in it; a zeroed tree is empty.
vn_status vn_point_tree_update(vn_point_tree *tree, int dim, const vn_points *points, int32_t count);

/// Whether a point is nearer to @p p than @p radius.
bool vn_point_tree_any_within(const vn_point_tree *tree, const double p[3], double radius);

/// The lune of two points: what is nearer to `s` than `v` is, and no farther from `v` than `s` is.
typedef struct vn_lune {
    double s[3], v[3];
    double low[3], high[3];  ///< only this box of it is looked at,
    double normal[3], least; ///< and of that only what is at least this far along the normal
} vn_lune;

/// Whether a point of the tree may be in the lune; called only for points that are, to rounding.
typedef bool vn_point_test_fn(int32_t point, const vn_lune *lune, void *payload);
/// Whether @p test is true of some point.
bool vn_point_tree_any_in_lune(const vn_point_tree *tree, const vn_lune *lune, vn_point_test_fn *test,
                               void *payload);

/// A point found, and its squared distance.
typedef struct vn_found {
    int32_t point;
    double distance2;
    double to[3]; ///< the way there from where was asked
} vn_found;
typedef VN_ARRAY(vn_found) vn_found_array;

/// The points that may be relative neighbors of @p p (READINGS R4), by growing distance up to √reach2: each
/// that is not certainly excluded by another. Some that are excluded by points in between are among them.
vn_status vn_point_tree_around(const vn_point_tree *tree, const double p[3], double reach2,
                               vn_found_array *found);

#endif
