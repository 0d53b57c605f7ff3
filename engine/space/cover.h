/// Which cells of a fine grid lie wholly within a distance of some point: whoever falls into one need not
/// ask how near the points are.
#ifndef VN_SPACE_COVER_H
#define VN_SPACE_COVER_H

#include "base/array.h"
#include "base/status.h"

typedef struct vn_cover {
    int dim;
    double low[3], cell; ///< corner of the first cell, and their width; 0: the cover is of no use
    double per_cell;
    int32_t size[3]; ///< cells in each direction
    int32_t words;   ///< 64-bit words a row
    double radius;   ///< of the points
    VN_ARRAY(uint64_t) bits;
} vn_cover;

/// An empty cover of the box, for points that cover what is within @p radius (> 0) of them. Its cells are a
/// sixth of that wide (in 3D a third), or as wide as 2 MB allow; where that is more than 2/5 of it, its width
/// is 0.
vn_status vn_cover_init(vn_cover *cover, int dim, const double low[3], const double high[3], double radius);
void vn_cover_free(vn_cover *cover);

/// What it does outside the box does not matter.
void vn_cover_add(vn_cover *cover, const double p[3]);

/// Whether @p p is in a covered cell: nearer than the radius to some point. When false, nothing is known.
static inline bool vn_cover_holds(const vn_cover *cover, const double p[3]) {
    int64_t at[3] = {0, 0, 0};
    for (int k = 0; k < cover->dim; k++) {
        double cell = (p[k] - cover->low[k]) * cover->per_cell;
        if (!(cell >= 0 && cell < cover->size[k])) {
            return false;
        }
        at[k] = (int64_t)cell;
    }
    const uint64_t *row = cover->bits.data + (at[2] * cover->size[1] + at[1]) * cover->words;
    return row[at[0] >> 6] >> (at[0] & 63) & 1;
}

#endif
