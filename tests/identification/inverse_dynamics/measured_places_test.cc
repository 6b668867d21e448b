#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/inverse_dynamics/filtered_activations.h"
#include "identification/inverse_dynamics/log_motion.h"
#include "identification/inverse_dynamics/regressor.h"
#include "identification/inverse_dynamics/zero_phase_lowpass.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using ::testing::HasSubstr;
using testing::Pendulum;

// The servo pendulum with a lag before the servo, by Runge-Kutta:
//
//   J q'' = k_p (w − q) − b q' − M g l sin q,   T w' = u − w
//
// and what is measured of it: the tip, its orientation, and the force that the mount gives in the
// arm's axes, M (a − g) of the mass at the distance l.
struct LaggedPendulum {
  Pendulum p;
  double lag = 0.05;  // s
  double q = 0, v = 0, w = 0;

  double mass() const { return p.bob + p.tip; }
  double Acceleration(double at, double speed, double target) const {
    const double j = p.inertia + mass() * p.length * p.length;
    return (p.kp * (target - at) - p.damping * speed - mass() * 9.81 * p.length * std::sin(at)) / j;
  }
  void Step(double u, double h) {
    double sum[3] = {}, k[3] = {};
    const double reach[] = {0, h / 2, h / 2, h}, weight[] = {h / 6, h / 3, h / 3, h / 6};
    for (int i = 0; i < 4; ++i) {
      const double at = q + reach[i] * k[0], speed = v + reach[i] * k[1],
                   target = w + reach[i] * k[2];
      k[0] = speed, k[1] = Acceleration(at, speed, target), k[2] = (u - target) / lag;
      for (int s = 0; s < 3; ++s) sum[s] += weight[i] * k[s];
    }
    q += sum[0], v += sum[1], w += sum[2];
  }
  std::vector<double> Measured() const {
    const double s = std::sin(q), c = std::cos(q), a = Acceleration(q, v, w), l = p.length;
    const double fx = mass() * (-l * c * a + l * s * v * v),
                 fz = mass() * (l * s * a + l * c * v * v + 9.81);
    return {-l * s,          -l * c, std::cos(q / 2), 0,
            std::sin(q / 2), 0,      c * fx - s * fz, s * fx + c * fz};
  }
};

class MeasuredPlaces : public Bench {
 protected:
  void AddTrials(const LaggedPendulum& truth, double place = 0, double force = 0) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int t = 0; t < 3; ++t) {
      LaggedPendulum p = truth;
      std::string csv = "time,u,x,z,qw,qx,qy,qz,fx,fz\n";
      const auto u = Command(t, 400);
      for (std::size_t k = 0; k < u.size(); ++k) {
        csv += fmt::format("{},{}", testing::kPeriod * static_cast<double>(k), u[k]);
        int i = 0;
        for (const double y : p.Measured())
          csv += fmt::format(",{:.12g}", y + (i++ < 6 ? place : force) * normal(random));
        csv += "\n";
        for (int s = 0; s < 100; ++s) p.Step(u[k], testing::kPeriod / 100);
      }
      Write(fmt::format("t{}.csv", t), csv);
      logs_ += fmt::format("  - {{file: t{}.csv, use: train}}\n", t);
    }
  }
  ModelSpec Model() const {
    std::string xml = Pendulum{}.Xml();
    xml.insert(xml.find("kp="), "timeconst=\"0.05\" ");
    xml.insert(xml.find("<inertial pos=\"0 0 -"), "<site name='mount'/>");
    xml.insert(xml.find("</sensor>"),
               "<framepos name='tip' objtype='xbody' objname='tip'/>"
               "<framequat name='turn' objtype='xbody' objname='tip'/>"
               "<force name='mount' site='mount'/>");
    return ModelSpec::Load(Write("model.xml", xml));
  }
  Experiment Read(const std::string& outputs, const std::string& parameters) const {
    return Experiment::Read(
        Write("experiment.yaml", "format: 1\nmodel: model.xml\nlogs:\n" + logs_ +
                                     "inputs:\n  - {actuator: servo, column: u, unit: rad}\n"
                                     "outputs:\n" +
                                     outputs + "parameters:\n" + parameters));
  }
};

const std::string kTip =
    "  - {column: x, unit: m, sensor: 'tip[0]'}\n  - {column: z, unit: m, sensor: 'tip[2]'}\n";
const std::string kTurn = "  - {columns: [qw, qx, qy, qz], unit: '1', sensor: turn}\n";
const std::string kForce =
    "  - {column: fx, unit: N, sensor: 'mount[0]'}\n"
    "  - {column: fz, unit: N, sensor: 'mount[2]'}\n";
const std::string kServo =
    "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.3, lower: 0, upper: 1}\n"
    "  - {name: kp, target: 'actuator:servo', attribute: kp, initial: 3, lower: 1, upper: 9}\n"
    "  - {name: T, target: 'actuator:servo', attribute: 'dynprm[0]', initial: 0.1, lower: 0.005, "
    "upper: 0.2}\n";
