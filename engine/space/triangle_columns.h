/// Triangles in columns along x, for "how many are there from here on?"
#ifndef VN_SPACE_TRIANGLE_COLUMNS_H
#define VN_SPACE_TRIANGLE_COLUMNS_H

#include "space/triangle_tree.h"

/// A zeroed one owns nothing.
typedef struct vn_triangle_columns {
    const vn_triangle *triangles; ///< borrowed
    double low[2], cell[2];       ///< of the grid over y and z
    int32_t counts[2];
    VN_ARRAY(int32_t) starts; ///< column c holds items [starts[c], starts[c + 1])
    VN_ARRAY(int32_t) items;  ///< triangles in ascending order
} vn_triangle_columns;

/// Over @p count triangles, which must stay where they are.
vn_status vn_triangle_columns_build(vn_triangle_columns *columns, const vn_triangle *triangles,
                                    int32_t count);
void vn_triangle_columns_free(vn_triangle_columns *columns);

/// Whether the ray from @p p towards greater x (vn_ray_passes()) passes an odd number of triangles, not
/// counting triangle @p skip (-1: none). @p touched is set when @p p is on one of them, and left else.
bool vn_triangle_columns_odd(const vn_triangle_columns *columns, const double p[3], int32_t skip,
                             bool *touched);

#endif
