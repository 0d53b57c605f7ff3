/// The bench "cco".
#ifndef VN_BENCH_CCO_H
#define VN_BENCH_CCO_H

#include "report.h"

/// Trees of 1,000 to 1,000,000 terminals (10,000 when @p quick) in a disk and a ball, in seconds and in
/// yardsticks.
void bench_cco(report *r, double yard, bool quick);

#endif
