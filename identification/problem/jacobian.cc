// How the residuals of a problem follow its parameters.
#include <memory>
#include <numeric>

#include "error.h"
#include "identification/problem/problem.h"
#include "identification/sensitivity/model_difference.h"
#include "identification/sensitivity/smooth_path.h"
#include "identification/sensitivity/step_sensitivity.h"
#include "identification/sensitivity/stepped_path.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/parallel.h"
#include "sim/simulation/initial_state.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

// A simulation with all columns in closed form takes as long as some four plain ones.
constexpr std::size_t kWorth = 4;

}  // namespace

std::vector<Problem::Matrix> Problem::Jacobian(const Vector& x, const std::vector<Vector>& r,
                                               const std::vector<bool>& use,
                                               const std::vector<Matrix>& known, bool rough) const {
  std::vector<Matrix> J(use.size());
  const auto motions = Motions(use);
  std::size_t first = 0;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    J[l] = Matrix::Zero(r[l].size(), x.size());
    if (known.empty()) continue;
    first = static_cast<std::size_t>(known[l].cols());
    J[l].leftCols(known[l].cols()) = known[l];
  }
  std::vector<std::size_t> columns;
  for (std::size_t k = first; k < parameters_.size(); ++k) {
    if (path_ == Path::kStepped || IsOfMeasurement(k)) columns.push_back(k);
  }
  DifferenceColumns(x, r, motions, columns, J);
  if (path_ == Path::kSmooth) SensitivityColumns(x, motions, first, rough, J);
  return J;
}

std::vector<Problem::Matrix> Problem::StartJacobian(const Vector& x, const std::vector<Vector>& r,
                                                    const std::vector<bool>& use) const {
  std::vector<Matrix> J(use.size());
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (use[l]) J[l] = Matrix::Zero(r[l].size(), x.size());
  }
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < parameters_.size(); ++k) {
    if (parameters_[k].IsStart()) columns.push_back(k);
  }
  DifferenceColumns(x, r, Motions(use), columns, J);
  return J;
}

// Whether a parameter changes how a motion is measured, not the motion.
bool Problem::IsOfMeasurement(std::size_t k) const {
  return SideOf(parameters_[k].change) == Side::kMeasurement;
}

bool Problem::WithinBounds(std::size_t k, double value) const {
  return value >= parameters_[k].lower && value <= parameters_[k].upper;
}

double Problem::StepOf(const Vector& x, std::size_t k, double share) const {
  const double step = share * parameters_[k].scale;
  return x[k] + step > parameters_[k].upper ? -step : step;
}

void Problem::DifferenceColumns(const Vector& x, const std::vector<Vector>& r,
                                const std::vector<std::vector<std::size_t>>& motions,
                                const std::vector<std::size_t>& columns,
                                std::vector<Matrix>& J) const {
  std::vector<std::pair<std::size_t, std::size_t>> tasks;  // motion, parameter
  std::vector<std::vector<std::size_t>> left(motions.size());
  ParallelFor(motions.size(), [&](std::size_t thread, std::size_t i) {
    for (const std::size_t k : columns) {
      if (parameters_[k].log[motions[i].front()]) left[i].push_back(k);
    }
    left[i] = ClosedFormColumns(x, motions[i], left[i], thread, J);
  });
  std::size_t exact = 0;  // simulations that gave columns in closed form
  for (std::size_t i = 0; i < motions.size(); ++i) {
    exact += left[i].size() < columns.size();
    for (const std::size_t k : left[i]) tasks.emplace_back(i, k);
  }
  ParallelFor(tasks.size(), [&](std::size_t thread, std::size_t t) {
    if (StopRequested()) return;
    const std::size_t i = tasks[t].first, k = tasks[t].second;
    double step = StepOf(x, k, share_);
    const auto moved = [&](double by) {
      Vector beside = x;
      beside[k] += by;
      return Run(thread, beside, motions[i].front());
    };
    const bool room = WithinBounds(k, x[k] - step);
    Trace there = moved(step), back;
    bool both = central_ && room;
    if (both) back = moved(-step);
    if (both && back.diverged) both = false;
    if (there.diverged && room) {  // at the edge of what can be simulated: to the other side
      there = central_ ? std::move(back) : moved(-step);
      step = -step, both = false;
    }
    for (const std::size_t l : motions[i])
      J[l].col(k) = both ? (ResidualOf(l, there) - ResidualOf(l, back)) / (2 * step)
                         : (ResidualOf(l, there) - r[l]) / step;
  });
  evaluations_ += (central_ ? 2 : 1) * tasks.size() + exact;
}

PerturbedRun Problem::RunOf(ModelAndData machine, const Vector& x, std::size_t log) const {
  PerturbedRun trial{std::move(machine), {}, {}, {}, {}, {}};
  const Log& logged = experiment_->logs[log];
  InitialState start = StartAt(trial.machine, x, log);
  if (start.qpos.empty()) start = StartOf(trial.machine, setup_, logged);
  mjModel& m = *trial.machine.model;
  mjData& d = *trial.machine.data;
  const Wiring wiring(setup_, m);
  Inputs inputs(m, setup_, logged, wiring);
  inputs.AtRow(d, 0);
  Settle(m, d);
  inputs.EnableAll();
  trial.q = std::move(start.qpos), trial.v = std::move(start.qvel);
  trial.w.assign(d.act, d.act + m.na);
  trial.z.assign(d.plugin_state, d.plugin_state + m.npluginstate);
  return trial;
}

