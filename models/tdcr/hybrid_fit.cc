#include "models/tdcr/hybrid_fit.h"

#include <cmath>
#include <limits>

#include "models/tdcr/linear_curvature.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/solver.h"

namespace continuum::tdcr {
namespace {

constexpr std::size_t kFolds = 5;

// Unknowns: V of FitWeights, column by column; residuals over L and the root of the sample count.
struct HybridProblem {
  const Robot& robot;
  const Samples& samples;
  double penalty;
  Eigen::VectorXd sizes;  // of the features

  Eigen::Index unknowns() const { return 6 * sizes.size(); }
  Eigen::Index equations() const { return Residuals(samples) + (penalty > 0 ? unknowns() : 0); }
  double scale() const {
    return 1 / (robot.length * std::sqrt(static_cast<double>(samples.size())));
  }
  Eigen::MatrixXd Weights(const Eigen::VectorXd& x) const {
    return sizes.cwiseInverse().asDiagonal() * x.reshaped(sizes.size(), 6) / robot.length;
  }
  bool operator()(const double* x, double* f) const {
    const auto weights = Weights(Eigen::Map<const Eigen::VectorXd>(x, unknowns()));
    for (const Sample* s : samples) {
      const Eigen::Matrix3Xd disks = Disks(robot, Corrected(robot, weights, *s), *s);
      for (int i = 0; i < robot.disks; ++i) {
        if (!s->pair->measured->Has(i)) continue;
        for (int a = 0; a < 3; ++a) *f++ = (disks(a, i) - s->points(a, i)) * scale();
      }
    }
    if (penalty > 0) {
      for (Eigen::Index i = 0; i < unknowns(); ++i) *f++ = std::sqrt(penalty) * x[i];
    }
    return true;
  }
  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const {
    (*this)(x.data(), f.data());
    const auto weights = Weights(x);
    const LinearCurvature linear(robot);
    Eigen::Index row = 0;
    for (const Sample* s : samples) {
      const auto gradient = linear.Gradient(Corrected(robot, weights, *s));
      const Eigen::VectorXd scaled = s->features.cwiseQuotient(sizes);
      for (int i = 0; i < robot.disks; ++i) {
        if (!s->pair->measured->Has(i)) continue;
        const Eigen::Matrix3Xd g = gradient[static_cast<std::size_t>(i)] * (scale() / robot.length);
        for (Eigen::Index c = 0; c < 6; ++c) {
          jacobian.block(row, c * sizes.size(), 3, sizes.size()) = g.col(c) * scaled.transpose();
        }
        row += 3;
      }
    }
    if (penalty > 0) {
      auto rows = jacobian.bottomRows(unknowns());
      rows.setZero();
      rows.diagonal().setConstant(std::sqrt(penalty));
    }
    return true;
  }
};

Eigen::VectorXd Sizes(const Samples& samples) {
  Eigen::VectorXd sizes = Eigen::VectorXd::Zero(samples.front()->features.size());
  for (const Sample* s : samples) sizes = sizes.cwiseMax(s->features.cwiseAbs());
  return (sizes.array() > 0).select(sizes, 1);
}

}  // namespace

Eigen::Index Residuals(const Samples& samples) {
  Eigen::Index count = 0;
  for (const Sample* s : samples) count += 3 * s->pair->measured->count();
  return count;
}

Eigen::Matrix3Xd Corrected(const Robot& robot, const Eigen::MatrixXd& weights,
                           const Sample& sample) {
  return sample.u + LinearCurvature(robot).Curvatures(weights.transpose() * sample.features);
}

Eigen::Matrix3Xd Disks(const Robot& robot, const Eigen::Matrix3Xd& u, const Sample& sample) {
  return Positions(EqualArcs(robot), u) + sample.beside;
}

Weights FitWeights(const Robot& robot, const Samples& samples, double penalty) {
  const HybridProblem problem{robot, samples, penalty, Sizes(samples)};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.unknowns());
  numerics::Options options;
  options.tolerance = 1e-14;
  options.gradient = 1e-9;
  options.decrease = 1e-6;  // along the flat valleys of weights that the shapes hardly tell apart
  options.step = 1e-10;
  options.max_iterations = 5000;
  const auto outcome =
      numerics::LevenbergMarquardt<Eigen::VectorXd>(problem, x, problem.equations(), options);
  return {problem.Weights(x), outcome.ok()};
}

std::optional<LeftOut> CrossValidate(const Robot& robot, const Samples& samples, double penalty) {
  if (samples.size() < 2) return std::nullopt;
  TipErrors errors;
  LeftOut left_out;
  for (std::size_t fold = 0; fold < std::min(kFolds, samples.size()); ++fold) {
    Samples kept;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i % kFolds != fold) kept.push_back(samples[i]);
    }
    const bool determined = Residuals(kept) >= 6 * samples.front()->features.size();
    if (!determined && !(penalty > 0)) return std::nullopt;
    const Weights weights = FitWeights(robot, kept, penalty);
    left_out.converged = left_out.converged && weights.converged;
    for (std::size_t i = fold; i < samples.size(); i += kFolds) {
      const Measured& measured = *samples[i]->pair->measured;
      const Eigen::Matrix3Xd disks =
          Disks(robot, Corrected(robot, weights.values, *samples[i]), *samples[i]);
      errors.Add(robot, measured, disks);
      left_out.explained.Add(robot, measured, disks);
    }
  }
  left_out.tips = errors.train;
  return left_out;
}

double ChoosePenalty(const Robot& robot, const Samples& samples) {
  double chosen = 0, least = std::numeric_limits<double>::infinity();
  for (int i = -1; i <= 14; ++i) {
    const double penalty = i < 0 ? 0 : std::pow(10, -6 + 0.5 * i);
    const auto candidate = CrossValidate(robot, samples, penalty);
    if (!candidate || !candidate->converged || least <= candidate->explained.rmse()) continue;
    least = candidate->explained.rmse();
    chosen = penalty;
  }
  return chosen;
}

}  // namespace continuum::tdcr
