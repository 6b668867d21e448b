#include "identification/sensitivity/moved_sensors.h"

namespace continuum {
namespace {

void Move(double* state, const Tangents& tangents, Eigen::Index column, double move) {
  for (Eigen::Index i = 0; i < tangents.rows(); ++i) state[i] += move * tangents(i, column);
}

}  // namespace

void MovedSensors::At(const mjModel& m, const mjData& d) {
  state_.resize(mj_stateSize(&m, mjSTATE_INTEGRATION));
  mj_getState(&m, &d, state_.data(), mjSTATE_INTEGRATION);
  shift_.setZero(d.nefc > 0 ? m.nsensordata : 0);
  if (shift_.size() == 0) return;
  mj_setState(&m, again_.get(), state_.data(), mjSTATE_INTEGRATION);
  mj_forward(&m, again_.get());
  for (int i = 0; i < m.nsensordata; ++i) shift_[i] = d.sensordata[i] - again_->sensordata[i];
}

void MovedSensors::Observe(const mjModel& m, const NumberTangents& numbers,
                           const Tangents& activation, Eigen::Index column, std::size_t row,
                           Recorder& recorder) {
  using Kind = Number::Kind;
  const ModelAndData& machine = *models_[column];
  mjModel& other = *machine.model;
  mjData& there = *machine.data;
  mj_setState(&other, &there, state_.data(), mjSTATE_INTEGRATION);
  Move(there.qpos, numbers[Kind::kPosition], column, move_);
  Move(there.qvel, numbers[Kind::kSpeed], column, move_);
  Move(there.act, activation, column, move_);
  Move(there.plugin_state, numbers[Kind::kState], column, move_);
  other.opt.timestep = m.opt.timestep;
  mj_forward(&other, &there);
  for (Eigen::Index i = 0; i < shift_.size(); ++i) there.sensordata[i] += shift_[i];
  recorder.Take(there, row);
}

}  // namespace continuum
