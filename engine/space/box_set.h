/// A grid of boxes of which some are taken: those that lines pass, exactly.
#ifndef VN_SPACE_BOX_SET_H
#define VN_SPACE_BOX_SET_H

#include "base/array.h"
#include "base/status.h"

/// Coordinates count in parts of a box; box i holds [i, i + 1) boxes, so its lower faces and not its upper
/// ones.
#define VN_BOX_PARTS 32768

/// A zeroed one is empty and owns nothing.
typedef struct vn_box_set {
    int dim;
    int64_t side; ///< boxes along each
    uint64_t *bits;
    size_t words, room;
} vn_box_set;
void vn_box_set_free(vn_box_set *set);

/// None taken, of @p side boxes in each direction: side^dim at most 2^33, and side at most 2^16.
vn_status vn_box_set_clear(vn_box_set *set, int dim, int64_t side);

/// Take every box that has a point of the line from @p a to @p b, ends included; both lie in the grid.
void vn_box_set_add(vn_box_set *set, const int64_t a[3], const int64_t b[3]);

bool vn_box_set_has(const vn_box_set *set, const int64_t box[3]);
int64_t vn_box_set_count(const vn_box_set *set);

/// The boxes of twice the side that hold a taken one, into @p out, which is cleared. The side is even.
vn_status vn_box_set_double(vn_box_set *out, const vn_box_set *set);

#endif
