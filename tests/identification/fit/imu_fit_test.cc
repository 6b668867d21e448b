// Fits to a gyro and an accelerometer alone.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "identification/fit/fit.h"
#include "identification/problem/path_choice.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Command;
using testing::Pendulum;

// What an inertial sensor shows on the servo pendulum at the distance d, by Runge-Kutta: the rate
// about y, and in the arm's axes acceleration less gravity along x and z,
//
//   J q'' = k_p (u − q) − b q' − M g l sin q,   a_x = −d q'' − g sin q,   a_z = d q'² + g cos q
class ImuFitTest : public testing::Bench {
 protected:
  static constexpr double kPlace = 0.15, kBias = 0.03;  // m, rad/s

  void AddTrials(const Pendulum& p) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const double mass = p.bob + p.tip, j = p.inertia + mass * p.length * p.length;
    const auto acceleration = [&](double u, double q, double v) {
      return (p.kp * (u - q) - p.damping * v - mass * 9.81 * p.length * std::sin(q)) / j;
    };
    for (int t = 0; t < 2; ++t) {
      double q = 0, v = 0;
      std::string csv = "time,u,rate,ax,az\n";
      const auto command = Command(t, 300);
      for (std::size_t k = 0; k < command.size(); ++k) {
        const double u = command[k], a = acceleration(u, q, v);
        csv +=
            fmt::format("{},{},{:.9g},{:.9g},{:.9g}\n", testing::kPeriod * static_cast<double>(k),
                        u, v + kBias + 5e-3 * normal(random),
                        -kPlace * a - 9.81 * std::sin(q) + 0.05 * normal(random),
                        kPlace * v * v + 9.81 * std::cos(q) + 0.05 * normal(random));
        for (int s = 0; s < 100; ++s) Step(acceleration, u, testing::kPeriod / 100, q, v);
      }
      Write(fmt::format("t{}.csv", t), csv);
      logs_ += fmt::format("  - {{file: t{}.csv, use: train}}\n", t);
    }
  }

 private:
  template <class Acceleration>
  static void Step(const Acceleration& a, double u, double h, double& q, double& v) {
    const double v1 = v, a1 = a(u, q, v1), v2 = v + h / 2 * a1, a2 = a(u, q + h / 2 * v1, v2),
                 v3 = v + h / 2 * a2, a3 = a(u, q + h / 2 * v2, v3), v4 = v + h * a3,
                 a4 = a(u, q + h * v3, v4);
    q += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
};

TEST_F(ImuFitTest, FindsTheArmTheMountAndTheBiasOnBothPaths) {
  const Pendulum truth;
  AddTrials(truth);
  std::string xml = Pendulum{}.Xml("", 5e-4);
  xml.insert(xml.find("<body name=\"tip\""), "<site name='imu' pos='0 0 -0.1'/>");
  xml.insert(xml.find("</sensor>"),
             "<gyro name='gyro' site='imu'/><accelerometer name='acc' site='imu'/>");
  const ModelSpec system = ModelSpec::Load(Write("model.xml", xml));
  const Experiment e = Experiment::Read(Write(
      "experiment.yaml",
      "format: 1\nmodel: model.xml\nlogs:\n" + logs_ +
          "inputs:\n  - {actuator: servo, column: u, unit: rad}\n"
          "outputs:\n"
          "  - {column: rate, unit: rad/s, sensor: 'gyro[1]', sigma: 0.005}\n"
          "  - {column: ax, unit: m/s^2, sensor: 'acc[0]', sigma: 0.05}\n"
          "  - {column: az, unit: m/s^2, sensor: 'acc[2]', sigma: 0.05}\n"
          "parameters:\n"
          "  - {name: b, target: 'joint:hinge', attribute: damping, initial: 0.2, lower: 0, upper: "
          "1}\n"
          "  - {name: m, target: 'body:arm', attribute: mass, initial: 0.2, lower: 0.1, upper: 1}\n"
          "  - {name: mount, target: 'site:imu', attribute: 'pos[2]', initial: -0.1, lower: -0.3, "
          "upper: 0}\n"
          "  - {name: bias, target: 'sensor:gyro', attribute: bias, initial: 0, lower: -1, upper: "
          "1}\n"));
  Problem problem(e, system);
  ASSERT_EQ(problem.NoClosedForm(), "");
  ASSERT_EQ(SmoothObstacle(problem), "");
  const double expected[] = {truth.damping, truth.bob, -kPlace, kBias};
  for (const Path path : {Path::kStepped, Path::kSmooth}) {
    problem.Follow(path);
    const Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs());
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(fit.x[i] / expected[i], 1, 0.01)
          << problem.parameters()[i].name << (path == Path::kSmooth ? " smooth" : " stepped");
    // Three channels of 300 rows twice, noise alone.
    EXPECT_NEAR(2 * fit.cost / 1800, 1, 0.15);
  }
}

}  // namespace
}  // namespace continuum
