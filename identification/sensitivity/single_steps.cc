#include "identification/sensitivity/single_steps.h"

#include <algorithm>

namespace continuum {
namespace {

constexpr int kStart = mjSTATE_INTEGRATION;

Eigen::VectorXd Difference(const double* there, const double* here, Eigen::Index size) {
  using Numbers = Eigen::Map<const Eigen::VectorXd>;
  return Numbers(there, size) - Numbers(here, size);
}

}  // namespace

void SingleSteps::Keep(const mjModel& m, const mjData& d) {
  if (empty()) return;
  start_.resize(mj_stateSize(&m, kStart));
  mj_getState(&m, &d, start_.data(), kStart);
}

void SingleSteps::Step(const ModelAndData& machine, double h) const {
  machine.model->opt.timestep = h;
  mj_setState(machine.model.get(), machine.data.get(), start_.data(), kStart);
  mj_step(machine.model.get(), machine.data.get());
}

void SingleSteps::Take(const mjModel& m, const mjData& d) {
  for (Model& model : models_) {
    const bool both = model.mirrored && d.nefc > 0;
    Step(*model.machine, m.opt.timestep);
    if (both) Step(*model.mirrored, m.opt.timestep);
    const mjData &there = *model.machine->data, &here = both ? *model.mirrored->data : d;
    const double move = both ? 2 * move_ : move_;
    model.q = Difference(there.qpos, here.qpos, m.nq) / move;
    model.v = Difference(there.qvel, here.qvel, m.nv) / move;
    model.w = Difference(there.act, here.act, m.na) / move;
    model.z = Difference(there.plugin_state, here.plugin_state, m.npluginstate) / move;
  }
}

void SingleSteps::AddTo(NumberTangents& numbers, Tangents& activation) const {
  using Kind = Number::Kind;
  for (const Model& model : models_) {
    numbers[Kind::kPosition].col(model.column) += model.q;
    numbers[Kind::kSpeed].col(model.column) += model.v;
    activation.col(model.column) += model.w;
    numbers[Kind::kState].col(model.column) += model.z;
  }
}

const mjData* SingleSteps::Pose(const mjModel& m, const mjData& d, Eigen::Index column) {
  const auto model = std::find_if(models_.begin(), models_.end(),
                                  [&](const Model& each) { return each.column == column; });
  if (model == models_.end()) return nullptr;
  mjData& there = *model->machine->data;
  std::copy_n(d.qpos, m.nq, there.qpos);
  mj_kinematics(model->machine->model.get(), &there);
  return &there;
}

}  // namespace continuum
