// Cables over sites, wrapped geoms and pulleys, pulled by whatever pulls: bands of breakaway after
// Euler and Eytelwein, forces against an evaluation of their own, wrenches against the balance of
// forces.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

constexpr double kWeight = 10;  // of the load [N]

class CableRoute : public testing::Engine {
 protected:
  // A load of 1 kg on a slide under a corner, which the cable turns by a right angle; the other end
  // of the cable is at (-0.5, 0, 1).
  struct Rig {
    std::string corner = "site", config = Key("mu", "0.3");
    std::string end = R"(<site name="end" pos="-.5 0 1"/>)", tendon = {}, actuator = {}, more = {},
                sensor = {}, joint = "damping=\"1\"", body = {};
    double step = 1e-3;
    bool reversed = false;
  };
  static std::string Xml(const Rig& rig) {
    const std::string drum = R"(<site name="side" pos=".2 0 1.15"/><geom name="drum" contype="0"
        conaffinity="0" size=".05" )";
    std::string world = R"(<site name="corner" pos="0 0 1"/>)", path = R"(<site site="corner"/>)";
    std::string x = "0";
    if (rig.corner != "site") {
      world =
          drum + (rig.corner == "sphere" ? R"(type="sphere" pos="0 0 .95"/>)"
                                         : R"(type="cylinder" fromto="0 -.05 .95 0 .05 .95"/>)");
      path = R"(<geom geom="drum" sidesite="side"/>)", x = ".05";
    }
    path = rig.reversed ? R"(<site site="load"/>)" + path + R"(<site site="end"/>)"
                        : R"(<site site="end"/>)" + path + R"(<site site="load"/>)";
    return "<mujoco>" + Instance("capstan", Key("tendon", "t") + rig.config) +
           fmt::format(R"(<option timestep="{}" integrator="implicitfast" gravity="0 0 -10"/>
      <worldbody>{}{}<body pos="{} 0 .5" {}><joint name="z" type="slide" axis="0 0 1" {}/>
        <geom size=".02" mass="1" contype="0" conaffinity="0"/><site name="load"/></body>
      </worldbody><tendon><spatial name="t" {}>{}</spatial></tendon><actuator>{}</actuator>{}
      <sensor>{}</sensor></mujoco>)",
                       rig.step, world, rig.end, x, rig.body, rig.joint, rig.tendon, path,
                       rig.actuator, rig.more, rig.sensor);
  }
  // How far the load has moved up after 0.8 s of a pull [m].
  static double Moved(const Rig& rig, double pull) {
    const auto m = Model(Xml(rig));
    if (!m) return std::nan("");
    const auto d = Data(m);
    while (d->time < .8) {
      if (m->nu > 0) d->ctrl[0] = kWeight + (pull - kWeight) * std::min(1.0, d->time / .1);
      mj_step(m.get(), d.get());
    }
    return d->qpos[m->jnt_qposadr[mj_name2id(m.get(), mjOBJ_JOINT, "z")]];
  }
  // A load W over the angle θ rests for pulls in W exp(±μθ), within 1 %. A limit gives way by up to
  // 0.2 mm as its tension grows; the slowest of these loads has moved by 1 mm.
  template <class RigOf>
  static void ExpectBand(RigOf&& rig_of, double band, const std::string& what) {
    for (const double side : {-1., 1.}) {
      const double edge = kWeight * std::exp(side * band);
      const double held = edge * std::exp(-side * .01), moved = edge * std::exp(side * .01);
      EXPECT_LT(std::abs(Moved(rig_of(held), held)), 3e-4) << what << ", side " << side;
      EXPECT_GT(side * Moved(rig_of(moved), moved), 5e-4) << what << ", side " << side;
    }
  }
};

constexpr const char* kMotor = R"(<motor tendon="t" gear="-1"/>)";

TEST_F(CableRoute, ALoadBreaksAwayAsEytelweinSaysOverSitesCylindersAndSpheres) {
  for (const std::string corner : {"site", "cylinder", "sphere"}) {
    for (const double h : {5e-4, 2e-3}) {
      for (const double mu : {.1, .6}) {
        Rig rig{corner, Key("mu", std::to_string(mu))};
        rig.actuator = kMotor, rig.step = h;
        ExpectBand([&](double) { return rig; }, mu * mjPI / 2, corner + fmt::format(" {} s", h));
      }
    }
  }
}

