/// The line of least squares through points (shim over Eigen's eigenvectors of a symmetric matrix).
#ifndef VN_COLONIZE_AXIS_H
#define VN_COLONIZE_AXIS_H

#ifdef __cplusplus
extern "C" {
#endif

/// How points lie about their mean: the lower triangle of Σ x xᵀ, row by row.
typedef struct vn_spread {
    double covariance[6];
} vn_spread;

static inline void vn_spread_add(vn_spread *spread, const double x[3]) {
    double *c = spread->covariance;
    c[0] += x[0] * x[0];
    c[1] += x[1] * x[0];
    c[2] += x[1] * x[1];
    c[3] += x[2] * x[0];
    c[4] += x[2] * x[1];
    c[5] += x[2] * x[2];
}

/// The unit vector along which they spread most; its largest component is positive.
void vn_spread_axis(const vn_spread *spread, double axis[3]);

#ifdef __cplusplus
}
#endif

#endif
