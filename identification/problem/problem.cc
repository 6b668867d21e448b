#include "identification/problem/problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "error.h"
#include "identification/problem/duplicate_parameters.h"
#include "identification/problem/inertia_range.h"
#include "identification/problem/parameter_units.h"
#include "identification/problem/start_parameters.h"
#include "identification/problem/trace_bytes.h"
#include "identification/sensitivity/smooth_path.h"
#include "sim/experiment/measurement_model.h"
#include "sim/experiment/registration.h"
#include "sim/numerics/parallel.h"
#include "sim/numerics/parallel_scope.h"
#include "sim/numerics/shared_loop.h"
#include "sim/simulation/initial_state.h"
#include "sim/simulation/registration_fit.h"
#include "sim/simulation/simulate.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

// The start of a parameter that is above zero, or has no bounds to speak of, says its size.
double TypicalSize(double initial, double lower, double upper) {
  constexpr double kNoBound = 1e9;  // [unit]
  const double range = upper - lower;
  const double least = lower > 0 || range >= kNoBound ? 0 : 1e-3 * range;
  const double size = std::max(std::abs(initial), least);
  return std::isfinite(size) && size > 0 ? std::min(size, range) : 1;
}

// Whether a parameter or a log changes a geom, so that those without contacts have to stay.
bool ChangesGeoms(const Experiment& e) {
  const auto is_geom = [](const auto& change) { return change.target.starts_with("geom:"); };
  bool geoms = std::any_of(e.parameters.begin(), e.parameters.end(), is_geom);
  for (const Log& log : e.logs)
    geoms = geoms || std::any_of(log.set.begin(), log.set.end(), is_geom);
  return geoms;
}

}  // namespace

std::vector<bool> TrainLogs(const Experiment& experiment) {
  std::vector<bool> use;
  for (const Log& log : experiment.logs) use.push_back(log.train);
  return use;
}

double SumOfSquares(const std::vector<Eigen::VectorXd>& residuals) {
  double sum = 0;
  for (const auto& r : residuals) sum += r.squaredNorm();
  return sum;
}

Problem::Problem(const Experiment& experiment, const ModelSpec& system,
                 std::vector<Parameter> extra, ForceTerms terms, std::vector<bool> seen)
    : experiment_(&experiment),
      seen_(seen.empty() ? continuum::TrainLogs(experiment) : std::move(seen)),
      setup_(WithoutLogs(experiment)),
      runs_(experiment.logs.size()),
      terms_(std::move(terms)),
      evaluations_(ThreadCount()) {
  const bool geoms = ChangesGeoms(experiment);
  for (std::size_t t = 0; t < ThreadCount(); ++t) {
    systems_.push_back(system);
    if (!geoms) systems_.back().DropVisuals();
  }
  for (const Parameter& p : experiment.parameters) Expand(p);
  KeepToInertias(system, parameters_);
  RefuseDuplicates(experiment.parameters, system);
  const Wiring wiring(experiment, system.model());
  for (const Parameter& p : RegistrationParameters(experiment, wiring, system.model())) Expand(p);
  for (FreeParameter& p : StartParameters(experiment, system)) parameters_.push_back(std::move(p));
  for (const Parameter& p : extra) Expand(p);
  for (std::size_t k = 0; k < terms_.count; ++k) {
    parameters_.push_back({"force term " + std::to_string(k + 1),
                           "N*m",
                           0,
                           -100 * terms_.size,
                           100 * terms_.size,
                           10 * terms_.size,
                           {},
                           AllLogs()});
  }
  for (std::size_t l = 0; l < experiment.logs.size(); ++l) {
    std::size_t first = 0;
    while (!SameMotion(first, l)) ++first;
    motion_.push_back(first);
  }
  FindScales();
}

void Problem::FindScales() {
  const Experiment& experiment = *experiment_;
  const Pool pool(experiment);
  bool sigma = true;
  for (const Output& out : experiment.outputs) sigma &= out.sigma > 0 || out.weight == 0;
  for (std::size_t c = 0; c < experiment.channels.size(); ++c) {
    const auto& channel = experiment.channels[c];
    const Output& out = experiment.outputs[channel.output];
    if (!pool.counts(c)) continue;
    channels_.push_back(c);
    const double unit = sigma ? out.sigma * channel.factor : pool.scale(c);
    scale_.push_back(unit / std::sqrt(out.weight));
    pooled_.push_back(scale_.back() / pool.scale(c));
  }
}