// Two branches, each with half of the tension: the load hangs on the second, behind a corner.
TEST_F(CableRoute, ABranchBehindAPulleyCarriesTheTensionByItsDivisor) {
  const auto moved = [](double pull) {
    const auto m = Model("<mujoco>" + Instance("capstan", Key("tendon", "t") + Key("mu", "0.3")) +
                         R"(<option timestep=".001" integrator="implicitfast" gravity="0 0 -10"/>
      <worldbody><site name="a" pos="0 1 1"/><site name="b" pos="0 2 1"/>
        <site name="end" pos="-.5 0 1"/><site name="corner" pos="0 0 1"/>
        <body pos="0 0 .5"><joint type="slide" axis="0 0 1" damping="1"/>
        <geom size=".02" mass="1" contype="0" conaffinity="0"/><site name="load"/></body></worldbody>
      <tendon><spatial name="t"><site site="a"/><site site="b"/><pulley divisor="2"/>
        <site site="end"/><site site="corner"/><site site="load"/></spatial></tendon>
      <actuator><motor tendon="t" gear="-1"/></actuator></mujoco>)");
    const auto d = Data(m);
    while (d->time < .4) {
      d->ctrl[0] = 2 * (kWeight + (pull - kWeight) * std::min(1.0, d->time / .1));
      mj_step(m.get(), d.get());
    }
    return d->qpos[0];
  };
  for (const double side : {-1., 1.}) {
    const double edge = kWeight * std::exp(side * .3 * mjPI / 2);
    EXPECT_LT(std::abs(moved(edge * std::exp(-side * .01))), 1e-4);
    EXPECT_GT(side * moved(edge * std::exp(side * .01)), 1e-3);
  }
}

// A straight branch has the tension of the tendon, those behind it by their divisor.
TEST_F(CableRoute, ABranchWithoutContactsIsDrawnAndReadLikeTheOthers) {
  const auto read = [](const char* site) {
    return fmt::format(
        R"(<plugin plugin="continuum.capstan" instance="i" objtype="site" objname="{}"/>)", site);
  };
  const auto m = Model("<mujoco>" + Instance("capstan", Key("tendon", "t") + Key("mu", "0.3")) +
                       R"(<worldbody><site name="a" pos="0 1 1"/><site name="b" pos="0 2 1"/>
        <site name="end" pos="-.5 0 1"/><site name="corner" pos="0 0 1"/>
        <site name="fixed" pos="0 0 0"/></worldbody>
      <tendon><spatial name="t"><site site="a"/><site site="b"/><pulley divisor="2"/>
        <site site="end"/><site site="corner"/><site site="fixed"/><pulley divisor="4"/>
        <site site="corner"/><site site="b"/></spatial></tendon>
      <actuator><motor tendon="t" gear="-1"/></actuator><sensor>)" +
                       read("a") + read("end") + "</sensor></mujoco>");
  const auto d = Data(m);
  d->ctrl[0] = 12;
  mj_step(m.get(), d.get());
  EXPECT_DOUBLE_EQ(d->sensordata[0], 12);
  EXPECT_DOUBLE_EQ(d->sensordata[1], 6);
}

// The red of what lies on a drum or a ball, from its pulled side to the load's.
TEST_F(CableRoute, OnAGeomTheColourFadesFromOneTensionToTheOther) {
  for (const std::string corner : {"cylinder", "sphere"}) {
    Rig rig{corner};
    rig.actuator = kMotor;
    const auto m = Model(Xml(rig));
    const auto d = Data(m);
    d->ctrl[0] = 20;
    RunUntil(m, d, .1);  // the load goes up
    mjvScene scene;
    mjv_defaultScene(&scene), mjv_makeScene(m.get(), &scene, 100);
    mjp_getPluginAtSlot(m->plugin[0])->visualize(m.get(), d.get(), nullptr, &scene, 0);
    std::vector<float> red;
    for (const mjvGeom& piece : std::span(scene.geoms, static_cast<std::size_t>(scene.ngeom))) {
      const double radius = std::hypot(piece.pos[0], piece.pos[2] - .95);
      if (radius > .051) continue;
      EXPECT_NEAR(radius, .05, 5e-4) << corner;
      red.push_back(piece.rgba[0]);
    }
    mjv_freeScene(&scene);
    ASSERT_GT(red.size(), 5u);
    EXPECT_TRUE(std::is_sorted(red.rbegin(), red.rend()));
    EXPECT_NEAR(red.front(), .93, .03);
    EXPECT_NEAR(red.back(), .13 + .8 * std::exp(-.3 * mjPI / 2), .03);
  }
}

