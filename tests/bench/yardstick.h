/// The yardstick that absolute times are divided by: machines differ, and one machine differs from hour
/// to hour.
#ifndef VN_BENCH_YARDSTICK_H
#define VN_BENCH_YARDSTICK_H

#ifdef __cplusplus
extern "C" {
#endif

/// Seconds that CGAL's 2D Delaunay triangulation of @p points uniform points takes on one core, by one
/// insert(begin, end). Negative when it failed.
double vn_yardstick(int points);

#ifdef __cplusplus
}
#endif

#endif
