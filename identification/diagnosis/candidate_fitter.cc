#include "identification/diagnosis/candidate_fitter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "error.h"
#include "identification/diagnosis/look_logs.h"
#include "identification/diagnosis/search_rules.h"
#include "identification/fit/cross_validation.h"
#include "identification/fit/intervals.h"
#include "identification/fit/local_search.h"
#include "identification/fit/wide_slope_fit.h"
#include "identification/inverse_dynamics/search_fit.h"
#include "identification/inverse_dynamics/short_horizon.h"
#include "identification/statistics/uncertainty.h"
#include "sim/simulation/simulate.h"

namespace continuum {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

Problem ProblemOf(const CandidateResult& c, const Experiment& experiment) {
  return Problem(experiment, c.hypothesis.system, c.hypothesis.Free());
}

double SquaresWithoutPart(double error, double part) {
  return std::max(0.0, error * error - part * part);
}

double WithoutPart(double error, double part) { return std::sqrt(SquaresWithoutPart(error, part)); }

FitOptions CandidateFitter::Options() const {
  FitOptions options{iterations, 1e-3};  // first order does the rest
  options.whitening = &whitening;
  options.idle = true, options.rough = true;
  options.until = until;
  return options;
}

// For fits that begin next to their end.
FitOptions CandidateFitter::FewSteps() const {
  FitOptions options = Options();
  options.iterations = 5;
  return options;
}

// Of a complete fit, as FitOptions::slopes has them.
Matrix CandidateFitter::SlopesOf(const Problem& problem, const Fitted& fitted) const {
  Matrix slopes = whitening.Stack(fitted.sensitivities->jacobian, TrainLogs(*experiment));
  for (Eigen::Index i = 0; i < slopes.cols(); ++i) slopes.col(i) *= problem.parameters()[i].scale;
  return slopes;
}

Fitted CandidateFitter::Fit(const Problem& problem, FitStart start, double rival, bool idle) const {
  const auto train = TrainLogs(*experiment);
  auto validate = train;
  validate.flip();
  Fitted f;
  FitOptions options = Options();
  options.hopeless = HopelessCost(rival, criteria);
  options.idle = idle;
  options.slopes = &start.slopes;
  f.fit = FitParameters(problem, start.x, train, options);
  f.fit.x = FitStarts(problem, f.fit.x, validate);
  f.residuals = problem.Residuals(f.fit.x, problem.AllLogs());
  RequireFinite(problem, f.fit.x, f.residuals, problem.AllLogs(), "with the fitted parameters");
  f.error = {problem.PooledRms(f.residuals, train), problem.PooledRms(f.residuals, validate)};
  f.cost = 2 * f.fit.cost;
  return f;
}

// As `identify` does, of many logs with those for a look, then with all and in units of the noise.
// By secants first; where these leave much, on along slopes, in twice their time, and without a
// limit of time around that.
Fitted CandidateFitter::FitNull(const Problem& problem) const {
  constexpr int kIterations = 100;
  constexpr double kNear = 1e-3;  // of the cost that a step gains: what follows goes on from there
  constexpr double kTimes = 2;
  constexpr std::uint64_t kSeed = 1;
  const double begin = ProcessorSeconds();
  const auto logs = LogsForALook(*experiment, problem.step());
  FitOptions options{.iterations = kIterations, .tolerance = kNear, .rough = true, .until = until};
  continuum::Fit best = FitBySearch(problem, problem.Start(), logs, {}, options).fit;
  const double now = ProcessorSeconds();
  if (std::isfinite(until)) options.until = std::min(until, now + kTimes * (now - begin));
  options.rough = false;
  if (IsFarOverNoise(problem, best.x, logs) && !TimeIsOver()) {
    continuum::Fit other = FitWithWideSlopes(problem, best.x, logs, options);
    if (other.cost < best.cost) best = std::move(other);
    if (std::isinf(until)) SearchAround(problem, problem.Start(), logs, kSeed, options, best);
  }
  return Fit(problem, {best.x}, std::numeric_limits<double>::infinity(), false);
}

std::vector<Vector> CandidateFitter::OverShortHorizons(const Problem& problem,
                                                       const Vector& x) const {
  const auto logs = LogsForALook(*experiment, problem.step());
  const auto pieces = OnShortHorizons(problem, logs);
  if (!pieces) return {};
  try {
    return {FitParameters(*pieces, x, logs, Options()).x};
  } catch (const Error&) {
    return {};  // it diverges there
  }
}

continuum::Fit CandidateFitter::FitWidely(const Problem& problem, const Vector& x) const {
  FitOptions options = Options();
  options.rough = false;
  return FitWithWideSlopes(problem, x, TrainLogs(*experiment), options);
}

void CandidateFitter::Complete(const Problem& problem, Fitted& f) const {
  const auto train = TrainLogs(*experiment);
  Sensitivities s;
  s.jacobian = problem.Jacobian(f.fit.x, f.residuals, train);
  s.uncertainty = UncertaintyOf(problem, f.fit.x, f.residuals, s.jacobian, whitening);
  s.step = problem.StepEffects(f.fit.x, f.residuals, train);
  AllowForStep(problem, s.jacobian, s.step, whitening, s.uncertainty);
  LeaveOutStep(problem, f.fit.x, f.residuals, s.jacobian, s.step, whitening, 0, s.uncertainty);
  f.sensitivities = std::move(s);
  if (!whitening.active()) return;
  const ProjectedResidual residual = ProjectedResidualOf(f);
  f.cost = residual.cost();
  f.sensitivities->freedom = residual.freedom();
  f.sensitivities->simulated = SimulatedSquaresOf(problem, f, residual.shift());
}

SimulatedSquares CandidateFitter::SimulatedSquaresOf(const Problem& problem, const Fitted& f,
                                                     const Vector& shift) const {
  const auto train = TrainLogs(*experiment);
  const Sensitivities& s = f.sensitivities.value();
  const std::vector<bool> fixed(shift.size(), true);
  const auto squares = [&](const std::vector<Vector>& residuals) {
    return ProjectedResidual(whitening, train, residuals, s.jacobian, fixed, s.step, criteria)
        .cost();
  };
  SimulatedSquares out{squares(f.residuals), std::numeric_limits<double>::infinity()};
  try {
    out.there = squares(problem.Residuals(problem.Clamp(f.fit.x + shift), train));
  } catch (const Error&) {
    return out;  // it diverges there
  }
  return out;
}

void CandidateFitter::FitFinely(const Problem& problem, const std::optional<Vector>& fine,
                                Fitted& f) const {
  Sensitivities& s = f.sensitivities.value();
  Matrix slopes = SlopesOf(problem, f);
  FitOptions options = FewSteps();
  options.slopes = &slopes;
  const auto fit = [&] {
    return fine ? *fine
                : FitParameters(AtQuarter(problem), f.fit.x, TrainLogs(*experiment), options).x;
  };
  ReachByFineFit(problem, f.fit.x, f.residuals, s.jacobian, s.step, options, fit, s.uncertainty);
}

Fitted CandidateFitter::Continue(const Problem& problem, const Fitted& before) const {
  const auto train = TrainLogs(*experiment);
  Fitted f = before;
  FitOptions options = FewSteps();
  Matrix slopes = SlopesOf(problem, before);
  options.slopes = &slopes;
  f.fit = FitParameters(problem, before.fit.x, train, options);
  f.residuals = problem.Residuals(f.fit.x, train);
  f.error.train = problem.PooledRms(f.residuals, train);
  f.cost = 2 * f.fit.cost;
  return f;
}

Fitted CandidateFitter::FitAll(const Problem& problem, const Vector& start) const {
  Fitted f = Fit(problem, {start});
  Complete(problem, f);
  return f;
}

void CandidateFitter::CompleteOnValidate(const Problem& problem, Fitted& fitted) const {
  auto& known = fitted.sensitivities.value().jacobian;
  std::vector<bool> missing = TrainLogs(*experiment);
  missing.flip();
  for (std::size_t l = 0; l < missing.size(); ++l) missing[l] = missing[l] && known[l].size() == 0;
  if (std::find(missing.begin(), missing.end(), true) == missing.end()) return;
  auto J = problem.Jacobian(fitted.fit.x, fitted.residuals, missing);
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (missing[l]) known[l] = std::move(J[l]);
  }
}