TEST_F(CableRoute, TheSpringOfATendonPullsAgainstFriction) {
  ExpectBand(
      [](double pull) {
        Rig rig;
        rig.tendon = fmt::format(R"(stiffness="100" springlength="0 {}")", 1 - pull / 100);
        return rig;
      },
      .3 * mjPI / 2, "spring");
}

// The attribute damping of an actuator resists whatever the actuator gives: its drum holds a load
// that falls at v by gear² b v before the corner, and by more behind it.
TEST_F(CableRoute, TheDamperOfAnActuatorHoldsAFallingLoad) {
  for (const double gear : {1., 2.}) {
    Rig rig;
    rig.joint = "", rig.step = 5e-4;
    rig.actuator = fmt::format(R"(<motor tendon="t" gear="{}" damping="40"/>)", gear);
    const auto m = Model(Xml(rig));
    const auto d = Data(m);
    RunUntil(m, d, .4);
    const double speed = kWeight * std::exp(-.3 * mjPI / 2) / (gear * gear * 40);
    EXPECT_NEAR(d->qvel[0], -speed, 1e-6 * speed) << "gear " << gear;
  }
}

// MuJoCo leaves out the gravity compensation of actuators where there are none: the load has its
// whole weight, and friction holds it.
TEST_F(CableRoute, WithoutActuatorsNothingCompensatesGravity) {
  ExpectBand(
      [](double pull) {
        Rig rig;
        rig.joint += R"( actuatorgravcomp="true")", rig.body = R"(gravcomp="1")";
        rig.tendon = fmt::format(R"(stiffness="100" springlength="0 {}")", 1 - pull / 100);
        return rig;
      },
      .3 * mjPI / 2, "not compensated");
}

std::string Winch(const std::string& body) {
  return R"(<body pos="-.5 0 1"><joint name="w" type="slide" axis="-1 0 0" damping="1"/>
      <geom size=".02" mass=")" +
         body + R"(" contype="0" conaffinity="0"/><site name="end"/></body>)";
}

// μθ = 1.6 hands on up to five times the tension: no step may multiply an error by as much.
TEST_F(CableRoute, AWinchAtEitherEndPullsThroughTheLengthLimit) {
  for (const bool reversed : {false, true}) {
    for (const auto& [mass, mu] : {std::pair{".1", .3}, {"5", .3}, {".1", 1.}, {"5", 1.}}) {
      Rig rig{"site", Key("mu", std::to_string(mu))};
      rig.end = Winch(mass), rig.reversed = reversed;
      rig.tendon = R"(limited="true" range="0 1" solreflimit=".005 1")";
      rig.actuator = R"(<motor joint="w"/>)";
      ExpectBand([&](double) { return rig; }, mu * mjPI / 2,
                 fmt::format("winch of {} kg, mu {}, reversed {}", mass, mu, reversed));
    }
  }
}

TEST_F(CableRoute, AnEqualityPullsLikeALimit) {
  Rig rig;
  rig.end = Winch(".1"), rig.actuator = R"(<motor joint="w"/>)";
  rig.more = R"(<equality><tendon tendon1="t" solref=".005 1"/></equality>)";
  ExpectBand([&](double) { return rig; }, .3 * mjPI / 2, "equality");
}

