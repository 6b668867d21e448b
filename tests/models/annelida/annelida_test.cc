#include "models/annelida/annelida.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/annelida/planar_chain.h"
#include "models/annelida/study.h"
#include "sim/io/file.h"
#include "sim/model/mjcf_document.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/annelida/";

AnnelidaParameters Parameters() { return ReadAnnelida(kFolder + "annelida.yaml"); }
ModelSpec Robot() { return ModelSpec::Load(kFolder + "annelida.xml"); }

double Sensor(const ModelAndData& machine, const std::string& name, int component = 0) {
  const int id = mj_name2id(machine.model.get(), mjOBJ_SENSOR, name.c_str());
  EXPECT_GE(id, 0) << name;
  return machine.data->sensordata[machine.model->sensor_adr[id] + component];
}

void StepUntil(const ModelAndData& machine, double time) {
  while (machine.data->time < time - 1e-9) mj_step(machine.model.get(), machine.data.get());
}

double Fastest(const ModelAndData& machine) {
  const double* const v = machine.data->qvel;
  return std::abs(*std::max_element(v, v + machine.model->nv,
                                    [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

TEST(Annelida, TheCommittedFileIsTheGeneratedOne) {
  EXPECT_EQ(ReadFile(kFolder + "annelida.xml"), AnnelidaMjcf(Parameters()));
}

TEST(Annelida, CompilesWithoutItsPluginInstances) {
  MjcfDocument document(ReadFile(kFolder + "annelida.xml"));
  for (const char* const instance : {"joint_friction", "cable_friction"})
    document.RemoveInstance(instance);
  const std::string xml = document.Text();
  EXPECT_EQ(xml.find("<plugin"), xml.npos);
  char error[1000] = "";
  const Owned<mjSpec> spec(mj_parseXMLString(xml.c_str(), nullptr, error, sizeof error));
  ASSERT_TRUE(spec) << error;
  EXPECT_TRUE(Owned<mjModel>(mj_compile(spec.get(), nullptr))) << mjs_getError(spec.get());
}

TEST(Annelida, HasTheNamesThatOthersUse) {
  const ModelSpec robot = Robot();
  const mjModel& m = robot.model();
  for (int i = 1; i <= 4; ++i) {
    const std::string cable = "cable" + std::to_string(i);
    EXPECT_GE(mj_name2id(&m, mjOBJ_TENDON, cable.c_str()), 0);
    EXPECT_GE(mj_name2id(&m, mjOBJ_ACTUATOR, cable.c_str()), 0);
  }
  for (int i = 1; i <= 5; ++i) {
    for (const char* axis : {"_x", "_y"}) {
      const std::string joint = "bend" + std::to_string(i) + axis;
      EXPECT_GE(mj_name2id(&m, mjOBJ_JOINT, joint.c_str()), 0);
      const int sensor = mj_name2id(&m, mjOBJ_SENSOR, joint.c_str());
      ASSERT_GE(sensor, 0);
      EXPECT_EQ(m.sensor_type[sensor], mjSENS_JOINTPOS);
    }
  }
}

TEST(Annelida, HangsStraightAndItsMassesSumToThePublishedOnes) {
  const ModelAndData machine = Robot().Build();
  StepUntil(machine, 0.1);
  EXPECT_NEAR(Sensor(machine, "tip_pos", 2), -5 * 0.052, 1e-12);
  EXPECT_NEAR(machine.model->body_subtreemass[0], 4 * 0.2226 + 0.2013, 1e-12);
  EXPECT_LT(Fastest(machine), 1e-12);
}

TEST(Annelida, ACableBendsTheArmTowardItself) {
  const ModelSpec robot = Robot();
  for (const auto& [cable, joint, sign] :
       {std::tuple{0, "bend1_y", 1}, {1, "bend1_x", -1}, {2, "bend1_y", -1}, {3, "bend1_x", 1}}) {
    const ModelAndData machine = robot.Build();
    machine.data->ctrl[cable] = 15;
    StepUntil(machine, 1);
    EXPECT_GT(sign * Sensor(machine, joint), 0.02) << cable;
  }
}

// Largest speed and angle of a joint up to a time.
std::pair<double, double> Extremes(const ModelAndData& machine, double until) {
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  std::pair<double, double> most{0, 0};
  while (d.time < until - 1e-9) {
    mj_step(&m, &d);
    most.first = std::max(most.first, Fastest(machine));
    for (int i = 0; i < m.nq; ++i) most.second = std::max(most.second, std::abs(d.qpos[i]));
  }
  return most;
}

// Peaks at a step of 0.1 ms: 34 rad/s from rest, 77 rad/s from one side to the other. Without the
// discs' stop the inner cable turns inside out at 2 atan(b1/a) and the peak at 2 ms is near 1000.
TEST(Annelida, StaysStableUnderTensionStepsOf60N) {
  const ModelSpec robot = Robot();
  const double stop = Parameters().Stop();
  for (int cable = 0; cable < 4; ++cable) {
    const ModelAndData machine = robot.Build();
    machine.data->ctrl[cable] = 60;
    const auto [first_speed, first_angle] = Extremes(machine, 2);
    EXPECT_LT(first_speed, 1.02 * 34) << cable;
    EXPECT_LT(first_angle, stop + 0.1) << cable;
    EXPECT_LT(Fastest(machine), 1e-6) << cable;

    machine.data->ctrl[cable] = 0;
    machine.data->ctrl[(cable + 2) % 4] = 60;
    EXPECT_LT(Extremes(machine, 4).first, 1.02 * 77) << cable;
    EXPECT_LT(Fastest(machine), 1e-6) << cable;
    EXPECT_EQ(machine.data->warning[mjWARN_BADQACC].number, 0);
  }
}

// Every joint loaded at once, suddenly.
TEST(Annelida, GivesWayLittleBeforeItBreaksAway) {
  const AnnelidaParameters p = Parameters();
  const ModelAndData machine = Robot().Build();
  const auto joints = static_cast<int>(machine.model->nv);
  for (int i = 0; i < joints; ++i)
    machine.data->qfrc_applied[i] = (i % 2 ? -0.95 : 0.95) * p.tau_c * (1 + p.S);
  StepUntil(machine, 1);
  for (int i = 0; i < joints; ++i) EXPECT_LT(std::abs(machine.data->qpos[i]), 2e-3) << i;
}

TEST(Annelida, PulledSlowlyItsSpansCarryThePapersTensions) {
  const AnnelidaParameters p = Parameters();
  const ModelAndData machine = ModelSpec::Load(kFolder + "annelida_tensions.xml").Build();
  for (mjData& d = *machine.data; d.time < 12;) {
    d.ctrl[0] = 2 * d.time;
    mj_step(machine.model.get(), &d);
  }
  const double base = machine.data->ctrl[0];
  mj_forward(machine.model.get(), machine.data.get());
  double passed = 0;
  for (int i = 1; i <= 5; ++i) {
    const double theta = Sensor(machine, "bend" + std::to_string(i) + "_y");
    const double paper = base * std::exp(-p.mu * (passed + theta / 2));  // eq. 8
    // Creeping forward, a contact is within 2 % of its band (here 0.2 of 5 N) of sliding fully.
    EXPECT_NEAR(Sensor(machine, "tension1_" + std::to_string(i)), paper, 0.02 * (base - paper))
        << i;
    passed += theta;
  }
}

TEST(PlanarChain, KeepsItsEnergyWithoutFriction) {
  AnnelidaParameters p = Parameters();
  p.tau_mu = p.tau_c = p.mu = 0;
  const PlanarChain chain(p, 0.06);
  PlanarState state;
  state.q << 0.1, -0.2, 0.3, 0.1, 0.2;
  const double swing = chain.Energy(state) - chain.Energy({});
  const auto worst = [&](double h) {
    PlanarState s = state;
    double error = 0;
    for (int k = 0; k < std::lround(0.5 / h); ++k) {
      chain.Step(s, {0, 0}, h);
      error = std::max(error, std::abs(chain.Energy(s) - chain.Energy(state)));
    }
    return error;
  };
  // A first-order method: what is lost vanishes in proportion to the step.
  const double coarse = worst(2e-5), fine = worst(1e-5);
  EXPECT_LT(coarse, 0.01 * swing);
  EXPECT_NEAR(coarse / fine, 2, 0.05);
}

TEST(PlanarChain, IsTheSameMachineAsTheMjcf) {
  AnnelidaParameters p = Parameters();
  p.tau_c = p.mu = 0;
  const std::vector<Change> changes{{"option", "timestep", 5e-5},
                                    {"plugin:joint_friction", "tau_c", 0},
                                    {"plugin:cable_friction", "mu", 0},
                                    {"body:tip", "mass", 0.06}};
  const ModelAndData machine = Robot().Build(changes);
  const PlanarChain chain(p, 0.06);
  PlanarState state;
  double worst = 0, fastest = 0;
  for (int row = 1; row <= 50; ++row) {
    const double left = row < 20 ? 12 : 0, right = row < 20 ? 0 : 7;
    machine.data->ctrl[0] = left;
    machine.data->ctrl[2] = right;
    StepUntil(machine, 0.01 * row);
    for (int k = 0; k < 1000; ++k) chain.Step(state, {left, right}, 1e-5);
    for (int i = 0; i < 5; ++i) {
      worst = std::max(worst, std::abs(machine.data->qpos[2 * i + 1] - state.q[i]));
      fastest = std::max(fastest, std::abs(state.v[i]));
    }
    mj_forward(machine.model.get(), machine.data.get());
    EXPECT_NEAR(Sensor(machine, "tip_pos", 0), chain.Tip(state.q).x(), 1e-4);
    EXPECT_NEAR(Sensor(machine, "tip_pos", 2), chain.Tip(state.q).y(), 1e-4);
  }
  // Both are of first order: they lag by a fraction of their step.
  EXPECT_LT(worst, fastest * 5e-5);
}

// Hanging, gravity restores; the other way up the weight exceeds what the springs carry.
TEST(PlanarChain, HangingIsTheOnlyWayUpInWhichTheStraightArmStands) {
  AnnelidaParameters p = Parameters();
  PlanarState bent;
  bent.q << 5, 4, 3, 2, 1;
  bent.q *= 0.01;
  EXPECT_GT(PlanarChain(p).Energy(bent), PlanarChain(p).Energy({}));
  p.gravity = -p.gravity;
  EXPECT_LT(PlanarChain(p).Energy(bent), PlanarChain(p).Energy({}));
}

class BendAndReleaseTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    ours_ = BendMujoco(Robot(), kPlan, 1e-4);
    medium_ = BendMujoco(Robot(), kPlan, 5e-4);
    coarse_ = BendMujoco(Robot(), kPlan, 2e-3);
    chain_ = BendChain(PlanarChain(Parameters()), kPlan, 2e-5);
  }
  static double Distance(const PlanarJoints& a, const PlanarJoints& b) {
    return (a - b).cwiseAbs().maxCoeff();
  }

  inline static const BendAndRelease kPlan{};
  inline static BendResult ours_, medium_, coarse_, chain_;
};

TEST_F(BendAndReleaseTest, TheStaticBendIsThatOfTheChainAtTheModelsOwnStep) {
  // 0.5 % of the tension and of 90 degrees.
  EXPECT_NEAR(coarse_.tension, chain_.tension, 0.005 * chain_.tension);
  EXPECT_LT(Distance(coarse_.bend.q.back(), chain_.bend.q.back()), 0.005 * M_PI / 2);
}

TEST_F(BendAndReleaseTest, CurvatureGrowsTowardTheTip) {
  const PlanarJoints q = coarse_.bend.q.back();
  for (int i = 1; i < 5; ++i) EXPECT_GT(q[i], q[i - 1]);
}

// Root mean square over joints and 2 s, in parts of the largest angle.
double Error(const BendResult& run, const BendResult& truth) {
  double sum = 0, amplitude = 0;
  constexpr int kRows = 200;
  for (int k = 0; k < kRows; ++k) {
    amplitude = std::max(amplitude, truth.release.q[k].cwiseAbs().maxCoeff());
    sum += (run.release.q[k] - truth.release.q[k]).squaredNorm();
  }
  return std::sqrt(sum / (kRows * kAnnelidaLinks)) / amplitude;
}

TEST_F(BendAndReleaseTest, TheReleaseIsThatOfTheChainAsTheStepShrinks) {
  EXPECT_LT(Error(coarse_, chain_), 0.02);
  EXPECT_LT(Error(medium_, chain_), 0.005);
  EXPECT_LT(Error(ours_, chain_), 0.001);
}

TEST_F(BendAndReleaseTest, FrictionLeavesASteadyOffset) {
  const auto& q = ours_.release.q;
  EXPECT_GT(q.back().cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT(Distance(q.back(), q[q.size() - 20]), 1e-6);
  EXPECT_LT(Distance(q.back(), chain_.release.q.back()), 0.002);
}

}  // namespace
}  // namespace continuum
