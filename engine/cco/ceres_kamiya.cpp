// Equation 12 of Kerautret et al. 2023 by Ceres' tiny solver, which takes no memory.
#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

#include <cmath>

extern "C" {
#include "cco/bifurcation.h"
}

namespace {

// The unknowns are the logarithms of the squares of both radii: as squares, a step may make one negative.
// Each equation is the logarithm of what both sides of (12) are to one another.
struct drops {
    const double *flow, *length, *drop;

    template <typename T>
    bool operator()(const T *const square, T *residual) const {
        using std::exp;
        using std::log;
        T sixth = exp(3.0 * square[0]) / flow[1] + exp(3.0 * square[1]) / flow[2];
        T upper = flow[0] * length[0] * exp(-2.0 / 3 * log(flow[0] * sixth)); // (11)
        for (int i = 0; i < 2; i++) {
            residual[i] = log((upper + flow[i + 1] * length[i + 1] * exp(-2.0 * square[i])) / drop[i]);
        }
        return true;
    }
};

} // namespace

extern "C" bool vn_ceres_radii(const double flow[3], const double length[3], const double drop[2],
                               double radius[3]) {
    if (!(drop[0] > 0 && drop[1] > 0)) {
        return false;
    }
    using function = ceres::TinySolverAutoDiffFunction<drops, 2, 2>;
    drops equations{flow, length, drop};
    function automatic(equations);
    ceres::TinySolver<function> solver;
    solver.options.gradient_tolerance = 1e-15;
    solver.options.function_tolerance = 0;
    solver.options.parameter_tolerance = 1e-16;
    solver.options.cost_threshold = 1e-30;
    solver.options.max_num_iterations = 200;
    Eigen::Vector2d square;
    for (int i = 0; i < 2; i++) {
        square[i] = std::log(1.5 * std::sqrt(flow[i + 1] * length[i + 1] / drop[i]));
    }
    auto summary = solver.Solve(automatic, &square);
    double sixth = 0;
    for (int i = 0; i < 2; i++) {
        radius[i + 1] = std::exp(square[i] / 2);
        sixth += std::exp(3 * square[i]) / flow[i + 1];
    }
    radius[0] = std::pow(flow[0] * sixth, 1.0 / 6);
    return summary.final_cost < 1e-16 && std::isfinite(radius[0]);
}
