/// A changing set of straight tubes in cells of a regular grid: nearest ones, and those near another. Where a
/// tube is, the caller knows; the grid holds numbers.
#ifndef VN_SPACE_TUBE_GRID_H
#define VN_SPACE_TUBE_GRID_H

#include "base/array.h"
#include "base/status.h"

/// A tube in one of the cells that it passes.
typedef struct vn_tube_entry {
    int32_t tube, next;
} vn_tube_entry;

typedef struct vn_tube_grid {
    int dim;
    double low[3]; ///< corner of the first cell
    double cell;
    int32_t size[3];         ///< cells in each direction; what lies beyond is listed in the outermost
    VN_ARRAY(int32_t) heads; ///< of the chain of each cell
    VN_ARRAY(vn_tube_entry) entries;
    int32_t spare; ///< head of the chain of unused entries, or -1
} vn_tube_grid;

/// An empty grid of about @p cells cells (never more than 2^27) over the box; what it held is dropped.
vn_status vn_tube_grid_init(vn_tube_grid *grid, int dim, const double low[3], const double high[3],
                            int32_t cells);
void vn_tube_grid_free(vn_tube_grid *grid);

/// List the tube from @p a to @p b in every cell that its axis passes.
vn_status vn_tube_grid_insert(vn_tube_grid *grid, int32_t tube, const double a[3], const double b[3]);
/// Take it out again: the ends are those that it was listed with.
void vn_tube_grid_remove(vn_tube_grid *grid, int32_t tube, const double a[3], const double b[3]);

/// Return false to stop.
typedef bool vn_tube_visit_fn(int32_t tube, void *payload);
/// Visit all tubes listed in cells that the box touches, some of them several times. False when stopped.
bool vn_tube_grid_visit(const vn_tube_grid *grid, const double low[3], const double high[3],
                        vn_tube_visit_fn *visit, void *payload);
/// Visit those in the cells that are @p ring cells away from that of @p p (0: its own cell). Returns how far
/// around @p p everything has been visited when all rings up to this one were: INFINITY once nothing is left.
double vn_tube_grid_visit_ring(const vn_tube_grid *grid, const double p[3], int32_t ring,
                               vn_tube_visit_fn *visit, void *payload);

/// Squared distances between a point and a segment, and between two segments; ends may coincide.
double vn_point_segment_distance2(const double p[3], const double a[3], const double b[3]);
double vn_segment_segment_distance2(const double a[3], const double b[3], const double c[3],
                                    const double d[3]);

#endif
