#include "identification/problem/resting_joints.h"

#include <algorithm>
#include <cmath>

#include "sim/simulation/input_signals.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

constexpr double kMove = 1e-4;   // rad or m, and the same per second
constexpr double kSeen = 1e-6;   // of the move, that an output shows
constexpr double kStill = 1e-9;  // rad or m

// What the outputs show at a state, numbers of all kinds below each other.
class Shown {
 public:
  Shown(ModelAndData& machine, const Experiment& e, const Log& log)
      : m_(*machine.model), d_(*machine.data), wiring_(e, m_), inputs_(m_, e, log, wiring_) {}

  // Whether an output follows position or speed of a joint at a state.
  bool Follows(const std::vector<double>& q, const std::vector<double>& v, std::size_t row,
               int joint) {
    for (double* const moved : {d_.qpos + m_.jnt_qposadr[joint], d_.qvel + m_.jnt_dofadr[joint]}) {
      const auto at = [&](double by) {
        std::copy(q.begin(), q.end(), d_.qpos), std::copy(v.begin(), v.end(), d_.qvel);
        *moved += by;
        inputs_.AtRow(d_, row);
        mj_forward(&m_, &d_);
        return Numbers();
      };
      const std::vector<double> there = at(kMove), back = at(-kMove);
      for (std::size_t i = 0; i < there.size(); ++i)
        if (!(std::abs(there[i] - back[i]) <= kSeen * kMove)) return true;
    }
    return false;
  }

 private:
  std::vector<double> Numbers() const {
    std::vector<double> all;
    for (const Wiring::Source& source : wiring_.output) {
      if (source.kind == Output::Kind::kControl) continue;
      const double* const from =
          source.kind == Output::Kind::kSensor ? d_.sensordata : d_.actuator_force;
      all.push_back(from[source.address + source.component]);
    }
    return all;
  }

  mjModel& m_;
  mjData& d_;
  Wiring wiring_;
  Inputs inputs_;
};

}  // namespace

std::vector<int> RestingJoints(ModelAndData& machine, const Experiment& e, const Log& log,
                               const InitialState& start, std::vector<int> joints) {
  const mjModel& m = *machine.model;
  Shown shown(machine, e, log);
  const auto drop_seen = [&](const std::vector<double>& q, const std::vector<double>& v,
                             std::size_t row) {
    std::erase_if(joints, [&](int j) { return shown.Follows(q, v, row, j); });
  };
  std::erase_if(joints, [&](int j) { return start.qvel[m.jnt_dofadr[j]] != 0; });
  drop_seen(start.qpos, start.qvel, 0);
  if (joints.empty()) return joints;

  std::vector<double> farthest(m.njnt, 0), q, v;
  Hooks hooks;
  hooks.stepped = [&](const mjModel&, mjData& d) {
    for (const int j : joints) {
      const int adr = m.jnt_qposadr[j];
      farthest[j] = std::max(farthest[j], std::abs(d.qpos[adr] - start.qpos[adr]));
    }
    q.assign(d.qpos, d.qpos + m.nq), v.assign(d.qvel, d.qvel + m.nv);
  };
  if (Simulate(machine, e, log, start, hooks).diverged) return {};
  std::erase_if(joints, [&](int j) { return !(farthest[j] < kStill); });
  if (!q.empty()) drop_seen(q, v, log.rows() - 1);
  return joints;
}

}  // namespace continuum
