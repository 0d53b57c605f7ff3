// Equation 12 of Kerautret et al. 2023 as it is printed, by the whole of Ceres.
#include <ceres/ceres.h>

#include <cmath>

namespace {

struct printed {
    const double *f, *l, *d;

    template <typename T>
    bool operator()(const T *const square, T *residual) const {
        using ceres::pow;
        T sixth = pow(square[0], 3) / f[1] + pow(square[1], 3) / f[2];
        T root = pow(f[0] * sixth, 2.0 / 3);
        for (int i = 0; i < 2; i++) {
            T fourth = square[i] * square[i];
            residual[i] = (d[i] * fourth * root - f[0] * l[0] * fourth - f[i + 1] * l[i + 1] * root) /
                          (d[i] * fourth * root);
        }
        return true;
    }
};

} // namespace

extern "C" bool ceres_oracle(const double f[3], const double l[3], const double d[2], double radius[3]);

extern "C" bool ceres_oracle(const double f[3], const double l[3], const double d[2], double radius[3]) {
    double square[2];
    for (int i = 0; i < 2; i++) {
        square[i] = 1.5 * std::sqrt(f[i + 1] * l[i + 1] / d[i]);
    }
    ceres::Problem problem;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<printed, 2, 2>(new printed{f, l, d}), nullptr,
                             square);
    for (int i = 0; i < 2; i++) {
        problem.SetParameterLowerBound(square, i, 1e-12 * square[i]);
    }
    ceres::Solver::Options options;
    options.max_num_iterations = 1000;
    options.function_tolerance = 0;
    options.gradient_tolerance = 1e-16;
    options.parameter_tolerance = 1e-16;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    radius[1] = std::sqrt(square[0]);
    radius[2] = std::sqrt(square[1]);
    radius[0] = std::pow(f[0] * (std::pow(radius[1], 6) / f[1] + std::pow(radius[2], 6) / f[2]), 1.0 / 6);
    return summary.final_cost < 1e-20;
}
