#include "identification/fit/multiple_shooting.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

constexpr double kLong = 20;            // [s]
constexpr std::size_t kLeastRows = 10;  // of a segment

bool IsLong(const Log& log, std::size_t segments) {
  return log.rows() >= segments * kLeastRows && log.time.back() - log.time[0] > kLong;
}

bool HasPlainJoints(const mjModel& m) {
  for (int j = 0; j < m.njnt; ++j) {
    const bool plain = m.jnt_type[j] == mjJNT_HINGE || m.jnt_type[j] == mjJNT_SLIDE;
    if (!plain || !mj_id2name(&m, mjOBJ_JOINT, j)) return false;
  }
  return true;
}

bool MayBeSegmented(const Problem& problem, const std::vector<bool>& use, std::size_t segments) {
  constexpr double kMostWork = 2e10;  // of a least squares solution: seconds
  const Experiment& e = problem.experiment();
  const mjModel& m = problem.system().model();
  double rows = 0, starts = 0;
  bool any = false;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    const bool is_long = IsLong(e.logs[l], segments);
    any |= is_long;
    rows += static_cast<double>(e.logs[l].rows() * problem.channels().size());
    starts += 2.0 * static_cast<double>(m.njnt) * (is_long ? static_cast<double>(segments) : 1);
  }
  const auto own = [](const Parameter& p) { return p.per == Parameter::Per::kLog; };
  return any && rows * starts * starts < kMostWork && !e.quasi_static && HasPlainJoints(m) &&
         std::none_of(e.parameters.begin(), e.parameters.end(), own);
}

constexpr std::size_t kFew = 16, kMany = 64;  // segments of a long log

struct SegmentedLogs {
  Experiment experiment;
  std::vector<ContinuityCondition> continuity;
};

// A twentieth of a segment is the next one's too, three rows at least.
void AddSegments(const Log& log, std::size_t segments, SegmentedLogs& cut) {
  const std::size_t length = log.rows() / segments, shared = std::max<std::size_t>(3, length / 20);
  for (std::size_t k = 0; k < segments; ++k) {
    const std::size_t first = k * length;
    const std::size_t last =
        k + 1 == segments ? log.rows() - 1 : std::min(log.rows(), first + length + shared) - 1;
    Log segment = SegmentOf(log, first, last);
    segment.label = fmt::format("{}, part {}", log.label, k + 1);
    if (k > 0) segment.start.clear();
    cut.experiment.logs.push_back(std::move(segment));
    const std::size_t here = cut.experiment.logs.size() - 1;
    if (k > 0) cut.continuity.push_back({here - 1, here, static_cast<Eigen::Index>(shared)});
  }
}

SegmentedLogs Segmented(const Experiment& e, const std::vector<bool>& use, std::size_t segments) {
  SegmentedLogs cut{WithoutLogs(e), {}};
  cut.experiment.start = Experiment::Start::kEstimate;
  for (std::size_t l = 0; l < use.size(); ++l) {
    Log log = e.logs[l];
    log.train = use[l];
    if (log.train && IsLong(log, segments)) {
      AddSegments(log, segments, cut);
    } else {
      cut.experiment.logs.push_back(std::move(log));
    }
  }
  return cut;
}

// With the parameters of one problem in another, which has the same and starts of its own.
Problem::Vector Shared(const Problem& problem, const Problem::Vector& from, Problem::Vector to) {
  const Eigen::Index n = problem.WithoutStarts(problem.Start()).size();
  to.head(n) = from.head(n);
  return to;
}

double CostOf(const Problem& problem, const Problem::Vector& x, const std::vector<bool>& use) {
  const double cost = 0.5 * SumOfSquares(problem.Residuals(x, use));
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

struct SegmentFit {
  const Problem& problem;
  const std::vector<bool>& use;
  const FitOptions& options;
  ShootingSegments found;
  Problem::Vector x;  // where the last segments ended

  // Fits segments with these weights of their continuity conditions, one after the other.
  void Cut(std::size_t count, const std::vector<double>& weights) {
    const auto cut = Segmented(problem.experiment(), use, count);
    const Problem segments(cut.experiment, problem.system());
    Problem::Vector y = Shared(problem, x, segments.Start());
    FitOptions own = options;
    own.idle = true, own.tolerance = 1e-3, own.continuity = cut.continuity;
    for (const double weight : weights) {
      if (StopRequested()) break;
      own.continuity_weight = weight;
      const std::string which = fmt::format("{} segments, weight of their ends {}", count, weight);
      own.progress = Within({"fit of segments", 0, 0, which}, options.progress);
      try {
        y = FitParameters(segments, y, segments.TrainLogs(), own).x;
      } catch (const Error& error) {
        if (error.kind() != Error::Kind::kJob) throw;
        break;  // it diverges
      }
      Consider(FitStarts(problem, Shared(problem, y, x), use));
    }
    found.evaluations += segments.evaluations();
  }

  void Consider(const Problem::Vector& whole) {
    const double cost = CostOf(problem, whole, use);
    if (cost < found.after) found.x = whole, found.after = cost;
    x = whole;
  }
};

}  // namespace

Log SegmentOf(const Log& log, std::size_t first, std::size_t last) {
  Log segment = log;
  const auto cut = [&](auto& column) {
    using Column = std::remove_reference_t<decltype(column)>;
    if (!column.empty()) column = Column(column.begin() + first, column.begin() + last + 1);
  };
  cut(segment.time);
  for (auto* const columns : {&segment.input, &segment.measured}) {
    for (auto& column : *columns) cut(column);
  }
  for (auto& column : segment.enable) cut(column);
  return segment;
}

std::optional<ShootingSegments> FitByMultipleShooting(const Problem& problem,
                                                      const Problem::Vector& x,
                                                      const std::vector<bool>& use,
                                                      const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t evaluations = problem.evaluations();
  SegmentFit fit{problem, use, options, {x, CostOf(problem, x, use)}, x};
  fit.found.after = fit.found.before;
  if (MayBeSegmented(problem, use, kMany)) fit.Cut(kMany, {0});
  if (MayBeSegmented(problem, use, kFew)) fit.Cut(kFew, {0, 1, 10, 100});
  if (fit.found.evaluations == 0) return {};
  ShootingSegments& found = fit.found;
  found.evaluations += problem.evaluations() - evaluations;
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

}  // namespace continuum
