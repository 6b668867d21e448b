#include "hidden_effects/outside/native.h"

#include <algorithm>
#include <cmath>

#include "sim/model/model_spec.h"

namespace continuum::hidden {
namespace {

constexpr double kStep = 1e-4;  // s

void Stretch(mjModel& m, double factor) {
  for (mjtNum* const lengths : {m.body_pos, m.body_ipos}) {
    for (int i = 0; i < 3 * m.nbody; ++i) lengths[i] *= factor;
  }
  for (int i = 0; i < 3 * m.nsite; ++i) m.site_pos[i] *= factor;
}

}  // namespace

Columns RunNative(const NativeTruth& truth, const Columns& u) {
  constexpr double kPeriod = 0.01;
  ModelAndData machine = ModelSpec::Parse(truth.model).Build();
  mjModel* const m = machine.model.get();
  mjData* const d = machine.data.get();
  for (int i = 0; i < m->nbody; ++i) {
    m->body_mass[i] *= truth.heavier;
    for (int k = 0; k < 3; ++k)
      m->body_inertia[3 * i + k] *= truth.heavier * truth.longer * truth.longer;
  }
  Stretch(*m, truth.longer);
  std::copy(truth.friction.begin(), truth.friction.end(), m->dof_frictionloss);
  m->opt.timestep = kStep;
  mj_setConst(m, d);
  mj_resetData(m, d);
  std::copy(truth.start.begin(), truth.start.end(), d->qpos);
  std::copy(truth.speed.begin(), truth.speed.end(), d->qvel);
  Columns out(m->nsensordata);
  for (std::size_t row = 0; row < u[0].size(); ++row) {
    for (int i = 0; i < m->nu; ++i) d->ctrl[i] = u[i][row];
    mj_forward(m, d);
    for (int i = 0; i < m->nsensordata; ++i) out[i].push_back(d->sensordata[i]);
    for (long s = 0; s < std::lround(kPeriod / kStep); ++s) mj_step(m, d);
  }
  return out;
}

}  // namespace continuum::hidden
