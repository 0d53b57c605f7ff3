// Shim over Eigen's sparse LDLᵀ, with its approximate minimum degree ordering.
#include "network/sparse.h"

#include "base/guard.hpp"

#include <Eigen/SparseCholesky>

#include <cmath>
#include <memory>
#include <vector>

namespace {

// 64-bit indices: the factor of a large network may well have more entries than 32 bits count.
using Index = std::int64_t;
using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;
using Factor = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<Index>>;
using Numbers = Eigen::Map<Eigen::VectorXd>;
using GivenNumbers = Eigen::Map<const Eigen::VectorXd>;

} // namespace

struct vn_sparse {
    Factor factor;
};

namespace {

bool is_positive(const Factor &factor) {
    const auto &diagonal = factor.vectorD();
    for (Index i = 0; i < diagonal.size(); i++) {
        if (!(diagonal[i] > 0 && std::isfinite(diagonal[i]))) {
            return false;
        }
    }
    return true;
}

vn_status factorize(vn_sparse &sparse, int32_t size, const vn_sparse_entry *entries, int64_t count) {
    std::vector<Eigen::Triplet<double, Index>> triplets;
    triplets.reserve(static_cast<size_t>(count));
    for (int64_t i = 0; i < count; i++) {
        triplets.emplace_back(entries[i].row, entries[i].column, entries[i].value);
    }
    Matrix matrix(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    sparse.factor.compute(matrix);
    if (sparse.factor.info() != Eigen::Success || !is_positive(sparse.factor)) {
        return vn_fail(VN_INFEASIBLE,
                       "a sparse system of %d unknowns is not positive definite in doubles: its "
                       "numbers are too far apart",
                       size);
    }
    return VN_OK;
}

} // namespace

extern "C" vn_status vn_sparse_factor(vn_sparse **out, int32_t size, const vn_sparse_entry *entries,
                                      int64_t count) {
    *out = nullptr;
    return vn_guard("factoring a sparse system", [&] {
        auto sparse = std::make_unique<vn_sparse>();
        vn_status status = factorize(*sparse, size, entries, count);
        *out = status == VN_OK ? sparse.release() : nullptr;
        return status;
    });
}

extern "C" vn_status vn_sparse_solve(const vn_sparse *sparse, const double *right, double *out) {
    return vn_guard("solving a sparse system", [&] {
        Index size = sparse->factor.rows();
        Eigen::VectorXd solution = sparse->factor.solve(GivenNumbers(right, size));
        Numbers(out, size) = solution;
        return VN_OK;
    });
}

extern "C" void vn_sparse_destroy(vn_sparse *sparse) {
    delete sparse;
}
