/// The bench "vessels".
#ifndef VN_BENCH_VESSELS_H
#define VN_BENCH_VESSELS_H

#include "report.h"

/// Rauch & Harders' disk of 100 and of 800 steps, the retina, and vessels that fill a ball with up to a
/// million nodes (a hundred thousand when @p quick), in seconds and in yardsticks.
void bench_vessels(report *r, double yard, bool quick);

#endif