// On the smooth path with the method that takes fewer evaluations at the start.
void Problem::Follow(Path path) {
  path_ = path;
  runs_.Forget();
  if (path == Path::kStepped) return;
  solver_.stiff = true;
  if (DynamicsAt(0, Start(), 0)->rubs()) return;
  std::array<long, 2> rates;
  for (const bool stiff : {false, true}) {
    solver_.stiff = stiff;
    const SmoothTraces traces =
        SimulateSmooth(*DynamicsAt(0, Start(), 0), {}, setup_, experiment_->logs[0], solver_);
    rates[stiff] = traces.trace.diverged ? std::numeric_limits<long>::max() : traces.work.rates;
  }
  solver_.stiff = rates[true] <= rates[false];
}

double Problem::step() const { return step_ > 0 ? step_ : system().model().opt.timestep; }

void Problem::StepBy(double h) {
  step_ = h;
  runs_.Forget();
}

void Problem::Guide(std::function<Hooks(std::size_t log)> hooks) {
  guide_ = std::move(hooks), exact_ = false;
  std::iota(motion_.begin(), motion_.end(), std::size_t{0});  // on a way of its own each
  runs_.Forget();
}

double Problem::PresentValue(const Parameter& p) const {
  try {
    return IsMeasurement(p.target, p.attribute)
               ? MeasurementValue(*experiment_, p.target, p.attribute)
               : system().Value(p.target, p.attribute);
  } catch (const Error& e) {
    throw Error::Input(p.where, e.what());
  }
}

void Problem::Expand(const Parameter& p) {
  const double present = PresentValue(p);
  const std::string unit = IsMeasurement(p.target, p.attribute)
                               ? MeasurementUnit(*experiment_, p.target, p.attribute)
                               : UnitOf(system(), p);
  const double start = p.Start([&] { return present; });
  FreeParameter free{p.name, unit, start, p.lower, p.upper, 1, {}, {}, p.where};
  free.change = {p.target, p.attribute, 0, p.operation};
  if (p.frozen) {
    free.change.value = free.initial;
    frozen_.push_back(free.change);
    return;
  }
  if (free.initial < free.lower || free.initial > free.upper) {
    throw Error::Input(
        p.where,
        "a start within [" + std::to_string(free.lower) + ", " + std::to_string(free.upper) + "]",
        std::to_string(free.initial) + " (what the model has)");
  }
  free.scale = TypicalSize(free.initial, free.lower, free.upper);
  if (p.per == Parameter::Per::kAll) {
    for (const Log& log : experiment_->logs)
      free.log.push_back(p.condition.empty() || p.condition == log.condition);
    parameters_.push_back(free);
  } else {
    ExpandGroups(p, free);
  }
}

// One for each log or condition.
void Problem::ExpandGroups(const Parameter& p, const FreeParameter& free) {
  RequireSeen(p);
  const auto& logs = experiment_->logs;
  std::set<std::string> groups;
  for (const Log& log : logs) groups.insert(GroupOf(p, log));
  for (const std::string& name : groups) {
    FreeParameter one = free;
    one.name = p.name + "[" + name + "]";
    for (const Log& log : logs) one.log.push_back(GroupOf(p, log) == name);
    parameters_.push_back(std::move(one));
  }
}

// The logs that share a value.
std::string Problem::GroupOf(const Parameter& p, const Log& log) const {
  return p.per == Parameter::Per::kLog ? log.label : log.condition;
}

// Every value needs a log that determines it.
void Problem::RequireSeen(const Parameter& p) const {
  const auto& logs = experiment_->logs;
  std::set<std::string> named;
  for (std::size_t l = 0; l < logs.size(); ++l)
    if (seen_[l]) named.insert(GroupOf(p, logs[l]));
  for (const Log& log : logs) {
    const std::string name = GroupOf(p, log);
    if (named.contains(name)) continue;
    if (p.per == Parameter::Per::kLog)
      throw Error::Input(
          p.where + ".per",
          "`use: train` in every log where each has a value of its own (or `identify --all`, or "
          "`per: condition`)",
          "log '" + name +
              "' with `use: validate`, which no fit sees: nothing would determine its value");
    throw Error::Input(p.where + ".per", "a train log of every condition (or `identify --all`)",
                       "none of '" + name + "': nothing would determine its value");
  }
}

Problem::Vector Problem::Start() const {
  Vector x(static_cast<Eigen::Index>(parameters_.size()));
  for (std::size_t i = 0; i < parameters_.size(); ++i) x[i] = parameters_[i].initial;
  return x;
}

Problem::Vector Problem::Clamp(const Vector& x) const {
  Vector out = x;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    out[i] = std::clamp(x[i], parameters_[i].lower, parameters_[i].upper);
  }
  return out;
}

Problem::Vector Problem::WithoutStarts(const Vector& x) const {
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!parameters_[i].IsStart()) others.push_back(i);
  }
  return x(others);
}

