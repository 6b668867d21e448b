#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "error.h"
#include "models/spa/chain_error.h"
#include "models/spa/side_force.h"
#include "sim/io/file.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

const std::string kFolder = std::string(CONTINUUM_SOURCE) + "/models/spa/";
constexpr double kInfinity = std::numeric_limits<double>::infinity();

SpaFile File() { return ReadSpa(kFolder + "spa.yaml"); }

TEST(SpaFree, TheCommittedFileIsTheGeneratedOne) {
  EXPECT_EQ(ReadFile(kFolder + "spa_free.xml"), SpaMjcf(File(), {.evenness = 1}));
}

TEST(SpaFree, ASideForceBendsItAsTheClosedFormSays) {
  for (const double s : {1.0, 10.0, 1000.0}) {
    const SpaSideForce at = PushAcross(File(), {.evenness = s}, 0.01);
    // Angles of 1 mrad: sines and the stretch they leave are 1e-6 away.
    EXPECT_NEAR(at.sag, at.closed_form, 2e-5) << s;
    EXPECT_NEAR(at.mount, 1 + 1 / s, 1e-4) << s;
    EXPECT_NEAR(at.tip, 1 - 1 / s, 1e-4) << s;
  }
}

// The sag's distance from F L0³/(3EI) falls as N⁻².
TEST(SpaFree, ACantileverIsItsLimitOfManyLinks) {
  const auto sag = [](int links) {
    return PushAcross(File(), {.links = links, .evenness = 1}, 0.01).sag;
  };
  const double coarse = sag(4), fine = sag(10);
  EXPECT_NEAR(fine - (coarse - fine) / (100.0 / 16 - 1), 1.0 / 3, 2e-5);
}

// Squared natural frequencies [1/s²] of the chain at rest without gravity.
Eigen::VectorXd CriticalDamping(double evenness, int links) {
  const ModelAndData machine =
      ModelSpec::Parse(SpaMjcf(File(), {.links = links, .evenness = evenness})).Build();
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  std::fill_n(m.opt.gravity, 3, 0.0);
  mj_forward(&m, &d);
  Eigen::MatrixXd mass(m.nv, m.nv), stiffness(m.nv, m.nv);
  mj_fullM(&m, &d, mass.data());
  const double step = 1e-6;
  for (int j = 0; j < m.nv; ++j) {
    d.qpos[j] = step;
    mj_forward(&m, &d);
    for (int i = 0; i < m.nv; ++i) stiffness(i, j) = -d.qfrc_passive[i] / step;
    d.qpos[j] = 0;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      0.5 * (stiffness + stiffness.transpose()), mass);
  return solver.eigenvalues();
}

// Of a cantilever with EI = k_theta d² L0 and an elastic rod with EA = k_dL1 L0, both of m/L0: the
// bend 1.8751² √(EI L0/(m L0⁴)), twice, then the rod π/2 √(k_dL1/m). N = 20 is 0.5 % from there.
TEST(SpaFree, AtOneItSwingsAsAUniformBodyDoes) {
  const SpaParameters<double> p = File().parameters;
  const Eigen::VectorXd modes = CriticalDamping(1, 20);
  const double bend = p.k_theta * p.d * p.d / (p.m * p.L0 * p.L0);
  EXPECT_NEAR(modes[0], std::pow(1.87510407, 4) * bend, 0.01 * modes[0]);
  EXPECT_NEAR(modes[1], modes[0], 1e-6 * modes[0]);
  EXPECT_NEAR(modes[2], M_PI * M_PI / 4 * p.k_dL1 / p.m, 0.01 * modes[2]);
}

TEST(SpaFree, StiffEnoughItSwingsAsTheArcDoes) {
  const SpaParameters<double> p = File().parameters;
  const Eigen::VectorXd modes = CriticalDamping(1e4, 10);
  const double bend = p.k_theta * p.d * p.d / (p.m * p.L0 * p.L0);
  // The armature adds 1.7/N⁴, Simpson's weights 0.7/N⁴ to m L²/20.
  EXPECT_NEAR(modes[0], 20 * bend, 5e-4 * modes[0]);
  EXPECT_NEAR(modes[2], 3 * p.k_dL1 / p.m, 5e-4 * modes[2]);
}

TEST(SpaFree, StepsComeToThoseOfConstantCurvature) {
  const auto gap = [](double evenness) {
    return ChainError(File(), {{40e3, 40e3, 0}, false, 10, 2e-4, false, 0.5, evenness});
  };
  const SpaGap even = gap(kInfinity), stiff = gap(1000), body = gap(1);
  EXPECT_LT(stiff.delta, even.delta + 1e-3);
  EXPECT_LT(stiff.tip, even.tip + 1e-3);
  EXPECT_GT(body.delta, 0.05);  // a cantilever swings at 0.79 of the arc's rate
}

TEST(SpaFree, IsStableAtTheStepOfTheFileHoweverStiff) {
  for (const double s : {1.0, 30.0, 1e4}) {
    const ModelAndData machine = ModelSpec::Parse(SpaMjcf(File(), {.evenness = s})).Build();
    machine.data->ctrl[0] = 75e3;
    for (int k = 0; k < 1500; ++k) mj_step(machine.model.get(), machine.data.get());
    EXPECT_EQ(machine.data->warning[mjWARN_BADQACC].number, 0) << s;
    const mjModel& m = *machine.model;
    EXPECT_LT(Eigen::Map<Eigen::VectorXd>(machine.data->qvel, m.nv).cwiseAbs().maxCoeff(), 1) << s;
  }
}

// The largest eigenvalue of one step, straight without gravity.
double Growth(int links, double evenness, double timestep) {
  const ModelAndData machine =
      ModelSpec::Parse(SpaMjcf(File(), {.links = links, .evenness = evenness})).Build();
  mjModel& m = *machine.model;
  std::fill_n(m.opt.gravity, 3, 0.0);
  m.opt.timestep = timestep;
  mj_forward(&m, machine.data.get());
  const auto n = static_cast<Eigen::Index>(2 * m.nv + m.na);
  Eigen::MatrixXd step(n, n);
  mjd_transitionFD(&m, machine.data.get(), 1e-6, 1, step.data(), nullptr, nullptr, nullptr);
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(SpaFree, NothingGrowsUpToTheStepsThatTheReadmeNames) {
  EXPECT_LT(Growth(10, 1, 2e-3), 1);
  EXPECT_LT(Growth(10, 1000, 2e-3), 1);
  EXPECT_LT(Growth(16, 10, 2e-3), 1);
  EXPECT_LT(Growth(30, 1, 1e-3), 1);
  EXPECT_GT(Growth(16, 1, 2e-3), 1);
}

TEST(SpaFree, AtRestTheMountCarriesTheWeight) {
  const ModelAndData machine = ModelSpec::Load(kFolder + "spa_free.xml").Build();
  for (int k = 0; k < 6000; ++k) mj_step(machine.model.get(), machine.data.get());
  mj_forward(machine.model.get(), machine.data.get());
  const int id = mj_name2id(machine.model.get(), mjOBJ_SENSOR, "base_force");
  EXPECT_NEAR(machine.data->sensordata[machine.model->sensor_adr[id] + 2], -0.1806 * 9.81, 1e-8);
}

TEST(SpaFree, RefusesAnEvennessThatIsNone) {
  for (const double s : {0.0, -1.0, std::nan("")}) {
    EXPECT_THAT([&] { SpaMjcf(File(), {.evenness = s}); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("evenness")));
  }
}

}  // namespace
}  // namespace continuum
