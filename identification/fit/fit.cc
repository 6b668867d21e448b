#include "identification/fit/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "error.h"
#include "identification/fit/bounded_least_squares.h"
#include "identification/fit/secant_search.h"
#include "identification/problem/start_checks.h"
#include "identification/statistics/noise_model.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/decompositions.h"
#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// All residuals as one Ceres cost in the scaled parameters y = x/scale.
class Cost : public ceres::CostFunction {
 public:
  Cost(const Problem& problem, const std::vector<bool>& use, const FitOptions& options,
       const Whitening& whitening, Eigen::Index residuals)
      : problem_(problem), use_(use), options_(options), whitening_(whitening) {
    continuity_rows_ = Defects({}, 0).rows();
    together_ = !options.rough && problem.LinearisesCheaply();
    set_num_residuals(static_cast<int>(residuals + continuity_rows_));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.parameters().size()));
  }

  // What is known at one x already; J: empty where it is not.
  void Know(const Vector& x, std::vector<Vector> r, std::vector<Matrix> J) {
    x_ = x, r_ = std::move(r), J_ = std::move(J);
    if (!J_.empty()) derived_ = {x_, r_};
  }

  bool Evaluate(const double* const* y, double* residuals, double** jacobians) const override {
    const auto& parameters = problem_.parameters();
    const Vector x = Unscaled(problem_, y[0]);
    if (x_.size() != x.size() || x != x_) Look(x);
    const Vector all = whitening_.Stack(r_, use_);
    if (!all.allFinite()) return false;
    for (Eigen::Index k = 0; k < all.size(); ++k)
      residuals[k] = SoftL1(all[k], options_.soft).first;
    const std::vector<Matrix> r(r_.begin(), r_.end());
    Eigen::Map<Vector>(residuals + all.size(), continuity_rows_) = Defects(r, 1);
    if (!jacobians || !jacobians[0]) return true;
    Derive();
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> out(
        jacobians[0], num_residuals(), x.size());
    out.topRows(all.size()) = Slopes(all);
    out.bottomRows(continuity_rows_) = Defects(J_, x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      out.col(i).tail(continuity_rows_) *= parameters[i].scale;
    return out.allFinite();
  }

  // Slopes of the loss in the scaled parameters, next to x: the last step of a fit, which gains
  // too little, is not taken. None if they are not known there.
  Matrix SlopesNear(const Vector& x) const {
    constexpr double kNear = 1e-2;  // of the parameters' sizes
    if (J_.empty() || derived_.x.size() != x.size()) return {};
    double apart = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i)
      apart = std::max(apart, std::abs(derived_.x[i] - x[i]) / problem_.parameters()[i].scale);
    return apart < kNear ? Slopes(whitening_.Stack(derived_.r, use_)) : Matrix();
  }

 private:
  // Residuals at x; where slopes cost little beside them and most steps are good, with these.
  void Look(const Vector& x) const {
    x_ = x;
    if (!together_) {
      r_ = problem_.Residuals(x, use_);
      return;
    }
    auto [r, J] = problem_.Linearise(x, use_);
    r_ = std::move(r);
    together_ = !J.empty() || !whitening_.Stack(r_, use_).allFinite();
    if (!J.empty()) J_ = std::move(J), derived_ = {x_, r_};
  }

  // all: whitened residuals where J_ is known.
  Matrix Slopes(const Vector& all) const {
    Matrix out = whitening_.Stack(J_, use_);
    for (Eigen::Index k = 0; k < all.size(); ++k)
      out.row(k) *= SoftL1(all[k], options_.soft).second;
    for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) *= problem_.parameters()[i].scale;
    return out;
  }

  // By how much residuals, or columns of their Jacobian, differ where segments meet; all of one
  // channel follow each other in a log.
  Matrix Defects(const std::vector<Matrix>& of, Eigen::Index columns) const {
    const auto channels = static_cast<Eigen::Index>(problem_.channels().size());
    Eigen::Index rows = 0;
    for (const ContinuityCondition& condition : options_.continuity)
      rows += channels * condition.rows;
    Matrix all(rows, columns);
    if (columns == 0) return all;
    rows = 0;
    for (const ContinuityCondition& condition : options_.continuity) {
      const Matrix &before = of[condition.before], &after = of[condition.after];
      const Eigen::Index long_before = before.rows() / channels,
                         long_after = after.rows() / channels;
      for (Eigen::Index c = 0; c < channels; ++c) {
        all.middleRows(rows, condition.rows) =
            options_.continuity_weight *
            (before.middleRows((c + 1) * long_before - condition.rows, condition.rows) -
             after.middleRows(c * long_after, condition.rows));
        rows += condition.rows;
      }
    }
    return all;
  }

  // J_ at x_: updated (Broyden) along the step from where it was known, if the residuals changed
  // almost as it said; as it was, if they hardly changed; else anew. By differences it is made
  // anew: they see stick and slip.
  void Derive() const {
    if (!J_.empty() && derived_.x == x_) return;
    const bool anew = problem_.path() == Path::kStepped || options_.rough;
    if (J_.empty() || anew || !Updated()) J_ = problem_.Jacobian(x_, r_, use_, {}, true);
    derived_ = {x_, r_};
  }
  bool Updated() const {
    constexpr double kBent = 0.15, kNothing = 1e-3;  // of the change, of the residuals
    Vector step = x_ - derived_.x, scaled = step;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      scaled[i] /= std::pow(problem_.parameters()[i].scale, 2);
    }
    double bent = 0, change = 0, all = 0;
    std::vector<Vector> lack(J_.size());
    for (std::size_t l = 0; l < J_.size(); ++l) {
      if (!use_[l]) continue;
      const Vector difference = r_[l] - derived_.r[l];
      lack[l] = difference - J_[l] * step;
      bent += lack[l].squaredNorm(), change += difference.squaredNorm();
      all += r_[l].squaredNorm();
    }
    // A short step changes less than the simulation's own errors: nothing to learn from it.
    if (bent > kBent * kBent * change) return bent < kNothing * kNothing * all;
    for (std::size_t l = 0; l < J_.size(); ++l) {
      if (use_[l]) J_[l] += lack[l] * scaled.transpose() / scaled.dot(step);
    }
    return true;
  }

  const Problem& problem_;
  const std::vector<bool>& use_;
  const FitOptions& options_;
  const Whitening& whitening_;
  Eigen::Index continuity_rows_;
  mutable bool together_;  // residuals and their slopes
  mutable Vector x_;
  mutable std::vector<Vector> r_;  // at x_
  mutable std::vector<Matrix> J_;
  struct Derived {
    Vector x;
    std::vector<Vector> r;
  };
  mutable Derived derived_;  // where J_ is known
};

