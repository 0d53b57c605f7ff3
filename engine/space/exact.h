/// On which side a point is, without rounding: what decides so never contradicts itself.
#ifndef VN_SPACE_EXACT_H
#define VN_SPACE_EXACT_H

/// Twice the signed area of the triangle a, b, c: positive when they turn left. Exact in sign.
double vn_turn(double ax, double ay, double bx, double by, double cx, double cy);

/// Six times the signed volume of the tetrahedron a, b, c, p: positive when p is where (b - a) x (c - a)
/// points. Exact in sign, for coordinates whose products neither overflow nor underflow (1e-90 to 1e90, and
/// 0).
double vn_turn_3(const double a[3], const double b[3], const double c[3], const double p[3]);

#endif
