// Cables that are pulled at both ends (driven="both"): they run along themselves until friction
// leaves as much tension at one end as at the other.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <fmt/format.h>

#include "support/engine.h"

namespace continuum {
namespace {

constexpr double kMu = .3, kWeight = 20;  // [1], of the load [N]

// A load on a slide hangs in a loop of the cable, between two corners of the world. The cable comes
// to them from the sides, under the given angles, and turns back at the load.
struct Loop {
  double left = mjPI / 2, right = mjPI / 2;  // wrap angles at the corners
  double load = mjPI;                        // the same at the load; π: both sides are vertical
  double step = 1e-3, mu = kMu;
  std::string tendon = {}, actuator = R"(<motor tendon="t" gear="-1"/>)",
              config = "<config key=\"driven\" value=\"both\"/>";
};

class BothEnds : public testing::Engine {
 protected:
  static std::string Xml(const Loop& loop) {
    // the parts beside the load lean outward by `lean`
    const double lean = (mjPI - loop.load) / 2, x = 4 * std::sin(lean), z = 4 * std::cos(lean);
    const auto end = [&](double side, double angle) {
      const double a = angle + lean;  // from upward, outward
      return fmt::format("{} 0 {}", side * (x + std::sin(a)), z + std::cos(a));
    };
    return "<mujoco>" +
           Instance("capstan",
                    Key("tendon", "t") + Key("mu", std::to_string(loop.mu)) + loop.config) +
           fmt::format(R"(<option timestep="{}" integrator="implicitfast" gravity="0 0 -10"/>
      <worldbody><site name="a0" pos="{}"/><site name="a" pos="{} 0 {}"/>
        <site name="b" pos="{} 0 {}"/><site name="b0" pos="{}"/>
        <body><joint type="slide" axis="0 0 1" damping="1"/>
          <geom size=".02" mass="2" contype="0" conaffinity="0"/><site name="load"/></body>
      </worldbody><tendon><spatial name="t" {}><site site="a0"/><site site="a"/><site site="load"/>
        <site site="b"/><site site="b0"/></spatial></tendon><actuator>{}</actuator>
      <sensor><plugin plugin="continuum.capstan" instance="i" objtype="site" objname="a"/>
        <plugin plugin="continuum.capstan" instance="i" objtype="site" objname="load"/>
        <plugin plugin="continuum.capstan" instance="i" objtype="site" objname="b"/></sensor>
      </mujoco>)",
                       loop.step, end(-1, loop.left), -x, z, x, z, end(1, loop.right), loop.tendon,
                       loop.actuator);
  }
  // How far the load has moved up after 0.8 s of a pull [m].
  static double Moved(const Loop& loop, double pull, double start) {
    const auto m = Model(Xml(loop));
    const auto d = Data(m);
    while (d->time < .8) {
      if (m->nu > 0) d->ctrl[0] = start + (pull - start) * std::min(1.0, d->time / .1);
      mj_step(m.get(), d.get());
    }
    return d->qpos[0];
  }
};

// The load rests for pulls in W/2 exp(±μθ), θ the angle of one corner; within 1 %.
TEST_F(BothEnds, ALoadInALoopBreaksAwayWhereBothCornersDo) {
  for (const double h : {5e-4, 1e-3, 2e-3}) {
    Loop loop;
    loop.step = h;
    for (const double side : {-1., 1.}) {
      const double edge = kWeight / 2 * std::exp(side * kMu * mjPI / 2);
      EXPECT_LT(std::abs(Moved(loop, edge * std::exp(-side * .01), kWeight / 2)), 1e-4) << h;
      EXPECT_GT(side * Moved(loop, edge * std::exp(side * .01), kWeight / 2), 1e-3) << h;
    }
  }
}

// The spring of a tendon pulls at both ends too.
TEST_F(BothEnds, TheSpringOfATendonPullsAtBothEnds) {
  const auto moved = [&](double pull) {
    Loop loop;
    loop.tendon = fmt::format(R"(stiffness="100" springlength="0 {}")", 10 - pull / 100);
    loop.actuator = "";
    return Moved(loop, 0, 0);
  };
  for (const double side : {-1., 1.}) {
    const double edge = kWeight / 2 * std::exp(side * kMu * mjPI / 2);
    EXPECT_LT(std::abs(moved(edge * std::exp(-side * .01))), 3e-4);
    EXPECT_GT(side * moved(edge * std::exp(side * .01)), 5e-4);
  }
}

// In sliding each side of the load carries T exp(∓μθ) of its corner, as long as the load can hold
// the difference. A corner with more friction than all others together rests: the cable comes from
// the other side.
TEST_F(BothEnds, InSlidingEachSideHasTheFrictionOfItsWayOrTheCableComesFromTheOtherSide) {
  for (const double v : {-.1, .1}) {
    for (const auto& [left, right] : {std::pair{1.5, 1.5}, {1.7, 1.2}, {2.8, .2}, {.2, 2.8}}) {
      Loop loop;
      loop.left = left, loop.right = right;
      loop.load = 1.5;
      const auto m = Model(Xml(loop));
      const auto d = Data(m);
      d->qvel[0] = v, d->ctrl[0] = 12;
      mj_forward(m.get(), d.get());
      const double s = v > 0 ? -kMu : kMu;
      const double more = std::max(left, right) - std::min(left, right) - loop.load;
      const double a = more > 0 && left > right ? right + loop.load : left,
                   b = more > 0 && right > left ? left + loop.load : right;
      const double cosine = std::cos((mjPI - loop.load) / 2);
      const double due = (12 * std::exp(s * a) + 12 * std::exp(s * b)) * cosine / 2 - 10 - v / 2;
      EXPECT_NEAR(d->qacc[0], due, 1e-6) << left << " " << right;
      EXPECT_NEAR(d->sensordata[0], 12 * std::exp(s * a), 1e-6);
      EXPECT_NEAR(d->sensordata[1], 12 * std::exp(s * b), 1e-6);
      EXPECT_NEAR(d->sensordata[2], 12, 1e-6);  // at the far end as at the near one
    }
  }
}

TEST_F(BothEnds, OneCornerBetweenTwoEqualPullsHasNoFriction) {
  const auto m =
      Model("<mujoco>" +
            Instance("capstan", Key("tendon", "t") + Key("mu", ".5") + Key("driven", "both")) +
            R"(<worldbody><site name="a" pos="-1 0 1"/><site name="b" pos="1 0 1"/><body>
        <joint type="slide" axis="0 0 1"/><geom size=".02" mass="1"/><site name="m"/></body></worldbody>
      <tendon><spatial name="t"><site site="a"/><site site="m"/><site site="b"/></spatial></tendon>
      <actuator><motor tendon="t" gear="-1"/></actuator></mujoco>)");
  for (const double v : {-.2, 0., .2}) {
    const auto d = Data(m);
    d->qvel[0] = v, d->ctrl[0] = 5;
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->qfrc_passive[0], 0, 1e-6) << v;
  }
}