class Monitor : public ceres::IterationCallback {
 public:
  Monitor(const Problem& problem, const FitOptions& options, Fit& fit)
      : problem_(problem), options_(options), fit_(fit) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    const bool taken = s.step_is_successful || s.iteration == 0;
    fit_.trace.push_back(taken ? s.cost : fit_.trace.back());
    if (options_.progress) {
      options_.progress(
          {"fit", static_cast<std::size_t>(s.iteration), 0,
           fmt::format("cost {:.6g}, {} simulations", s.cost, problem_.evaluations())});
    }
    if (s.step_is_successful && s.iteration >= 2)
      lost_ = s.cost > options_.hopeless + kMore * s.cost_change ? lost_ + 1 : 0;
    settled_ = Settled(s);
    out_of_time_ = EndRequested() || ProcessorSeconds() > options_.until;
    return StopRequested() || lost_ >= options_.patience || settled_ || out_of_time_
               ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
               : ceres::SOLVER_CONTINUE;
  }
  bool settled() const { return settled_; }
  bool out_of_time() const { return out_of_time_; }

 private:
  // Whether a step failed from which little was expected: then the simulation's own errors decide.
  // One that diverged says nothing of what was expected (Ceres gives it the largest cost there is).
  bool Settled(const ceres::IterationSummary& s) const {
    if (!(s.cost < std::numeric_limits<double>::max())) return false;
    if (s.step_is_successful || !s.step_is_valid || !(s.relative_decrease < 0)) return false;
    return s.cost_change / s.relative_decrease < options_.tolerance * s.cost;
  }

  static constexpr double kMore = 4;  // steps as good as the last that a fit may still hope for

  const Problem& problem_;
  const FitOptions& options_;
  Fit& fit_;
  int lost_ = 0;  // steps in a row
  bool settled_ = false, out_of_time_ = false;
};

