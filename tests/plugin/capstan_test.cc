#include <cmath>
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;

class Capstan : public testing::Engine {
 protected:
  // A load on a vertical rail hangs on a cable over two fixed corners of 90 degrees; a second
  // slider is the drum. Pulling the cable toward the drum lifts the load.
  static std::string Crane(double mu, const std::string& more = "", const std::string& load = "1",
                           const std::string& config = "") {
    return "<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\"/>" +
           Instance("capstan", Key("tendon", "cable") + Key("mu", std::to_string(mu)) + config) +
           R"(<worldbody>
             <site name="s0" pos="0 0 0"/><site name="s1" pos="0 0 1"/><site name="s2" pos="1 0 1"/>
             <body pos="1 0 0"><joint name="rail" type="slide" axis="0 0 1" damping="2"/>
               <geom size=".05" mass=")" +
           load + R"("/><site name="s3"/></body>
           </worldbody>
           <tendon><spatial name="cable"><site site="s0"/><site site="s1"/><site site="s2"/>
             <site site="s3"/></spatial></tendon>
           <actuator><motor name="pull" tendon="cable" gear="-1"/></actuator>
           <sensor>
             <plugin name="t0" plugin="continuum.capstan" instance="i" objtype="site" objname="s0"/>
             <plugin name="t1" plugin="continuum.capstan" instance="i" objtype="site" objname="s1"/>
             <plugin name="t2" plugin="continuum.capstan" instance="i" objtype="site" objname="s2"/>
           </sensor>)" +
           more + "</mujoco>";
  }
  static constexpr double kAngle = M_PI / 2;
};

TEST_F(Capstan, FullSlidingFollowsTheExponentialWhateverTheMemory) {
  const auto m = Model(Crane(0.2));
  for (const double memory : {-0.3, 0.0, 0.3}) {
    for (const double v : {0.02, -0.02, 0.5}) {
      const auto d = Data(m);
      d->ctrl[0] = 12;
      d->qvel[0] = v;  // the load rises: pulled
      std::fill_n(d->plugin_state, m->npluginstate, memory);
      mj_forward(m.get(), d.get());
      const double s = v > 0 ? 1 : -1;
      EXPECT_NEAR(d->sensordata[0], 12, 1e-12);
      EXPECT_NEAR(d->sensordata[1], 12 * std::exp(-s * 0.2 * kAngle), 1e-6);
      EXPECT_NEAR(d->sensordata[2], 12 * std::exp(-s * 0.4 * kAngle), 1e-6);
      EXPECT_NEAR(d->qacc[0], d->sensordata[2] - 9.81 - 2 * v, 1e-4);
    }
  }
}

TEST_F(Capstan, CoulombLawTakesTheNormalForceOfTheBend) {
  const auto m = Model(Crane(0.2, "", "1", Key("law", "coulomb")));
  const auto d = Data(m);
  d->ctrl[0] = 12;
  d->qvel[0] = 0.1;
  mj_forward(m.get(), d.get());
  const double t = 0.2 * std::tan(kAngle / 2);
  EXPECT_NEAR(d->sensordata[1], 12 * (1 - t) / (1 + t), 1e-6);
}

TEST_F(Capstan, FrictionVariesWithTheAngle) {
  const auto m = Model(Crane(0.1, "", "1", Key("mu1", "0.05") + Key("mu2", "0.02")));
  const auto d = Data(m);
  d->ctrl[0] = 12;
  d->qvel[0] = 0.1;
  mj_forward(m.get(), d.get());
  const double mu = 0.1 + kAngle * (0.05 + kAngle * 0.02);
  EXPECT_NEAR(d->sensordata[1], 12 * std::exp(-mu * kAngle), 1e-6);
}

TEST_F(Capstan, HoldsALoadInsideTheBandWithoutCreep) {
  for (const double h : {1e-3, 2e-3}) {
    for (const double share : {-0.7, 0.7}) {
      const auto m = Model(Crane(0.2));
      m->opt.timestep = h;
      const auto d = Data(m);
      d->ctrl[0] = 9.81 * std::exp(share * 0.4 * kAngle);
      RunUntil(m, d, 2);
      EXPECT_LT(std::abs(d->qpos[0]), 2e-3) << "h " << h << " share " << share;
      const double settled = d->qpos[0];
      RunUntil(m, d, 12);
      EXPECT_LT(std::abs(d->qpos[0] - settled), 1e-6);
    }
  }
}