TEST_F(BothEnds, HoldsALoadInsideTheBandWithoutCreep) {
  const auto m = Model(Xml({}));
  const auto d = Data(m);
  d->ctrl[0] = kWeight / 2 * std::exp(.7 * kMu * mjPI / 2);
  RunUntil(m, d, 1);
  const double held = d->qpos[0];
  EXPECT_LT(std::abs(held), 1e-4);
  RunUntil(m, d, 11);
  EXPECT_NEAR(d->qpos[0], held, 1e-8);
}

// A chain of sites of which every third is fixed and the others move in a plane.
std::string RandomRoute(int n, int fixed, const std::function<double()>& uniform) {
  std::string bodies, path;
  for (int i = 0; i < n; ++i) {
    const char* const joints =
        i % 3 == fixed ? ""
                       : R"(<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>)";
    bodies += fmt::format(
        R"(<body pos="{} {} {}">{}<geom size=".02" mass="1000"/><site name="s{}"/></body>)", i,
        .8 * uniform(), .8 * uniform(), joints, i);
    path += fmt::format("<site site=\"s{}\"/>", i);
  }
  return "<worldbody>" + bodies + "</worldbody><tendon><spatial name=\"t\">" + path +
         R"(</spatial></tendon><actuator><motor tendon="t" gear="-1"/></actuator></mujoco>)";
}

// What the cable is and does at d, by the places and speeds of its sites.
struct Route {
  std::vector<double> along, slip, theta;  // of a segment; of the contact before it

  Route(const mjModel* m, const mjData* d) : along(3 * (m->nsite - 1)) {
    const int n = static_cast<int>(m->nsite);
    slip.resize(n), theta.resize(n);
    for (int k = n - 2; k >= 0; --k) {
      double* const line = along.data() + 3 * k;
      double near[6], far[6];
      mju_sub3(line, d->site_xpos + 3 * (k + 1), d->site_xpos + 3 * k), mju_normalize3(line);
      mj_objectVelocity(m, d, mjOBJ_SITE, k, near, 0);
      mj_objectVelocity(m, d, mjOBJ_SITE, k + 1, far, 0);
      slip[k] = slip[k + 1] - mju_dot3(far + 3, line) + mju_dot3(near + 3, line);
      if (k + 2 < n) theta[k + 1] = std::acos(mju_dot3(line, line + 3));
    }
  }
  int contacts() const { return static_cast<int>(slip.size()) - 2; }
  // Sum of ρ of the contacts if the cable runs with the speed u, but for one of them.
  double Sum(double u, double mu, int but = 0) const {
    double sum = 0;
    for (int k = 1; k <= contacts(); ++k)
      sum -= k == but ? 0 : (slip[k] + u > 0 ? mu : -mu) * theta[k];
    return sum;
  }
  // The contact that the cable does not slide over, by bisection for Sum = 0.
  int AtRest(double mu) const {
    double low = -100, high = 100;
    for (int i = 0; i < 100; ++i) {
      const double u = (low + high) / 2;
      (Sum(u, mu) > 0 ? low : high) = u;
    }
    int rest = 1;
    for (int k = 1; k <= contacts(); ++k) {
      if (std::abs(slip[k] + low) < std::abs(slip[rest] + low)) rest = k;
    }
    return rest;
  }
  double Slowest(int rest) const {
    double least = 1e9;
    for (int k = 1; k <= contacts(); ++k) {
      if (k != rest) least = std::min(least, std::abs(slip[k] - slip[rest]));
    }
    return least;
  }
};

