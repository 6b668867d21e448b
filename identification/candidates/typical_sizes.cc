#include "identification/candidates/typical_sizes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "binding/config.h"
#include "sim/model/mujoco_handles.h"
#include "sim/numerics/parallel.h"
#include "sim/simulation/simulate.h"

namespace continuum {

namespace {

// What moves on the way of one motion, in SI.
struct OnTheWay {
  std::vector<JointSizes> joints;
  std::vector<double> outputs;  // [actuator]

  void See(const mjModel& m, const mjData& d) {
    joints.resize(m.njnt);
    for (int i = 0; i < m.nv; ++i) {
      const double load = d.qfrc_actuator[i] - d.qfrc_bias[i] + d.qfrc_spring[i];
      JointSizes& joint = joints[m.dof_jntid[i]];
      joint.torque += d.qfrc_actuator[i] * d.qfrc_actuator[i] + load * load;
      joint.velocity += d.qvel[i] * d.qvel[i];
      joint.count += 1;
    }
    for (int j = 0; j < m.njnt; ++j) {
      const auto end = j + 1 < m.njnt ? m.jnt_qposadr[j + 1] : m.nq;
      const auto [least, most] = std::minmax_element(d.qpos + m.jnt_qposadr[j], d.qpos + end);
      joints[j].Join({0, 0, 0, *least, *most}, 1);
    }
    outputs.resize(m.nout);
    for (int i = 0; i < m.nout; ++i)
      outputs[i] = std::max(outputs[i], std::abs(d.actuator_force[i]));
  }
  // Another motion, which so many logs show.
  void Join(const OnTheWay& other, double logs) {
    joints.resize(other.joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j].Join(other.joints[j], logs);
    outputs.resize(other.outputs.size());
    for (std::size_t i = 0; i < outputs.size(); ++i)
      outputs[i] = std::max(outputs[i], other.outputs[i]);
  }
};

OnTheWay OfAllMotions(const Problem& problem, const Problem::Vector& x) {
  const auto motions = problem.Motions(problem.AllLogs());
  std::vector<OnTheWay> seen(motions.size());
  ParallelFor(motions.size(), [&](std::size_t thread, std::size_t i) {
    const std::size_t l = motions[i].front();
    ModelAndData machine = problem.system(thread).Build(problem.ChangesFor(x, l));
    Hooks hooks;
    hooks.row = [&](const mjModel& m, mjData& d, std::size_t) { seen[i].See(m, d); };
    Simulate(machine, problem.experiment(), problem.experiment().logs[l], {}, hooks);
  });
  OnTheWay all;
  for (std::size_t i = 0; i < motions.size(); ++i)
    all.Join(seen[i], static_cast<double>(motions[i].size()));
  return all;
}

// Of some joints together, where they move.
void Take(const std::vector<JointSizes>& some, Sizes& s) {
  JointSizes all;
  for (const JointSizes& joint : some) all.Join(joint, 1);
  if (all.torque > 0) s.torque = std::sqrt(all.torque / all.count);
  if (all.velocity > 0) s.velocity = std::sqrt(all.velocity / all.count);
  if (all.upper > all.lower) s.angle = all.upper - all.lower;
}

}  // namespace

void JointSizes::Join(const JointSizes& other, double times) {
  torque += times * other.torque, velocity += times * other.velocity, count += times * other.count;
  lower = std::min(lower, other.lower), upper = std::max(upper, other.upper);
}

Sizes Sizes::OfJoints(const mjModel& m, const std::vector<std::string>& some) const {
  std::vector<JointSizes> those;
  for (const std::string& name : some) {
    const int id = mj_name2id(&m, mjOBJ_JOINT, name.c_str());
    if (id >= 0 && static_cast<std::size_t>(id) < joints.size()) those.push_back(joints[id]);
  }
  Sizes own = *this;
  Take(those, own);
  return own;
}

Sizes Sizes::OfActuators(const mjModel& m, const std::vector<std::string>& some) const {
  Sizes own = *this;
  double most = 0;
  for (const std::string& name : some) {
    const int id = mj_name2id(&m, mjOBJ_ACTUATOR, name.c_str());
    const std::size_t output = id < 0 ? outputs.size() : m.actuator_outadr[id];
    if (output < outputs.size()) most = std::max(most, outputs[output]);
  }
  if (most > 0) own.torque = most;
  return own;
}

Sizes SizesOf(const Problem& problem, const Problem::Vector& x) {
  const Experiment& e = problem.experiment();
  const OnTheWay seen = OfAllMotions(problem, x);
  Sizes s;
  s.joints = seen.joints, s.outputs = seen.outputs;
  Take(s.joints, s);
  const double tension =
      seen.outputs.empty() ? 0 : *std::max_element(seen.outputs.begin(), seen.outputs.end());
  if (tension > 0) s.tension = tension;
  const mjModel& m = problem.system().model();
  if (m.nv > 0)
    s.inertia = std::accumulate(m.dof_M0, m.dof_M0 + m.nv, 0.0) / static_cast<double>(m.nv);
  if (m.nbody > 1) {
    s.robot = std::max(1e-6, m.body_subtreemass[0]);
    s.mass = std::max(1e-6, m.body_subtreemass[0] / static_cast<double>(m.nbody - 1));
  }
  s.step = m.opt.timestep;
  std::vector<double> intervals;
  s.duration = 0;
  for (const Log& log : e.logs) {
    s.duration = std::max(s.duration, log.time.back() - log.time.front());
    for (std::size_t k = 1; k < log.rows(); ++k) intervals.push_back(log.time[k] - log.time[k - 1]);
  }
  std::nth_element(intervals.begin(), intervals.begin() + intervals.size() / 2, intervals.end());
  s.period = intervals[intervals.size() / 2];
  return s;
}

double LeverOf(const mjModel& m, Place place, const std::vector<std::string>& names) {
  const Owned<mjData> d(mj_makeData(&m));
  mj_kinematics(&m, d.get());
  mj_comPos(&m, d.get());
  std::vector<double> moved(3 * static_cast<std::size_t>(m.nv));
  double longest = 0;
  for (const std::string& name : names) {
    const int id = mj_name2id(&m, ObjectType(place), name.c_str());
    (place == Place::kSite ? mj_jacSite : mj_jacBody)(&m, d.get(), moved.data(), nullptr, id);
    for (int v = 0; v < m.nv; ++v)
      longest = std::max(longest, std::hypot(moved[v], moved[m.nv + v], moved[2 * m.nv + v]));
  }
  return longest > 0 ? longest : 1;
}

double MassOf(const mjModel& m, const std::vector<std::string>& bodies) {
  double sum = 0;
  for (const std::string& name : bodies) {
    const int id = mj_name2id(&m, mjOBJ_BODY, name.c_str());
    if (id >= 0) sum += m.body_mass[id];
  }
  return sum > 0 ? sum : 1;
}

double InertiaOf(const mjModel& m, const std::vector<std::string>& joints) {
  double sum = 0;
  int count = 0;
  for (const std::string& name : joints) {
    const int id = mj_name2id(&m, mjOBJ_JOINT, name.c_str());
    for (int v = 0; v < m.nv; ++v)
      if (m.dof_jntid[v] == id) sum += m.dof_M0[v], ++count;
  }
  return count > 0 ? sum / count : 1;
}

double InputSize(const Experiment& e, const std::vector<std::string>& actuators) {
  double size = 0;
  for (std::size_t i = 0; i < e.inputs.size(); ++i) {
    const Input& in = e.inputs[i];
    if (in.column.empty() ||
        std::find(actuators.begin(), actuators.end(), in.actuator) == actuators.end())
      continue;
    for (const Log& log : e.logs) {
      for (const double u : log.input[i]) size = std::max(size, std::abs(u));
    }
  }
  return size > 0 ? size : 1;
}

std::pair<double, double> ReadingRange(const Experiment& e,
                                       const std::vector<std::string>& outputs) {
  double lower = kInfinity, upper = -kInfinity;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    if (std::find(outputs.begin(), outputs.end(), e.channels[c].name) == outputs.end()) continue;
    for (const Log& log : e.logs) {
      for (const double y : log.measured[c]) {
        if (std::isnan(y)) continue;
        lower = std::min(lower, y / e.channels[c].factor);
        upper = std::max(upper, y / e.channels[c].factor);
      }
    }
  }
  return {lower, upper};
}

double ReadingSize(const Experiment& e, const std::vector<std::string>& outputs) {
  const auto [lower, upper] = ReadingRange(e, outputs);
  const double size = std::max(-lower, upper);
  return size > 0 ? size : 1;
}

}  // namespace continuum
