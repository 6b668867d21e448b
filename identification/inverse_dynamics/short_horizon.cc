#include "identification/inverse_dynamics/short_horizon.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "error.h"
#include "identification/fit/out_of_step.h"
#include "identification/fit/wide_slope_fit.h"
#include "identification/inverse_dynamics/measured_motion.h"
#include "identification/inverse_dynamics/missing_force.h"
#include "sim/io/interrupt.h"
#include "sim/model/elastic_gear.h"

namespace continuum {
namespace {

constexpr std::size_t kPieces = 8, kLeastRows = 12;

// Positions and speeds at one time of a log.
struct Restart {
  double time;                           // from the first row
  std::vector<std::string> joints = {};  // names: candidates may have more joints
  std::vector<double> q = {}, v = {};

  void WriteTo(const mjModel& m, mjData& d) const {
    for (std::size_t i = 0; i < joints.size(); ++i)
      PlaceJoint(m, d, mj_name2id(&m, mjOBJ_JOINT, joints[i].c_str()), q[i], v[i]);
  }
};

std::vector<Restart> RestartsOf(const Experiment& e, const mjModel& m, const Log& log) {
  const std::size_t length = std::max(kLeastRows, log.rows() / kPieces);
  std::vector<Quartic> quartics;
  for (std::size_t row = length; row + kLeastRows < log.rows(); row += length)
    quartics.emplace_back(log.time, row);
  std::vector<Restart> restarts;
  for (const Quartic& q : quartics)
    restarts.push_back({log.time[q.begin + kHalfRows] - log.time[0]});
  for (const auto& [joint, motion] : MotionsOf(e, m, log, quartics)) {
    for (std::size_t k = 0; k < restarts.size(); ++k) {
      restarts[k].joints.emplace_back(mj_id2name(&m, mjOBJ_JOINT, joint));
      restarts[k].q.push_back(motion.angle[k]), restarts[k].v.push_back(motion.velocity[k]);
    }
  }
  return restarts;
}

Hooks HooksOf(const std::vector<Restart>& restarts) {
  constexpr double kRounding = 1e-9;  // [s]
  Hooks hooks;
  hooks.step = [&restarts, next = std::size_t{0}](const mjModel& m, mjData& d) mutable {
    for (; next < restarts.size() && d.time > restarts[next].time - kRounding; ++next)
      restarts[next].WriteTo(m, d);
  };
  return hooks;
}

}  // namespace

std::optional<Problem> OnShortHorizons(const Problem& problem, const std::vector<bool>& use) {
  const Experiment& e = problem.experiment();
  const auto all = std::make_shared<std::vector<std::vector<Restart>>>(use.size());
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    if (!MeasuresEveryJoint(problem, l)) return {};
    (*all)[l] =
        RestartsOf(problem.MeasuredBy(problem.Start(), l), problem.system().model(), e.logs[l]);
  }
  Problem pieces = problem;
  if (pieces.path() != Path::kStepped) pieces.Follow(Path::kStepped);
  pieces.Guide([all](std::size_t log) { return HooksOf((*all)[log]); });
  return pieces;
}

namespace {

FitOptions OverPieces(const FitOptions& options) {
  constexpr int kFewSteps = 15;
  constexpr double kNearEnough = 1e-3;  // of the cost
  FitOptions own = options;
  own.idle = own.rough = true, own.slopes = nullptr;
  own.iterations = std::min(own.iterations, kFewSteps), own.tolerance = kNearEnough;
  own.progress = Within({"fit over short horizons"}, options.progress);
  return own;
}

}  // namespace

Fit FitByShortHorizons(const Problem& problem, Fit best, const std::vector<bool>& use,
                       const FitOptions& options) {
  constexpr double kNear = 2;  // times the cost, from where a fit may still become the better one
  if (StopRequested() || !IsOutOfStep(problem, best.x, use)) return best;
  const auto pieces = OnShortHorizons(problem, use);
  if (!pieces) return best;
  const FitOptions first = OverPieces(options);
  FitOptions own = first;
  own.iterations = options.iterations, own.tolerance = options.tolerance;
  try {
    const Fit begin = FitParameters(*pieces, best.x, use, first);
    best.evaluations += begin.evaluations, best.seconds += begin.seconds;
    if (!(CostAt(problem, begin.x, use, options) < kNear * best.cost)) return best;
    Fit fit = FitWithWideSlopes(problem, begin.x, use, own);
    fit.evaluations += best.evaluations, fit.seconds += best.seconds;
    if (!(fit.cost < best.cost)) return best;
    fit.anew = true;
    return fit;
  } catch (const Error& error) {
    if (error.kind() != Error::Kind::kJob) throw;
    return best;  // it diverges there
  }
}

void FitOverPieces(const Problem& problem, const std::vector<bool>& use, const FitOptions& options,
                   Fit& fit) {
  if (StopRequested() || !IsOutOfStep(problem, fit.x, use)) return;
  const auto pieces = OnShortHorizons(problem, use);
  if (!pieces) return;
  FitOptions own = OverPieces(options);
  own.iterations = options.iterations, own.rough = false;
  try {
    const Fit there = FitParameters(*pieces, fit.x, use, own);
    fit.evaluations += there.evaluations, fit.seconds += there.seconds;
    if (IsOutOfStep(*pieces, there.x, use)) return;
    fit.x = there.x, fit.cost = CostAt(problem, there.x, use, options);
    fit.converged = there.converged, fit.message = there.message;
    fit.anew = false, fit.over_pieces = true;
  } catch (const Error& error) {
    if (error.kind() != Error::Kind::kJob) throw;  // it diverges there
  }
}

}  // namespace continuum