// Forces of the law from points, tensions and Jacobians of their own.
TEST_F(CableRoute, ForcesAreThoseOfTheTensionsAtTheTangentPoints) {
  for (const std::string geom :
       {R"(type="sphere" size=".04")", R"(type="cylinder" size=".04 .1" euler="60 20 0")"}) {
    const auto m = Model("<mujoco>" + Instance("capstan", Key("tendon", "t") + Key("mu", "0.4")) +
                         R"(<worldbody><site name="a" pos="0 .06 .3"/><body><freejoint/>
        <geom name="g" )" +
                         std::string(geom) + R"(/>
        <body pos="0 0 -.2"><joint axis="1 0 0"/><geom size=".02" pos="0 0 -.05"/>
          <site name="b" pos=".01 .05 0"/></body></body><site name="s" pos="0 .2 0"/></worldbody>
      <tendon><spatial name="t"><site site="a"/><geom geom="g" sidesite="s"/><site site="b"/>
      </spatial></tendon><actuator><motor tendon="t" gear="-1"/></actuator></mujoco>)");
    for (const double v : {-1., 1.}) {
      const auto d = Data(m);
      d->qpos[0] = .01, d->qpos[1] = .08, d->qpos[2] = .02;  // the path passes the geom
      d->qvel[6] = v, d->ctrl[0] = .02;
      mj_forward(m.get(), d.get());
      ASSERT_GE(d->wrap_obj[1], 0) << geom;
      const double *a = d->wrap_xpos, *p = a + 3, *q = a + 6, *b = a + 9;
      double u[3], w[3], axis[3], from[3], to[3];
      mju_sub3(u, p, a), mju_normalize3(u), mju_sub3(w, b, q), mju_normalize3(w);
      const int id = mj_name2id(m.get(), mjOBJ_GEOM, "g");
      // the angle by the length of the path: what is not straight lies on the geom
      const double arc = d->ten_length[0] - mju_dist3(a, p) - mju_dist3(q, b);
      for (int i = 0; i < 3; ++i) axis[i] = d->geom_xmat[9 * id + 3 * i + 2];
      mju_sub3(from, p, d->geom_xpos + 3 * id), mju_sub3(to, q, d->geom_xpos + 3 * id);
      const double pitch = m->geom_type[id] == mjGEOM_CYLINDER ? mju_dot3(u, axis) : 0;
      const double theta = arc * (1 - pitch * pitch) / .04;
      ASSERT_GT(theta, .1);
      // pays out or in, seen from the geom: dL of the straight part behind it
      std::vector<double> due(m->nv), jac(3 * m->nv), far(m->nv), near(m->nv);
      mj_jac(m.get(), d.get(), jac.data(), nullptr, b,
             m->site_bodyid[mj_name2id(m.get(), mjOBJ_SITE, "b")]);
      mju_mulMatTVec(far.data(), jac.data(), w, 3, static_cast<int>(m->nv));
      mj_jac(m.get(), d.get(), jac.data(), nullptr, q, m->geom_bodyid[id]);
      mju_mulMatTVec(near.data(), jac.data(), w, 3, static_cast<int>(m->nv));
      double rate = 0;
      for (int i = 0; i < m->nv; ++i) rate += (far[i] - near[i]) * d->qvel[i];
      ASSERT_GT(std::abs(rate), .02);
      const double tension = .02 * std::exp((rate > 0 ? 1 : -1) * .4 * theta);
      for (int i = 0; i < m->nv; ++i) {
        due[i] = -(tension - .02) * (far[i] - near[i]);
        EXPECT_NEAR(d->qfrc_passive[i], due[i], 1e-9) << geom << " dof " << i;
      }
    }
  }
}

// Where one hole ends and the next begins the cable has no direction of its own.
TEST_F(CableRoute, SitesThatCoincideBendTheCableAsOneDoes) {
  for (const std::string gap : {"0 0", "1e-16 0", "1e-12 1e-12"}) {
    for (const std::string path :
         {"end corner twin load", "corner twin load", "twin corner load"}) {
      const bool turned = path.starts_with("twin"), whole = path.starts_with("end");
      const std::string pair = turned ? R"(<site site="twin"/><site site="corner"/>)"
                                      : R"(<site site="corner"/><site site="twin"/>)";
      const auto m = Model("<mujoco>" + Instance("capstan", Key("tendon", "t") + Key("mu", "0.3")) +
                           R"(<option gravity="0 0 0"/><worldbody><site name="end" pos="0 -.5 1"/>
        <site name="corner" pos="0 0 1"/><site name="twin" pos=")" +
                           gap + R"( 1"/><body pos="0 0 .5"><joint type="slide" axis="0 0 1"/>
        <geom size=".02" mass="1" contype="0"/><site name="load"/></body></worldbody>
        <tendon><spatial name="t">)" +
                           (whole ? R"(<site site="end"/>)" : "") + pair +
                           R"(<site site="load"/></spatial></tendon>
        <actuator><motor tendon="t" gear="-1"/></actuator></mujoco>)");
      const auto d = Data(m);
      d->ctrl[0] = 12, d->qvel[0] = .1;
      mj_forward(m.get(), d.get());
      const double theta = whole ? mjPI / 2 : 0;
      EXPECT_NEAR(d->qacc[0], 12 * std::exp(-.3 * theta), 1e-6) << path << " " << gap;
    }
  }
}