TEST_F(Capstan, AStuckContactKeepsItsRatioWhenTheLoadGoes) {
  const auto m = Model(Crane(0.2));
  const auto d = Data(m);
  d->ctrl[0] = 9.81 * std::exp(0.6 * 0.4 * kAngle);
  RunUntil(m, d, 4);
  const double ratio = d->sensordata[2] / d->sensordata[0];
  EXPECT_NEAR(ratio, std::exp(-0.6 * 0.4 * kAngle), 1e-6);
  RunUntil(m, d, 60);
  EXPECT_NEAR(d->sensordata[2] / d->sensordata[0], ratio, 1e-9);
}

TEST_F(Capstan, SlackCableCarriesNothing) {
  const auto m = Model(Crane(0.2));
  const auto plain = Model(Crane(0));
  for (const double pull : {-3.0, 0.0}) {
    const auto d = Data(m);
    const auto e = Data(plain);
    for (const auto& [model, data] : {std::pair{&m, &d}, std::pair{&plain, &e}}) {
      (*data)->ctrl[0] = pull;
      (*data)->qvel[0] = 0.3;
      mj_forward(model->get(), data->get());
      EXPECT_EQ((*data)->sensordata[1], 0);
    }
    EXPECT_EQ(d->qacc[0], e->qacc[0]);
  }
}

TEST_F(Capstan, WithoutFrictionIsExactlyTheNativeModel) {
  const auto m = Model(Crane(0));
  std::string xml = Crane(0);
  xml.erase(xml.find("<extension>"), xml.find("</extension>") + 12 - xml.find("<extension>"));
  xml.erase(xml.find("<sensor>"), xml.find("</sensor>") + 9 - xml.find("<sensor>"));
  const auto native = Model(xml);
  const auto d = Data(m), e = Data(native);
  d->ctrl[0] = e->ctrl[0] = 11;
  RunUntil(m, d, 1), RunUntil(native, e, 1);
  EXPECT_EQ(d->qpos[0], e->qpos[0]);
}

// MuJoCo limits the sum of a tendon's actuator forces before their gears, then each by its own
// range.
TEST_F(Capstan, TheBaseTensionIsThatOfTheNativeTendonWithinItsRanges) {
  struct Case {
    std::string range, actuators;
    std::vector<double> control;
    double expected;
  };
  const std::string one = R"(<motor tendon="cable" gear="-1"/>)",
                    two = R"(<motor tendon="cable" gear="-2"/>)",
                    weak = R"(<motor tendon="cable" gear="-1" forcerange="0 3"/>)";
  for (const auto& [range, actuators, control, expected] :
       {Case{"0 4", one, {10}, 4}, Case{"-3 4", one, {10}, 4}, Case{"-4 4", two, {10}, 8},
        Case{"-4 4", one + two, {10, -2}, 4 * (10 - 4) / 8.},
        Case{"0 5", weak + two, {10, 4}, 3 + 2 * 4 * 5 / 14.}, Case{"0 4", one, {-1}, 0}}) {
    std::string xml = Crane(0.2);
    const std::string motor = R"(<motor name="pull" tendon="cable" gear="-1"/>)";
    xml.replace(xml.find(motor), motor.size(), actuators);
    xml.insert(xml.find("name=\"cable\""),
               "actuatorfrclimited=\"true\" actuatorfrcrange=\"" + range + "\" ");
    const auto m = Model(xml);
    const auto d = Data(m);
    std::copy(control.begin(), control.end(), d->ctrl);
    d->qvel[0] = 0.1;
    mj_forward(m.get(), d.get());
    double native = 0;
    for (int a = 0; a < m->nu; ++a) native -= m->actuator_gear[6 * a] * d->actuator_force[a];
    EXPECT_NEAR(native, expected, 1e-12) << range << actuators;
    EXPECT_NEAR(d->sensordata[0], native, 1e-12) << range << actuators;
  }
}