std::string Problem::NoClosedForm() const {
  if (parameters_.size() < kWorth) return "they are cheaper for a few parameters";
  if (!exact_) return "as asked for";
  if (terms_.count > 0) return "a force of free form acts";
  if (experiment_->quasi_static) return "the logs are quasi-static";
  const ModelAndData machine = ModelAt(0, Start(), 0, 0);
  return StepSensitivity::Obstacle(*machine.model, *machine.data, Wiring(setup_, *machine.model));
}

std::vector<std::size_t> Problem::ClosedFormColumns(const Vector& x,
                                                    const std::vector<std::size_t>& motion,
                                                    const std::vector<std::size_t>& columns,
                                                    std::size_t thread,
                                                    std::vector<Matrix>& J) const {
  const std::size_t log = motion.front();
  const Experiment setup = MeasuredBy(x, log);
  if (!exact_ || path_ != Path::kStepped || columns.size() < kWorth || terms_.count > 0 ||
      experiment_->quasi_static || setup.skew != experiment_->skew || StopRequested())
    return columns;
  std::vector<std::size_t> left, moving;
  for (const std::size_t k : columns) (IsOfMeasurement(k) ? left : moving).push_back(k);
  SteppedTraces traces;
  try {
    ModelAndData machine = ModelAt(thread, x, log, 0);
    const mjModel& m = *machine.model;
    if (!StepSensitivity::Obstacle(m, *machine.data, Wiring(setup, m)).empty()) return columns;
    PerturbedRun trial = RunOf(std::move(machine), x, log);
    std::vector<PerturbedRun> perturbed;
    for (const std::size_t k : moving) {
      Vector moved = x;
      const double step = StepOf(x, k, kPerturbation);
      moved[k] = x[k] + step;
      perturbed.push_back(RunOf(ModelAt(thread, moved, log, 0), moved, log));
      moved[k] = x[k] - step;
      PerturbedRun& run = perturbed.back();
      if (WithinBounds(k, moved[k]) && !ModelDifference(m, *run.machine.model).field.empty())
        run.mirrored = ModelAt(thread, moved, log, 0);
    }
    traces = SimulateStepped(trial, perturbed, setup, experiment_->logs[log]);
  } catch (const Error&) {  // of values that no machine has: differences look to the other side
    return columns;
  }
  for (std::size_t j = 0; j < moving.size(); ++j) {
    const std::size_t k = moving[j];
    if (!traces.perturbed[j] || !ResidualOf(log, *traces.perturbed[j]).allFinite()) {
      left.push_back(k);
      continue;
    }
    for (const std::size_t l : motion) {
      J[l].col(k) = (ResidualOf(l, *traces.perturbed[j]) - ResidualOf(l, traces.trace)) /
                    StepOf(x, k, kPerturbation);
    }
  }
  return left;
}

// Parameters of a motion are shared out so that no core waits for another.
void Problem::SensitivityColumns(const Vector& x,
                                 const std::vector<std::vector<std::size_t>>& motions,
                                 std::size_t first, bool rough, std::vector<Matrix>& J) const {
  struct Task {
    std::size_t motion;
    std::vector<std::size_t> moving;
  };
  std::vector<Task> tasks;
  const std::size_t shares = ThreadCount() / std::gcd(motions.size(), ThreadCount());
  for (std::size_t i = 0; i < motions.size(); ++i) {
    std::vector<std::size_t> moving;
    for (std::size_t k = first; k < parameters_.size(); ++k) {
      if (!IsOfMeasurement(k) && parameters_[k].log[motions[i].front()]) moving.push_back(k);
    }
    for (std::size_t s = 0; s < shares; ++s) {
      const auto at = [&](std::size_t share) {
        return moving.begin() + static_cast<std::ptrdiff_t>(share * moving.size() / shares);
      };
      if (at(s) != at(s + 1)) tasks.push_back({i, {at(s), at(s + 1)}});
    }
  }
  SolverOptions how = solver_;
  if (rough) how.relative = 1e-3, how.absolute = 1e-5;
  ParallelFor(tasks.size(), [&](std::size_t thread, std::size_t t) {
    if (StopRequested()) return;
    const auto& [i, moving] = tasks[t];
    const std::size_t log = motions[i].front();
    std::vector<std::unique_ptr<ContinuousDynamics>> perturbed;
    for (const std::size_t k : moving) {
      Vector moved = x;
      moved[k] += StepOf(x, k, kPerturbation);
      perturbed.push_back(DynamicsAt(thread, moved, log));
    }
    const auto dynamics = DynamicsAt(thread, x, log);
    const Log& logged = experiment_->logs[log];
    const Experiment measured = MeasuredBy(x, log);
    SmoothTraces traces = SimulateSmooth(*dynamics, perturbed, measured, logged, how);
    for (std::size_t j = 0; j < moving.size(); ++j) {
      MeasureTrace(measured, dynamics->wiring(), logged, traces.perturbed[j]);
      for (const std::size_t l : motions[i]) {
        J[l].col(moving[j]) = (ResidualOf(l, traces.perturbed[j]) - ResidualOf(l, traces.trace)) /
                              StepOf(x, moving[j], kPerturbation);
      }
    }
  });
  evaluations_ += tasks.size();
}

}  // namespace continuum
