// The equations of motion next to a state, against differences of MuJoCo's own.
#include "identification/sensitivity/force_derivatives.h"

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/model/model_spec.h"

namespace continuum {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// Hinges and slides in a tree with two branches, several on one body, tendons through sites of both
// branches and of the world, one of joints, and actuators of every kind that the closed form knows.
constexpr char kModel[] = R"(<mujoco>
  <option timestep="2e-3" integrator="implicitfast" gravity="1 -2 -9"><flag contact="disable"/></option>
  <worldbody>
    <site name="w" pos="0.1 0.05 0"/>
    <body pos="0 0 1" euler="10 20 30">
      <joint name="a" axis="1 2 3" pos="0.1 0 0.02" stiffness="3" springref="20" damping="0.2"/>
      <joint name="s" type="slide" axis="0 1 1" stiffness="50" damping="2" armature="0.1"/>
      <joint name="b" axis="0 1 0" damping="0.1" armature="0.02"/>
      <inertial pos="0.02 0.03 -0.2" mass="1.2" fullinertia="0.03 0.025 0.02 0.001 0.002 0.003"/>
      <site name="p" pos="0.05 0 -0.2"/>
      <body pos="0 0 -0.4">
        <joint name="c" axis="1 0 0" stiffness="2"/>
        <inertial pos="0 0.02 -0.1" mass="0.5" diaginertia="0.004 0.003 0.002"/>
        <site name="l" pos="0.04 0.01 -0.15"/>
        <body name="tip" pos="0 0 -0.2" euler="0 40 0">
          <joint name="e" axis="0 1 1"/>
          <inertial pos="0 0 -0.1" mass="0.3" diaginertia="0.002 0.002 0.001"/>
          <site name="t" pos="0 0.03 -0.1"/>
        </body>
      </body>
      <body pos="0.1 0 -0.3">
        <joint name="f" axis="0 0 1" pos="0.02 0.01 0" damping="0.05"/>
        <inertial pos="0.1 0 0" mass="0.4" diaginertia="0.003 0.002 0.001"/>
        <site name="r" pos="0.12 0.02 0.01"/>
      </body>
    </body>
    <body pos="1 0 0"><joint name="g" axis="0 1 0"/><geom size="0.05"/></body>
  </worldbody>
  <tendon>
    <spatial name="long" stiffness="30" damping="2" springlength="0.1">
      <site site="w"/><site site="p"/><site site="l"/><site site="t"/></spatial>
    <spatial name="across" stiffness="20" damping="1" springlength="0 0.1">
      <site site="t"/><site site="r"/></spatial>
    <fixed name="coupled" stiffness="4" damping="0.3">
      <joint joint="a" coef="0.5"/><joint joint="e" coef="-1.5"/></fixed>
  </tendon>
  <actuator>
    <general name="pull" tendon="long" gainprm="-1"/>
    <general name="servo" joint="c" gear="2" biastype="affine" gainprm="5" biasprm="0.1 -5 -0.3"/>
    <general name="lag" joint="e" dyntype="filterexact" dynprm="0.05" gainprm="3"/>
    <general name="both" tendon="across" gear="0.5" dyntype="integrator" gaintype="affine"
      gainprm="2 0.5 -0.2" biastype="affine" biasprm="0 1 -1"/>
    <motor name="weak" joint="f" forcelimited="true" forcerange="-0.01 0.01"/>
  </actuator>
</mujoco>)";

struct Bench {
  ModelAndData machine;
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  Vector a;

