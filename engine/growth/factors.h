/// Growth factors along a blade, and the heights that they make of the heights at first.
#ifndef VN_GROWTH_FACTORS_H
#define VN_GROWTH_FACTORS_H

#include "base/array.h"

/// f(y₀): linear between samples at evenly spaced heights, constant beyond the first and the last.
typedef struct vn_factors {
    VN_ARRAY(double) f;
    double low, cell; ///< the height of the first sample; from one sample to the next
} vn_factors;

/// Take @p count samples from @p low to @p high (NULL: 1 everywhere); VN_INVALID names the height of one that
/// is no factor, after "@p what".
vn_status vn_factors_set(vn_factors *factors, const char *what, const double *samples, int32_t count,
                         double low, double high);
void vn_factors_free(vn_factors *factors);
/// Sample the smooth curve through @p points points (y, f), y ascending, at evenly spaced heights. It
/// overshoots no point, and is constant beyond the first and the last. VN_INVALID names the point that is
/// wrong.
vn_status vn_factors_spline(double *out, int32_t samples, const char *what, const double *yf, int32_t points,
                            double low, double high);
double vn_factors_at(const vn_factors *factors, double y0);

/// y(t) = ∫₀^{y₀} f^t dy at every sample, for one t: exact for the f above, in between too.
typedef struct vn_heights {
    const vn_factors *factors;
    double time;
    VN_ARRAY(double) y;
} vn_heights;

/// VN_INFEASIBLE when heights can no longer be told apart, or are out of the range of numbers.
vn_status vn_heights_make(vn_heights *heights, const vn_factors *factors, double time);
void vn_heights_free(vn_heights *heights);
double vn_heights_at(const vn_heights *heights, double y0);
/// The y₀ whose height is @p y.
double vn_heights_invert(const vn_heights *heights, double y);

#endif
