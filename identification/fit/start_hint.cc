#include "identification/fit/start_hint.h"

#include <fmt/format.h>

#include "error.h"

namespace continuum {
namespace {

constexpr double kShare = 0.1;            // of the cost
constexpr double kNoise = 10;             // times what noise gives for each start
constexpr Eigen::Index kMostStarts = 64;  // simulations of a log for each slope

double Rows(const std::vector<Problem::Vector>& r) {
  double rows = 0;
  for (const auto& part : r) rows += static_cast<double>((part.array() != 0).count());
  return rows;
}

}  // namespace

std::string StartHint(const Problem& problem, const Problem::Vector& x,
                      const std::vector<bool>& use) {
  if (problem.experiment().start != Experiment::Start::kMeasured) return "";
  Experiment e = problem.experiment();
  e.start = Experiment::Start::kEstimate;
  try {
    const Problem free(e, problem.system(), {}, {}, problem.seen());
    Problem::Vector y = free.Start();
    y.head(x.size()) = x;
    const auto starts = y.size() - x.size();
    if (starts > kMostStarts) return "";
    const auto r = problem.Residuals(x, use);
    const double before = SumOfSquares(r);
    const FitOptions few{.iterations = 5, .tolerance = 1e-2, .soft = e.soft, .idle = true};
    const double after = SumOfSquares(free.Residuals(FitParameters(free, y, use, few).x, use));
    const double gain = before - after;
    if (!(gain > kShare * before) ||
        !(gain * Rows(r) > kNoise * after * static_cast<double>(starts)))
      return "";
    return fmt::format(
        "the logs begin elsewhere, or faster, than their first rows measure: with 'start: "
        "estimate' "
        "{:.3g} % of the cost would be removed",
        100 * gain / before);
  } catch (const Error&) {
    return "";  // joints whose start cannot be a parameter
  }
}

}  // namespace continuum
