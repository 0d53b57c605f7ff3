/// Sparse systems that are symmetric and positive definite, factored once and solved again and again. The
/// shim behind it is Eigen's.
#ifndef VN_NETWORK_SPARSE_H
#define VN_NETWORK_SPARSE_H

#include "venule/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct vn_sparse vn_sparse;

/// On or below the diagonal: row >= column. Entries of one place are added up.
typedef struct vn_sparse_entry {
    int32_t row, column;
    double value;
} vn_sparse_entry;

/// VN_INFEASIBLE where rounding left it not positive definite. One thread, so one result.
vn_status vn_sparse_factor(vn_sparse **out, int32_t size, const vn_sparse_entry *entries, int64_t count);
/// @p out and @p right have `size` numbers, and may be the same.
vn_status vn_sparse_solve(const vn_sparse *sparse, const double *right, double *out);
void vn_sparse_destroy(vn_sparse *sparse);

#ifdef __cplusplus
}
#endif

#endif
