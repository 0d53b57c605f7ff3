/// Mean value coordinates of a point with respect to a closed polygon.
#ifndef VN_GROWTH_MEAN_VALUE_H
#define VN_GROWTH_MEAN_VALUE_H

#include "base/status.h"

/// Corners of a polygon as columns.
typedef struct vn_corners {
    const double *x, *y;
    int32_t count;
} vn_corners;

/// Where @p p comes when the corners of @p before move to those of @p after: Σ λ_i after_i, with λ_i the mean
/// value coordinates of @p p in @p before. On an edge it is linear; the identity when both are equal.
/// Defined in the whole plane for every polygon that does not cross itself.
void vn_mean_value_move(const vn_corners *before, const vn_corners *after, const double p[2], double q[2]);

#endif
