#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <vector>

namespace continuum::tdcr {

/// J x = b of a rod with contacts that remember. A contact that slides moves nothing but its own
/// residual: its column is -1 on the diagonal. Such unknowns are left out and follow afterwards,
///
///   J_cc x_c = b_c,   x_u = J_uc x_c - b_u                                                    (1)
///
/// With nine tendons on 60 steps of the rod some 50 of 543 unknowns are left.
class ContactFactors {
 public:
  explicit ContactFactors(Eigen::Index /*size*/) {}

  void compute(const Eigen::MatrixXd& jacobian) {
    coupled_.clear();
    alone_.clear();
    for (Eigen::Index i = 0; i < jacobian.cols(); ++i) {
      const bool alone = jacobian(i, i) == -1 && (jacobian.col(i).array() != 0).count() == 1;
      (alone ? alone_ : coupled_).push_back(i);
    }
    factors_.compute(jacobian(coupled_, coupled_));
    follow_ = jacobian(alone_, coupled_);
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& b) const {
    Eigen::VectorXd x(b.size());
    const Eigen::VectorXd coupled = factors_.solve(b(coupled_));
    x(coupled_) = coupled;
    if (!alone_.empty()) x(alone_) = follow_ * coupled - b(alone_);
    return x;
  }

 private:
  std::vector<Eigen::Index> coupled_, alone_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
  Eigen::MatrixXd follow_;
};

}  // namespace continuum::tdcr
