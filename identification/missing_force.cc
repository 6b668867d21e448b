#include "identification/missing_force.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Dense>

#include "sim/measurement.h"

namespace continuum {
namespace {

struct Smooth {
  std::vector<double> q, v, a;
};

// Least-squares parabola over the 11 rows around each row.
Smooth Smoothed(const std::vector<double>& t, const std::vector<double>& y) {
  constexpr int kHalf = 5;
  const int n = static_cast<int>(t.size());
  Smooth s{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (int k = 0; k < n; ++k) {
    const int begin = std::max(0, std::min(k - kHalf, n - 2 * kHalf - 1));
    const int end = std::min(n, begin + 2 * kHalf + 1);
    Eigen::MatrixXd A(end - begin, 3);
    Eigen::VectorXd b(end - begin);
    for (int i = begin; i < end; ++i) {
      const double dt = t[i] - t[k];
      A.row(i - begin) << 1, dt, dt * dt / 2;
      b[i - begin] = y[i];
    }
    const Eigen::Vector3d c = A.colPivHouseholderQr().solve(b);
    s.q[k] = c[0], s.v[k] = c[1], s.a[k] = c[2];
  }
  return s;
}

// The channel that measures each joint; empty when one is not measured.
std::map<int, std::size_t> JointChannels(const Experiment& e, const mjModel& m) {
  std::map<int, std::size_t> channels;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const Output& out = e.outputs[e.channels[c].output];
    if (out.kind != Output::Kind::kSensor) continue;
    const int id = mj_name2id(&m, mjOBJ_SENSOR, out.source.c_str());
    if (id >= 0 && m.sensor_type[id] == mjSENS_JOINTPOS) channels[m.sensor_objid[id]] = c;
  }
  if (channels.size() != static_cast<std::size_t>(m.njnt)) channels.clear();
  return channels;
}

}  // namespace

MissingForce FindMissingForce(const Problem& problem, const Problem::Vector& x) {
  const Experiment& e = problem.experiment();
  const auto channels = JointChannels(e, problem.system().model());
  if (channels.empty() || e.quasi_static) return {};
  std::map<int, MissingForce> found;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const Log& log = e.logs[l];
    if (log.rows() < 11) continue;
    std::map<int, Smooth> state;
    for (const auto& [joint, c] : channels) {
      auto y = log.measured[c];
      for (double& value : y) value = SignalOf(e, c, value);
      if (std::any_of(y.begin(), y.end(), [](double v) { return std::isnan(v); })) return {};
      state[joint] = Smoothed(log.time, y);
    }
    Machine machine = problem.system().Build(problem.ChangesFor(x, l));
    std::size_t next = 0;
    Hooks hooks;
    hooks.step = [&](const mjModel& m, mjData& d) {  // each row starts from the measured state
      if (next >= log.rows() || d.time < log.time[next] - log.time[0] - 1e-9) return;
      for (const auto& [joint, s] : state) {
        d.qpos[m.jnt_qposadr[joint]] = s.q[next];
        d.qvel[m.jnt_dofadr[joint]] = s.v[next];
      }
    };
    hooks.row = [&](const mjModel& m, mjData& d, std::size_t row) {
      next = row + 1;
      Eigen::VectorXd lack(m.nv), force(m.nv);
      for (const auto& [joint, s] : state) {
        const int dof = m.jnt_dofadr[joint];
        lack[dof] = s.a[row] - d.qacc[dof];
      }
      mj_mulM(&m, &d, force.data(), lack.data());
      if (row + 1 == log.rows()) return;  // no step starts there
      for (const auto& [joint, s] : state) {
        MissingForce& out = found[joint];
        out.joint = mj_id2name(&m, mjOBJ_JOINT, joint);
        out.slides = m.jnt_type[joint] == mjJNT_SLIDE;
        out.log.push_back(l);
        out.time.push_back(log.time[row]);
        out.angle.push_back(s.q[row]);
        out.velocity.push_back(s.v[row]);
        out.load.push_back(d.qfrc_actuator[m.jnt_dofadr[joint]]);
        out.force.push_back(force[m.jnt_dofadr[joint]]);
      }
    };
    Simulate(machine, e, log, {}, hooks);
  }
  const auto size = [](const MissingForce& f) {
    double sum = 0;
    for (const double v : f.force) sum += v * v;
    return sum;
  };
  const MissingForce* largest = nullptr;
  for (const auto& [joint, f] : found) {
    if (!largest || size(f) > size(*largest)) largest = &f;
  }
  return largest ? *largest : MissingForce{};
}

}  // namespace continuum