constexpr const char* kOutOfTime = "out of time";

// Whitened residuals as the loss counts them.
Vector WithLoss(const Vector& r, const FitOptions& options) {
  return r.unaryExpr([&](double v) { return SoftL1(v, options.soft).first; });
}

// Why a fit ended.
std::string InWords(const ceres::Solver::Summary& summary, const Monitor& watch,
                    const FitOptions& o) {
  if (watch.out_of_time()) return EndRequested() ? "interrupted" : kOutOfTime;
  if (watch.settled()) return "a further step gains less than the errors of the simulation";
  if (summary.termination_type == ceres::USER_SUCCESS)
    return StopRequested() ? "interrupted" : "given up: it cannot come near a better one";
  if (summary.termination_type == ceres::CONVERGENCE)
    return fmt::format("a further step gains less than {:g} % of the cost", 100 * o.tolerance);
  if (static_cast<int>(summary.iterations.size()) > o.iterations) return "out of iterations";
  return summary.message;
}

}  // namespace

void RequireFinite(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                   const std::vector<bool>& use, const std::string& when) {
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l] || r[l].allFinite()) continue;
    const Log& log = problem.experiment().logs[l];
    throw Error::Job(log.file.string() + ", log '" + log.label + "', " + when + ": " +
                     WhyItDiverges(problem, x, l));
  }
}

double TypicalRms(const Problem& problem, std::vector<Vector> r, const std::vector<bool>& use) {
  if (problem.experiment().soft == 0) return problem.PooledRms(r, use);
  constexpr double kSigma = 1.4826, kFar = 3;  // of a median of normal sizes; standard deviations
  std::vector<double> sizes;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    for (const double v : r[l])
      if (v != 0) sizes.push_back(std::abs(v));
  }
  if (sizes.empty()) return 0;
  const auto middle = sizes.begin() + std::ssize(sizes) / 2;
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double most = kFar * kSigma * *middle;
  for (Vector& part : r) part = part.cwiseMax(-most).cwiseMin(most);
  return problem.PooledRms(r, use);
}

bool IsFarOverNoise(const Problem& problem, const Vector& x, const std::vector<bool>& use) {
  return IsFarOver(NoiseOf(problem.experiment()),
                   TypicalRms(problem, problem.Residuals(x, use), use));
}

// Differences of rows tell no more than the least that noise may be.
bool IsMoreThanNoise(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                     const std::vector<bool>& use) {
  Noise noise = NoiseOf(problem.experiment());
  const double error = TypicalRms(problem, r, use);
  if (!(noise.rms > 0) || noise.source == "differences" || IsNear(noise, error)) return false;
  if (problem.path() == Path::kStepped) {
    std::vector<Vector> step = AtQuarter(problem).Residuals(x, use);
    for (std::size_t l = 0; l < step.size(); ++l) {
      if (!use[l]) continue;
      step[l] -= r[l];
      if (!step[l].allFinite()) step[l].setZero();
    }
    noise.rms = std::hypot(noise.rms, TypicalRms(problem, step, use));
  }
  return !IsNear(noise, error);
}

Vector LossResiduals(const Problem& problem, const Vector& x, const std::vector<bool>& use,
                     const FitOptions& options) {
  const Whitening none;
  const Whitening& whitening = options.whitening ? *options.whitening : none;
  return WithLoss(whitening.Stack(problem.Residuals(x, use), use), options);
}

double CostAt(const Problem& problem, const Vector& x, const std::vector<bool>& use,
              const FitOptions& options) {
  const Vector r = LossResiduals(problem, x, use, options);
  return r.allFinite() ? 0.5 * r.squaredNorm() : std::numeric_limits<double>::infinity();
}

