#pragma once

#include <Eigen/Core>

namespace continuum {

/// The least real part of the eigenvalues of a square matrix: positive for a stiffness that holds.
/// Out of line, for any size: Eigen's solver of unsymmetric problems takes the compiler 10 s a
/// size.
double LeastRealEigenvalue(const Eigen::MatrixXd& matrix);

}  // namespace continuum
