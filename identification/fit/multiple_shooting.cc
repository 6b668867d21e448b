#include "identification/fit/multiple_shooting.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

constexpr double kLong = 20;            // [s]
constexpr std::size_t kLeastRows = 10;  // of a piece

bool IsLong(const Log& log, std::size_t pieces) {
  return log.rows() >= pieces * kLeastRows && log.time.back() - log.time[0] > kLong;
}

bool HasPlainJoints(const mjModel& m) {
  for (int j = 0; j < m.njnt; ++j) {
    const bool plain = m.jnt_type[j] == mjJNT_HINGE || m.jnt_type[j] == mjJNT_SLIDE;
    if (!plain || !mj_id2name(&m, mjOBJ_JOINT, j)) return false;
  }
  return true;
}

bool MayBeCut(const Problem& problem, const std::vector<bool>& use, std::size_t pieces) {
  constexpr double kMostWork = 2e10;  // of a least squares solution: seconds
  const Experiment& e = problem.experiment();
  const mjModel& m = problem.system().model();
  double rows = 0, starts = 0;
  bool any = false;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    const bool is_long = IsLong(e.logs[l], pieces);
    any |= is_long;
    rows += static_cast<double>(e.logs[l].rows() * problem.channels().size());
    starts += 2.0 * static_cast<double>(m.njnt) * (is_long ? static_cast<double>(pieces) : 1);
  }
  const auto own = [](const Parameter& p) { return p.per == Parameter::Per::kLog; };
  return any && rows * starts * starts < kMostWork && !e.quasi_static && HasPlainJoints(m) &&
         std::none_of(e.parameters.begin(), e.parameters.end(), own);
}

constexpr std::size_t kFew = 16, kMany = 64;  // pieces of a long log

struct Parts {
  Experiment experiment;
  std::vector<Seam> seams;
};

// A twentieth of a piece is the next one's too, three rows at least.
void AddPieces(const Log& log, std::size_t pieces, Parts& cut) {
  const std::size_t length = log.rows() / pieces, shared = std::max<std::size_t>(3, length / 20);
  for (std::size_t k = 0; k < pieces; ++k) {
    const std::size_t first = k * length;
    const std::size_t last =
        k + 1 == pieces ? log.rows() - 1 : std::min(log.rows(), first + length + shared) - 1;
    Log piece = Piece(log, first, last);
    piece.label = fmt::format("{}, part {}", log.label, k + 1);
    if (k > 0) piece.start.clear();
    cut.experiment.logs.push_back(std::move(piece));
    const std::size_t here = cut.experiment.logs.size() - 1;
    if (k > 0) cut.seams.push_back({here - 1, here, static_cast<Eigen::Index>(shared)});
  }
}

Parts CutUp(const Experiment& e, const std::vector<bool>& use, std::size_t pieces) {
  Parts cut{e, {}};
  cut.experiment.logs.clear();
  cut.experiment.start = Experiment::Start::kEstimate;
  for (std::size_t l = 0; l < use.size(); ++l) {
    Log log = e.logs[l];
    log.train = use[l];
    if (log.train && IsLong(log, pieces)) {
      AddPieces(log, pieces, cut);
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

struct Search {
  const Problem& problem;
  const std::vector<bool>& use;
  const FitOptions& options;
  ShootingSegments found;
  Problem::Vector x;  // where the last pieces ended

  // Fits pieces with these weights of their seams, one after the other.
  void Cut(std::size_t count, const std::vector<double>& weights) {
    const auto cut = CutUp(problem.experiment(), use, count);
    const Problem pieces(cut.experiment, problem.system());
    Problem::Vector y = Shared(problem, x, pieces.Start());
    FitOptions own = options;
    own.idle = true, own.tolerance = 1e-3, own.seams = cut.seams;
    for (const double weight : weights) {
      if (StopRequested()) break;
      own.seam_weight = weight;
      own.progress = [&](const std::string& line) {
        if (options.progress)
          options.progress(fmt::format("{} pieces, seams {}: {}", count, weight, line));
      };
      try {
        y = FitParameters(pieces, y, pieces.TrainLogs(), own).x;
      } catch (const Error& error) {
        if (error.kind() != Error::Kind::kJob) throw;
        break;  // it diverges
      }
      Consider(FitStarts(problem, Shared(problem, y, x), use));
    }
    found.evaluations += pieces.evaluations();
  }

  void Consider(const Problem::Vector& whole) {
    const double cost = CostOf(problem, whole, use);
    if (cost < found.after) found.x = whole, found.after = cost;
    x = whole;
  }
};

}  // namespace

Log Piece(const Log& log, std::size_t first, std::size_t last) {
  Log piece = log;
  const auto cut = [&](auto& column) {
    using Column = std::remove_reference_t<decltype(column)>;
    if (!column.empty()) column = Column(column.begin() + first, column.begin() + last + 1);
  };
  cut(piece.time);
  for (auto* const columns : {&piece.input, &piece.measured}) {
    for (auto& column : *columns) cut(column);
  }
  for (auto& column : piece.enable) cut(column);
  return piece;
}

std::optional<ShootingSegments> FitInPieces(const Problem& problem, const Problem::Vector& x,
                                            const std::vector<bool>& use,
                                            const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t evaluations = problem.evaluations();
  Search search{problem, use, options, {x, CostOf(problem, x, use)}, x};
  search.found.after = search.found.before;
  if (MayBeCut(problem, use, kMany)) search.Cut(kMany, {0});
  if (MayBeCut(problem, use, kFew)) search.Cut(kFew, {0, 1, 10, 100});
  if (search.found.evaluations == 0) return {};
  ShootingSegments& found = search.found;
  found.evaluations += problem.evaluations() - evaluations;
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

}  // namespace continuum
