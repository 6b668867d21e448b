#include "identification/sensitivity/moved_sensors.h"

namespace continuum {
namespace {

void Move(double* state, const Tangents& tangents, Eigen::Index column, double move) {
  for (Eigen::Index i = 0; i < tangents.rows(); ++i) state[i] += move * tangents(i, column);
}

}  // namespace

void MovedSensors::Observe(const mjModel& m, const mjData& d, const NumberTangents& numbers,
                           const Tangents& activation, Eigen::Index column, std::size_t row,
                           Recorder& recorder) {
  using Kind = Number::Kind;
  const ModelAndData& machine = *models_[column];
  mjModel& other = *machine.model;
  mjData& there = *machine.data;
  state_.resize(mj_stateSize(&m, mjSTATE_INTEGRATION));
  mj_getState(&m, &d, state_.data(), mjSTATE_INTEGRATION);
  mj_setState(&other, &there, state_.data(), mjSTATE_INTEGRATION);
  Move(there.qpos, numbers[Kind::kPosition], column, move_);
  Move(there.qvel, numbers[Kind::kSpeed], column, move_);
  Move(there.act, activation, column, move_);
  Move(there.plugin_state, numbers[Kind::kState], column, move_);
  other.opt.timestep = m.opt.timestep;
  mj_forward(&other, &there);
  recorder.Take(there, row);
}

}  // namespace continuum
