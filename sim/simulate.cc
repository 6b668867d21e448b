#include "sim/simulate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <Eigen/Dense>

#include "engine.h"
#include "error.h"
#include "sim/file.h"
#include "sim/units.h"

namespace continuum {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kSteps = 1e9;  // hours of computing for the smallest model; and an int counts them

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
  return {Output::Kind::kSensor, m.sensor_adr[id], dim, component};
}

// Gain and bias of an actuator with an enable column, so that "off" can take them away: neither
// torque nor back-EMF.
class Gate {
 public:
  Gate(mjModel& m, int actuator) : m_(&m), a_(actuator) {
    gain_.assign(Gain(), Gain() + mjNGAIN);
    bias_.assign(Bias(), Bias() + mjNBIAS);
  }
  void Switch(bool on) {
    for (int i = 0; i < mjNGAIN; ++i) Gain()[i] = on ? gain_[i] : 0;
    for (int i = 0; i < mjNBIAS; ++i) Bias()[i] = on ? bias_[i] : 0;
  }

 private:
  double* Gain() const { return m_->actuator_gainprm + mjNGAIN * a_; }
  double* Bias() const { return m_->actuator_biasprm + mjNBIAS * a_; }

  mjModel* m_;
  int a_;
  std::vector<double> gain_, bias_;
};

// The inputs of one log on one machine.
class Inputs {
 public:
  Inputs(mjModel& m, const Experiment& e, const Log& log, const Wiring& wiring)
      : experiment_(e), log_(log), wiring_(wiring) {
    for (std::size_t i = 0; i < wiring.actuator.size(); ++i)
      gates_.emplace_back(m, wiring.actuator[i]);
  }

  void AtRow(mjData& d, std::size_t row) {
    for (std::size_t i = 0; i < gates_.size(); ++i) {
      d.ctrl[wiring_.actuator[i]] = log_.input[i][row];
      if (wiring_.gated[i]) gates_[i].Switch(log_.enable[i][row]);
    }
  }
  void Between(mjData& d, std::size_t row, double t) const {
    const double share = (t - log_.time[row]) / (log_.time[row + 1] - log_.time[row]);
    for (std::size_t i = 0; i < gates_.size(); ++i) {
      if (!experiment_.inputs[i].linear) continue;
      const auto& u = log_.input[i];
      d.ctrl[wiring_.actuator[i]] = u[row] + share * (u[row + 1] - u[row]);
    }
  }
  void AllOn() {
    for (Gate& gate : gates_) gate.Switch(true);
  }

 private:
  const Experiment& experiment_;
  const Log& log_;
  const Wiring& wiring_;
  std::vector<Gate> gates_;
};

double Within(double value, bool limited, const double range[2]) {
  return limited ? std::clamp(value, range[0], range[1]) : value;
}

// Lags and delays as if the present inputs, as the engine clamps them, had been there for ever.
void Settle(const mjModel& m, mjData& d) {
  const bool clamped = !(m.opt.disableflags & mjDSBL_CLAMPCTRL);
  for (int a = 0; a < m.nu; ++a) {
    const int adr = m.actuator_actadr[a];
    const bool lagged =
        m.actuator_dyntype[a] == mjDYN_FILTER || m.actuator_dyntype[a] == mjDYN_FILTEREXACT;
    if (adr >= 0 && lagged) {
      const double u =
          Within(d.ctrl[a], clamped && m.actuator_ctrllimited[a], m.actuator_ctrlrange + 2 * a);
      d.act[adr] = Within(u, m.actuator_actlimited[a], m.actuator_actrange + 2 * a);
    }
    const int samples = m.actuator_history[2 * a];
    if (samples > 0) {
      const std::vector<double> past(samples, d.ctrl[a]);
      mj_initCtrlHistory(&m, &d, a, nullptr, past.data());
    }
  }
  SettleEffects(m, d);
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

bool Healthy(const mjModel& m, const mjData& d) {
  for (const int kind : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC, mjWARN_BADCTRL}) {
    if (d.warning[kind].number > 0) return false;
  }
  return std::all_of(d.qpos, d.qpos + m.nq, [](double q) { return std::isfinite(q); });
}

// Numbers of one output over the rows.
using Record = std::vector<std::vector<double>>;  // [component][row]

double At(const std::vector<double>& time, const std::vector<double>& y, double t) {
  if (t <= time.front()) return y.front();
  const auto next = std::upper_bound(time.begin(), time.end(), t);
  if (next == time.end()) return y.back();
  const std::size_t i = next - time.begin();
  return y[i - 1] + (t - time[i - 1]) / (time[i] - time[i - 1]) * (y[i] - y[i - 1]);
}

// y_meas(t) = scale R(axis, angle) y(t − delay) + bias + rate (t − t_0), in the output's unit.
void Measure(Record& record, const Measurement& how, const std::vector<double>& time,
             double factor) {
  if (how == Measurement{}) return;
  Record late = record;
  if (how.delay > 0) {
    for (std::size_t c = 0; c < record.size(); ++c) {
      for (std::size_t k = 0; k < time.size(); ++k) {
        late[c][k] = At(time, record[c], time[k] - how.delay);
      }
    }
  }
  double quat[4] = {1, 0, 0, 0};
  double axis[3] = {how.axis[0], how.axis[1], how.axis[2]};
  if (how.angle != 0) {
    mju_normalize3(axis);
    mju_axisAngle2Quat(quat, axis, how.angle);
  }
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (record.size() == 3) {
      double y[3] = {late[0][k], late[1][k], late[2][k]}, turned[3];
      mju_rotVecQuat(turned, y, quat);
      for (int c = 0; c < 3; ++c) late[c][k] = turned[c];
    } else if (record.size() == 4) {
      double y[4] = {late[0][k], late[1][k], late[2][k], late[3][k]}, turned[4];
      mju_mulQuat(turned, quat, y);
      for (int c = 0; c < 4; ++c) late[c][k] = turned[c];
    }
    for (std::size_t c = 0; c < record.size(); ++c) {
      record[c][k] =
          how.scale * late[c][k] + factor * (how.bias + how.rate * (time[k] - time.front()));
    }
  }
}

