// The scenes of models/cables do what their films and README say.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/film/film_recipe.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

// A model under the inputs of its film.
class Scene {
 public:
  explicit Scene(const std::string& recipe)
      : clip_(Clip::Read(CONTINUUM_SOURCE "/renders/" + recipe)) {}

  ModelAndData Left() const { return System().Build(); }
  ModelAndData Right() const { return clip_.Beside(System()).Build(); }
  void RunUntil(const ModelAndData& machine, double end) const {
    while (machine.data->time < end - 1e-9) Step(machine);
  }
  void Step(const ModelAndData& machine) const {
    const Log& log = clip_.experiment.logs.front();
    const auto row = static_cast<std::size_t>(machine.data->time / (log.time[1] - log.time[0]));
    for (std::size_t k = 0; k < log.input.size(); ++k) {
      const std::string& name = clip_.experiment.inputs[k].actuator;
      machine.data->ctrl[mj_name2id(machine.model.get(), mjOBJ_ACTUATOR, name.c_str())] =
          log.input[k][std::min(row, log.time.size() - 1)];
    }
    mj_step(machine.model.get(), machine.data.get());
  }

 private:
  ModelSpec System() const { return ModelSpec::Load(clip_.experiment.model); }

  Clip clip_;
};

double Joint(const ModelAndData& machine, const char* name) {
  const int joint = mj_name2id(machine.model.get(), mjOBJ_JOINT, name);
  return machine.data->qpos[machine.model->jnt_qposadr[joint]];
}

// Each branch carries half of the pull. Over the angle θ its weight rises at 2 W e^(μθ) and comes
// down at 2 W e^(−μθ), within 1 %.
TEST(CableScenes, WeightsBehindABlockRiseAndComeDownAsEytelweinSays) {
  const Scene scene("drum_and_pulley.yaml");
  constexpr double kWeight = 9.81, kMu = 0.15;
  for (const auto& [weight, turns] : {std::pair{"weight_1", 0.25}, {"weight_2", 1.25}}) {
    const double band = kMu * 2 * M_PI * turns;
    for (const double side : {1., -1.}) {
      const ModelAndData machine = scene.Left();
      if (side < 0) scene.RunUntil(machine, 9);  // both are up, and stand
      const double edge = 2 * kWeight * std::exp(side * band);
      const auto pull = [&](double tension) {
        const double from = machine.data->ctrl[0], start = machine.data->time;
        while (machine.data->time < start + 2) {
          machine.data->ctrl[0] =
              std::lerp(from, tension, std::min(1., machine.data->time - start));
          mj_step(machine.model.get(), machine.data.get());
        }
        return side * Joint(machine, weight);
      };
      const double before = pull(edge * std::exp(-side * 0.1));  // the other one is at its stop
      EXPECT_LT(pull(edge * std::exp(-side * 0.01)) - before, 3e-5) << weight << " " << side;
      EXPECT_GT(pull(edge * std::exp(side * 0.01)) - before, 5e-4) << weight << " " << side;
    }
  }
}

// After the tension has fallen to a quarter.
TEST(CableScenes, FrictionKeepsTheGripOfTheHand) {
  const Scene scene("hand.yaml");
  const ModelAndData with = scene.Left(), without = scene.Right();
  const auto height = [](const ModelAndData& machine) {
    return machine.data->xpos[3 * mj_name2id(machine.model.get(), mjOBJ_BODY, "can") + 2];
  };
  scene.RunUntil(with, 6), scene.RunUntil(without, 6);
  const double lifted = height(with);
  EXPECT_GT(lifted, 0.15);
  EXPECT_GT(height(without), 0.15);
  scene.RunUntil(with, 11), scene.RunUntil(without, 11);
  EXPECT_NEAR(height(with), lifted, 5e-3);  // MuJoCo's contacts let it slip by 0.3 mm/s
  EXPECT_LT(height(without), 0.06);         // on the floor
  for (int w = 0; w < mjNWARNING; ++w) EXPECT_EQ(with.data->warning[w].number, 0);
}

}  // namespace
}  // namespace continuum
