// ctest labels: slow
#include "identification/inverse_dynamics/regressor.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "models/spa/chain_error.h"
#include "models/spa/logs.h"
#include "models/spa/response.h"
#include "sim/io/file.h"
#include "support/pendulum.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using Eigen::Vector3d;
using testing::ArNoise;

SpaFile Truth() { return ReadSpa(std::string(CONTINUUM_SOURCE) + "/models/spa/spa.yaml"); }

Regression Found(const std::filesystem::path& file) {
  const Experiment e = Experiment::Read(file);
  const Problem problem(e, ModelSpec::Load(e.model));
  const Regression found = FitByRegressor(problem, problem.AllLogs());
  EXPECT_EQ(problem.evaluations(), 0u);
  return found;
}

// Table I of the paper; a mass is a share of the model's.
void ExpectTableOne(const Regression& found, double tolerance) {
  const SpaParameters<double> p = Truth().parameters;
  const char* const names[] = {"x_m",     "y_m",  "T_PT1",   "A",     "m",
                               "d_theta", "d_dL", "k_theta", "k_dL1", "k_dL3"};
  const double expected[] = {p.x_m,     p.y_m,  p.T_PT1,   p.A,     1,
                             p.d_theta, p.d_dL, p.k_theta, p.k_dL1, p.k_dL3};
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(found.x[i] / expected[i], 1, tolerance) << names[i];
}

// Swaps the logs for those of another base: tip in the world, as a camera sees it.
void Record(const std::filesystem::path& folder, const SpaBaseMotion& motion, const SpaStart& start,
            const std::function<std::string(double)>& more) {
  SpaFile truth = Truth();
  truth.options.mass = SpaMass::kArc;
  const Spa<double> spa(truth.parameters, truth.options);
  const SpaNoise noise;
  ArNoise place(noise.tip, 0, 1), force(noise.force, 0, 2), torque(noise.torque, 0, 3);
  const std::pair<const char*, Vector3d> steps[] = {
      {"one", {60e3, 0, 0}},     {"two", {0, 60e3, 0}},           {"three", {0, 0, 60e3}},
      {"pair", {35e3, 35e3, 0}}, {"other_pair", {0, 35e3, 35e3}}, {"all", {35e3, 35e3, 35e3}}};
  for (const auto& [name, pressure] : steps) {
    std::vector<Vector3d> input(1200, pressure);
    std::fill_n(input.begin(), 200, Vector3d::Zero());
    const auto samples = SpaRespond(spa, start, input, 1e-3, motion);
    std::string csv = "time,p1,p2,p3,x,y,z,fx,fy,fz,mx,my,mz,b0,b1,b2,b3,b4,b5\n";
    for (std::size_t k = 0; k < samples.size(); k += 5) {
      const SpaSample& s = samples[k];
      const SpaBase<double> base = motion(s.time);
      const Vector3d tip = base.p_WB + base.R_WB * s.tip;
      csv += fmt::format("{:.3f}", s.time);
      for (const double p : input[k]) csv += fmt::format(",{}", p);
      for (const double y : tip) csv += fmt::format(",{:.9g}", y + place.Next());
      for (int i = 0; i < 6; ++i)
        csv += fmt::format(",{:.9g}", s.wrench[i] + (i < 3 ? force : torque).Next());
      csv += more(s.time) + "\n";
    }
    WriteFile(folder / (std::string(name) + ".csv"), csv);
  }
}

void Edit(const std::filesystem::path& file,
          const std::vector<std::pair<std::string, std::string>>& edits) {
  std::string text = ReadFile(file);
  for (const auto& [from, to] : edits) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
  }
  WriteFile(file, text);
}

// The analytic model's steps (Runge-Kutta of order 8), with noise: tip, pressures asked for, base
// wrench at 200 Hz. k_dL3, by which the elongation softens, is the least certain.
TEST(SpaRegressor, FindsTableOneFromTipPressuresAndBaseForce) {
  const testing::Scratch scratch;
  WriteSpaLogs(Truth(), {}, 1, scratch.folder());
  const Regression found = Found(scratch / "experiment.yaml");
  ExpectTableOne(found, 0.02);
  EXPECT_EQ(found.how.substr(0, 25), "m from forces and torques");
  EXPECT_GT(found.iterations, 0);
}