// −Σ (T_k − T_0) dL_k/dq, one contact at rest.
std::vector<double> FrictionOf(const mjModel* m, const mjData* d, const Route& route, double mu,
                               double base, int rest) {
  std::vector<double> force(m->nv), jacobian(3 * m->nv), pull(m->nv);
  double tension = base;
  for (int k = 1; k <= route.contacts(); ++k) {
    const double own = (route.slip[k] > route.slip[rest] ? -mu : mu) * route.theta[k];
    tension *= std::exp(k == rest ? -route.Sum(-route.slip[rest], mu, rest) : own);
    for (const int end : {k, k + 1}) {
      mj_jacSite(m, d, jacobian.data(), nullptr, end);
      mju_mulMatTVec(pull.data(), jacobian.data(), route.along.data() + 3 * k, 3,
                     static_cast<int>(m->nv));
      mju_addToScl(force.data(), pull.data(), (end == k ? 1 : -1) * (tension - base),
                   static_cast<int>(m->nv));
    }
  }
  return force;
}

// Against tensions by a search for the speed with which the cable runs along itself.
TEST_F(BothEnds, OnRandomRoutesTensionsFollowFromTheSpeedOfTheCableAndTakeEnergyOnly) {
  std::mt19937 random(5);
  const auto uniform = [&] { return 2 * std::generate_canonical<double, 53>(random) - 1; };
  int checked = 0;
  for (int state = 0; state < 1000; ++state) {
    const auto m =
        Model("<mujoco>" +
              Instance("capstan", Key("tendon", "t") + Key("mu", ".4") + Key("driven", "both")) +
              RandomRoute(4 + state % 6, state % 3, uniform));
    const auto d = Data(m);
    for (int i = 0; i < m->nv; ++i) d->qpos[i] = .2 * uniform(), d->qvel[i] = uniform();
    d->ctrl[0] = 10;
    mj_forward(m.get(), d.get());
    EXPECT_LE(mju_dot(d->qfrc_passive, d->qvel, static_cast<int>(m->nv)), 1e-9);
    const Route route(m.get(), d.get());
    const int rest = route.AtRest(.4);
    if (route.Slowest(rest) < .02) continue;  // on fresh data these need not slide in full
    ++checked;
    const auto due = FrictionOf(m.get(), d.get(), route, .4, 10, rest);
    for (int i = 0; i < m->nv; ++i) EXPECT_NEAR(d->qfrc_passive[i], due[i], 2e-6) << state;
  }
  EXPECT_GT(checked, 500);
}

// A sprung load at 20 and 5 N in turn. Reversals are of first order in the step, with one driven
// end too (3 % of what friction does, at 2 ms).
TEST_F(BothEnds, FastTensionMovesTheLoadAsSmallStepsSay) {
  const auto lifted = [&](double h, double mu) {
    Loop loop;
    loop.step = h, loop.left = 1.2, loop.right = .8, loop.mu = mu;
    const auto m = Model(Xml(loop));
    m->jnt_stiffness[0] = 2000, m->dof_damping[0] = 20;
    const auto d = Data(m);
    double sum = 0;
    int n = 0;
    for (; d->time < 1; mj_step(m.get(), d.get())) {
      d->ctrl[0] = static_cast<int>((d->time + 1e-7) / .01) % 2 ? 20 : 5;
      if (d->time > .5) sum += d->qpos[0], ++n;
    }
    return sum / n;
  };
  const double due = lifted(2e-5, kMu), friction = lifted(2e-5, 0) - due;
  EXPECT_GT(friction, 5e-4);
  for (const double h : {5e-4, 1e-3, 2e-3}) EXPECT_NEAR(lifted(h, kMu), due, .07 * friction) << h;
}

// What pulls is a length limit here, at both ends alike.
TEST_F(BothEnds, ALengthLimitPullsAtBothEnds) {
  Loop loop;
  loop.actuator = "", loop.tendon = R"(limited="true" range="0 10" solreflimit=".005 1")";
  const auto m = Model(Xml(loop));
  const auto d = Data(m);
  d->qvel[0] = -.05;  // it falls into the limit
  RunUntil(m, d, 2);
  const double held = d->qpos[0];
  EXPECT_NEAR(d->sensordata[0] + d->sensordata[1], kWeight, 1e-3);
  EXPECT_GT(d->sensordata[2], kWeight / 2 * std::exp(-kMu * mjPI / 2) - 1e-3);
  EXPECT_LT(d->sensordata[2], kWeight / 2 * std::exp(kMu * mjPI / 2) + 1e-3);
  RunUntil(m, d, 12);
  EXPECT_NEAR(d->qpos[0], held, 1e-7);
}

}  // namespace
}  // namespace continuum
