#include "sim/numerics/decompositions.h"

template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& Eigen::SelfAdjointEigenSolver<
    Eigen::MatrixXd>::compute<Eigen::MatrixXd>(const Eigen::EigenBase<Eigen::MatrixXd>&, int);
template Eigen::LDLT<Eigen::MatrixXd>& Eigen::LDLT<Eigen::MatrixXd>::compute<Eigen::MatrixXd>(
    const Eigen::EigenBase<Eigen::MatrixXd>&);
template void Eigen::LDLT<Eigen::MatrixXd>::_solve_impl_transposed<true>(const Eigen::VectorXd&,
                                                                         Eigen::VectorXd&) const;

namespace continuum {

double LeastRealEigenvalue(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().real().minCoeff();
}

}  // namespace continuum
