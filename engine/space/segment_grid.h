/// A fixed set of line segments in the plane, for "which are near here".
#ifndef VN_SPACE_SEGMENT_GRID_H
#define VN_SPACE_SEGMENT_GRID_H

#include "base/array.h"
#include "space/exact.h"

typedef struct vn_segment {
    double x0, y0, x1, y1;
} vn_segment;

/// Cells of a regular grid over the segments' bounds, each with the segments that cross it.
typedef struct vn_segment_grid {
    VN_ARRAY(vn_segment) segments;
    VN_ARRAY(int32_t) starts; ///< cell c holds items [starts[c], starts[c + 1])
    VN_ARRAY(int32_t) items;
    double min_x, min_y, cell;
    int32_t columns, rows;
} vn_segment_grid;

/// Push the segments, then build once; a zeroed grid is empty.
vn_status vn_segment_grid_build(vn_segment_grid *grid);
void vn_segment_grid_free(vn_segment_grid *grid);

/// Return false to stop.
typedef bool vn_segment_visit_fn(int32_t segment, void *payload);
/// Visit every segment that shares a cell with the box; one may be visited several times. False when stopped.
bool vn_segment_grid_visit(const vn_segment_grid *grid, double min_x, double min_y, double max_x,
                           double max_y, vn_segment_visit_fn *visit, void *payload);

/// The segment nearest to (x, y), its squared distance and the nearest point; -1 when there are no segments.
/// Of several equally near ones, the lowest index.
int32_t vn_segment_grid_nearest(const vn_segment_grid *grid, double x, double y, double *distance2,
                                double q[2]);

/// Whether two segments share a point (ends included).
bool vn_segments_touch(const vn_segment *s, const vn_segment *t);

#endif
