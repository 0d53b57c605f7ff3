/// Triangles in space, in a tree of boxes: which one is nearest to a point, and which ones touch it.
#ifndef VN_SPACE_TRIANGLE_TREE_H
#define VN_SPACE_TRIANGLE_TREE_H

#include "space/points.h"

/// Its corners. Where the last two are equal it is an edge: the answers hold for that, too.
typedef struct vn_triangle {
    double a[3], b[3], c[3];
} vn_triangle;

enum { VN_TRIANGLE_FAN = 8, VN_TRIANGLE_LEVELS = 12 };

/// The boxes of eight triangles, or of eight smaller packs, side by side so that they are tested together.
/// In units of the tree's size from its lowest corner, rounded outwards.
typedef struct vn_triangle_pack {
    float low[3][VN_TRIANGLE_FAN], high[3][VN_TRIANGLE_FAN];
} vn_triangle_pack;

/// A zeroed one is empty and owns nothing.
typedef struct vn_triangle_tree {
    VN_ARRAY(vn_triangle) triangles; ///< neighbours beside one another
    VN_ARRAY(int32_t) numbers;       ///< of each of them, as they were given
    VN_ARRAY(double) radii;          ///< how thick each of them is; empty: none is
    VN_ARRAY(vn_triangle_pack) packs;
    int32_t starts[VN_TRIANGLE_LEVELS + 1]; ///< level l has the packs [starts[l], starts[l + 1])
    int levels;                             ///< level 0 boxes triangles
    double low[3], size;
} vn_triangle_tree;

/// The nearest point @p q of the triangle; returns its squared distance.
double vn_triangle_closest(const vn_triangle *triangle, const double p[3], double q[3]);

/// Build it of @p count triangles, a copy of which it keeps. All corners are finite.
vn_status vn_triangle_tree_build(vn_triangle_tree *tree, const vn_triangle *triangles, int32_t count);
/// The same of thick ones: all that is within @p radii[i] (0 or more) of triangle i belongs to it.
vn_status vn_triangle_tree_build_thick(vn_triangle_tree *tree, const vn_triangle *triangles,
                                       const double *radii, int32_t count);
void vn_triangle_tree_free(vn_triangle_tree *tree);

/// The number of the triangle nearest to @p p, among those within squared distance @p reach2, or -1; of
/// equally near ones the lowest number. @p d2 gets the squared distance, @p q the nearest point. To thick
/// ones the distance is that to their surface, and 0 inside; @p q is the nearest point of the triangle all
/// the same.
int32_t vn_triangle_tree_nearest(const vn_triangle_tree *tree, const double p[3], double reach2, double *d2,
                                 double q[3]);

/// Called with a triangle's number; false ends the visit.
typedef bool vn_triangle_visit(int32_t number, void *payload);

/// Visit all triangles, thick or not, within squared distance @p reach2 of @p p, in an order that depends on
/// the tree alone. False when a visit was ended.
bool vn_triangle_tree_around(const vn_triangle_tree *tree, const double p[3], double reach2,
                             vn_triangle_visit *visit, void *payload);

/// Called with a triangle and its number; false ends the visit.
typedef bool vn_triangle_along(const vn_triangle *triangle, int32_t number, void *payload);

/// Visit all triangles that the line from @p a to @p b may meet: those whose boxes it comes into, and perhaps
/// a few more. In the same order; false when a visit was ended.
bool vn_triangle_tree_along(const vn_triangle_tree *tree, const double a[3], const double b[3],
                            vn_triangle_along *visit, void *payload);

#endif
