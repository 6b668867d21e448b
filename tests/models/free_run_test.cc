// Robots let go from a bent pose: their laws take energy, whatever the step adds to it.
#include <algorithm>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "models/spa/parameters.h"
#include "models/spa/spa.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

const std::string kModels = std::string(CONTINUUM_SOURCE) + "/models/";

// Of 10 s without inputs: what was lost, and the largest rise above the least energy before [J].
struct FreeRun {
  double lost = 0, risen = 0;
};
FreeRun Release(const std::string& file, const std::function<void(const mjModel&, mjData&)>& bend,
                const std::function<double(const mjModel&, const mjData&)>& elastic) {
  const ModelAndData machine = ModelSpec::Load(kModels + file).Build();
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  m.opt.enableflags |= mjENBL_ENERGY;
  bend(m, d);
  mj_forward(&m, &d);
  const auto energy = [&] { return d.energy[0] + d.energy[1] + elastic(m, d); };
  const double begin = energy();
  double least = begin, risen = 0;
  while (d.time < 10) {
    mj_step(&m, &d);
    mj_forward(&m, &d);
    risen = std::max(risen, energy() - least);
    least = std::min(least, energy());
  }
  return {begin - energy(), risen};
}

void Turn(const mjModel& m, mjData& d, const std::string& ending, double angle) {
  for (int j = 0; j < m.njnt; ++j) {
    const char* const name = mj_id2name(&m, mjOBJ_JOINT, j);
    if (name && std::string(name).ends_with(ending)) d.qpos[m.jnt_qposadr[j]] = angle;
  }
}

TEST(FreeRun, TheSnakeArmOnlyLosesEnergy) {
  const auto bend = [](const mjModel& m, mjData& d) {
    Turn(m, d, "_x", 0.25), Turn(m, d, "_y", -0.4);
  };
  const FreeRun run =
      Release("annelida/annelida.xml", bend, [](const auto&, const auto&) { return 0.0; });
  EXPECT_GT(run.lost, 0.1);
  EXPECT_LT(run.risen, 1e-3 * run.lost);
}

// The elastic energy is the segment's law's own, of the shape that its sensor tells.
TEST(FreeRun, TheSoftActuatorOnlyLosesEnergy) {
  const SpaFile file = ReadSpa(kModels + "spa/spa.yaml");
  const Spa<double> spa(file.parameters, file.options);
  const auto bend = [](const mjModel& m, mjData& d) {
    for (int j = 0; j < m.njnt; ++j) {
      const std::string name = mj_id2name(&m, mjOBJ_JOINT, j);
      const bool end = name.starts_with("bend0_") || name.starts_with("bend10_");
      if (name.starts_with("bend")) d.qpos[m.jnt_qposadr[j]] = (end ? 0.5 : 1) * 0.06;
    }
  };
  const auto elastic = [&](const mjModel& m, const mjData& d) {
    const int id = mj_name2id(&m, mjOBJ_SENSOR, "delta");
    const Eigen::Map<const Eigen::Vector3d> delta(d.sensordata + m.sensor_adr[id]);
    return spa.Energy({delta, Eigen::Vector3d::Zero()}, SpaBase<double>::Hanging()).elastic;
  };
  const FreeRun run = Release("spa/spa.xml", bend, elastic);
  EXPECT_GT(run.lost, 1e-3);
  EXPECT_LT(run.risen, 1e-3 * run.lost);
}

}  // namespace
}  // namespace continuum
