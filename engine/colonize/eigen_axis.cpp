#include "colonize/axis.h"

#include <Eigen/Eigenvalues>

extern "C" void vn_spread_axis(const vn_spread *spread, double axis[3]) {
    const double *c = spread->covariance;
    Eigen::Matrix3d matrix;
    matrix << c[0], c[1], c[3], c[1], c[2], c[4], c[3], c[4], c[5];
    // The iterative solver: the direct one loses the vector where two eigenvalues are close.
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    Eigen::Vector3d v = solver.eigenvectors().col(2);
    Eigen::Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    v *= v[largest] < 0 ? -1 : 1;
    Eigen::Map<Eigen::Vector3d>(axis, 3) = v;
}
