#include "identification/fit/intervals.h"

#include <cstdint>
#include <limits>
#include <optional>

#include "error.h"
#include "identification/fit/local_search.h"
#include "identification/statistics/information_modes.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// Whether first order said, to half of it, what a quarter of the step changes.
bool FirstOrderHolds(const Uncertainty& u, const Vector& moved) {
  const Vector predicted = u.step / kWholeStep, wrong = moved - predicted;
  return wrong.dot(u.information * wrong) < 0.25 * predicted.dot(u.information * predicted);
}

// Where a log begins that the fit did not see was fitted to that log alone (FitStarts): so is its
// error. Nothing where it diverges.
std::optional<Uncertainty> OfOwnStart(const Problem& problem, const Vector& x,
                                      const std::vector<Vector>& r, std::size_t log, double soft) {
  if (!r[log].allFinite()) return {};
  std::vector<bool> use(r.size(), false);
  use[log] = true;
  const auto J = problem.StartJacobian(x, r, use);
  Uncertainty u = UncertaintyOf(problem, x, r, J, {}, soft);
  AllowForStep(problem, WeightedByCurvature(J, soft, r),
               WeightedByCurvature(problem.StepEffects(x, r, use), soft, r), {}, u);
  return u;
}

// [log] of those that the fit did not see.
std::vector<std::optional<Uncertainty>> OfOwnStarts(const Problem& problem, const Vector& x,
                                                    const std::vector<Vector>& r, double soft) {
  std::vector<std::optional<Uncertainty>> own(r.size());
  if (problem.experiment().start != Experiment::Start::kEstimate) return own;
  for (std::size_t l = 0; l < r.size() && !StopRequested(); ++l)
    if (!problem.seen()[l]) own[l] = OfOwnStart(problem, x, r, l, soft);
  return own;
}

// What is known of a log's own start.
void TakeStart(const Problem& problem, std::size_t log, const Uncertainty& own, Uncertainty& u) {
  std::vector<Eigen::Index> starts;
  for (Eigen::Index i = 0; i < u.standard_error.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    if (p.IsStart() && p.log[log]) starts.push_back(i);
  }
  u.standard_error(starts) = own.standard_error(starts);
  u.lower(starts) = own.lower(starts);
  u.upper(starts) = own.upper(starts);
  u.correlation(starts, starts) = own.correlation(starts, starts);
  u.information(starts, starts) = own.information(starts, starts);
  if (u.step.size() && own.step.size()) u.step(starts) = own.step(starts);
}

// Near the best at a quarter of the step, with the slopes J at x: a few damped steps do not go far
// along what the logs hardly determine.
Vector FineStart(const Problem& fine, const Vector& x, const std::vector<Matrix>& J, double soft) {
  constexpr int kIterations = 5;
  if (soft > 0) return x;
  return RefitByChords(fine, x, fine.Residuals(x, fine.seen()), J, fine.seen(), kIterations);
}

// At a quarter of the step. Where dry friction acts, a fit from x ends in the next of many minima.
Vector FineFit(const Problem& problem, const Vector& x, const std::vector<Matrix>& J,
               FitOptions options) {
  constexpr std::uint64_t kSeed = 1;
  constexpr int kIterations = 30;
  const Problem fine = AtQuarter(problem);
  Fit fit = FitParameters(fine, FineStart(fine, x, J, options.soft), problem.seen(), options);
  options.iterations = kIterations;
  SearchAround(fine, {}, problem.seen(), kSeed, options, fit);
  return fit.x;
}

}  // namespace

Uncertainty UnknownUncertainty(const Problem& problem, const Vector& x, const std::string& why) {
  const Vector none = Vector::Constant(x.size(), std::numeric_limits<double>::quiet_NaN());
  return {.standard_error = none,
          .lower = none,
          .upper = none,
          .correlation = none * none.transpose(),
          .information = Matrix::Zero(x.size(), x.size()),
          .at_bound = AtBounds(problem, x),
          .lacks = "not computed: " + why};
}

void ReachByFineFit(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                    const std::vector<Matrix>& J, const std::vector<Matrix>& step,
                    const FitOptions& options, const std::function<Vector()>& fine,
                    Uncertainty& u) {
  if (u.step.size() == 0 || !(u.step.array().abs() > u.standard_error.array()).any()) return;
  Vector moved;
  try {
    moved = fine() - x;
  } catch (const Error&) {
    return;  // it diverges at the finer step: first order has to do
  }
  if (StopRequested()) {
    u.lacks = "by first order in the time step: the fit at a fine one was interrupted";
    return;
  }
  const Whitening none;
  const Whitening& whitening = options.whitening ? *options.whitening : none;
  const bool first_order_holds = FirstOrderHolds(u, moved);
  const auto slopes = first_order_holds ? J : Secants(problem, x, r, J, step, whitening);
  u = UncertaintyOf(problem, x, r, slopes, whitening, options.soft);
  WidenByStep(problem, moved, u);
  if (first_order_holds) {
    LeaveOutStep(problem, x, r, J, step, whitening, options.soft, u);
    return AllowForSecondOrder(problem, J, step, whitening, u);
  }
  const Vector more = (kWholeRoot - kWholeStep) * moved;
  Widen(problem, more.cwiseMin(0), more.cwiseMax(0), u);
  WidenByStepSize(problem, x, slopes, step, whitening, u);
}

Uncertainty IntervalsOf(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                        const ProgressCallback& progress) {
  Problem centered = problem;
  centered.Center();
  auto J = centered.Jacobian(x, r, problem.seen());
  KeepInvariances(problem, x, r, J);
  if (StopRequested()) return UnknownUncertainty(problem, x, "interrupted");
  const double soft = problem.experiment().soft;
  Uncertainty u = UncertaintyOf(problem, x, r, J, {}, soft);
  if (problem.path() != Path::kStepped) return u;
  const auto step = problem.StepEffects(x, r, problem.seen());
  const auto own = OfOwnStarts(centered, x, r, soft);
  if (StopRequested()) return UnknownUncertainty(problem, x, "interrupted");
  AllowForStep(problem, WeightedByCurvature(J, soft, r), WeightedByCurvature(step, soft, r), {}, u);
  LeaveOutStep(centered, x, r, J, step, {}, soft, u);
  FitOptions few{.iterations = 5, .tolerance = 1e-4, .soft = soft, .idle = true};
  few.progress = Within({"fit at a fine step"}, progress);
  ReachByFineFit(
      centered, x, r, J, step, few, [&] { return FineFit(centered, x, J, few); }, u);
  for (std::size_t l = 0; l < own.size(); ++l)
    if (own[l]) TakeStart(problem, l, *own[l], u);
  return u;
}

}  // namespace continuum