TEST(SpaRegressor, FindsTableOneOfAnActuatorThatStands) {
  const testing::Scratch scratch;
  WriteSpaLogs(Truth(), {}, 1, scratch.folder());
  Edit(scratch / "spa.xml", {{"quat=\"0 1 0 0\"", "quat=\"1 0 0 0\""}});
  const Spa<double> spa(Truth().parameters, {.mass = SpaMass::kArc});
  const SpaBase<double> standing;
  Record(
      scratch.folder(), [&](double) { return standing; },
      SpaAtRest(spa, Vector3d::Zero(), standing), [](double) { return ",0,0,0,0,0,0"; });
  ExpectTableOne(Found(scratch / "experiment.yaml"), 0.02);
}

// Six joints between world and base whose positions are logged, each with a servo that a simulation
// would follow them by: the servos' forces do not count.
TEST(SpaRegressor, FindsTableOneOnABaseThatIsMoved) {
  const testing::Scratch scratch;
  WriteSpaLogs(Truth(), {}, 1, scratch.folder());
  const char* const axes[] = {"1 0 0", "0 -1 0", "0 0 -1", "1 0 0", "0 1 0", "0 0 1"};
  std::string joints = "<inertial pos=\"0 0 0\" mass=\"1e-9\" diaginertia=\"1e-12 1e-12 1e-12\"/>";
  std::string servos, sensors, inputs, outputs;
  for (int i = 0; i < 6; ++i) {
    const char* const unit = i < 3 ? "m" : "rad";
    joints += fmt::format("<joint name=\"base{}\" type=\"{}\" axis=\"{}\"/>", i,
                          i < 3 ? "slide" : "hinge", axes[i]);
    servos +=
        fmt::format("<position name=\"base{0}\" joint=\"base{0}\" kp=\"1e9\" dampratio=\"1\"/>", i);
    sensors += fmt::format("<jointpos name=\"base{0}\" joint=\"base{0}\"/>", i);
    inputs += fmt::format(
        "  - {{column: b{0}, unit: {1}, actuator: base{0}, interpolate: linear}}\n", i, unit);
    outputs +=
        fmt::format("  - {{column: b{0}, unit: {1}, sensor: base{0}, sigma: 1e-5}}\n", i, unit);
  }
  Edit(scratch / "spa.xml", {{"<site name=\"base\"", joints + "<site name=\"base\""},
                             {"<actuator>", "<actuator>" + servos},
                             {"<sensor>", "<sensor>" + sensors}});
  Edit(scratch / "experiment.yaml",
       {{"inputs:\n", "inputs:\n" + inputs}, {"outputs:\n", "outputs:\n" + outputs}});
  const Spa<double> spa(Truth().parameters, {.mass = SpaMass::kArc});
  const auto swing = [](double t) {
    std::string text;  // as SpaSwing has it
    for (int i = 0; i < 6; ++i)
      text += fmt::format(
          ",{:.9g}", (i < 3 ? 0.02 : 0.2) * std::sin(2 * std::numbers::pi * (1 + 0.6 * i) * t));
    return text;
  };
  Record(scratch.folder(), SpaSwing(), SpaAtRest(spa, Vector3d::Zero(), SpaBase<double>::Hanging()),
         swing);
  const Regression found = Found(scratch / "experiment.yaml");
  ExpectTableOne(found, 0.02);
  // The servos carry a simulation along.
  const Experiment e = Experiment::Read(scratch / "experiment.yaml");
  const Problem problem(e, ModelSpec::Load(e.model));
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const Trace trace = problem.Predict(found.x, l);
    double off = 0, range = 0;
    for (std::size_t k = 0; k < trace.channel[6].size(); ++k) {
      off = std::max(off, std::abs(trace.channel[6][k] - e.logs[l].measured[6][k]));
      range = std::max(range, std::abs(e.logs[l].measured[6][k]));
    }
    EXPECT_LT(off, 0.02 * range) << e.logs[l].label;
  }
}

}  // namespace
}  // namespace continuum
