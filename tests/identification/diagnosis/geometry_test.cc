// ctest labels: slow
// Hidden geometry is found: the mounting angle of a link, the place of a site, the radius of a
// drum.
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "identification/diagnosis/diagnosis.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using Eigen::AngleAxisd, Eigen::Vector3d;

constexpr double kInertia = 0.02, kDamping = 0.2, kServo = 6, kLength = 0.3;  // SI
constexpr std::size_t kRows = 250;

// A link about an upright axis, turned by a servo on a drum; its tip by hand:
//
//   I q'' = r k_p (u − r q) − b q',   tip = R_z(yaw) R_y(pitch) R_x(roll) R_z(q) (l + dx, dy, dz)
struct Link {
  double roll = 0, pitch = 0, radius = 1;  // rad, rad, 1
  Vector3d site{kLength, 0, 0};            // m

  std::vector<Vector3d> Run(const std::vector<double>& u) const {
    constexpr int kSteps = 200;
    constexpr double h = testing::kPeriod / kSteps;
    double q = 0, v = 0;
    std::vector<Vector3d> tip;
    for (const double input : u) {
      tip.push_back(AngleAxisd(pitch, Vector3d::UnitY()) * AngleAxisd(roll, Vector3d::UnitX()) *
                    AngleAxisd(q, Vector3d::UnitZ()) * site);
      for (int k = 0; k < kSteps; ++k) {
        v += h * (radius * kServo * (input - radius * q) - kDamping * v) / kInertia;
        q += h * v;
      }
    }
    return tip;
  }
};

class HiddenGeometry : public testing::Bench {
 protected:
  static std::string Xml() {
    return fmt::format(
        R"(<mujoco><option timestep="0.002" integrator="implicitfast" gravity="0 0 0"/><worldbody>
      <body name="link"><joint name="q" axis="0 0 1" damping="{}"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1 1 {}"/><site name="tip" pos="{} 0 0"/></body>
      </worldbody><actuator><position name="servo" joint="q" kp="{}"/></actuator>
      <sensor><framepos name="tip" objtype="site" objname="tip"/></sensor></mujoco>)",
        kDamping, kInertia, kLength, kServo);
  }

  Diagnosis Find(const Link& link) {
    for (int trial = 0; trial < 3; ++trial) {
      for (unsigned copy = 0; copy < 2; ++copy) AddTrial(link, trial, copy);
    }
    const Experiment e = Experiment::Read(Write(
        "experiment.yaml",
        "format: 1\nmodel: model.xml\nstart: rest\nlogs:\n" + logs_ +
            "inputs:\n  - {column: u, unit: rad, actuator: servo}\noutputs:\n"
            "  - {column: x, unit: m, sensor: 'tip[0]'}\n"
            "  - {column: y, unit: m, sensor: 'tip[1]'}\n"
            "  - {column: z, unit: m, sensor: 'tip[2]'}\n"
            "parameters:\n  - {name: b, target: 'joint:*', attribute: damping, initial: 0.2, "
            "lower: 0, upper: 2}\ncandidates: [mounting_angle, site_place, drum_radius, armature, "
            "input_gain, coulomb]\n"));
    DiagnosisOptions options;
    options.placebos = 0;
    return Diagnose(e, ModelSpec::Load(Write("model.xml", Xml())), options);
  }

  // The values of the candidate that was named, by the names of its parameters.
  static std::map<std::string, double> Named(const Diagnosis& d, const std::string& effect) {
    std::map<std::string, double> values;
    if (!d.chosen()) {
      ADD_FAILURE() << d.verdict.reason;
      return values;
    }
    EXPECT_EQ(d.verdict.word(), "named") << d.verdict.reason;
    EXPECT_EQ(d.chosen()->hypothesis.effect, effect) << d.verdict.reason;
    const auto& extra = d.chosen()->hypothesis.extra;
    for (std::size_t i = 0; i < extra.size(); ++i) {
      values[extra[i].name] =
          d.chosen()->fitted.fit.x[d.chosen()->first_extra() + static_cast<Eigen::Index>(i)];
    }
    return values;
  }

 private:
  void AddTrial(const Link& link, int trial, unsigned copy) {
    const auto u = testing::Command(trial, kRows);
    testing::ArNoise noise(5e-4, 0, 10 * static_cast<unsigned>(trial) + copy);
    std::string csv = "time,u,x,y,z\n";
    const auto tip = link.Run(u);
    for (std::size_t k = 0; k < kRows; ++k) {
      csv += fmt::format("{},{}", testing::kPeriod * static_cast<double>(k), u[k]);
      for (int i = 0; i < 3; ++i) csv += fmt::format(",{}", tip[k][i] + noise.Next());
      csv += "\n";
    }
    const std::string file = fmt::format("t{}_{}.csv", trial, copy);
    Write(file, csv);
    logs_ += fmt::format("  - {{file: {}, trial: t{}, use: {}}}\n", file, trial,
                         trial == 2 ? "validate" : "train");
  }
};

TEST_F(HiddenGeometry, AMountingAngleIsNamed) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const auto found = Named(Find({.roll = 0.05, .pitch = -0.03}), "mounting_angle");
  EXPECT_NEAR(found.at("roll"), 0.05, 2e-3);
  EXPECT_NEAR(found.at("pitch"), -0.03, 2e-3);
}

// What is not needed is left out: dy.
TEST_F(HiddenGeometry, ThePlaceOfASiteIsNamed) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const auto found = Named(Find({.site = {kLength + 0.01, 0, -0.02}}), "site_place");
  EXPECT_NEAR(found.at("dx"), 0.01, 1e-3);
  EXPECT_NEAR(found.at("dz"), -0.02, 1e-3);
}

TEST_F(HiddenGeometry, TheRadiusOfADrumIsNamed) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const auto found = Named(Find({.radius = 0.9}), "drum_radius");
  EXPECT_NEAR(found.at("scale"), 0.9, 0.01);
}

}  // namespace
}  // namespace continuum
