#include "sim/numerics/decompositions.h"

#include <Eigen/Eigenvalues>

namespace continuum {

double LeastRealEigenvalue(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().real().minCoeff();
}

}  // namespace continuum
