#include "sim/simulation/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "effects/all.h"
#include "error.h"
#include "sim/simulation/critical_damping.h"
#include "sim/simulation/initial_state.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/rest_search.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

constexpr double kGrace = 50;  // time constants after which a row without rest gets finer steps
constexpr double kFar = 0.05;  // shares of their ranges that inputs move before modes are renewed,
                               // and from rest to rest

// Whether a law moves on its own while what it acts on stands still.
template <class E>
bool Creeps() {
  if constexpr (ForceLaw<E>) {
    ParamsOf<E, double> p;
    Vec<double, E::kStates.size()> z;
    z.fill(1);
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = E::kParams[i].initial;
    const auto rates = E::template Eval<double>(Port<double>{0, 0}, z, p).zdot;
    return std::any_of(rates.begin(), rates.end(), [](double rate) { return rate != 0; });
  }
  return false;
}

void RefuseCreep(const mjModel& m) {
  for (int i = 0; i < m.nplugin; ++i) {
    const std::string plugin = mjp_getPluginAtSlot(m.plugin[i])->name;
    All::ForEach([&]<class E>() {
      if (plugin != "continuum." + std::string(E::kName) || !Creeps<E>()) return;
      const char* const name = mj_id2name(&m, mjOBJ_PLUGIN, i);
      throw Error::Input(plugin + " '" + (name ? name : "") + "'",
                         "effects without a time of their own (quasi_static)", "one that creeps");
    });
  }
}

// One log on one machine.
class QuasiStaticRun {
 public:
  QuasiStaticRun(ModelAndData& machine, const Experiment& e, const Log& log, const Wiring& wiring,
                 const Hooks& hooks, const QuasiStaticOptions& options)
      : m_(*machine.model),
        d_(*machine.data),
        log_(log),
        hooks_(hooks),
        options_(options),
        inputs_(m_, e, log, wiring) {
    for (std::size_t i = 0; i < log.input.size(); ++i) {
      const auto [low, high] = std::minmax_element(log.input[i].begin(), log.input[i].end());
      range_.push_back(*high - *low);
    }
  }

  // Puts the machine at its start, under the first inputs or (risen) under none of them.
  void Begin(const InitialState& start, bool risen) {
    mj_resetData(&m_, &d_);
    std::copy(start.qpos.begin(), start.qpos.end(), d_.qpos);
    for (std::size_t i = 0; i < range_.size(); ++i) {
      from_.push_back(risen ? 0 : log_.input[i][0]);
      if (risen) range_[i] = std::max(range_[i], std::abs(log_.input[i][0]));
    }
    inputs_.Switch(0);
    inputs_.Blend(d_, from_, 0, 0);
    Settle(m_, d_);
    search_.emplace(m_, d_, hooks_);
  }

  // Moves to a row and rests there; false when there is no rest.
  bool MoveTo(std::size_t row) {
    if (row > 0) inputs_.Switch(row);
    since_update_ += LargestShareTo(row);
    if (!FindRest(row) && !Relax(row)) return false;
    for (std::size_t i = 0; i < from_.size(); ++i) from_[i] = log_.input[i][row];
    mj_forward(&m_, &d_);
    return true;
  }

  std::string Failure(std::size_t row) const {
    const std::string place =
        fmt::format("row {} of {} ({:g} s)", row + 1, log_.rows(), log_.time[row]);
    if (Diverged(m_, d_)) return "the simulation diverges at " + place;
    const int dof = static_cast<int>(
        std::max_element(d_.qvel, d_.qvel + m_.nv,
                         [](double a, double b) { return std::abs(a) < std::abs(b); }) -
        d_.qvel);
    const int joint = m_.dof_jntid[dof];
    const char* const name = mj_id2name(&m_, mjOBJ_JOINT, joint);
    return fmt::format("no rest at {}: joint '{}' still moves at {:.3g} {}/s after {:.3g} s", place,
                       name ? name : "", d_.qvel[dof],
                       m_.jnt_type[joint] == mjJNT_SLIDE ? "m" : "rad",
                       options_.longest_wait * damping_->slowest());
  }

  void End() { inputs_.EnableAll(); }

