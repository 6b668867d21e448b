// Which columns of a problem's Jacobian have a closed form, and why the others have none.
#include <memory>
#include <numeric>
#include <utility>

#include "error.h"
#include "identification/problem/problem.h"
#include "identification/sensitivity/continuous_sensitivity.h"
#include "identification/sensitivity/model_difference.h"
#include "identification/sensitivity/smooth_path.h"
#include "identification/sensitivity/step_sensitivity.h"
#include "identification/sensitivity/stepped_path.h"
#include "sim/io/interrupt.h"
#include "sim/simulation/initial_state.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Way = Derivative::Way;

// A simulation with all columns in closed form takes as long as some four plain ones.
constexpr std::size_t kWorth = 4;

Derivative OfMeasurement(const Change& change) {
  if (change.attribute == "skew") return {Way::kDifferences, "the rows' times change"};
  return {Way::kMeasurement, "the motion stays the same"};
}

}  // namespace

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

// Why a log's columns are not even tried, whatever its model is; empty: they are.
std::string Problem::NotTried(const Vector& x, std::size_t log, std::size_t columns) const {
  if (path_ == Path::kSmooth) return "no steps are made";
  if (StopRequested()) return "as it was stopped";
  if (columns < kWorth) return "differences are cheaper for fewer than four parameters";
  if (!exact_) return "as asked for";
  if (terms_.count > 0) return "a force of free form acts";
  if (experiment_->quasi_static) return "the logs are quasi-static";
  return MeasuredBy(x, log).skew == experiment_->skew ? "" : "the clock is another one";
}

std::string Problem::NoClosedForm() const {
  const std::string why = NotTried(Start(), 0, parameters_.size());
  if (!why.empty()) return why;
  const ModelAndData machine = ModelAt(0, Start(), 0, 0);
  return StepSensitivity::Obstacle(*machine.model, *machine.data, Wiring(setup_, *machine.model));
}

PerturbedRun Problem::RunBeside(const mjModel& m, const Vector& x, std::size_t log, std::size_t k,
                                std::size_t thread) const {
  Vector moved = x;
  const double step = StepOf(x, k, kPerturbation);
  moved[k] = x[k] + step;
  PerturbedRun run = RunOf(ModelAt(thread, moved, log, 0), moved, log);
  run.field = ModelDifference(m, *run.machine.model).field;
  moved[k] = x[k] - step;
  if (WithinBounds(k, moved[k]) && !run.field.empty())
    run.mirrored = ModelAt(thread, moved, log, 0);
  return run;
}

// Writes column k of J, unless it is left to differences.
Derivative Problem::TakeColumn(const Vector& x, const std::vector<std::size_t>& motion,
                               std::size_t k, const PerturbedRun& run, const Trace& here,
                               const Trace& there, std::vector<Matrix>& J) const {
  if (!ResidualOf(motion.front(), there).allFinite())
    return {Way::kDifferences, "its sensitivity diverges"};
  for (const std::size_t l : motion)
    J[l].col(k) = (ResidualOf(l, there) - ResidualOf(l, here)) / StepOf(x, k, kPerturbation);
  return {run.field.empty() ? Way::kClosedForm : Way::kSingleSteps, run.field};
}

std::vector<Derivative> Problem::SteppedColumns(const Vector& x,
                                                const std::vector<std::size_t>& motion,
                                                const std::vector<std::size_t>& columns,
                                                std::size_t thread, Trace& here,
                                                std::vector<Matrix>& J) const {
  const std::size_t log = motion.front();
  const Experiment setup = MeasuredBy(x, log);
  ModelAndData machine = ModelAt(thread, x, log, 0);
  const mjModel& m = *machine.model;
  const std::string why = StepSensitivity::Obstacle(m, *machine.data, Wiring(setup, m));
  std::vector<Derivative> made(columns.size(), {Way::kDifferences, why});
  if (!why.empty()) return made;
  PerturbedRun trial = RunOf(std::move(machine), x, log);
  std::vector<PerturbedRun> perturbed;
  for (const std::size_t k : columns) perturbed.push_back(RunBeside(m, x, log, k, thread));
  SteppedTraces traces = SimulateStepped(trial, perturbed, setup, experiment_->logs[log]);
  here = std::move(traces.trace);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    made[j].why = traces.why_not[j];
    if (made[j].why.empty())
      made[j] = TakeColumn(x, motion, columns[j], perturbed[j], here, traces.perturbed[j], J);
  }
  return made;
}

std::vector<Derivative> Problem::ClosedFormColumns(const Vector& x,
                                                   const std::vector<std::size_t>& motion,
                                                   const std::vector<std::size_t>& columns,
                                                   std::size_t thread, Trace& here,
                                                   std::vector<Matrix>& J) const {
  std::vector<std::size_t> moving;
  for (const std::size_t k : columns) {
    if (!IsOfMeasurement(k)) moving.push_back(k);
  }
  std::string why = NotTried(x, motion.front(), columns.size());
  std::vector<Derivative> of_motion;
  try {
    if (why.empty()) of_motion = SteppedColumns(x, motion, moving, thread, here, J);
  } catch (const Error& error) {  // of values that no machine has: differences look to both sides
    why = error.what();
  }
  if (!why.empty()) of_motion.assign(moving.size(), {Way::kDifferences, why});
  std::vector<Derivative> made;
  for (auto next = of_motion.begin(); const std::size_t k : columns)
    made.push_back(IsOfMeasurement(k) ? OfMeasurement(parameters_[k].change) : *next++);
  return made;
}

// Of the differential equation; no simulation is needed to tell.
std::vector<Derivative> Problem::SmoothColumns(const Vector& x, std::size_t log,
                                               const std::vector<std::size_t>& columns) const {
  std::vector<std::size_t> moving;
  for (const std::size_t k : columns) {
    if (!IsOfMeasurement(k)) moving.push_back(k);
  }
  const auto dynamics = DynamicsAt(0, x, log);
  const auto beside = DynamicsBeside(0, x, log, moving);
  const ContinuousSensitivity sensitivity(*dynamics, beside, kPerturbation);
  std::vector<Derivative> made;
  for (std::size_t j = 0; const std::size_t k : columns) {
    if (IsOfMeasurement(k)) {
      made.push_back(OfMeasurement(parameters_[k].change));
    } else {
      const std::string& why = sensitivity.WhyNot(j++);
      made.push_back({why.empty() ? Way::kClosedForm : Way::kSingleRates, why});
    }
  }
  return made;
}

std::vector<std::vector<Derivative>> Problem::WaysOf(const Vector& x,
                                                     const std::vector<bool>& use) const {
  std::vector<std::vector<Derivative>> ways(parameters_.size(),
                                            std::vector<Derivative>(use.size()));
  std::vector<Matrix> J(use.size());
  const std::vector<Vector> r = Residuals(x, use);
  for (std::size_t l = 0; l < use.size(); ++l) J[l].resize(r[l].size(), x.size());
  Trace here;
  std::vector<std::size_t> all(parameters_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (const auto& motion : Motions(use)) {
    const std::vector<std::size_t> columns = ActingColumns(all, motion.front());
    const std::vector<Derivative> made = path_ == Path::kSmooth
                                             ? SmoothColumns(x, motion.front(), columns)
                                             : ClosedFormColumns(x, motion, columns, 0, here, J);
    for (std::size_t j = 0; j < columns.size(); ++j) {
      for (const std::size_t l : motion) ways[columns[j]][l] = made[j];
    }
  }
  return ways;
}

}  // namespace continuum
