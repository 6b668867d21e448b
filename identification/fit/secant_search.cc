#include "identification/fit/secant_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

class SecantSearch {
 public:
  SecantSearch(const ceres::CostFunction& cost, const Box& box, const Search& search, Vector& y,
               Matrix& slopes)
      : cost_(cost), box_(box), search_(search), y_(y), J_(slopes) {
    summary_.termination_type = ceres::NO_CONVERGENCE;
  }

  ceres::Solver::Summary Run() {
    r_.resize(cost_.num_residuals());
    if (J_.cols() == 0 ? !Renew() : !At(y_, r_)) return Failed();
    summary_.initial_cost = summary_.final_cost = 0.5 * r_.squaredNorm();
    Report({.step_is_valid = true, .step_is_successful = true});
    while (summary_.termination_type == ceres::NO_CONVERGENCE &&
           std::ssize(summary_.iterations) <= search_.iterations)
      Step();
    return summary_;
  }

 private:
  static constexpr double kSmallest = 1e-7;  // step, in scales of the parameters
  static constexpr int kMostVain = 3;        // steps in a row before the slopes are made anew

  bool At(const Vector& y, Vector& r) const {
    const double* const block = y.data();
    return cost_.Evaluate(&block, r.data(), nullptr) && r.allFinite();
  }

  // Slopes at y, and the residuals there.
  bool Renew() {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> J(r_.size(), y_.size());
    const double* const block = y_.data();
    double* slopes = J.data();
    fresh_ = true, vain_ = 0;
    if (!cost_.Evaluate(&block, r_.data(), &slopes) || !J.allFinite()) return false;
    J_ = J;
    return true;
  }

  ceres::Solver::Summary Failed() {
    summary_.termination_type = ceres::FAILURE;
    summary_.message = "the simulation diverges next to the start of the fit";
    summary_.initial_cost = summary_.final_cost = std::numeric_limits<double>::max();
    return summary_;
  }

  // Where the slopes lead.
  Vector Proposed() const {
    Matrix damped = J_.transpose() * J_;
    for (double& entry : damped.diagonal()) entry += std::max(lambda_ * entry, kTiny);
    const Vector step = BoundedStep(box_, y_, damped, J_.transpose() * r_);
    return (y_ + step).cwiseMax(box_.lower).cwiseMin(box_.upper);
  }

  void Step() {
    const Vector trial = Proposed(), step = trial - y_;
    const Vector change = J_ * step;
    const double before = r_.squaredNorm();
    const double promised = -2 * r_.dot(change) - change.squaredNorm();
    const bool nowhere = !(step.norm() > kSmallest * (y_.norm() + kSmallest)) ||
                         !(promised > search_.tolerance * before);
    if (nowhere || vain_ >= kMostVain) return Stuck();
    Vector there(r_.size());
    if (!At(trial, there)) {
      ++vain_, lambda_ = std::max(4 * lambda_, 1.0);  // half the step, or less
      return Report({.step_is_valid = false, .step_is_successful = false});
    }
    const double after = there.squaredNorm();
    J_ += (there - r_ - change) * step.transpose() / step.squaredNorm();
    const bool lower = after < before;
    ceres::IterationSummary s;
    s.step_is_valid = true, s.step_is_successful = lower;
    s.cost_change = 0.5 * (before - after);
    s.relative_decrease = (before - after) / promised;
    Damp(s.relative_decrease);
    if (lower) {
      y_ = trial, r_ = std::move(there);
      summary_.final_cost = 0.5 * after;
      vain_ = before - after > search_.tolerance * before ? 0 : vain_ + 1;
    } else {
      ++vain_;
    }
    fresh_ = false;
    Report(s);
  }

  // More of the gradient's own direction where a step gained little of what it promised.
  void Damp(double gain) {
    if (gain > 0.75) lambda_ /= 5;
    if (gain < 0.25) lambda_ = std::max(3 * lambda_, 1e-3);
  }

  // No step promises more, or none kept what it promised: so it is where the slopes are new.
  void Stuck() {
    if (fresh_ && vain_ < kMostVain) {
      summary_.termination_type = ceres::CONVERGENCE;
    } else if (renewed_at_ <= summary_.final_cost * (1 + search_.tolerance)) {
      summary_.termination_type = ceres::CONVERGENCE;  // they were new near here
    } else {
      renewed_at_ = summary_.final_cost, lambda_ = 1e-3;
      if (!Renew()) summary_.termination_type = ceres::CONVERGENCE;
    }
  }

  // Who watches may end it.
  void Report(ceres::IterationSummary s) {
    s.iteration = static_cast<int>(summary_.iterations.size());
    s.cost = summary_.final_cost;
    summary_.iterations.push_back(s);
    if (!search_.watch || (*search_.watch)(s) == ceres::SOLVER_CONTINUE) return;
    summary_.termination_type = ceres::USER_SUCCESS;
  }

  static constexpr double kTiny = 1e-300;

  const ceres::CostFunction& cost_;
  const Box& box_;
  const Search& search_;
  Vector& y_;
  Matrix& J_;
  Vector r_;
  double lambda_ = 1e-3;
  bool fresh_ = false;  // slopes were made at y, no step has changed them
  int vain_ = 0;        // steps in a row that gained nothing
  double renewed_at_ = std::numeric_limits<double>::infinity();  // cost
  ceres::Solver::Summary summary_;
};

}  // namespace

ceres::Solver::Summary MinimizeBySecants(const ceres::CostFunction& cost, const Box& box,
                                         const Search& search, Vector& y, Matrix& slopes) {
  return SecantSearch(cost, box, search, y, slopes).Run();
}

}  // namespace continuum