  explicit Bench(const std::string& model = kModel) : machine(ModelSpec::Parse(model).Build()) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const auto fill = [&](double* x, int n) {
      for (int i = 0; i < n; ++i) x[i] = normal(random);
    };
    fill(d.qpos, static_cast<int>(m.nq)), fill(d.qvel, static_cast<int>(m.nv));
    fill(d.ctrl, static_cast<int>(m.nu)), fill(d.act, static_cast<int>(m.na));
    a.resize(m.nv);
    fill(a.data(), static_cast<int>(m.nv));
  }
  // F by a model that may be another one.
  Vector Force(const mjModel& by) {
    mj_forward(&by, &d);
    Vector force(by.nv), heavy(by.nv);
    for (int i = 0; i < by.nv; ++i)
      force[i] = d.qfrc_passive[i] + d.qfrc_actuator[i] - d.qfrc_bias[i];
    mj_mulM(&by, &d, heavy.data(), a.data());
    return force - heavy;
  }
  // Of the state, by central differences.
  Matrix Differences(double* x, Eigen::Index n) {
    constexpr double kStep = 1e-6;
    Matrix J(m.nv, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double was = x[i];
      x[i] = was + kStep;
      const Vector more = Force(m);
      x[i] = was - kStep;
      J.col(i) = (more - Force(m)) / (2 * kStep);
      x[i] = was;
    }
    mj_forward(&m, &d);
    return J;
  }
};

// A tree of up to six bodies with up to two joints each, tendons through sites and from joint to
// joint, and actuators on either.
std::string RandomModel(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto vector = [&](double size) {
    return fmt::format("{} {} {}", size * uniform(random), size * uniform(random),
                       size * uniform(random));
  };
  const int bodies = 2 + below(5);
  std::vector<std::string> inside(bodies + 1), joints;
  for (int b = bodies; b > 0; --b) {
    std::string body =
        fmt::format("<body pos='{}' euler='{} 20 30'>", vector(0.4), 90 * uniform(random));
    for (int j = 0, count = 1 + below(2); j < count; ++j) {
      joints.push_back(fmt::format("j{}_{}", b, j));
      body += fmt::format(
          "<joint name='{}' type='{}' axis='{}' pos='{}' stiffness='{}' damping='{}' "
          "armature='0.01'/>",
          joints.back(), below(3) ? "hinge" : "slide", vector(1), vector(0.1), 3 * below(2),
          0.2 * below(2));
    }
    body += fmt::format("<inertial pos='{}' mass='{}' diaginertia='0.01 0.012 0.014'/>",
                        vector(0.1), 1.2 + uniform(random));
    body += fmt::format("<site name='s{}' pos='{}'/>", b, vector(0.2)) + inside[b] + "</body>";
    inside[below(b)] += body;
  }
  std::string tendons, actuators;
  for (int t = 0; t < 3; ++t) {
    tendons += fmt::format("<spatial name='t{}' stiffness='{}' damping='{}' springlength='0.1'>", t,
                           5 * below(3), below(2));
    for (int k = 0, last = -1, count = 2 + below(3); k < count; ++k) {
      int site = below(bodies + 1);
      if (site == last) site = (site + 1) % (bodies + 1);
      tendons += fmt::format("<site site='s{}'/>", last = site);
    }
    tendons += "</spatial>";
    actuators += fmt::format(
        "<general tendon='t{}' gear='{}' biastype='affine' gainprm='-2' biasprm='0.1 {} {}'/>", t,
        uniform(random), uniform(random), -0.1 * below(2));
    actuators += fmt::format(
        "<general joint='{}' dyntype='filter' dynprm='0.1' gaintype='affine' "
        "gainprm='1 {} {}'/>",
        joints[below(static_cast<int>(joints.size()))], uniform(random), uniform(random));
  }
  return "<mujoco><option integrator='implicitfast'><flag contact='disable'/></option><worldbody>"
         "<site name='s0' pos='0.3 0.2 0.1'/>" +
         inside[0] + "</worldbody><tendon>" + tendons + "</tendon><actuator>" + actuators +
         "</actuator></mujoco>";
}

// Central differences of this size are good to some 1e-9 of the largest entry.
void ExpectClose(const Matrix& exact, const Matrix& differences) {
  const double size = differences.cwiseAbs().maxCoeff();
  EXPECT_GT(size, 0);
  EXPECT_LT((exact - differences).cwiseAbs().maxCoeff(), 1e-7 * size);
}

