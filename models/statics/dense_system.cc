#include "models/statics/dense_system.h"

#include <Eigen/Eigenvalues>

namespace continuum::statics {

int NegativeRealParts(const Eigen::MatrixXd& matrix) {
  constexpr double kZero = -1e-9;  // of the largest
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
  const double limit = kZero * values.cwiseAbs().maxCoeff();
  return static_cast<int>((values.real().array() < limit).count());
}

}  // namespace continuum::statics
