#include "binding/articulated_inertia.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "support/engine.h"

namespace continuum {
namespace {

using Numbers = std::vector<double>;

class ArticulatedInertiaTest : public testing::Engine {
 protected:
  // Branches, welded bodies, all types of joints, and a second tree.
  static std::string Trees() {
    const std::string geom = "<geom type='box' size='.02 .03 .05' pos='.01 0 .04' mass='.3'/>";
    return "<mujoco><worldbody><body pos='0 0 1'><freejoint/>" + geom + "<body pos='.1 0 0'>" +
           geom + "<body pos='0 .1 0'><joint type='ball' armature='.01'/>" + geom +
           "<body pos='0 0 .1'>" + geom + "</body></body></body><body pos='-.1 0 0'>" +
           "<joint axis='1 1 0'/><joint type='slide' axis='0 1 .3'/>" + geom +
           "<body pos='0 .2 0'><joint axis='0 1 1' damping='.2'/>" + geom +
           "</body><body pos='0 -.2 0'><joint axis='1 0 1'/>" + geom +
           "</body></body></body><body pos='3 0 0'><joint axis='0 1 0'/>" + geom +
           "<body pos='.3 0 0'><joint axis='0 0 1'/>" + geom +
           "</body></body></worldbody></mujoco>";
  }
  static std::string Chain(int links) {
    std::string bodies, close;
    for (int k = 0; k < links; ++k) {
      bodies +=
          "<body pos='0 0 -.03'><joint axis='1 0 0'/><joint axis='0 1 0'/><geom "
          "type='capsule' size='.004' fromto='0 0 0 0 0 -.02' mass='.01'/>";
      close += "</body>";
    }
    return "<mujoco><worldbody>" + bodies + close + "</worldbody></mujoco>";
  }
  // Of (M + h D) x = b, the largest over the largest of b, M by MuJoCo.
  static double Residual(const mjModel& m, const mjData& d, const Numbers& damping,
                         const Numbers& x, const Numbers& b) {
    Numbers M(m.nv * m.nv);
    mj_fullM(&m, &d, M.data());
    double worst = 0, size = 0;
    for (int i = 0; i < m.nv; ++i) {
      double residual = damping[i] * x[i] - b[i];
      for (int j = 0; j < m.nv; ++j) residual += M[i * m.nv + j] * x[j];
      worst = std::max(worst, std::abs(residual)), size = std::max(size, std::abs(b[i]));
    }
    return worst / size;
  }
  // Numbers with M of unit force: b = M y, so that x is of the size of y.
  static double WorstResidual(const std::string& xml) {
    const auto m = Model(xml);
    const auto d = Data(m);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < m->nv; ++i) d->qvel[i] = normal(random);
    mj_integratePos(m.get(), d->qpos, d->qvel, .5);
    mj_forward(m.get(), d.get());
    Numbers damping(m->nv), four(4 * m->nv);
    for (int i = 0; i < m->nv; ++i) damping[i] = 1e-5 + 2e-3 * m->dof_damping[i];
    for (double& v : four) v = normal(random);
    std::vector<int> dofs(m->nv);
    for (int i = 0; i < m->nv; ++i) dofs[i] = i;
    ArticulatedInertia inertia(*m, dofs);
    inertia.Update(*m, *d, damping);
    Numbers x = four;
    inertia.SolveFour(x.data());
    double worst = 0;
    for (int c = 0; c < 4; ++c) {
      Numbers b(m->nv), of_four(m->nv);
      for (int i = 0; i < m->nv; ++i) b[i] = four[4 * i + c], of_four[i] = x[4 * i + c];
      Numbers alone = b;
      inertia.Solve(alone.data());
      worst = std::max(worst, Residual(*m, *d, damping, of_four, b));
      worst = std::max(worst, Residual(*m, *d, damping, alone, b));
    }
    return worst;
  }
};

// 2.2e-16 times the entries of M by those of x, which unit moments on light links make large.
TEST_F(ArticulatedInertiaTest, SolvesWithMuJoCosInertia) {
  EXPECT_LT(WorstResidual(Trees()), 1e-13);
  EXPECT_LT(WorstResidual(Chain(5)), 1e-12);
  EXPECT_LT(WorstResidual(Chain(60)), 1e-10);
}

TEST_F(ArticulatedInertiaTest, KnowsArmatureThatIsNotOfJoints) {
  const auto m = Model(Chain(3));
  EXPECT_TRUE(ArticulatedInertia::Covers(*m));
  const auto with = Model(
      "<mujoco><worldbody><body><joint name='j'/><geom size='.1'/></body></worldbody>"
      "<tendon><fixed armature='.1'><joint joint='j' coef='1'/></fixed></tendon></mujoco>");
  EXPECT_FALSE(ArticulatedInertia::Covers(*with));
  const auto motor = Model(
      "<mujoco><worldbody><body><joint name='j'/><geom size='.1'/></body></worldbody>"
      "<actuator><general joint='j' armature='.1'/></actuator></mujoco>");
  EXPECT_FALSE(ArticulatedInertia::Covers(*motor));
}

// The same arm solved for what resists and, by an armature of 1e-300 kg that changes no bit of M,
// for all joints.
class FewUnknownsTest : public testing::Engine {
 protected:
  struct Case {
    const char *config, *tendon, *actuator;
  };
  static std::string Arm(const Case& c, bool all_joints) {
    std::string bodies, close, cables, motors;
    for (int k = 0; k < 3; ++k) {
      const double x = .01 * std::cos(2 * mjPI / 3 * k), y = .01 * std::sin(2 * mjPI / 3 * k);
      bodies += fmt::format("<site name='s{}_0' pos='{} {} .02'/>", k, x, y);
      cables += fmt::format("<spatial name='t{}' {}>", k, c.tendon);
      for (int i = 0; i <= kLinks; ++i) cables += fmt::format("<site site='s{}_{}'/>", k, i);
      cables += "</spatial>";
      motors += fmt::format(fmt::runtime(c.actuator), k);
    }
    for (int i = 1; i <= kLinks; ++i) {
      bodies +=
          "<body pos='0 0 -.03'><joint axis='1 0 0' stiffness='.5' damping='.01'/><joint "
          "axis='0 1 0' stiffness='.5' damping='.01'/><geom type='capsule' size='.004' "
          "fromto='0 0 0 0 0 -.02' mass='.01' contype='0' conaffinity='0'/>";
      for (int k = 0; k < 3; ++k) {
        bodies += fmt::format("<site name='s{}_{}' pos='{} {} -.015'/>", k, i,
                              .01 * std::cos(2 * mjPI / 3 * k), .01 * std::sin(2 * mjPI / 3 * k));
      }
      close += "</body>";
    }
    const std::string other =
        fmt::format("<spatial {}><site site='s0_0'/><site site='s0_1'/></spatial>",
                    all_joints ? "armature='1e-300'" : "");
    return "<mujoco><option integrator='implicitfast'/>" +
           Instance("capstan", Key("tendon", "t*") + Key("mu", ".2") + c.config) + "<worldbody>" +
           bodies + close + "</worldbody><tendon>" + cables + other + "</tendon><actuator>" +
           motors + "</actuator></mujoco>";
  }
  static constexpr int kLinks = 20;
};

TEST_F(FewUnknownsTest, GiveTheSameMotionAsAllJoints) {
  const Case cases[] = {
      {"", "", "<motor tendon='t{}' gear='-1'/>"},
      {"", "damping='.5'", "<motor tendon='t{}' gear='-1'/>"},
      {"", "", "<position tendon='t{}' kp='300' kv='20'/>"},
      {"<config key='driven' value='both'/>", "", "<motor tendon='t{}' gear='-1'/>"},
      {"<config key='give' value='2e-5'/>", "damping='.1'", "<motor tendon='t{}' gear='-1'/>"},
  };
  for (const Case& c : cases) {
    const auto few = Model(Arm(c, false)), all = Model(Arm(c, true));
    const auto d = Data(few), e = Data(all);
    ASSERT_EQ(few->nv, 2 * kLinks);
    double worst = 0, far = 0;
    const bool servo = std::string(c.actuator).find("position") != std::string::npos;
    for (int step = 0; step < 300; ++step) {
      for (int a = 0; a < few->nu; ++a) {
        const double u = std::sin(9 * d->time + a);
        d->ctrl[a] = e->ctrl[a] = servo ? few->tendon_length0[a] - .02 - .01 * u : 2 + u;
      }
      mj_step(few.get(), d.get());
      mj_step(all.get(), e.get());
      for (int i = 0; i < few->nq; ++i) {
        worst = std::max(worst, std::abs(d->qpos[i] - e->qpos[i]));
        far = std::max(far, std::abs(d->qpos[i]));
      }
    }
    EXPECT_GT(far, .02) << c.config << c.tendon << c.actuator;
    // Roundings of angles of 0.04 rad, and a thousand times that for what they do to the steps
    // that follow.
    EXPECT_LT(worst, 1e-13) << c.config << c.tendon << c.actuator;
  }
}

}  // namespace
}  // namespace continuum