// From 20 mm/s on, also where friction could stop the load within the step: 0.2 kg.
TEST_F(Capstan, SlidesInFullOnFreshData) {
  for (const char* load : {"1", "0.2"}) {
    const auto m = Model(Crane(0.3, "", load));
    for (const double v : {-1.0, -0.02, 0.02, 1.0}) {
      const auto d = Data(m);
      d->ctrl[0] = 5;
      d->qvel[0] = v;
      mj_forward(m.get(), d.get());
      const double rho = 2 * 0.3 * kAngle * (v > 0 ? -1 : 1);  // upward the cable is paid in
      EXPECT_NEAR(std::log(d->sensordata[2] / 5), rho, 1e-6) << load << " " << v;
    }
  }
}

TEST_F(Capstan, IsAloneOnItsCable) {
  const auto [model, error] = Compile(Crane(
      0.3, "<extension><plugin plugin=\"continuum.capstan\"><instance name=\"second\">" +
               Key("tendon", "cab*") + Key("mu", "0.1") + "</instance></plugin></extension>"));
  EXPECT_FALSE(model);
  EXPECT_THAT(error, ::testing::HasSubstr("one instance on a cable"));
}

// Friction opposes the speed that the step ends with.
TEST_F(Capstan, NeverCreatesEnergy) {
  for (const char* load : {"1", "0.01", "1e-4"}) {
    const auto m = Model(Crane(0.3, "", load));
    m->opt.integrator = mjINT_RK4;  // its acceleration is that of the step, without damping in M
    const auto d = Data(m);
    d->ctrl[0] = 5;
    for (int k = 0; k < 200; ++k) {
      d->qvel[0] = 0.3 * std::sin(0.7 * k);
      mj_forward(m.get(), d.get());
      const double after = d->qvel[0] + m->opt.timestep * d->qacc[0];
      EXPECT_LE((d->sensordata[2] - d->sensordata[0]) * after, 1e-12) << load << " " << k;
    }
  }
}

TEST_F(Capstan, NamesWhatItCannotUse) {
  std::string xml = Crane(0.2);
  xml.replace(xml.find("objname=\"s1\""), 12, "objname=\"far\"");
  xml.insert(xml.find("<site name=\"s0\""), "<site name=\"far\"/>");
  EXPECT_THAT(Compile(xml).error, HasSubstr("a site or wrapped geom of the tendons"));
}

// Blue at 0, red at the largest tension so far.
TEST_F(Capstan, ColoursFitTheTensionsOfTheCable) {
  const auto m = Model(Crane(0.2));
  const auto d = Data(m);
  mjvScene scene;
  mjv_defaultScene(&scene);
  mjv_makeScene(m.get(), &scene, 100);
  const auto red = [&](double pull) {
    d->ctrl[0] = pull, d->qvel[0] = 0.1;
    mj_forward(m.get(), d.get());
    scene.ngeom = 0;
    mjp_getPluginAtSlot(m->plugin[0])->visualize(m.get(), d.get(), nullptr, &scene, 0);
    return std::vector{scene.geoms[0].rgba[0], scene.geoms[1].rgba[0]};
  };
  const auto share = [](double of) {
    return FloatNear(static_cast<float>(0.13 + 0.8 * of), 1e-6f);
  };
  const double behind = std::exp(-0.2 * kAngle);
  EXPECT_THAT(red(120), ElementsAre(share(1), share(behind)));
  EXPECT_THAT(red(60), ElementsAre(share(0.5), share(behind / 2)));
  mjv_freeScene(&scene);
}

TEST_F(Capstan, NeedsAContact) {
  const auto compiled = Compile("<mujoco>" + Instance("capstan", Key("tendon", "cable")) +
                                R"(<worldbody><site name="a" pos="0 0 1"/>
    <body><joint type="slide"/><geom size=".1"/><site name="b"/></body></worldbody>
  <tendon><spatial name="cable"><site site="a"/><site site="b"/></spatial></tendon></mujoco>)");
  EXPECT_FALSE(compiled.model);
  EXPECT_THAT(compiled.error,
              HasSubstr("continuum.capstan 'i': tendon 'cable': expected a contact"));
  EXPECT_THAT(compiled.error, HasSubstr("found 2 sites"));
}

}  // namespace
}  // namespace continuum
