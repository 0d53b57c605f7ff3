#include "base/parallel.h"

#include <omp.h>

void vn_set_threads(int threads) {
    omp_set_num_threads(threads > 0 ? threads : omp_get_num_procs());
}

// Threads that wait for work keep their cores busy for a while, which on a shared machine costs the others
// more than a small loop gains: eighty per cent of a leaf of 27,000 nodes went there.
enum { FEWEST_RANGES = 16 };

void vn_parallel_for(int64_t count, int64_t grain, vn_range_fn *work, void *payload) {
    int64_t ranges = (count + grain - 1) / grain;
#pragma omp parallel for schedule(dynamic, 1) if (ranges >= FEWEST_RANGES)
    for (int64_t i = 0; i < ranges; i++) {
        int64_t begin = i * grain;
        int64_t end = begin + grain < count ? begin + grain : count;
        work(begin, end, payload);
    }
}