Fit FitParameters(const Problem& problem, const Vector& x, const std::vector<bool>& use,
                  const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t before = problem.evaluations();
  Fit fit;
  fit.x = problem.Clamp(x);
  Matrix none_yet, &slopes = options.slopes ? *options.slopes : none_yet;
  auto [r, J] = slopes.cols() == 0 && problem.LinearisesCheaply()
                    ? problem.Linearise(fit.x, use)
                    : Problem::Linearised{problem.Residuals(fit.x, use), {}};
  const Whitening none;
  const Whitening& whitening = options.whitening ? *options.whitening : none;
  const Vector all = whitening.Stack(r, use);
  RequireFinite(problem, fit.x, r, use, "at the start of the fit");
  fit.cost = 0.5 * WithLoss(all, options).squaredNorm();
  fit.evaluations = problem.evaluations() - before;
  if (x.size() == 0) {
    fit.converged = true;
    return fit;
  }
  if (ProcessorSeconds() > options.until) {
    fit.trace = {fit.cost}, fit.message = kOutOfTime;
    return fit;
  }
  if (slopes.cols() == 0) {
    if (J.empty()) J = problem.Jacobian(fit.x, r, use, {}, true);
    RequireFiniteSlopes(problem, fit.x, J);
    if (!options.idle && !StopRequested()) RequireEffect(problem, fit.x, J);
  }

  Cost cost(problem, use, options, whitening, all.size());
  cost.Know(fit.x, std::move(r), std::move(J));
  Monitor watch(problem, options, fit);
  Vector y = Scaled(problem, fit.x);
  const Search search{options.iterations, options.tolerance, &watch};
  const Box box = BoxOf(problem);
  const auto summary = options.rough ? MinimizeBySecants(cost, box, search, y, slopes)
                                     : Minimize(cost, box, search, y);
  fit.iterations = static_cast<int>(summary.iterations.size()) - 1;
  fit.x = Unscaled(problem, y.data());
  if (options.slopes && !options.rough) slopes = cost.SlopesNear(fit.x);
  fit.cost = summary.final_cost;
  fit.converged = summary.termination_type == ceres::CONVERGENCE || watch.settled();
  fit.message = InWords(summary, watch, options);
  fit.evaluations = problem.evaluations() - before;
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return fit;
}

Vector RefitByChords(const Problem& problem, const Vector& x, std::vector<Vector> r,
                     const std::vector<Matrix>& J, const std::vector<bool>& use, int iterations) {
  constexpr double kNothing = 1e-4;  // of the squares, that is worth no simulation
  const Eigen::Index n = x.size();
  Matrix H = Matrix::Zero(n, n);
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (use[l]) H += J[l].transpose() * J[l];
  }
  for (double& entry : H.diagonal()) entry += 1e-9 * (entry + 1e-300);
  const Box box = BoundsOf(problem);
  Vector best = x;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) r[l].resize(0);
  }
  double cost = SumOfSquares(r);
  for (int k = 0; k < iterations && !StopRequested(); ++k) {
    Vector g = Vector::Zero(n);
    for (std::size_t l = 0; l < use.size(); ++l) {
      if (use[l]) g += J[l].transpose() * r[l];
    }
    const Vector step = BoundedStep(box, best, H, g);
    const double promised = -2 * g.dot(step) - step.dot(H * step);
    if (!(promised > kNothing * cost)) return best;
    bool lower = false;
    for (double share = 1; share > 0.2 && !lower; share /= 2) {
      const Vector next = problem.Clamp(best + share * step);
      auto there = problem.Residuals(next, use);
      const double value = SumOfSquares(there);
      if (!(value < cost)) continue;
      lower = true;
      best = next, r = std::move(there), cost = value;
    }
    if (!lower) break;
  }
  return best;
}

// What the first rows say of a speed may be far off: then one linearisation is not enough.
Vector FitStarts(const Problem& problem, const Vector& x, const std::vector<bool>& use) {
  constexpr int kMostRounds = 10;
  constexpr double kSettled = 0.99;  // of the squares before
  if (problem.experiment().start != Experiment::Start::kEstimate) return x;
  Vector best = x;
  auto r = problem.Residuals(best, use);
  for (int k = 0; k < kMostRounds && !StopRequested(); ++k) {
    const double before = SumOfSquares(r);
    best = RefitByChords(problem, best, r, problem.StartJacobian(best, r, use), use);
    r = problem.Residuals(best, use);
    if (!(SumOfSquares(r) < kSettled * before)) break;
  }
  return best;
}

}  // namespace continuum