void CandidateFitter::AddFolds(const Problem& problem, const std::vector<Fold>& folds,
                               Fitted& fitted) const {
  if (!fitted.folds.error.empty()) return;
  CompleteOnValidate(problem, fitted);
  fitted.folds =
      CrossValidate(problem, fitted.fit.x, fitted.residuals, fitted.sensitivities->jacobian, folds);
}

ProjectedResidual CandidateFitter::ProjectedResidualOf(const Fitted& fitted) const {
  return ProjectedResidualOf(fitted, TrainLogs(*experiment));
}

ProjectedResidual CandidateFitter::ProjectedResidualOf(const Fitted& fitted,
                                                       const std::vector<bool>& use) const {
  const Sensitivities& s = fitted.sensitivities.value();
  return ProjectedResidual(whitening, use, fitted.residuals, s.jacobian, s.uncertainty.at_bound,
                           s.step, criteria);
}

std::vector<Vector> CandidateFitter::StepColumn(const Fitted& fitted) const {
  const auto train = TrainLogs(*experiment);
  std::vector<Vector> column(train.size());
  for (std::size_t l = 0; l < column.size(); ++l) {
    if (train[l]) column[l] = fitted.sensitivities.value().step[l].col(0);
  }
  return column;
}

double CandidateFitter::StepError(const Problem& problem, const Fitted& fitted) const {
  return problem.PooledRms(StepColumn(fitted), TrainLogs(*experiment));
}

bool CandidateFitter::ExplainedByStep(const Fitted& fitted) const {
  const double step = whitening.Stack(StepColumn(fitted), TrainLogs(*experiment)).squaredNorm();
  return continuum::ExplainedByStep(2 * fitted.fit.cost, fitted.sensitivities.value().freedom, step,
                                    criteria);
}

}  // namespace continuum
