#include "base/status.h"

#include <math.h>
#include <signal.h>
#include <stdatomic.h>
#include <time.h>

// The time budget belongs to the process, as the memory budget does: what an operator grants to a run.
static struct {
    volatile sig_atomic_t interrupted;
    _Atomic double deadline; // seconds of the monotonic clock; 0: none
    _Atomic double granted;
} vn_clock;

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void vn_set_time_budget(double seconds) {
    atomic_store(&vn_clock.granted, seconds);
    atomic_store(&vn_clock.deadline, seconds > 0 ? now() + seconds : 0.0);
}

void vn_interrupt(void) {
    vn_clock.interrupted = 1;
}

vn_status vn_poll(void) {
    if (vn_clock.interrupted) {
        vn_clock.interrupted = 0;
        return vn_fail(VN_INTERRUPTED, "interrupted");
    }
    double deadline = atomic_load(&vn_clock.deadline);
    if (deadline > 0 && now() > deadline) {
        return vn_fail(VN_LIMIT, "time is up: the run passed its limit of %g s (raise --time, or grow less)",
                       atomic_load(&vn_clock.granted));
    }
    return VN_OK;
}
