#include "identification/inverse_dynamics/equation_error_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>

#include "error.h"
#include "identification/fit/bounded_least_squares.h"
#include "identification/fit/out_of_step.h"
#include "identification/fit/wide_slope_fit.h"
#include "identification/inverse_dynamics/missing_force.h"
#include "identification/statistics/noise_model.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

constexpr Search kFewSteps{5, 1e-2};

// Missing forces of all joints below each other as one Ceres cost in scaled parameters.
class ForceCost : public ceres::CostFunction {
 public:
  ForceCost(const Problem& problem, const std::vector<bool>& use) : problem_(problem), use_(use) {
    for (std::size_t l = 0; l < use_.size(); ++l)
      use_[l] = use_[l] && MeasuresEveryJoint(problem, l);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.parameters().size()));
  }

  // From now on at this, in units of what is missing at x. Returns whether anything is.
  bool Look(StackedForces::Kind kind, const Vector& x) {
    const auto joints = MissingForces(problem_, x, use_);
    units_ = StackedForces(joints, kind);
    set_num_residuals(static_cast<int>(units_.size()));
    return units_.Of(joints).norm() > 0;
  }

  std::size_t evaluations() const { return evaluations_; }

  bool Evaluate(const double* const* y, double* residuals, double** jacobians) const override {
    const Vector x = Unscaled(problem_, y[0]);
    evaluations_ += static_cast<std::size_t>(std::count(use_.begin(), use_.end(), true)) *
                    (jacobians && jacobians[0] ? 1 + problem_.parameters().size() : 1);
    const Vector f = Forces(x);
    if (!f.allFinite()) return false;
    Vector::Map(residuals, f.size()) = f;
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> J(
        jacobians[0], f.size(), x.size());
    J.setZero();
    const auto differ = [&](std::size_t, std::size_t k) {
      if (StopRequested() || problem_.parameters()[k].IsStart()) return;
      const double step = problem_.StepOf(x, k, 1e-3);
      Vector moved = x;
      moved[static_cast<Eigen::Index>(k)] += step;
      J.col(static_cast<Eigen::Index>(k)) =
          (Forces(moved) - f) * (problem_.parameters()[k].scale / step);
    };
    ShareOut(static_cast<std::size_t>(x.size()), differ, [&](auto& archive, std::size_t k) {
      FieldsOfBlock(archive, J.col(static_cast<Eigen::Index>(k)));
    });
    return J.allFinite();
  }

 private:
  // Not finite where no machine can have these parameters.
  Vector Forces(const Vector& x) const {
    try {
      return units_.Of(MissingForces(problem_, x, use_));
    } catch (const Error&) {
      return Vector::Constant(units_.size(), std::numeric_limits<double>::quiet_NaN());
    }
  }

  const Problem& problem_;
  std::vector<bool> use_;
  StackedForces units_;
  mutable std::size_t evaluations_ = 0;
};

}  // namespace

std::optional<EquationFit> FitEquations(const Problem& problem, const Vector& x,
                                        const std::vector<bool>& use) {
  ForceCost cost(problem, use);
  if (x.size() == 0 || !cost.Look(&MissingForce::force, x)) return {};
  Vector y = Scaled(problem, x);
  const Box box = BoxOf(problem);
  Minimize(cost, box, kFewSteps, y);
  cost.Look(&MissingForce::acceleration, Unscaled(problem, y.data()));
  Minimize(cost, box, kFewSteps, y);
  return EquationFit{Unscaled(problem, y.data()), cost.evaluations()};
}

Fit FitByEquations(const Problem& problem, Fit best, const std::vector<bool>& use,
                   const FitOptions& options) {
  const double before = best.seconds;
  const auto begin = std::chrono::steady_clock::now();
  const auto spent = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const Progress stage{"fit from the equations of motion"};
  FitOptions own = options;
  own.iterations -= best.iterations, own.idle = true,
                                     own.progress = Within(stage, options.progress);
  if (own.iterations <= 0 || StopRequested() || !IsOutOfStep(problem, best.x, use)) return best;
  if (options.progress) options.progress(stage);
  const auto equations = FitEquations(problem, best.x, use);
  if (equations) best.evaluations += equations->evaluations;
  best.seconds = before + spent();
  if (StopRequested()) {
    best.converged = false, best.message = "interrupted";
    return best;
  }
  if (!equations || !(CostAt(problem, equations->x, use, options) < best.cost)) return best;
  Fit fit = FitWithWideSlopes(problem, equations->x, use, own);
  fit.evaluations += best.evaluations, fit.seconds = before + spent();
  fit.anew = true;
  return fit;
}

}  // namespace continuum
