/// A parallel loop whose result cannot depend on the number of threads: each range writes to its own slots.
#ifndef VN_BASE_PARALLEL_H
#define VN_BASE_PARALLEL_H

#include "base/status.h"

/// Work on the indices [begin, end). Must write only what belongs to these indices.
typedef void vn_range_fn(int64_t begin, int64_t end, void *payload);

/// Call @p work over [0, count) in ranges of at most @p grain indices (1 or more), in any order.
void vn_parallel_for(int64_t count, int64_t grain, vn_range_fn *work, void *payload);

#endif
