#include "sim/simulation/simulate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "error.h"
#include "sim/io/decimal.h"
#include "sim/simulation/initial_state.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/quasi_static.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

// The most rows of a log in any interval of this length [s].
std::size_t RowsWithin(const std::vector<double>& time, double length) {
  std::size_t most = 0;
  for (std::size_t first = 0, last = 0; last < time.size(); ++last) {
    while (time[last] - time[first] > length) ++first;
    most = std::max(most, last - first + 1);
  }
  return most;
}

// A delay reaches back over its steps, which rows shorten, only as far as the actuator's history.
void RequireHistory(const mjModel& m, const Log& log) {
  for (int a = 0; a < m.nactuator; ++a) {
    const double delay = m.actuator_delay[a];
    if (delay <= 0) continue;
    const double steps = std::ceil(delay / m.opt.timestep);
    const std::size_t needed = static_cast<std::size_t>(steps) + RowsWithin(log.time, delay) + 2;
    const auto samples = static_cast<std::size_t>(m.actuator_history[2 * a]);
    if (needed <= samples) continue;
    const char* const name = mj_id2name(&m, mjOBJ_ACTUATOR, a);
    throw Error::Input(log.label + ": actuator '" + (name ? name : "") + "' with a delay of " +
                           Decimal(delay) + " s",
                       "a history of " + std::to_string(needed) +
                           " samples, or a time step near the log's sampling interval",
                       std::to_string(samples));
  }
}

// Whether what sensors say depends only on the state that they see: none keeps samples, and none is
// computed by somebody else's code.
bool SensorsKeepNothing(const mjModel& m) {
  if (mjcb_sensor) return false;
  for (int s = 0; s < m.nsensor; ++s) {
    if (m.sensor_history[2 * s] > 0 || m.sensor_delay[s] > 0 || m.sensor_interval[2 * s] > 0)
      return false;
    if (m.sensor_type[s] == mjSENS_USER) return false;
    if (m.sensor_type[s] != mjSENS_PLUGIN) continue;
    const int instance = m.sensor_plugin[s];
    const mjpPlugin* const plugin =
        instance < 0 ? nullptr : mjp_getPluginAtSlot(m.plugin[instance]);
    if (!plugin || !std::string_view(plugin->name).starts_with("continuum.")) return false;
  }
  return true;
}

bool AnyAbove(const double* values, std::ptrdiff_t count, double least) {
  return std::any_of(values, values + count, [&](double v) { return v > least; });
}

bool MayTouch(const mjModel& m) {
  if (m.npair > 0 || m.nflex > 0) return true;
  for (int g = 0; g < m.ngeom; ++g)
    if (m.geom_contype[g] != 0 || m.geom_conaffinity[g] != 0) return true;
  return false;
}

// Whether the solver may ever have something to solve: without that MuJoCo need not look for it.
// Who sleeps is left to MuJoCo.
bool MayHaveRows(const mjModel& m) {
  if (m.opt.enableflags & mjENBL_SLEEP) return true;
  const auto any = [](const auto* flags, auto count) {
    return std::any_of(flags, flags + count, [](auto flag) { return flag != 0; });
  };
  return m.neq > 0 || MayTouch(m) || any(m.jnt_limited, m.njnt) ||
         any(m.tendon_limited, m.ntendon) || AnyAbove(m.dof_frictionloss, m.nv, 0) ||
         AnyAbove(m.tendon_frictionloss, m.ntendon, 0);
}

constexpr int kState = mjSTATE_QPOS | mjSTATE_QVEL | kMemory;

// One log on one machine, step by step.
class TimedRun {
 public:
  TimedRun(ModelAndData& machine, const Experiment& e, const Log& log, const Wiring& wiring,
           const Hooks& hooks)
      : m_(*machine.model),
        d_(*machine.data),
        log_(log),
        hooks_(hooks),
        inputs_(m_, e, log, wiring),
        recorder_(m_, wiring, log.rows()),
        h_(m_.opt.timestep),
        given_(m_.opt.disableflags),
        disabled_(given_ | (MayHaveRows(m_) ? 0 : mjDSBL_CONSTRAINT)),
        between_(disabled_ | (SensorsKeepNothing(m_) ? mjDSBL_SENSOR : 0)) {}