void ExpectTangent(Bench& bench) {
  ASSERT_EQ(ForceDerivatives::Obstacle(bench.m), "");
  const Matrix by_position = bench.Differences(bench.d.qpos, bench.m.nq);
  const Matrix by_velocity = bench.Differences(bench.d.qvel, bench.m.nv);
  const Matrix by_activation = bench.Differences(bench.d.act, bench.m.na);
  ForceDerivatives derivatives(bench.m);
  derivatives.Place(bench.m, bench.d);
  derivatives.Update(bench.m, bench.d, bench.a.data(), bench.d.qvel);
  ExpectClose(derivatives.by_position(), by_position);
  ExpectClose(derivatives.by_velocity(), by_velocity);
  ExpectClose(derivatives.by_activation(), by_activation);
}

TEST(ForceDerivatives, FollowsPositionsSpeedsAndActivations) {
  Bench bench;
  ExpectTangent(bench);
}

TEST(ForceDerivatives, FollowsAnyTree) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(RandomModel(seed));
    Bench bench(RandomModel(seed));
    ExpectTangent(bench);
  }
}

// Parameters that the closed form tells apart, by their fields in another model.
TEST(ForceDerivatives, FollowsParameters) {
  const std::vector<Change> changes{{"joint:a", "stiffness", 4},
                                    {"joint:a", "springref", 0.6},
                                    {"joint:f", "damping", 0.4},
                                    {"joint:*", "armature", 0.3},
                                    {"body:tip", "mass", 0.5},
                                    {"body:tip", "ipos[1]", 0.05},
                                    {"body:tip", "inertia[0]", 0.0025},
                                    {"body:tip", "point_mass", 0.2},
                                    {"tendon:long", "stiffness", 50},
                                    {"tendon:across", "damping", 3},
                                    {"tendon:long", "springlength", 0.2},
                                    {"actuator:pull", "gainprm[0]", -2},
                                    {"actuator:servo", "kp", 7},
                                    {"actuator:servo", "gear[0]", 3},
                                    {"actuator:weak", "forcerange[1]", 0.5},
                                    {"option", "gravity[0]", 5}};
  const ModelSpec system = ModelSpec::Parse(kModel);
  for (const Change& change : changes) {
    SCOPED_TRACE(change.target + " " + change.attribute);
    Bench bench;
    const ModelAndData other = system.Build(std::vector{change});
    const ModelDifference difference(bench.m, *other.model);
    EXPECT_EQ(difference.field, "");
    const Vector changed = bench.Force(*other.model);
    const Vector expected = changed - bench.Force(bench.m);
    ForceDerivatives derivatives(bench.m);
    derivatives.Place(bench.m, bench.d);
    derivatives.Update(bench.m, bench.d, bench.a.data(), bench.d.qvel);
    Vector more = Vector::Zero(bench.m.nv);
    derivatives.Differ(bench.m, bench.d, *other.model, difference, more.data());
    EXPECT_GT(expected.norm(), 0);
    EXPECT_LT((more - expected).norm(), 1e-9 * changed.norm());
  }
}

TEST(ForceDerivatives, NamesWhatItDoesNotCover) {
  const auto field = [](const Change& change) {
    const ModelSpec system = ModelSpec::Parse(kModel);
    return ModelDifference(system.model(), *system.Build(std::vector{change}).model).field;
  };
  EXPECT_EQ(field({"site:t", "pos[0]", 0.02}), "site_pos");
  EXPECT_EQ(field({"body:tip", "pos[0]", 0.02}), "body_pos");
  EXPECT_EQ(field({"joint:a", "ref", 0.1}), "qpos0");
  EXPECT_EQ(field({"body:tip", "force[0]", 1, Change::Operation::kAdd}), "nu");  // an actuator more
  const auto obstacle = [](const std::string& from, const std::string& to) {
    std::string xml = kModel;
    xml.replace(xml.find(from), from.size(), to);
    return ForceDerivatives::Obstacle(ModelSpec::Parse(xml).model());
  };
  EXPECT_NE(obstacle("<joint name=\"g\" axis=\"0 1 0\"/>", "<joint type=\"ball\"/>"), "");
  EXPECT_NE(obstacle("<motor name=\"weak\" joint=\"f\"", "<motor name=\"weak\" site=\"t\""), "");
}

}  // namespace
}  // namespace continuum