const std::string kMass =
    "  - {name: m, target: 'body:arm', attribute: mass, initial: 0.2, lower: 0.1, upper: 1}\n";

TEST_F(MeasuredPlaces, GiveTheJointsThatMoveThem) {
  AddTrials({});
  const ModelSpec system = Model();
  std::vector<LogMotion> motions;
  for (const std::string& outputs : {kTip, kTurn}) {
    const Experiment e = Read(outputs, kServo);
    const Problem problem(e, system);
    ModelAndData machine = system.Build();
    motions.push_back(MotionOf(problem, machine, 0, 15));
  }
  const Log log = Read(kTip, kServo).logs[0];
  for (std::size_t k = 60; k < 340; ++k) {
    const double q = std::atan2(-log.measured[0][k], -log.measured[1][k]);
    for (const LogMotion& motion : motions) EXPECT_NEAR(motion.q[0][k], q, 2e-3) << k;
  }
}

// A lag bends the forces, a mass shows at the mount.
TEST_F(MeasuredPlaces, GiveServoLagAndMassWithTheForceAtTheMount) {
  const LaggedPendulum truth;
  for (const std::string& place : {kTip, kTurn}) {
    logs_.clear();
    AddTrials(truth, 5e-5, 5e-3);
    const ModelSpec system = Model();
    const Experiment e = Read(place + kForce, kServo + kMass);
    const Problem problem(e, system);
    const Regression found = FitByRegressor(problem, problem.TrainLogs(), {.cutoff = 15});
    EXPECT_NEAR(found.x[0], truth.p.damping, 0.02 * truth.p.damping);
    EXPECT_NEAR(found.x[1], truth.p.kp, 0.01 * truth.p.kp);
    EXPECT_NEAR(found.x[2], truth.lag, 0.01 * truth.lag);
    EXPECT_NEAR(found.x[3], truth.p.bob, 0.01 * truth.p.bob);
    for (int i = 0; i < 4; ++i) EXPECT_GT(found.uncertainty.standard_error[i], 0) << i;
    EXPECT_LT(found.train, 5);
    EXPECT_THAT(found.how, HasSubstr("m from forces and torques; T by a particle swarm"));
  }
}

TEST_F(MeasuredPlaces, ThatNoJointMovesAreRefused) {
  AddTrials({});
  const ModelSpec system = Model();
  const auto refused = [&](const std::string& outputs, const std::string& more) {
    const Experiment e = Read(outputs, kServo + more);
    const Problem problem(e, system);
    try {
      FitByRegressor(problem, problem.TrainLogs());
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refused("  - {column: x, unit: m, sensor: 'tip[1]'}\n", ""),
              HasSubstr("no output of joint 'hinge'"));
  EXPECT_THAT(refused(kForce, ""), HasSubstr("no output of joint 'hinge'"));
  EXPECT_THAT(refused(kTip,
                      "  - {name: l, target: 'body:tip', attribute: 'pos[2]', initial: -0.2, "
                      "lower: -0.3, upper: -0.1}\n"),
              HasSubstr("'l'"));
}

// T w' = u − w of a step, and of a ramp.
TEST(FilteredActivation, IsTheClosedFormOfALag) {
  const ModelSpec system = ModelSpec::Parse(
      "<mujoco><worldbody><body><joint name='j'/><geom size='0.1'/></body></worldbody><actuator>"
      "<general name='u' joint='j' dyntype='filterexact' dynprm='0.03'/></actuator></mujoco>");
  Experiment e;
  e.inputs.emplace_back();
  e.inputs[0].column = e.inputs[0].actuator = "u";
  Log log;
  for (int k = 0; k < 200; ++k) log.time.push_back(0.01 * k);
  for (const bool linear : {false, true}) {
    e.inputs[0].linear = linear;
    log.input.assign(1, {});
    for (int k = 0; k < 200; ++k)
      log.input[0].push_back(k < 100 ? 0 : linear ? 0.01 * (k - 99) : 1);
    const Wiring wiring(e, system.model());
    const auto w = FilteredActivations(e, system.model(), log, wiring, 0.2);
    std::vector<double> exact;
    for (int k = 0; k < 1593; ++k) {  // an eighth of a row each
      const double t = 0.01 / 8 * k - (linear ? 0.99 : 1), T = 0.03;
      exact.push_back(t < 0 ? 0 : linear ? t - T * (1 - std::exp(-t / T)) : 1 - std::exp(-t / T));
    }
    const auto smooth = LowPass(exact, 0.2 / 8);
    for (int k = 0; k < 200; ++k) EXPECT_NEAR(w[0][k], smooth[8 * k], 1e-9) << linear << k;
  }
}

}  // namespace
}  // namespace continuum