 private:
  // From rest to rest, without motion. With dry friction, which depends on the way, the inputs go
  // on by a small share of their ranges each time.
  bool FindRest(std::size_t row) {
    if (!options_.search || !search_->Obstacle().empty() || (row > 0 && Switched(row)))
      return false;
    const auto state = StateOf(m_, d_, mjSTATE_INTEGRATION);
    const double way = LargestShareTo(row);
    double gone = 0;  // share of the way to the row
    for (double stride = search_->Rubs() ? std::min(1.0, kFar / way) : 1; gone < 1;) {
      const double next = 1 - gone < 1.5 * stride ? 1 : gone + stride;
      inputs_.Blend(d_, from_, row, next);
      Settle(m_, d_);
      if (search_->Advance()) {
        gone = next;
      } else if ((stride /= 2) * way < kFar / 8) {
        mj_setState(&m_, &d_, state.data(), mjSTATE_INTEGRATION);
        return false;
      }
    }
    return true;
  }
  // By motion: a ramp of the inputs, then a wait for rest.
  bool Relax(std::size_t row) {
    const double way = LargestShareTo(row);
    if (!damping_) damping_.emplace(m_, d_), damping_->Update(m_, d_);
    if (since_update_ > kFar || (row > 0 && Switched(row)))
      damping_->Update(m_, d_), since_update_ = 0;
    const double h = m_.opt.timestep;
    const int ramp = Steps(options_.crossing_time * way);
    for (int step = 1; step <= ramp && !Diverged(m_, d_); ++step) {
      inputs_.Blend(d_, from_, row, static_cast<double>(step) / ramp);
      Step();
    }
    inputs_.Blend(d_, from_, row, 1);
    bool at_rest = ramp == 0 && row > 0 && !Switched(row);  // nothing has changed
    for (double waited = 0; !at_rest && waited < options_.longest_wait; waited += kGrace) {
      if (waited > 0) Refine(h);
      at_rest = Wait(kGrace);
      if (Diverged(m_, d_)) break;
    }
    m_.opt.timestep = h;
    return at_rest;
  }
  // The largest share of its range that an input has to go.
  double LargestShareTo(std::size_t row) const {
    double way = 0;
    for (std::size_t i = 0; i < range_.size(); ++i) {
      if (range_[i] > 0) way = std::max(way, std::abs(log_.input[i][row] - from_[i]) / range_[i]);
    }
    return way;
  }
  bool Switched(std::size_t row) const {
    return std::any_of(log_.enable.begin(), log_.enable.end(),
                       [&](const auto& on) { return !on.empty() && on[row] != on[row - 1]; });
  }
  // Of a duration in time constants of the slowest mode.
  int Steps(double duration) const {
    return static_cast<int>(std::ceil(duration * damping_->slowest() / m_.opt.timestep));
  }
  // Until the machine rests; false when it does not.
  bool Wait(double duration) {
    const int steps = Steps(duration);
    for (int step = 0; step < steps && !Diverged(m_, d_); ++step) {
      Step();
      if (IsAtRest()) return true;
    }
    return false;
  }
  // A machine that still moves may have become stiffer than its modes were and its step can carry,
  // say by a cable that was slack.
  void Refine(double usual) {
    m_.opt.timestep = std::max(0.5 * m_.opt.timestep, usual / 8);
    damping_->Update(m_, d_);
  }
  void Step() {
    Settle(m_, d_);
    mju_zero(d_.qfrc_applied, static_cast<int>(m_.nv));
    if (hooks_.step) hooks_.step(m_, d_);
    const Eigen::VectorXd damping = damping_->Force(d_);
    mju_addTo(d_.qfrc_applied, damping.data(), static_cast<int>(m_.nv));
    before_.assign(d_.qvel, d_.qvel + m_.nv);
    mj_step(&m_, &d_);
    mju_zero(d_.qfrc_applied, static_cast<int>(m_.nv));
  }
  // By the acceleration that the step had: in qacc friction that holds light links leaves what its
  // solver tolerates.
  bool IsAtRest() const {
    const double t = damping_->slowest(), h = m_.opt.timestep;
    for (int i = 0; i < m_.nv; ++i) {
      const double a = (d_.qvel[i] - before_[i]) / h;
      if (std::abs(d_.qvel[i]) * t > options_.rest || std::abs(a) * t * t > options_.rest)
        return false;
    }
    return true;
  }

  mjModel& m_;
  mjData& d_;
  const Log& log_;
  const Hooks& hooks_;
  const QuasiStaticOptions& options_;
  Inputs inputs_;
  std::vector<double> range_, from_;  // of each input
  std::vector<double> before_;        // speeds before the last step
  std::optional<RestSearch> search_;
  std::optional<CriticalDamping> damping_;
  double since_update_ = 0;
};

}  // namespace

Trace SimulateAtRest(ModelAndData& machine, const Experiment& e, const Log& log,
                     const InitialState& initial, const Hooks& hooks,
                     const QuasiStaticOptions& options) {
  const InitialState start = initial.qpos.empty() ? StartOf(machine, e, log) : initial;
  const bool risen = initial.qpos.empty() && e.start == Experiment::Start::kRest;
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  m.opt.disableflags |= mjDSBL_AUTORESET;
  RefuseCreep(m);
  const Wiring wiring(e, m);
  QuasiStaticRun run(machine, e, log, wiring, hooks, options);
  run.Begin(start, risen);
  Recorder recorder(m, wiring, log.rows());
  Trace trace;
  for (std::size_t row = 0; row < log.rows() && !trace.diverged; ++row) {
    if (run.MoveTo(row)) {
      recorder.Take(d, row);
      if (hooks.row) hooks.row(m, d, row);
      continue;
    }
    trace.diverged = true;
    trace.diverged_at = log.time[row];
    trace.why = run.Failure(row);
  }
  run.End();
  recorder.Release(trace);
  MeasureTrace(e, wiring, log, trace);
  return trace;
}

}  // namespace continuum
