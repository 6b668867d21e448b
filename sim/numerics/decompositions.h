#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

// Sources that include this header take these from decompositions.cc: Eigen's factorisations of
// dense matrices cost the compiler some 3 s each. Expressions are evaluated before,
// `Solver(Matrix(A.transpose() * A))`, as only factorisations of plain matrices are here.
extern template Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& Eigen::SelfAdjointEigenSolver<
    Eigen::MatrixXd>::compute<Eigen::MatrixXd>(const Eigen::EigenBase<Eigen::MatrixXd>&, int);
extern template Eigen::LDLT<Eigen::MatrixXd>&
Eigen::LDLT<Eigen::MatrixXd>::compute<Eigen::MatrixXd>(const Eigen::EigenBase<Eigen::MatrixXd>&);
extern template void Eigen::LDLT<Eigen::MatrixXd>::_solve_impl_transposed<true>(
    const Eigen::VectorXd&, Eigen::VectorXd&) const;

namespace continuum {

/// The least real part of the eigenvalues of a square matrix: positive for a stiffness that holds.
/// Out of line, for any size: Eigen's solver of unsymmetric problems takes the compiler 10 s a
/// size.
double LeastRealEigenvalue(const Eigen::MatrixXd& matrix);

}  // namespace continuum
