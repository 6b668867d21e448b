#include "identification/problem/start_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "error.h"
#include "identification/problem/resting_joints.h"
#include "sim/experiment/measurement_model.h"
#include "sim/model/elastic_gear.h"
#include "sim/model/joint_equalities.h"
#include "sim/simulation/initial_state.h"

namespace continuum {
namespace {

constexpr const char* kPosition = "position";
constexpr const char* kSpeed = "speed";

// How far a joint moves in a log, by what is measured of it; some size where nothing is.
double Travel(const mjModel& m, int joint, const Experiment& e, const Log& log) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const Output& out = e.outputs[e.channels[c].output];
    if (out.kind != Output::Kind::kSensor) continue;
    const int id = mj_name2id(&m, mjOBJ_SENSOR, out.source.c_str());
    if (id < 0 || m.sensor_type[id] != mjSENS_JOINTPOS || m.sensor_objid[id] != joint) continue;
    double low = kInfinity, high = -kInfinity;
    for (const double y : log.measured[c]) {
      if (!std::isnan(y)) low = std::min(low, y), high = std::max(high, y);
    }
    if (high > low) return high - low;
  }
  return m.jnt_type[joint] == mjJNT_SLIDE ? 0.1 : 1;  // m, rad
}

std::string JointName(const mjModel& m, int joint) {
  const char* const name = mj_id2name(&m, mjOBJ_JOINT, joint);
  if (name) return name;
  throw Error::Input("start: estimate", "joints with names", "one without");
}

// Those that no equality ties to others, and no motors of elastic gears, which follow their joints.
std::vector<int> IndependentJoints(const mjModel& m) {
  const JointEqualities ties(m);
  std::vector<int> joints;
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_type[j] != mjJNT_HINGE && m.jnt_type[j] != mjJNT_SLIDE)
      throw Error::Input("start: estimate", "hinge and slide joints", "'" + JointName(m, j) + "'");
    const auto& free = ties.dofs();
    if (IsGearMotor(m, j)) continue;
    const bool tied = std::find(free.begin(), free.end(), m.jnt_dofadr[j]) == free.end();
    if (!tied || !ties.obstacle().empty()) joints.push_back(j);
  }
  return joints;
}

// Within its size of what the first rows say or of another value: of speeds rest, as noise may hide
// it.
FreeParameter StartParameter(const std::string& joint, const std::string& what,
                             const std::string& unit, double value, double size, double other,
                             std::size_t log, const Experiment& e) {
  FreeParameter p;
  p.name = joint + " " + what + "[" + e.logs[log].label + "]";
  p.unit = unit;
  p.initial = value;
  p.lower = std::min(value, other) - size, p.upper = std::max(value, other) + size;
  p.scale = size;
  p.change.target = "start:" + joint, p.change.attribute = what;
  p.log.assign(e.logs.size(), false);
  p.log[log] = true;
  return p;
}

void AddStarts(const Experiment& e, const ModelSpec& system, std::size_t l,
               std::vector<FreeParameter>& all) {
  const Log& log = e.logs[l];
  ModelAndData machine = system.Build(SettingsOfModel(log));
  const mjModel& m = *machine.model;
  const InitialState start = StartOf(machine, e, log);
  const std::vector<int> joints = IndependentJoints(m);
  const std::vector<int> resting = RestingJoints(machine, e, log, start, joints);
  for (const int j : joints) {
    if (std::find(resting.begin(), resting.end(), j) != resting.end()) continue;
    const std::string joint = JointName(m, j);
    const double travel = Travel(m, j, e, log);
    const double fast = 10 * travel;  // 1/s: back and forth three times a second
    const bool slide = m.jnt_type[j] == mjJNT_SLIDE;
    const double q = start.qpos[m.jnt_qposadr[j]], v = start.qvel[m.jnt_dofadr[j]];
    all.push_back(StartParameter(joint, kPosition, slide ? "m" : "rad", q, travel, q, l, e));
    all.push_back(StartParameter(joint, kSpeed, slide ? "m/s" : "rad/s", v, fast, 0, l, e));
  }
}

}  // namespace

std::vector<FreeParameter> StartParameters(const Experiment& e, const ModelSpec& system) {
  std::vector<FreeParameter> all;
  if (e.start != Experiment::Start::kEstimate) return all;
  for (std::size_t l = 0; l < e.logs.size(); ++l) AddStarts(e, system, l, all);
  return all;
}

void SetInitialState(const mjModel& m, const Change& change, InitialState& state) {
  const int joint = mj_name2id(&m, mjOBJ_JOINT, change.target.substr(6).c_str());
  if (change.attribute == kPosition) {
    state.qpos[m.jnt_qposadr[joint]] = change.value;
  } else {
    state.qvel[m.jnt_dofadr[joint]] = change.value;
  }
}

void SetTiedJoints(ModelAndData& machine, InitialState& state) {
  FollowGears(*machine.model, state.qpos.data(), state.qvel.data());
  const JointEqualities ties(*machine.model);
  if (ties.none() || !ties.obstacle().empty()) return;
  std::vector<double> q(ties.positions()), v(ties.velocities());
  ties.FreePositions(state.qpos.data(), q.data());
  ties.FreeVelocities(state.qvel.data(), v.data());
  ties.Spread(*machine.model, q.data(), v.data(), *machine.data);
  state.qpos.assign(machine.data->qpos, machine.data->qpos + machine.model->nq);
  state.qvel.assign(machine.data->qvel, machine.data->qvel + machine.model->nv);
}

}  // namespace continuum
