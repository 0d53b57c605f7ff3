/// Where lines meet triangles, decided without rounding.
#ifndef VN_SPACE_TRIANGLE_MEETS_H
#define VN_SPACE_TRIANGLE_MEETS_H

#include "space/triangle_tree.h"

typedef enum vn_line_meeting {
    VN_LINE_APART,
    VN_LINE_MEETS,    ///< they share a point; those of the triangle's border count
    VN_LINE_COPLANAR, ///< the line is in the triangle's plane
} vn_line_meeting;

/// The line from @p a to @p b, ends included.
vn_line_meeting vn_line_meets(const vn_triangle *triangle, const double a[3], const double b[3]);

/// Of a line in the triangle's plane, whether they share a point.
bool vn_coplanar_line_meets(const vn_triangle *triangle, const double a[3], const double b[3]);

/// Of a line from the triangle's corner `a` to @p b, whether they share more than that.
bool vn_line_enters(const vn_triangle *triangle, const double b[3]);

/// A ray from @p p towards greater x, moved from there by next to nothing along y and by less along z, so
/// that it passes no edge: whether it goes through the triangle. So each of the rays passes just one of two
/// triangles that lie on either side of an edge, and both or none of those on one side. @p touched is set
/// when
/// @p p is on the triangle.
bool vn_ray_passes(const vn_triangle *triangle, const double p[3], bool *touched);

#endif
