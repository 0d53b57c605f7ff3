/// What every bench needs: calls that must not fail, and the time.
#ifndef VN_BENCH_STOPWATCH_H
#define VN_BENCH_STOPWATCH_H

#include "venule/venule.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static inline void bench_must(vn_status status) {
    if (status != VN_OK) {
        fprintf(stderr, "bench: %s\n", vn_message());
        exit(vn_exit_status(status));
    }
}

/// Seconds since some moment.
static inline double bench_now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

#endif
