#include "sim/simulation/simulate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <string_view>

#include <Eigen/Dense>

#include "engine.h"
#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/io/file.h"
#include "sim/io/interrupt.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/quasi_static.h"

namespace continuum {
namespace {

std::string NamesOf(const mjModel& m, mjtObj type, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    if (const char* name = mj_id2name(&m, type, i))
      all += (all.empty() ? "" : ", ") + std::string(name);
  }
  return all.empty() ? "none" : all;
}

std::string Place(const std::string& where, const std::string& what) {
  return where.empty() ? what : where + ": " + what;
}

int ActuatorId(const mjModel& m, const std::string& name, const std::string& where) {
  const int id = mj_name2id(&m, mjOBJ_ACTUATOR, name.c_str());
  if (id >= 0) return id;
  throw Error::Input(Place(where, "actuator '" + name + "'"), "an actuator of the model",
                     NamesOf(m, mjOBJ_ACTUATOR, static_cast<int>(m.nu)));
}

// "[12]" → 12; -1 when it is none.
int Index(std::string_view text) {
  int index = -1;
  if (!text.starts_with('[') || !text.ends_with(']')) return index;
  text = text.substr(1, text.size() - 2);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  return error == std::errc{} && end == text.data() + text.size() ? index : -1;
}

// A turn needs something that has a direction: a vector of three or a quaternion.
void CheckTurn(const Output& out, int dim) {
  if (out.measurement.angle == 0 || dim == 3 || out.quaternion()) return;
  throw Error::Input(out.where + ".angle", "a turn of a vector or a quaternion",
                     "sensor '" + out.source + "' with " + std::to_string(dim) +
                         (dim == 1 ? " number" : " numbers"));
}

Wiring::Source::Seen SeenOf(int type) {
  using Seen = Wiring::Source::Seen;
  switch (type) {
    case mjSENS_FRAMEPOS:
      return Seen::kPoint;
    case mjSENS_FRAMEQUAT:
      return Seen::kTurn;
    case mjSENS_FRAMEXAXIS:
    case mjSENS_FRAMEYAXIS:
    case mjSENS_FRAMEZAXIS:
    case mjSENS_FRAMELINVEL:
    case mjSENS_FRAMEANGVEL:
    case mjSENS_FRAMELINACC:
    case mjSENS_FRAMEANGACC:
    case mjSENS_SUBTREELINVEL:
      return Seen::kVector;
    default:
      return Seen::kAsIs;
  }
}

// "tip_pos[1]" → sensor and component; the whole sensor is recorded, so that it can be turned.
Wiring::Source SensorSource(const mjModel& m, const Output& out) {
  std::string name = out.source;
  int component = 0;
  int id = mj_name2id(&m, mjOBJ_SENSOR, name.c_str());
  const std::size_t open = name.rfind('[');
  if (id < 0 && open != name.npos && Index(name.substr(open)) >= 0) {
    component = Index(name.substr(open));
    name.resize(open);
    id = mj_name2id(&m, mjOBJ_SENSOR, name.c_str());
  } else if (id >= 0 && m.sensor_dim[id] > 1 && !out.quaternion()) {
    throw Error::Input(Place(out.where, "sensor '" + name + "'"),
                       "a component such as '" + name + "[0]'", "none");
  }
  if (id < 0) {
    throw Error::Input(Place(out.where, "sensor '" + out.source + "'"), "a sensor of the model",
                       NamesOf(m, mjOBJ_SENSOR, static_cast<int>(m.nsensor)));
  }
  const int dim = m.sensor_dim[id];
  if (component >= dim || (out.quaternion() && dim != 4)) {
    throw Error::Input(
        Place(out.where, "sensor '" + out.source + "'"),
        out.quaternion() ? "a quaternion" : "a component below " + std::to_string(dim),
        out.quaternion() ? std::to_string(dim) + " numbers" : std::to_string(component));
  }
  CheckTurn(out, dim);
  return {Output::Kind::kSensor, m.sensor_adr[id], dim, component, SeenOf(m.sensor_type[id]), id};
}

// A marker belongs to a position that is measured.
void CheckMarkers(const Experiment& e, const mjModel& m, const Wiring& wiring) {
  std::set<std::string> points;
  std::string all;
  for (const auto& source : wiring.output) {
    if (source.seen != Wiring::Source::Seen::kPoint) continue;
    const std::string name = mj_id2name(&m, mjOBJ_SENSOR, source.sensor);
    if (points.insert(name).second) all += (all.empty() ? "" : ", ") + name;
  }
  for (const auto& [sensor, offset] : e.registration.offset) {
    if (sensor.empty() ? points.empty() : !points.contains(sensor)) {
      throw Error::Input(Place(e.file.string(), "registration.marker"),
                         "a position sensor (framepos) of the outputs",
                         "'" + sensor + "' (" + (all.empty() ? "there is none" : all) + ")");
    }
  }
}

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
  for (int a = 0; a < m.nu; ++a) {
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

constexpr int kMemory = mjSTATE_TIME | mjSTATE_ACT | mjSTATE_HISTORY | mjSTATE_PLUGIN;
constexpr int kState = mjSTATE_QPOS | mjSTATE_QVEL | kMemory;

std::vector<double> StateOf(const mjModel& m, const mjData& d, int parts) {
  std::vector<double> state(mj_stateSize(&m, parts));
  mj_getState(&m, &d, state.data(), parts);
  return state;
}

bool IsJoint(const mjModel& m, const Output& out, mjtSensor type, int& joint) {
  if (out.kind != Output::Kind::kSensor) return false;
  const int id = mj_name2id(&m, mjOBJ_SENSOR, out.source.c_str());
  if (id < 0 || m.sensor_type[id] != type) return false;
  joint = m.sensor_objid[id];
  return true;
}

// By least squares through up to two rows on each side; NaN where fewer than two are measured.
double SlopeAt(const std::vector<double>& time, const std::vector<double>& y, std::size_t row) {
  constexpr std::size_t kReach = 2;
  const std::size_t first = row - std::min(row, kReach),
                    last = std::min(row + kReach, time.size() - 1);
  double n = 0, t = 0, q = 0, tt = 0, tq = 0;
  for (std::size_t k = first; k <= last; ++k) {
    if (std::isnan(y[k])) continue;
    const double at = time[k] - time[row];
    n += 1, t += at, q += y[k], tt += at * at, tq += at * y[k];
  }
  return n < 2 ? std::numeric_limits<double>::quiet_NaN() : (n * tq - t * q) / (n * tt - t * t);
}

}  // namespace

std::vector<double> MemoryOf(const mjModel& m, const mjData& d) { return StateOf(m, d, kMemory); }

Hooks Hooks::Stoppable() {
  Hooks hooks;
  hooks.step = [](const mjModel&, mjData&) { StopIfRequested(); };
  return hooks;
}

Wiring::Wiring(const Experiment& e, const mjModel& m) {
  for (const Input& in : e.inputs) {
    actuator.push_back(ActuatorId(m, in.actuator, in.where));
    gated.push_back(!in.enable.empty());
  }
  for (const Output& out : e.outputs) {
    if (out.kind == Output::Kind::kSensor) {
      output.push_back(SensorSource(m, out));
    } else {
      output.push_back({out.kind, ActuatorId(m, out.source, out.where), 1, 0});
    }
  }
  CheckMarkers(e, m, *this);
  marked = e.registration.has_marker();
}

namespace {

// Of what the first rows measure; the rest is at rest.
InitialState FirstMeasured(const mjModel& m, const Experiment& e, const Log& log) {
  InitialState state{{m.qpos0, m.qpos0 + m.nq}, std::vector<double>(m.nv, 0)};
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const Output& out = e.outputs[e.channels[c].output];
    int joint = -1;
    const bool known = !std::isnan(log.measured[c][0]);
    if (IsJoint(m, out, mjSENS_JOINTPOS, joint)) {
      if (!known && e.start == Experiment::Start::kMeasured) {
        throw Error::Input(
            log.file.string() + ", column '" + e.channels[c].name + "'",
            "a joint position in the first row of '" + log.label + "' (start: measured)", "none");
      }
      if (known) state.qpos[m.jnt_qposadr[joint]] = SignalOf(e, c, log.measured[c][0]);
      if (e.start != Experiment::Start::kEstimate) continue;
      std::vector<double> q = log.measured[c];
      for (double& y : q) y = SignalOf(e, c, y);
      if (const double slope = SlopeAt(log.time, q, 0); !std::isnan(slope))
        state.qvel[m.jnt_dofadr[joint]] = slope;
    } else if (known && IsJoint(m, out, mjSENS_JOINTVEL, joint)) {
      state.qvel[m.jnt_dofadr[joint]] = SignalOf(e, c, log.measured[c][0]);
    }
  }
  return state;
}

InitialState ByKind(ModelAndData& machine, const Experiment& e, const Log& log) {
  const mjModel& m = *machine.model;
  switch (e.start) {
    case Experiment::Start::kRest:
      return {{m.qpos0, m.qpos0 + m.nq}, std::vector<double>(m.nv, 0)};
    case Experiment::Start::kEquilibrium:
      return Equilibrium(machine, e, log);
    default:
      return FirstMeasured(m, e, log);
  }
}

}  // namespace