TEST_F(CableRoute, TensionIsReadableAtSitesAndGeomsAndUnchangedWhereAGeomIsNotTouched) {
  const auto sensor = [](const char* type, const char* name) {
    return fmt::format(
        R"(<plugin plugin="continuum.capstan" instance="i" objtype="{}" objname="{}"/>)", type,
        name);
  };
  for (const std::string geom : {"sphere", "cylinder"}) {
    Rig rig{geom};
    rig.actuator = kMotor;
    rig.sensor = sensor("site", "end") + sensor("geom", "drum") + sensor("site", "load");
    const auto m = Model(Xml(rig));
    for (const double v : {-.1, .1}) {
      const auto d = Data(m);
      d->ctrl[0] = 12, d->qvel[0] = v;
      mj_forward(m.get(), d.get());
      const double due = 12 * std::exp((v > 0 ? -.3 : .3) * mjPI / 2);
      EXPECT_NEAR(d->sensordata[0], 12, 1e-9);
      EXPECT_NEAR(d->sensordata[1], due, 1e-6);
      EXPECT_NEAR(d->sensordata[2], due, 1e-6);
    }
    const auto d = Data(m);
    d->ctrl[0] = 12, d->qvel[0] = .1;
    d->qpos[0] = .6;  // the straight line passes above
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->sensordata[1], 12, 1e-9) << geom;
  }
}

TEST_F(CableRoute, AWrenchIsTheBalanceOfWeightAndTrueCableForces) {
  for (const double pull : {8., 12.}) {
    const auto m = Model(fmt::format(R"(<mujoco><extension><plugin plugin="continuum.capstan">
        <instance name="i">{}</instance></plugin><plugin plugin="continuum.wrench">
        <instance name="w"/></plugin></extension>
      <option timestep=".001" integrator="implicitfast" gravity="0 0 -10"/><worldbody>
        <site name="end" pos="-.5 0 1"/><body name="post" pos="0 0 .8"><site name="foot"/>
          <geom size=".01" mass=".1" contype="0" conaffinity="0"/><site name="corner" pos="0 0 .2"/>
        </body><body pos="0 0 .5"><joint type="slide" axis="0 0 1" damping="1"/>
          <geom size=".02" mass="1" contype="0" conaffinity="0"/><site name="load"/></body>
      </worldbody><tendon><spatial name="t"><site site="end"/><site site="corner"/>
        <site site="load"/></spatial></tendon><actuator><motor tendon="t" gear="-1"/></actuator>
      <sensor><plugin plugin="continuum.wrench" instance="w" objtype="site" objname="foot"/>
        <force site="foot"/></sensor></mujoco>)",
                                     Key("tendon", "t") + Key("mu", "0.3")));
    const auto d = Data(m);
    d->ctrl[0] = pull;
    RunUntil(m, d, .5);
    mj_forward(m.get(), d.get());
    ASSERT_LT(std::abs(d->qpos[0]), 1e-4);
    // The cable pulls the corner toward the end by `pull` and down by the weight that it holds.
    const double tension = kWeight + d->qacc[0] + d->qvel[0];
    const double due[6] = {pull, 0, 1 + tension, 0, .2 * pull, 0};
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(d->sensordata[i], due[i], 1e-6) << i;
    EXPECT_NEAR(d->sensordata[8], 1 + pull, 1e-6);  // MuJoCo's does not know the friction
  }
}

