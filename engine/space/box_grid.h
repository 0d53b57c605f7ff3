/// A growing set of boxes, in two or three dimensions, for "which of them overlap this one".
#ifndef VN_SPACE_BOX_GRID_H
#define VN_SPACE_BOX_GRID_H

#include "base/array.h"
#include "base/status.h"

/// A box in one of the cells that it touches; it is listed a little too large.
typedef struct vn_box_entry {
    int32_t item, next;
    float low[3], high[3]; ///< from the grid's origin
} vn_box_entry;

/// Boxes hashed into square or cubic cells. What a box is of, the caller knows: the grid holds numbers. An
/// item may have several boxes, and keeps them all.
typedef struct vn_box_grid {
    int dim;
    double cell;
    double origin[3];
    VN_ARRAY(int32_t) heads; ///< of the chain of each bucket; a power of two of them
    VN_ARRAY(vn_box_entry) entries;
    int32_t large; ///< head of the chain of boxes that touch too many cells to be listed there, or -1
} vn_box_grid;

/// Empty the grid and make it ready for about @p items boxes; @p cell > 0, best about as wide as most of
/// them. @p origin is best near the boxes, whose places are kept with seven digits from there.
vn_status vn_box_grid_init(vn_box_grid *grid, int dim, double cell, const double origin[3], int32_t items);
void vn_box_grid_free(vn_box_grid *grid);

vn_status vn_box_grid_insert(vn_box_grid *grid, int32_t item, const double low[3], const double high[3]);

/// Return false to stop. Must not insert.
typedef bool vn_box_visit_fn(int32_t item, void *payload);
/// Visit every item of which a box overlaps this one; some several times, and some that only come near it.
/// False when stopped.
bool vn_box_grid_visit(const vn_box_grid *grid, const double low[3], const double high[3],
                       vn_box_visit_fn *visit, void *payload);

#endif