InitialState StartOf(ModelAndData& machine, const Experiment& e, const Log& log) {
  const mjModel& m = *machine.model;
  InitialState state = ByKind(machine, e, log);
  for (const auto& [name, known] : log.start) {
    const int joint = mj_name2id(&m, mjOBJ_JOINT, name.c_str());
    const int type = joint < 0 ? -1 : m.jnt_type[joint];
    if (type != mjJNT_HINGE && type != mjJNT_SLIDE)
      throw Error::Input("the start of log '" + log.label + "'", "hinge or slide joints",
                         "'" + name + "'");
    state.qpos[m.jnt_qposadr[joint]] = known[0];
    state.qvel[m.jnt_dofadr[joint]] = known[1];
  }
  return state;
}

std::optional<InitialState> StateAt(const mjModel& m, const Experiment& e, const Log& log,
                                    std::size_t row) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (m.nq != m.nv) return {};
  InitialState state{std::vector<double>(m.nq, unknown), std::vector<double>(m.nv, unknown)};
  std::vector<bool> sensed(m.nv);
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const Output& out = e.outputs[e.channels[c].output];
    int joint = -1;
    if (IsJoint(m, out, mjSENS_JOINTVEL, joint)) {
      state.qvel[m.jnt_dofadr[joint]] = SignalOf(e, c, log.measured[c][row]);
      sensed[m.jnt_dofadr[joint]] = true;
    }
    if (!IsJoint(m, out, mjSENS_JOINTPOS, joint)) continue;
    std::vector<double> q = log.measured[c];
    for (double& y : q) y = SignalOf(e, c, y);
    const int dof = m.jnt_dofadr[joint];
    state.qpos[dof] = q[row];
    if (!sensed[dof]) state.qvel[dof] = SlopeAt(log.time, q, row);
  }
  for (const auto* const all : {&state.qpos, &state.qvel}) {
    if (std::any_of(all->begin(), all->end(), [](double x) { return std::isnan(x); })) return {};
  }
  return state;
}

