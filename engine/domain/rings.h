/// Closed polylines, and what can be done with them: the common tongue of outlines.
#ifndef VN_DOMAIN_RINGS_H
#define VN_DOMAIN_RINGS_H

#include "base/array.h"
#include "space/segment_grid.h"
#include "venule/domain.h"

/// Ring i has the points [i > 0 ? ends[i-1] : 0, ends[i]); the last is joined to the first.
typedef struct vn_rings {
    VN_ARRAY(double) x;
    VN_ARRAY(double) y;
    VN_ARRAY(int32_t) ends;
} vn_rings;

void vn_rings_free(vn_rings *rings);
vn_status vn_rings_point(vn_rings *rings, double x, double y);
/// End the ring that vn_rings_point() was filling. Repeated neighbours and a repeated first point are
/// dropped, and so is a ring of fewer than three points.
vn_status vn_rings_close(vn_rings *rings);
vn_status vn_rings_append(vn_rings *rings, const vn_rings *more);
static inline int32_t vn_rings_begin(const vn_rings *rings, int32_t ring) {
    return ring > 0 ? rings->ends.data[ring - 1] : 0;
}

/// The area of one ring, positive when it runs counter-clockwise.
double vn_rings_area_of(const vn_rings *rings, int32_t ring);
vn_box vn_rings_bounds(const vn_rings *rings);
/// Push every edge into @p grid, that of point i as segment i; the grid is not built yet.
vn_status vn_rings_edges(const vn_rings *rings, vn_segment_grid *grid);
/// The point that ends the edge of point @p i of the ring [begin, end).
static inline int32_t vn_rings_next(int32_t begin, int32_t end, int32_t i) {
    return i + 1 < end ? i + 1 : begin;
}

/// Two edges that cross or touch without being neighbours; VN_INVALID says where, after "@p what: ".
vn_status vn_rings_check_simple(const vn_rings *rings, const char *what);

typedef enum vn_fill { VN_FILL_EVEN_ODD, VN_FILL_NONZERO } vn_fill;
/// Clean outlines of what a painter fills by @p fill: no crossings, outer rings counter-clockwise, holes
/// clockwise.
vn_status vn_rings_resolve(vn_rings *out, const vn_rings *rings, vn_fill fill);
/// The outlines of a combination; both operands filled even-odd.
vn_status vn_rings_combine(vn_rings *out, const vn_rings *a, const vn_rings *b, vn_combination how);

/// The outlines, filled even-odd, with a margin of width @p margin taken off all round; its arcs are off by
/// 1e-6 of it.
vn_status vn_rings_inset(vn_rings *out, const vn_rings *rings, double margin);

/// The outlines of any 2D domain. Curved borders become polylines of equal area with about @p sides sides
/// a circle.
vn_status vn_domain_outline(const vn_domain *domain, int32_t sides, vn_rings *out);

/// A polygon domain that takes over @p rings (left empty, also on failure), which vn_rings_resolve() has
/// cleaned.
vn_status vn_domain_from_rings(vn_domain **out, vn_rings *rings, const char *unit);

#endif