Problem::Side Problem::SideOf(const Change& c) {
  if (c.target.starts_with("start:")) return Side::kStart;
  return IsMeasurement(c.target, c.attribute) ? Side::kMeasurement : Side::kModel;
}

// Those of one side, in the order in which they apply.
std::vector<Change> Problem::ChangesAt(const Vector& x, std::size_t log, Side side) const {
  std::vector<Change> changes;
  const auto add = [&](const Change& c) {
    if (SideOf(c) == side) changes.push_back(c);
  };
  for (const Change& c : experiment_->logs[log].set) add(c);
  for (const Change& c : frozen_) add(c);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (!parameters_[i].log[log] || parameters_[i].change.target.empty()) continue;
    Change change = parameters_[i].change;
    change.value = x[i];
    add(change);
  }
  return changes;
}

std::vector<Change> Problem::ChangesFor(const Vector& x, std::size_t log) const {
  return ChangesAt(x, log, Side::kModel);
}

Experiment Problem::MeasuredBy(const Vector& x, std::size_t log) const {
  Experiment e = setup_;
  for (const Change& c : ChangesAt(x, log, Side::kMeasurement)) ApplyMeasurement(e, c);
  return e;
}

std::vector<Change> Problem::CommonChanges(const Vector& x) const {
  std::vector<Change> changes;
  for (const Change& c : frozen_) {
    if (SideOf(c) == Side::kModel) changes.push_back(c);
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const auto& acts = parameters_[i].log;
    if (std::find(acts.begin(), acts.end(), false) != acts.end()) continue;
    const Change& change = parameters_[i].change;
    if (change.target.empty() || SideOf(change) != Side::kModel) continue;
    changes.push_back(parameters_[i].change);
    changes.back().value = x[i];
  }
  return changes;
}

// Of values that no machine has, whose model does not compile or finds no rest: as much a step to
// be rejected as one that diverges.
Trace Problem::Rejected(const Log& log, const Error& error) const {
  Trace trace;
  trace.diverged = true;
  trace.diverged_at = log.time.front();
  trace.why = error.what();
  const std::vector<double> none(log.rows(), std::numeric_limits<double>::quiet_NaN());
  trace.channel.assign(experiment_->channels.size(), none);
  return trace;
}

// step: a time step other than the model's [s], or 0.
Trace Problem::Run(std::size_t thread, const Vector& x, std::size_t log, double step) const {
  const Experiment setup = MeasuredBy(x, log);
  const Vector theta = x.tail(static_cast<Eigen::Index>(terms_.count));
  const Log& logged = experiment_->logs[log];
  if (const auto known = step > 0 ? nullptr : runs_.Find(motion_[log], MadeOf(x, log, setup.skew));
      known && !known->trace.raw.empty()) {
    Trace trace = known->trace;
    MeasureTrace(setup, Wiring(setup, system().model()), logged, trace);
    return trace;
  }
  if (path_ == Path::kSmooth) {
    try {
      const auto dynamics = DynamicsAt(thread, x, log);
      return SimulateSmooth(*dynamics, {}, setup, logged, solver_).trace;
    } catch (const Error& error) {
      return Rejected(logged, error);
    }
  }
  ModelAndData machine;
  try {
    machine = ModelAt(thread, x, log, step);
  } catch (const Error& error) {
    return Rejected(logged, error);
  }
  Hooks hooks = guide_ ? guide_(log) : Hooks{};
  if (terms_.count > 0) {
    const std::span<const double> weights(theta.data(), terms_.count);
    hooks.step = [&terms = terms_, weights](const mjModel& m, mjData& d) {
      mju_zero(d.qfrc_applied, static_cast<int>(m.nv));
      terms.add(m, d, weights);
    };
  }
  try {
    const InitialState start = StartAt(machine, x, log);
    if (setup.skew == experiment_->skew) return Simulate(machine, setup, logged, start, hooks);
    return Simulate(machine, setup, Stretched(logged, setup.skew), start, hooks);
  } catch (const Error& error) {
    if (error.kind() == Error::Kind::kInput) throw;
    return Rejected(logged, error);
  }
}

// As another clock has its times.
Log Problem::Stretched(const Log& logged, double skew) const {
  Log stretched = logged;
  const double longer = (1 + skew) / (1 + experiment_->skew);
  for (double& t : stretched.time) t *= longer;
  if (stretched.begin) *stretched.begin *= longer;
  return stretched;
}

// As it steps.
ModelAndData Problem::ModelAt(std::size_t thread, const Vector& x, std::size_t log,
                              double step) const {
  auto changes = ChangesFor(x, log);
  if (const double h = step > 0 ? step : step_; h > 0) changes.push_back({"option", "timestep", h});
  return systems_[thread].Build(changes);
}