  void Begin(const InitialState& start) {
    m_.opt.disableflags = disabled_;
    mj_resetData(&m_, &d_);
    std::copy(start.qpos.begin(), start.qpos.end(), d_.qpos);
    std::copy(start.qvel.begin(), start.qvel.end(), d_.qvel);
    inputs_.AtRow(d_, 0);
    Settle(m_, d_);
    if (!start.memory.empty()) mj_setState(&m_, &d_, start.memory.data(), kMemory);
  }

  // From a row to the next; false when the simulation diverges, which the trace then says.
  bool Cross(std::size_t row, Trace& trace) {
    const double begin = log_.time[row], span = log_.time[row + 1] - begin;
    inputs_.AtRow(d_, row);
    const auto steps = static_cast<int>(std::floor(span / h_ + 1e-9));
    const double remainder = span - steps * h_;
    const int all = steps + (remainder > 1e-9 * h_ ? 1 : 0);
    if (all == 0) EvaluateRow(row);  // the next row is at the same time but for rounding
    for (int step = 0; step < all; ++step) {
      m_.opt.timestep = step < steps ? h_ : remainder;
      if (step > 0) inputs_.Interpolate(d_, row, begin + step * h_);
      if (hooks_.step) hooks_.step(m_, d_);
      if (step == 0) {
        StepFromRow(row);
      } else {
        m_.opt.disableflags = between_;
        mj_step(&m_, &d_);
        m_.opt.disableflags = disabled_;
      }
      if (hooks_.stepped) hooks_.stepped(m_, d_);
      if (!Diverged(m_, d_)) continue;
      trace.diverged = true;
      trace.diverged_at = begin + step * h_;
      return false;
    }
    return true;
  }

  // The last row, after which there is no step.
  void Finish() {
    m_.opt.timestep = h_;
    inputs_.AtRow(d_, log_.rows() - 1);
    EvaluateRow(log_.rows() - 1);
  }

  void Release(Trace& trace) {
    m_.opt.timestep = h_;
    m_.opt.disableflags = given_;
    inputs_.EnableAll();
    recorder_.Release(trace);
  }

 private:
  void EvaluateRow(std::size_t row) {
    mj_forward(&m_, &d_);
    recorder_.Take(d_, row);
    if (hooks_.row) hooks_.row(m_, d_, row);
  }

  // A row's step; what the row sees is recorded.
  void StepFromRow(std::size_t row) {
    // The stages of RK4 overwrite the forces of the first: evaluate the row before its step.
    const bool staged = m_.opt.integrator == mjINT_RK4;
    if (staged) EvaluateRow(row);
    const auto seen = hooks_.row ? StateOf(m_, d_, kState) : std::vector<double>{};
    mj_step(&m_, &d_);  // its sensors and forces are those of the state it starts from
    if (staged) return;
    recorder_.Take(d_, row);
    if (!hooks_.row) return;
    const auto after = StateOf(m_, d_, kState);
    mj_setState(&m_, &d_, seen.data(), kState);
    hooks_.row(m_, d_, row);
    mj_setState(&m_, &d_, after.data(), kState);
  }

  mjModel& m_;
  mjData& d_;
  const Log& log_;
  const Hooks& hooks_;
  Inputs inputs_;
  Recorder recorder_;
  double h_;  // time step of the model [s]
  // Flags: of the model; at rows; between them, where nobody reads sensors.
  int given_, disabled_, between_;
};

}  // namespace

void CheckLength(const Log& log, double timestep) {
  const double span = log.time.back() - log.time.front();
  if (span / timestep <= kMostSteps) return;
  throw Error::Input(log.file.empty() ? log.label : log.file.string(),
                     "at most 1e9 time steps of " + Decimal(timestep) + " s", Decimal(span) + " s");
}

Trace Simulate(ModelAndData& machine, const Experiment& e, const Log& log,
               const InitialState& initial, const Hooks& hooks) {
  if (e.quasi_static) return SimulateAtRest(machine, e, log, initial, hooks);
  const InitialState start = initial.qpos.empty() ? StartOf(machine, e, log) : initial;
  mjModel& m = *machine.model;
  CheckLength(log, m.opt.timestep);
  m.opt.disableflags |= mjDSBL_AUTORESET;
  RequireHistory(m, log);
  const Wiring wiring(e, m);
  TimedRun run(machine, e, log, wiring, hooks);
  run.Begin(start);
  Trace trace;
  for (std::size_t row = 0; row + 1 < log.rows(); ++row) {
    if (!run.Cross(row, trace)) break;
  }
  if (!trace.diverged) run.Finish();
  run.Release(trace);
  MeasureTrace(e, wiring, log, trace);
  return trace;
}

}  // namespace continuum
