/// Random terminals far from the vessels that there are (Kerautret et al. 2023, section 3.3.2): the
/// distribution of darts that fall anywhere and are refused nearly always, without throwing those that must
/// be.
///
/// The box around the region is cut into a tree of cells. Each knows a vessel, and so a distance that no
/// point in it exceeds from the vessels: that of its middle and half its diagonal. Darts are thrown only into
/// cells where that is above the threshold, and those that would have fallen elsewhere are counted in one
/// stroke. Those too near to the middle are refused by their cell's class, before any cell is looked up.
#ifndef VN_CCO_DARTS_H
#define VN_CCO_DARTS_H

#include "base/array.h"
#include "venule/cco.h"

enum { VN_DART_LEVELS = 18, VN_DART_CLASSES = 140, VN_DART_WHOLE = 1023 };

typedef struct vn_dart_cell {
    uint64_t at : 54;   ///< which cell of its level, 18 bits for each direction
    uint64_t mass : 10; ///< part of it that is in the region, weighed by density; all of it: VN_DART_WHOLE
    int32_t
        link; ///< of a leaf, its place in its bin, or -1 where nothing of the region is; else ~first child
    int32_t witness[2]; ///< the vessel that last refused a dart here, and the one before; or -1
    float bound;
} vn_dart_cell;

typedef struct vn_dart_bin {
    VN_ARRAY(int32_t) cells;
} vn_dart_bin;

typedef struct vn_darts {
    int dim;
    const vn_domain *region;
    vn_cco_value_fn *density;
    void *payload;
    double low[3], side; ///< of the outermost cell
    double total;        ///< mass of the region: its measure, weighed
    double mean;         ///< density
    double tolerance;    ///< that vessels may be away from where vn_darts_tell() was told
    VN_ARRAY(vn_dart_cell) cells;
    vn_dart_bin *bins;                ///< by class of bound, then level
    uint32_t levels[VN_DART_CLASSES]; ///< which of a class's bins hold any
    double mass[VN_DART_CLASSES];     ///< of each class's leaves
    double volume[VN_DART_CLASSES];
    double bounds[VN_DART_CLASSES]; ///< none of the class is above it
} vn_darts;

/// @p tolerance is small against the thresholds that are to come.
vn_status vn_darts_init(vn_darts *darts, int dim, const vn_domain *region, double tolerance,
                        vn_cco_value_fn *density, void *payload, vn_rng *rng);
void vn_darts_free(vn_darts *darts);

/// What terminals keep away from, and how one is looked for.
typedef struct vn_dart_search {
    double threshold, factor; ///< after so many tries in vain the threshold is multiplied by the factor
    int32_t tries;
    int32_t most_cells; ///< cells are not divided any more when there are as many
    /// The distance from @p p to the nearest vessel, whose number is @p vessel then.
    double (*distance)(const double p[3], int32_t *vessel, void *payload);
    double (*distance_to)(const double p[3], int32_t vessel, void *payload);
    /// Whether a point far enough away may not be taken all the same.
    bool (*refuse)(const double p[3], void *payload);
    void *payload;
} vn_dart_search;
/// A random point; @p darts_thrown counts those that were skipped too. VN_INFEASIBLE when none is found at a
/// millionth of the region's size.
vn_status vn_darts_throw(vn_darts *darts, const vn_dart_search *search, vn_rng *rng, double p[3],
                         int64_t *darts_thrown);

/// Vessels were added: these, each a segment from one point to the next. Where @p moved is above 0, vessels
/// at most that far from the first two were there instead.
vn_status vn_darts_tell(vn_darts *darts, const int32_t *vessels, const double (*ends)[2][3], int32_t count,
                        double moved);

#endif
