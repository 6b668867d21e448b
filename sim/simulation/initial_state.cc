#include "sim/simulation/initial_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/model/elastic_gear.h"
#include "sim/simulation/equilibrium.h"

namespace continuum {
namespace {

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
      if (known) state.qpos[m.jnt_qposadr[joint]] = SignalOf(e, log, c, 0);
      if (e.start != Experiment::Start::kEstimate) continue;
      const std::vector<double> q = SignalsOf(e, log, c);
      if (const double slope = SlopeAt(log.time, q, 0); !std::isnan(slope))
        state.qvel[m.jnt_dofadr[joint]] = slope;
    } else if (known && IsJoint(m, out, mjSENS_JOINTVEL, joint)) {
      state.qvel[m.jnt_dofadr[joint]] = SignalOf(e, log, c, 0);
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

std::vector<double> StateOf(const mjModel& m, const mjData& d, int parts) {
  std::vector<double> state(mj_stateSize(&m, parts));
  mj_getState(&m, &d, state.data(), parts);
  return state;
}

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
  if (e.start != Experiment::Start::kEquilibrium)
    FollowGears(m, state.qpos.data(), state.qvel.data());
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
      state.qvel[m.jnt_dofadr[joint]] = SignalOf(e, log, c, row);
      sensed[m.jnt_dofadr[joint]] = true;
    }
    if (!IsJoint(m, out, mjSENS_JOINTPOS, joint)) continue;
    const std::vector<double> q = SignalsOf(e, log, c);
    const int dof = m.jnt_dofadr[joint];
    state.qpos[dof] = q[row];
    if (!sensed[dof]) state.qvel[dof] = SlopeAt(log.time, q, row);
  }
  FollowGears(m, state.qpos.data(), state.qvel.data());
  for (const auto* const all : {&state.qpos, &state.qvel}) {
    if (std::any_of(all->begin(), all->end(), [](double x) { return std::isnan(x); })) return {};
  }
  return state;
}

}  // namespace continuum