TEST_F(CableRoute, OfAGlobFixedTendonsAreLeftOutButByTheirNameRefused) {
  const auto xml = [](const std::string& tendon) {
    return "<mujoco>" + Instance("capstan", Key("tendon", tendon) + Key("mu", "0.3")) +
           R"(<worldbody><site name="a"/><site name="b" pos=".1 0 0"/><body><joint name="j"/>
      <geom size=".1"/><site name="c" pos=".1 .1 0"/></body></worldbody><tendon>
      <fixed name="f"><joint joint="j" coef="1"/></fixed>
      <spatial name="t"><site site="a"/><site site="b"/><site site="c"/></spatial></tendon></mujoco>)";
  };
  EXPECT_TRUE(Model(xml("*")));
  const auto [m, error] = Compile(xml("f t"));
  EXPECT_FALSE(m);
  EXPECT_THAT(error, HasSubstr("tendon 'f': expected a spatial tendon, found a fixed tendon"));
  const auto [none, why] = Compile(xml("f*"));
  EXPECT_FALSE(none);
  EXPECT_THAT(why, HasSubstr("found a fixed tendon"));
}

// From the tip to the base, pulled at the base: as from the base.
TEST_F(CableRoute, TheDrivenEndIsSaid) {
  for (const double v : {-.1, .1}) {
    std::vector<double> acceleration;
    for (const bool reversed : {false, true}) {
      Rig rig{"cylinder"};
      rig.actuator = kMotor, rig.reversed = reversed;
      rig.config += Key("driven", reversed ? "last" : "first");
      const auto m = Model(Xml(rig));
      const auto d = Data(m);
      d->qvel[0] = v, d->ctrl[0] = 12;
      mj_forward(m.get(), d.get());
      acceleration.push_back(d->qacc[0]);
    }
    EXPECT_NEAR(acceleration[0], acceleration[1], 1e-9);
    EXPECT_NEAR(acceleration[0], 12 * std::exp((v > 0 ? -1 : 1) * .3 * mjPI / 2) - 10 - v, 1e-6);
  }
  Rig rig;
  rig.config += Key("driven", "motor");
  const auto [m, error] = Compile(Xml(rig));
  EXPECT_FALSE(m);
  EXPECT_THAT(error, HasSubstr("driven: expected first | last | both, found 'motor'"));
}

// A load too heavy to be moved runs at given speeds, tight, slack, and at rest: contacts give in
// proportion to what they slid, ρ = −μθ x/give, and forget as much by what they slide when slack.
TEST_F(CableRoute, ASlackCableForgetsByTheSlidingThatFrictionTakesToBuildUp) {
  const double give = 5e-3, band = .3 * mjPI / 2, h = 1e-3;
  Rig rig;
  rig.config += Key("give", std::to_string(give));
  rig.actuator = kMotor, rig.joint = "armature=\"1e12\"";
  rig.sensor = R"(<plugin plugin="continuum.capstan" instance="i" objtype="site" objname="load"/>)";
  const auto m = Model(Xml(rig));
  const auto run = [&](const testing::Owned<mjData>& d, double tension, double distance,
                       int steps) {
    d->ctrl[0] = tension;
    for (int i = 0; i < steps; ++i) {
      d->qvel[0] = distance / (steps * h);
      mj_step(m.get(), d.get());
    }
  };
  for (const double slack : {0., 5e-4, -5e-4, 1.5e-3, -2.5e-3, 4e-3}) {
    const auto d = Data(m);
    run(d, 12, 0, 1);  // fresh
    run(d, 12, 2e-3, 400);
    const double rho = std::log(d->sensordata[0] / 12);
    EXPECT_NEAR(rho, -band * 2e-3 / give, 1e-3);  // the solver's ρ is linear in each step
    run(d, 0, slack, 10);
    EXPECT_EQ(d->sensordata[0], 0);
    run(d, 8, 0, 1);
    const double rest = std::min(0., rho + band * std::abs(slack) / give);
    EXPECT_NEAR(d->sensordata[0], 8 * std::exp(rest), 1e-8) << slack;
  }
}

std::vector<std::string> warnings;