bool IsJoint(const mjModel& m, const Output& out, mjtSensor type, int& joint) {
  if (out.kind != Output::Kind::kSensor) return false;
  const int id = mj_name2id(&m, mjOBJ_SENSOR, out.source.c_str());
  if (id < 0 || m.sensor_type[id] != type) return false;
  joint = m.sensor_objid[id];
  return true;
}

double FirstMeasured(const Experiment& e, const Log& log, std::size_t channel) {
  const Output& out = e.outputs[e.channels[channel].output];
  const double bias = e.channels[channel].factor * out.measurement.bias;
  return (log.measured[channel][0] - bias) / out.measurement.scale;
}

}  // namespace

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
}

InitialState StartOf(Machine& machine, const Experiment& e, const Log& log) {
  const mjModel& m = *machine.model;
  InitialState state{{m.qpos0, m.qpos0 + m.nq}, std::vector<double>(m.nv, 0)};
  if (e.start == Experiment::Start::kRest) return state;
  if (e.start == Experiment::Start::kEquilibrium) return Equilibrium(machine, e, log);
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
      if (known) state.qpos[m.jnt_qposadr[joint]] = FirstMeasured(e, log, c);
    } else if (known && IsJoint(m, out, mjSENS_JOINTVEL, joint)) {
      state.qvel[m.jnt_dofadr[joint]] = FirstMeasured(e, log, c);
    }
  }
  return state;
}

InitialState Equilibrium(Machine& machine, const Experiment& e, const Log& log) {
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

void MeasureTrace(const Experiment& e, const Wiring& wiring, const Log& log, Trace& trace) {
  trace.channel.clear();
  for (std::size_t o = 0; o < trace.raw.size(); ++o) {
    Record record = trace.raw[o];
    Measure(record, e.outputs[o].measurement, log.time, UnitFactor(e.outputs[o].unit, ""));
    if (e.outputs[o].quaternion()) {
      for (auto& component : record) trace.channel.push_back(std::move(component));
    } else {
      trace.channel.push_back(std::move(record[wiring.output[o].component]));
    }
  }
}

void CheckLength(const Log& log, double timestep) {
  const double span = log.time.back() - log.time.front();
  if (span / timestep <= kSteps) return;
  throw Error::Input(log.file.empty() ? log.label : log.file.string(),
                     "at most 1e9 time steps of " + Decimal(timestep) + " s", Decimal(span) + " s");
}

Trace Simulate(Machine& machine, const Experiment& e, const Log& log, const InitialState& initial,
               const Hooks& hooks) {
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

  Trace trace;
  std::vector<Record> records;
  for (const auto& source : wiring.output) {
    records.emplace_back(source.size, std::vector<double>(log.rows(), kMissing));
  }
  const auto record = [&](std::size_t row) {
    for (std::size_t o = 0; o < records.size(); ++o) {
      const auto& source = wiring.output[o];
      for (int c = 0; c < source.size; ++c) {
        const double* const from = source.kind == Output::Kind::kSensor  ? d.sensordata
                                   : source.kind == Output::Kind::kForce ? d.actuator_force
                                                                         : d.ctrl;
        records[o][c][row] = from[source.address + c];
      }
    }
  };
  // The stages of RK4 overwrite the forces of the first: evaluate the row before its step.
  const bool staged = m.opt.integrator == mjINT_RK4;
  std::vector<double> qpos(m.nq), qvel(m.nv);
  const auto stepped = [&](std::size_t row) {  // a row's step; what the row sees is recorded
    std::copy(d.qpos, d.qpos + m.nq, qpos.begin());
    std::copy(d.qvel, d.qvel + m.nv, qvel.begin());
    if (staged) {
      mj_forward(&m, &d);
      record(row);
      if (hooks.row) hooks.row(m, d, row);
    }
    mj_step(&m, &d);  // its sensors and forces are those of the state it starts from
    if (staged) return;
    record(row);
    if (!hooks.row) return;
    std::swap_ranges(qpos.begin(), qpos.end(), d.qpos);
    std::swap_ranges(qvel.begin(), qvel.end(), d.qvel);
    hooks.row(m, d, row);
    std::swap_ranges(qpos.begin(), qpos.end(), d.qpos);
    std::swap_ranges(qvel.begin(), qvel.end(), d.qvel);
  };

  for (std::size_t row = 0; row + 1 < log.rows() && !trace.diverged; ++row) {
    const double begin = log.time[row], span = log.time[row + 1] - begin;
    inputs.AtRow(d, row);
    const auto steps = static_cast<int>(std::floor(span / h + 1e-9));
    const double rest = span - steps * h;
    const int all = steps + (rest > 1e-9 * h ? 1 : 0);
    for (int step = 0; step < all; ++step) {
      m.opt.timestep = step < steps ? h : rest;
      if (step > 0) inputs.Between(d, row, begin + step * h);
      if (hooks.step) hooks.step(m, d);
      if (step == 0) {
        stepped(row);
      } else {
        mj_step(&m, &d);
      }
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
    mj_forward(&m, &d);
    record(log.rows() - 1);
    if (hooks.row) hooks.row(m, d, log.rows() - 1);
  }
  inputs.AllOn();

  trace.raw = std::move(records);
  MeasureTrace(e, wiring, log, trace);
  return trace;
}

}  // namespace continuum