InitialState Problem::StartAt(ModelAndData& machine, const Vector& x, std::size_t log) const {
  const auto changes = ChangesAt(x, log, Side::kStart);
  if (changes.empty()) return {};
  InitialState state = StartOf(machine, setup_, experiment_->logs[log]);
  for (const Change& c : changes) SetInitialState(*machine.model, c, state);
  SetTiedJoints(machine, state);
  return state;
}

std::unique_ptr<ContinuousDynamics> Problem::DynamicsAt(std::size_t thread, const Vector& x,
                                                        std::size_t log) const {
  return std::make_unique<ContinuousDynamics>(systems_[thread].Build(ChangesFor(x, log)),
                                              *experiment_, experiment_->logs[log]);
}

Trace Problem::Predict(const Vector& x, std::size_t log) const { return Run(0, x, log); }

Problem::Vector Problem::ResidualOf(std::size_t index, const Trace& trace) const {
  const Log& log = experiment_->logs[index];
  const auto rows = static_cast<Eigen::Index>(log.rows());
  Vector r(rows * static_cast<Eigen::Index>(channels_.size()));
  if (trace.diverged) return r.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto residuals = continuum::Residuals(*experiment_, log, trace);
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    for (Eigen::Index k = 0; k < rows; ++k) {
      const double value = residuals[channels_[c]][k];
      r[static_cast<Eigen::Index>(c) * rows + k] = std::isnan(value) ? 0 : value / scale_[c];
    }
  }
  return r;
}

// Whether two logs make the same simulation: replicates do, unless they start as measured.
bool Problem::SameMotion(std::size_t a, std::size_t b) const {
  if (a == b) return true;
  const Log &x = experiment_->logs[a], &y = experiment_->logs[b];
  const bool known = experiment_->start == Experiment::Start::kRest ||
                     experiment_->start == Experiment::Start::kEquilibrium;
  return known && x.time == y.time && x.Begin() == y.Begin() && x.input == y.input &&
         x.enable == y.enable && x.set == y.set && x.start == y.start &&
         std::all_of(parameters_.begin(), parameters_.end(),
                     [&](const FreeParameter& p) { return p.log[a] == p.log[b]; });
}

std::vector<std::vector<std::size_t>> Problem::Motions(const std::vector<bool>& use) const {
  std::map<std::size_t, std::vector<std::size_t>> shared;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (use[l]) shared[motion_[l]].push_back(l);
  }
  std::vector<std::vector<std::size_t>> motions;
  for (auto& [first, logs] : shared) motions.push_back(std::move(logs));
  return motions;
}

std::vector<Problem::Vector> Problem::Residuals(const Vector& x,
                                                const std::vector<bool>& use) const {
  const auto motions = Motions(use);
  std::vector<Vector> out(use.size());
  std::vector<LastRun> made(motions.size());
  const auto simulate = [&](std::size_t thread, std::size_t i) {
    const std::size_t first = motions[i].front();
    made[i] = MadeOf(x, first, MeasuredBy(x, first).skew);
    made[i].trace = Run(thread, x, first);
    for (const std::size_t l : motions[i]) out[l] = ResidualOf(l, made[i].trace);
  };
  ShareOut(motions.size(), simulate, [&](auto& archive, std::size_t i) {
    for (const std::size_t l : motions[i]) archive(out[l]);
    archive(made[i]);
  });
  Keep(motions, std::move(made));
  Count(motions.size());
  return out;
}

LastRun Problem::MadeOf(const Vector& x, std::size_t log, double skew) const {
  return {ChangesFor(x, log), ChangesAt(x, log, Side::kStart),
          x.tail(static_cast<Eigen::Index>(terms_.count)), skew};
}

void Problem::Keep(const std::vector<std::vector<std::size_t>>& motions,
                   std::vector<LastRun> made) const {
  for (std::size_t i = 0; i < motions.size(); ++i)
    runs_.Keep(motion_[motions[i].front()], std::move(made[i]));
}

void Problem::Count(std::size_t simulations) const { evaluations_[ThisThread()] += simulations; }

std::size_t Problem::evaluations() const {
  if (InParallelFor()) return evaluations_[ThisThread()];
  return std::accumulate(evaluations_.begin(), evaluations_.end(), std::size_t{0});
}

double Problem::PooledRms(const std::vector<Vector>& r, const std::vector<bool>& use) const {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    const Log& log = experiment_->logs[l];
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      for (std::size_t k = 0; k < log.rows(); ++k) {
        if (!IsMeasured(*experiment_, log, channels_[c], k)) continue;
        const double e = pooled_[c] * r[l][static_cast<Eigen::Index>(c * log.rows() + k)];
        squares += e * e;
        ++count;
      }
    }
  }
  return count ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

}  // namespace continuum