// Sensors of three bodies in a row; the cable leads from the world over the second to the third and
// back to it.
TEST_F(CableRoute, AWarningNamesTheSensorsThatFrictionPassesAndNoOthers) {
  warnings.clear();
  mju_user_warning = [](const char* text) { warnings.emplace_back(text); };
  const auto m = Model("<mujoco>" + Instance("capstan", Key("tendon", "t") + Key("mu", "0.3")) +
                       R"(<worldbody><site name="a" pos="0 0 1"/><body pos="1 0 0"><joint/>
      <geom size=".1"/><site name="b1"/><body pos="1 0 0"><joint/><geom size=".1"/><site name="b2"/>
      <site name="c" pos="0 .1 0"/><body pos="1 0 0"><joint/><geom size=".1"/><site name="b3"/>
      <site name="d" pos="0 .1 0"/><body pos="1 0 0"><joint/><geom size=".1"/><site name="b4"/>
      </body></body></body></body><body pos="0 9 0"><joint/><geom size=".1"/><site name="o"/></body>
      </worldbody><tendon><spatial name="t"><site site="a"/><site site="c"/><site site="d"/>
      <site site="c"/></spatial></tendon><sensor><force name="first" site="b1"/>
      <torque name="second" site="b2"/><force name="third" site="b3"/><torque site="b3"/>
      <force name="fourth" site="b4"/><force name="other" site="o"/></sensor></mujoco>)");
  mju_user_warning = [](const char*) {};
  ASSERT_EQ(warnings.size(), 1U);  // once, not for each mjData
  EXPECT_THAT(warnings[0], HasSubstr("as here 'third', number 3; a sensor of"));
}

// Robots that share no kinematic tree do not couple: one instance for both is one for each. A third
// cable joins the second robot to a third.
TEST_F(CableRoute, OneInstanceOnSeveralRobotsIsOneOnEach) {
  const auto arm = [](const std::string& name, double y, double z) {
    return fmt::format(R"(<site name="{0}0" pos="-.1 {1} {2}"/><site name="{0}1" pos="0 {1} {2}"/>
      <body pos="0 {1} 0"><joint axis="0 1 0" stiffness=".5" damping=".01"/>
        <geom type="capsule" fromto="0 0 0 .1 0 0" size=".01" mass=".05" contype="0"/>
        <site name="{0}2" pos=".05 0 {2}"/><body pos=".1 0 0">
          <joint axis="0 1 0" stiffness=".5" damping=".01"/>
          <geom type="capsule" fromto="0 0 0 .1 0 0" size=".01" mass=".05" contype="0"/>
          <site name="{0}3" pos=".05 0 {2}"/></body></body>)",
                       name, y, z);
  };
  const auto run = [&](const std::string& instances) {
    const auto m = Model("<mujoco><extension><plugin plugin=\"continuum.capstan\">" + instances +
                         R"(</plugin></extension>
      <option timestep=".001" integrator="implicitfast"/><worldbody>)" +
                         arm("a", 0, .02) + arm("b", 1, .02) + arm("c", 1.2, .03) + R"(</worldbody>
      <tendon><spatial name="b"><site site="b0"/><site site="b1"/><site site="b2"/>
          <site site="b3"/></spatial>
        <spatial name="a"><site site="a0"/><site site="a1"/><site site="a2"/><site site="a3"/></spatial>
        <spatial name="c"><site site="b0"/><site site="b1"/><site site="b3"/><site site="c2"/>
          <site site="c3"/></spatial></tendon>
      <actuator><motor tendon="a" gear="-1"/><motor tendon="b" gear="-1"/><motor tendon="c" gear="-1"/>
      </actuator></mujoco>)");
    const auto d = Data(m);
    while (d->time < 1) {
      for (int u = 0; u < 3; ++u) d->ctrl[u] = 2 + 2 * std::sin(7 * d->time + u);
      mj_step(m.get(), d.get());
    }
    return std::vector<double>(d->qpos, d->qpos + m->nq);
  };
  const auto instance = [](const std::string& name, const std::string& tendons) {
    return "<instance name=\"" + name + "\">" + Key("tendon", tendons) + Key("mu", ".3") +
           "</instance>";
  };
  const auto all = run(instance("all", "*")), each = run(instance("x", "a") + instance("y", "b c"));
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(all[i], each[i], 1e-12) << i;
  EXPECT_GT(std::abs(all[0]), .01);
}

}  // namespace
}  // namespace continuum
