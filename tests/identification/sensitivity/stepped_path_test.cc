// Sensitivities of the model as MuJoCo steps it, against the product of its single steps' own.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "identification/problem/problem.h"
#include "support/wheel.h"

namespace continuum {
namespace {

constexpr int kSteps = 5;  // of a row

// A wheel that sticks and slides by two kinds of dry friction, with a lag in its motor: rows that
// hold, a law's memory and an activation.
constexpr char kModel[] = R"(<mujoco>
  <option timestep="2e-3" integrator="implicitfast" solver="Newton" tolerance="0"/>
  <extension>
    <plugin plugin="continuum.coulomb"><instance name="dry"><config key="joint" value="hinge"/>
      <config key="tau_c" value="1"/></instance></plugin>
    <plugin plugin="continuum.dahl"><instance name="soft"><config key="joint" value="hinge"/>
      <config key="f" value="0.8"/><config key="sigma" value="300"/></instance></plugin>
  </extension>
  <worldbody><body><joint name="hinge" stiffness="40" damping="1" armature="0.8"/>
    <inertial pos="0 0 0" mass="1" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
  <actuator><general name="servo" joint="hinge" dyntype="filterexact" dynprm="0.02"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/></sensor>
</mujoco>)";

constexpr char kParameters[] =
    "parameters:\n"
    "  - {name: k, target: 'joint:hinge', attribute: stiffness, initial: 40, lower: 1, upper: 90}\n"
    "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 1, lower: 0.1, upper: 9}\n"
    "  - {name: j, target: 'joint:hinge', attribute: armature, initial: 0.8, lower: 0.1, upper: "
    "9}\n"
    "  - {name: dry, target: 'plugin:dry', attribute: tau_c, initial: 1, lower: 0, upper: 6}\n"
    "  - {name: soft, target: 'plugin:soft', attribute: f, initial: 0.8, lower: 0, upper: 6}\n"
    "  - {name: T, target: 'actuator:servo', attribute: 'dynprm[0]', initial: 0.02, lower: 0.001, "
    "upper: 0.1}\n";

struct State {
  static constexpr int kParts = mjSTATE_FULLPHYSICS | mjSTATE_WARMSTART;
  static Eigen::VectorXd Of(const ModelAndData& machine) {
    Eigen::VectorXd x(mj_stateSize(machine.model.get(), kParts));
    mj_getState(machine.model.get(), machine.data.get(), x.data(), kParts);
    return x;
  }
  static Eigen::VectorXd After(ModelAndData& machine, const Eigen::VectorXd& x, double input) {
    mj_setState(machine.model.get(), machine.data.get(), x.data(), kParts);
    machine.data->ctrl[0] = input;
    mj_step(machine.model.get(), machine.data.get());
    return Of(machine);
  }
};

// d angle / d parameter k at every row: s⁺ = ∂Φ/∂x s + ∂Φ/∂p of every step Φ alone, along s.
std::vector<double> StepByStep(const Problem& problem, std::size_t k) {
  const double reach = 1e-6 * problem.parameters()[k].scale;
  const auto built = [&](double by) {
    Eigen::VectorXd p = problem.Start();
    p[static_cast<Eigen::Index>(k)] += by;
    return problem.system().Build(problem.ChangesFor(p, 0));
  };
  ModelAndData here = built(0), above = built(reach), below = built(-reach);
  Eigen::VectorXd x = State::Of(here), s = Eigen::VectorXd::Zero(x.size());
  std::vector<double> slopes;
  for (const double input : problem.experiment().logs[0].input[0]) {
    slopes.push_back(s[1]);  // after the clock
    for (int i = 0; i < kSteps; ++i) {
      const auto up = State::After(above, x + reach * s, input);
      const auto down = State::After(below, x - reach * s, input);
      s = (up - down) / (2 * reach);
      x = State::After(here, x, input);
    }
  }
  return slopes;
}

class SteppedTest : public testing::Bench {};

TEST_F(SteppedTest, NarrowDifferencesAreTheSensitivitiesOfEveryStep) {
  const std::vector<double> u = testing::ToAndFro(400);
  AddLog("shaken", "use: train", u, testing::Noisy(std::vector<double>(u.size(), 0), 0.1, 0, 1));
  const Experiment experiment = ReadExperiment(kParameters);
  Problem problem(experiment, ModelSpec::Load(Write("model.xml", kModel)));
  problem.Center();
  problem.DifferBy(1e-6);
  const auto use = problem.AllLogs();
  const auto x = problem.Start();
  const auto J = problem.Jacobian(x, problem.Residuals(x, use), use)[0];
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const auto slopes = StepByStep(problem, static_cast<std::size_t>(k));
    const auto exact = Eigen::VectorXd::Map(slopes.data(), std::ssize(slopes));
    const Eigen::VectorXd found = J.col(k) * problem.scale(0);
    ASSERT_GT(exact.norm(), 0) << problem.parameters()[k].name;
    EXPECT_LT((found - exact).norm(), 1e-5 * exact.norm()) << problem.parameters()[k].name;
  }
}

}  // namespace
}  // namespace continuum
