// Steps the arm of every law for a second, under two integrators, and prints where that ends: a
// line "LAW INTEGRATOR qpos... qvel...".
#include <cstdio>
#include <string>

#include <mujoco/mujoco.h>

#include "support/every_law.h"

namespace continuum {
namespace {

constexpr int kSteps = 500;

void Print(const std::string& law, const std::string& config, const std::string& integrator) {
  const std::string xml =
      testing::Arm(testing::EffectOf(law), config, "integrator=\"" + integrator + "\"");
  char error[1000] = "";
  mjSpec* const spec = mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error);
  mjModel* const model = spec ? mj_compile(spec, nullptr) : nullptr;
  std::printf("%s %s", law.c_str(), integrator.c_str());
  if (!model) std::printf(" %s", spec ? mjs_getError(spec) : error);
  if (model) {
    mjData* const data = mj_makeData(model);
    testing::Drive(model, data, kSteps);
    for (int i = 0; i < model->nq; ++i) std::printf(" %.17g", data->qpos[i]);
    for (int i = 0; i < model->nv; ++i) std::printf(" %.17g", data->qvel[i]);
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  std::printf("\n");
  mj_deleteSpec(spec);
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) {
  mju_user_warning = [](const char*) {};
  if (argc != 2) return 2;
  mj_loadPluginLibrary(argv[1]);
  for (const auto& [law, config] : continuum::testing::Laws()) {
    for (const char* integrator : {"implicitfast", "RK4"})
      continuum::Print(law, config, integrator);
  }
  return 0;
}
