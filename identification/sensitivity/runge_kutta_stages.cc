#include "identification/sensitivity/runge_kutta_stages.h"

#include <algorithm>

#include "identification/sensitivity/native_forces.h"

namespace continuum {
namespace {

constexpr int kStart = mjSTATE_INTEGRATION;

// x_i of (1) from stage i − 1, which d has; x_0 is at `start`.
void MoveOn(const mjModel& m, mjData& d, const std::vector<double>& start, double span) {
  const std::vector<double> q_rate(d.qvel, d.qvel + m.nv), v_rate(d.qacc, d.qacc + m.nv),
      w_rate(d.act_dot, d.act_dot + m.na);
  mj_setState(&m, &d, start.data(), kStart);
  mj_integratePos(&m, d.qpos, q_rate.data(), span);
  for (int i = 0; i < m.nv; ++i) d.qvel[i] += span * v_rate[i];
  for (int i = 0; i < m.na; ++i) d.act[i] += span * w_rate[i];
  d.time += span;
}

}  // namespace

RungeKuttaStages::RungeKuttaStages(const ModelAndData& machine)
    : data_(mj_copyData(nullptr, machine.model.get(), machine.data.get())),
      start_(mj_stateSize(machine.model.get(), kStart)) {}

void RungeKuttaStages::Keep(const mjModel& m, const mjData& d) {
  mj_getState(&m, &d, start_.data(), kStart);
}

mjData& RungeKuttaStages::Evaluate(const mjModel& m, std::size_t i) {
  mjData& d = *data_;
  if (i == 0) {
    mj_setState(&m, &d, start_.data(), kStart);
  } else {
    MoveOn(m, d, start_, kReach[i] * m.opt.timestep);
  }
  mj_forwardSkip(&m, &d, mjSTAGE_NONE, 1);
  const std::vector<double> met = ControlsMet(m, d);
  std::copy(met.begin(), met.end(), d.ctrl);
  d.time += m.opt.timestep;
  return d;
}

}  // namespace continuum