InitialState Equilibrium(ModelAndData& machine, const Experiment& e, const Log& log) {
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  const int flags = m.opt.disableflags;
  m.opt.disableflags |= mjDSBL_FRICTIONLOSS;
  std::vector<std::vector<double>> friction(m.nplugin);
  for (int i = 0; i < m.nplugin; ++i) {  // a cable without friction: all its parameters zero
    if (std::string(mjp_getPluginAtSlot(m.plugin[i])->name) != "continuum.capstan") continue;
    friction[i] = BoundOf(m, d, i).parameters();
    SetParameters(m, d, i, std::vector<double>(friction[i].size(), 0));
  }
  const Wiring wiring(e, m);
  Inputs inputs(m, e, log, wiring);
  mj_resetData(&m, &d);
  inputs.AtRow(d, 0);
  const int nv = static_cast<int>(m.nv);
  const auto residual = [&](double load) {  // M·qacc: what is not balanced
    for (std::size_t i = 0; i < wiring.actuator.size(); ++i)
      d.ctrl[wiring.actuator[i]] = load * log.input[i][0];
    Settle(m, d);
    mj_forward(&m, &d);
    Eigen::VectorXd r(nv);
    mj_mulM(&m, &d, r.data(), d.qacc);
    return r;
  };
  const auto move = [&](const std::vector<double>& q, const Eigen::VectorXd& step) {
    std::copy(q.begin(), q.end(), d.qpos);
    mj_integratePos(&m, d.qpos, step.data(), 1);
  };
  bool balanced = false;
  for (double load = 0.25; load <= 1; load += 0.25) {
    Eigen::VectorXd r = residual(load);
    balanced = false;
    for (int iteration = 0; iteration < 60 && !balanced; ++iteration) {
      StopIfRequested();
      const std::vector<double> q(d.qpos, d.qpos + m.nq);
      Eigen::MatrixXd J(nv, nv);
      for (int i = 0; i < nv; ++i) {
        const double eps = 1e-7;
        move(q, eps * Eigen::VectorXd::Unit(nv, i));
        J.col(i) = (residual(load) - r) / eps;
      }
      const Eigen::VectorXd full = -J.fullPivLu().solve(r);
      double share = 1;
      Eigen::VectorXd next;
      for (; share > 1e-4; share /= 2) {
        move(q, share * full);
        next = residual(load);
        if (next.allFinite() && next.norm() < (1 - 0.1 * share) * r.norm() + 1e-13) break;
      }
      r = next;
      balanced = share * full.norm() < 1e-10 * (1 + std::sqrt(nv)) || r.norm() < 1e-13;
      if (share <= 1e-4) break;
    }
  }
  for (int i = 0; i < m.nplugin; ++i) {
    if (!friction[i].empty()) SetParameters(m, d, i, friction[i]);
  }
  m.opt.disableflags = flags;
  inputs.AllOn();
  if (!balanced) {
    throw Error::Job(log.label + ": no static equilibrium was found under the first inputs");
  }
  return {{d.qpos, d.qpos + m.nq}, std::vector<double>(nv, 0)};
}

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
  mjData& d = *machine.data;
  const double h = m.opt.timestep;
  CheckLength(log, h);
  m.opt.disableflags |= mjDSBL_AUTORESET;
  RequireHistory(m, log);
  const Wiring wiring(e, m);
  Inputs inputs(m, e, log, wiring);
  mj_resetData(&m, &d);
  std::copy(start.qpos.begin(), start.qpos.end(), d.qpos);
  std::copy(start.qvel.begin(), start.qvel.end(), d.qvel);
  inputs.AtRow(d, 0);
  Settle(m, d);
  if (!start.memory.empty()) mj_setState(&m, &d, start.memory.data(), kMemory);

  Trace trace;
  Recorder recorder(m, wiring, log.rows());
  // The stages of RK4 overwrite the forces of the first: evaluate the row before its step.
  const bool staged = m.opt.integrator == mjINT_RK4;
  const auto evaluated = [&](std::size_t row) {
    mj_forward(&m, &d);
    recorder.Take(d, row);
    if (hooks.row) hooks.row(m, d, row);
  };
  const auto stepped = [&](std::size_t row) {  // a row's step; what the row sees is recorded
    if (staged) evaluated(row);
    const auto seen = hooks.row ? StateOf(m, d, kState) : std::vector<double>{};
    mj_step(&m, &d);  // its sensors and forces are those of the state it starts from
    if (staged) return;
    recorder.Take(d, row);
    if (!hooks.row) return;
    const auto after = StateOf(m, d, kState);
    mj_setState(&m, &d, seen.data(), kState);
    hooks.row(m, d, row);
    mj_setState(&m, &d, after.data(), kState);
  };

  for (std::size_t row = 0; row + 1 < log.rows() && !trace.diverged; ++row) {
    const double begin = log.time[row], span = log.time[row + 1] - begin;
    inputs.AtRow(d, row);
    const auto steps = static_cast<int>(std::floor(span / h + 1e-9));
    const double rest = span - steps * h;
    const int all = steps + (rest > 1e-9 * h ? 1 : 0);
    if (all == 0) evaluated(row);  // the next row is at the same time but for rounding
    for (int step = 0; step < all; ++step) {
      m.opt.timestep = step < steps ? h : rest;
      if (step > 0) inputs.Between(d, row, begin + step * h);
      if (hooks.step) hooks.step(m, d);
      if (step == 0) {
        stepped(row);
      } else {
        mj_step(&m, &d);
      }
      if (hooks.stepped) hooks.stepped(m, d);
      if (!Healthy(m, d)) {
        trace.diverged = true;
        trace.diverged_at = begin + step * h;
        break;
      }
    }
  }
  m.opt.timestep = h;
  if (!trace.diverged) {
    inputs.AtRow(d, log.rows() - 1);
    evaluated(log.rows() - 1);
  }
  inputs.AllOn();

  recorder.Release(trace);
  MeasureTrace(e, wiring, log, trace);
  return trace;
}

}  // namespace continuum
