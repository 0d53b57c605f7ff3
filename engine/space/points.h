/// Points as columns: the one shape in which the engine hands them around.
#ifndef VN_SPACE_POINTS_H
#define VN_SPACE_POINTS_H

#include "base/sort.h"

#include <math.h>

/// Borrowed columns; `z` is NULL in 2D.
typedef struct vn_points {
    const double *x, *y, *z;
} vn_points;

static inline void vn_points_get(const vn_points *points, int32_t i, double p[3]) {
    p[0] = points->x[i];
    p[1] = points->y[i];
    p[2] = points->z != NULL ? points->z[i] : 0;
}

static inline double vn_points_distance2(const vn_points *points, int32_t i, const double p[3]) {
    double dx = points->x[i] - p[0];
    double dy = points->y[i] - p[1];
    double dz = points->z != NULL ? points->z[i] - p[2] : 0;
    return dx * dx + dy * dy + dz * dz;
}

static inline double vn_distance2(const double p[3], const double q[3]) {
    double dx = q[0] - p[0];
    double dy = q[1] - p[1];
    double dz = q[2] - p[2];
    return dx * dx + dy * dy + dz * dz;
}

static inline bool vn_finite(const double p[3]) {
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

/// Number @p index of a sequence that fills [0, 1) evenly; bases without a common factor fill boxes.
double vn_halton(int32_t index, int32_t base);

/// The place of @p p along a Z-shaped curve through the box: points near one another mostly get near keys.
uint64_t vn_morton(const double p[3], int dim, const double min[3], double size);

/// The box around points [begin, end) and the length of its longest side; an empty range has none
/// (negative infinity).
double vn_points_extent(const vn_points *points, int32_t begin, int32_t end, double low[3], double high[3]);

/// Sort @p items, whose values are points, along the curve through the box at @p low of side @p size.
vn_status vn_points_sort(const vn_points *points, int dim, const double low[3], double size,
                         vn_keyed_array *items, vn_keyed_array *scratch);

#endif
