#include <cmath>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>

#include "effects/pcc_segment.h"
#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kLinks = 3;

class Segment : public testing::Engine {
 protected:
  struct Options {
    std::string config = Key("body", "base link3") + Key("actuator", "p1 p2 p3");
    std::string p1 = R"(<general name="p1" joint="l1" gear="0"/>)";
    std::string flags;    // in <option>
    bool turned = false;  // link frames a quarter turn about z from their parents
    bool delta = true;    // the sensor
    std::string place = "0 0 .043333333333";  // of a link on the one before; in all L0
    std::string more;                         // instances
  };

  // The segment's own numbers, where the configuration has no others.
  static std::string Complete(std::string config) {
    for (const Param& param : PccSegmentLaw::kParams) {
      const std::string name(param.name);
      if (config.find("key=\"" + name + "\"") != config.npos) continue;
      std::ostringstream value;
      value << std::setprecision(17) << param.initial;
      config += Key(name, value.str());
    }
    return config;
  }

  // Three links, the base upside down; each stretches, then bends about x and y.
  static std::string Arm(const Options& o) {
    std::string bodies, close;
    for (int k = 1; k <= kLinks; ++k) {
      const std::string i = std::to_string(k);
      bodies += "<body name=\"link" + i + "\" pos=\"" + o.place + "\"" +
                (o.turned ? " quat=\"1 0 0 1\"" : "") +
                "><inertial pos=\"0 0 0\" mass=\".05\" diaginertia=\"1e-4 1e-4 1e-4\"/>"
                "<joint name=\"l" +
                i + "\" type=\"slide\" axis=\"0 0 1\"/>" + "<joint name=\"x" + i +
                "\" axis=\"1 0 0\"/><joint name=\"y" + i + "\" axis=\"0 1 0\"/>";
      close += "</body>";
    }
    return "<mujoco><option timestep=\"1e-3\">" + o.flags + "</option>" +
           Instance("pcc_segment", Complete(o.config)) + o.more +
           "<worldbody><body name=\"base\" quat=\"0 1 0 0\">" + bodies + close +
           "</body><body name=\"aside\"/></worldbody><actuator>" + o.p1 +
           R"(<general name="p2" joint="l1" gear="0" forcelimited="true" forcerange="0 50000"/>
              <general name="p3" joint="l1" gear="0" ctrllimited="true" ctrlrange="0 75000"/>
              <motor name="motor" joint="l1"/></actuator>)" +
           (o.delta
                ? R"(<sensor><plugin name="delta" plugin="continuum.pcc_segment" instance="i"/></sensor>)"
                : "") +
           "</mujoco>";
  }
  static std::string Error(const std::string& config) {
    Options options;
    options.config = config;
    const auto [model, error] = Compile(Arm(options));
    EXPECT_FALSE(model) << config;
    return error;
  }
  static PccSegmentLaw::Params<double> Table() {
    PccSegmentLaw::Params<double> p;
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = PccSegmentLaw::kParams[i].initial;
    return p;
  }
  static void Scatter(const testing::Owned<mjModel>& m, const testing::Owned<mjData>& d) {
    std::mt19937 rng(3);
    std::normal_distribution<double> n;
    for (int i = 0; i < m->nv; ++i) {
      d->qpos[i] = (i % kLinks == 0 ? 0.002 : 0.05) * n(rng);
      d->qvel[i] = (i % kLinks == 0 ? 0.02 : 0.5) * n(rng);
    }
    d->ctrl[0] = 3e4, d->ctrl[1] = 6e4, d->ctrl[2] = 8e4;  // p2 and p3 are limited
  }
};

TEST_F(Segment, JointsFeelTheLawThroughTheTransposedMapOfTheirSums) {
  const auto m = Model(Arm({}));
  const auto d = Data(m);
  Scatter(m, d);
  mj_forward(m.get(), d.get());
  Vec<double, 3> delta{}, rate{};
  for (int k = 0; k < kLinks; ++k) {
    for (const auto& [sum, q] : {std::pair{&delta, d->qpos}, {&rate, d->qvel}}) {
      (*sum)[0] += 0.05 * q[3 * k + 2];
      (*sum)[1] -= 0.05 * q[3 * k + 1];
      (*sum)[2] += q[3 * k];
    }
  }
  const auto force = PccSegmentLaw::Eval<double>(delta, rate, {3e4, 5e4, 7.5e4}, 0, Table());
  for (int k = 0; k < kLinks; ++k) {
    EXPECT_NEAR(d->qfrc_passive[3 * k], force[2], 1e-12);
    EXPECT_NEAR(d->qfrc_passive[3 * k + 1], -0.05 * force[1], 1e-13);
    EXPECT_NEAR(d->qfrc_passive[3 * k + 2], 0.05 * force[0], 1e-13);
  }
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(d->sensordata[i], delta[i], 1e-15);
  for (int i = 0; i < m->nv; ++i) EXPECT_EQ(d->qfrc_actuator[i], 0);
}

TEST_F(Segment, FramesOfLinksMayBeTurnedAboutTheArm) {
  const auto a = Model(Arm({}));
  Options options;
  options.turned = true;
  const auto b = Model(Arm(options));
  const auto da = Data(a), db = Data(b);
  // The first link's y is −x of the base, its x is +y; all others stay at rest.
  da->qpos[1] = 0.1, da->qpos[2] = 0.2;
  db->qpos[1] = 0.2, db->qpos[2] = -0.1;
  for (const auto* pair : {&da, &db}) (*pair)->ctrl[0] = 3e4;
  mj_forward(a.get(), da.get());
  mj_forward(b.get(), db.get());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(da->sensordata[i], db->sensordata[i], 1e-15);
  EXPECT_NEAR(da->qfrc_passive[1], -db->qfrc_passive[2], 1e-14);
  EXPECT_NEAR(da->qfrc_passive[2], db->qfrc_passive[1], 1e-14);
}

TEST_F(Segment, PressureInChamberOneBendsTowardXAndLengthens) {
  const auto m = Model(Arm({}));
  const auto d = Data(m);
  d->ctrl[0] = 4e4;
  mj_forward(m.get(), d.get());
  EXPECT_GT(d->qacc[3 * (kLinks - 1) + 2], 0);
  EXPECT_GT(d->qfrc_passive[0], 0);
}

// Links that turn freely against each other share one spring: their sum rings with the energy that
// the body stores, and loses what its damping takes.
TEST_F(Segment, EnergyIsKeptButForTheDamping) {
  for (const double damping : {0.0, 0.5}) {
    Options options;
    options.config +=
        Key("d_theta", std::to_string(damping)) + Key("d_dL", std::to_string(damping));
    options.flags = "<flag energy=\"enable\"/>";
    const auto m = Model(Arm(options));
    m->opt.integrator = mjINT_RK4;
    m->opt.timestep = 1e-4;
    const auto d = Data(m);
    Scatter(m, d);
    std::fill_n(d->ctrl, m->nu, 0.0);
    const auto energy = [&] {
      mj_forward(m.get(), d.get());
      const auto p = Table();
      const double* const x = d->sensordata;
      return d->energy[0] + d->energy[1] + 0.5 * p[8] * (x[0] * x[0] + x[1] * x[1]) +
             0.5 * p[10] * x[2] * x[2] + 0.25 * p[11] * std::pow(x[2], 4);
    };
    double lost = 0, rate[2] = {};
    const double begin = energy();
    for (int k = 0; k < 1000; ++k) {
      double power = 0, delta[3];
      mju_copy3(delta, d->sensordata);
      for (int c = 0; c < 3; ++c) {
        double v = 0;
        for (int i = 0; i < kLinks; ++i) {
          v += c == 0   ? 0.05 * d->qvel[3 * i + 2]
               : c == 1 ? -0.05 * d->qvel[3 * i + 1]
                        : d->qvel[3 * i];
        }
        power += damping * v * v;
      }
      rate[k % 2] = power;
      lost += 1e-4 * power * (k == 0 ? 0.5 : 1);
      mj_step(m.get(), d.get());
    }
    // The trapezoidal rule misses 1e-4 of the loss and half its last value.
    EXPECT_NEAR(begin - energy(), lost - 0.5e-4 * rate[1], damping > 0 ? 2e-3 * lost : 1e-9);
  }
}

TEST_F(Segment, WithoutSpringsAndDampersItIsSilent) {
  Options options;
  options.flags = "<flag spring=\"disable\" damper=\"disable\"/>";
  const auto m = Model(Arm(options));
  const auto d = Data(m);
  Scatter(m, d);
  mj_forward(m.get(), d.get());
  for (int i = 0; i < m->nv; ++i) EXPECT_EQ(d->qfrc_passive[i], 0);
}

TEST_F(Segment, BadInputSaysWhichKeyAndWhatWasFound) {
  const std::string body = Key("body", "base link3"), chambers = Key("actuator", "p1 p2 p3");
  EXPECT_THAT(Error(chambers),
              HasSubstr("continuum.pcc_segment 'i': body: expected 2 names, found 0"));
  EXPECT_THAT(Error(Key("body", "base link9") + chambers),
              HasSubstr("no body 'link9' in the model"));
  EXPECT_THAT(Error(Key("body", "link3 base") + chambers),
              HasSubstr("expected 'base' on a chain of bodies that begins at 'link3'"));
  EXPECT_THAT(Error(Key("body", "base aside") + chambers),
              HasSubstr("found one that begins at 'aside'"));
  EXPECT_THAT(Error(Key("body", "world base") + chambers), HasSubstr("joints between them"));
  EXPECT_THAT(Error(body + Key("actuator", "p1 p2")),
              HasSubstr("actuator: expected 3 names, found 2"));
  EXPECT_THAT(Error(body + Key("actuator", "p1 p2 p3 p1")), HasSubstr("expected 3 names, found 4"));
  EXPECT_THAT(Error(body + Key("actuator", "p1 p2 p2")), HasSubstr("different names"));
  EXPECT_THAT(Error(body + Key("actuator", "p1 p2 p4")), HasSubstr("no actuator 'p4'"));
  EXPECT_THAT(
      Error(body + Key("actuator", "p1 p2 motor")),
      AllOf(HasSubstr("actuator 'motor': expected gear=\"0\""), HasSubstr("found '1 0 0 ")));
  EXPECT_THAT(Error(body + chambers + Key("L0", "0")),
              HasSubstr("L0: expected a finite number in ]0"));
  EXPECT_THAT(Error(body + chambers + Key("L0", "-.1")), HasSubstr("found '-.1'"));
  EXPECT_THAT(Error(body + chambers + Key("d", "0")),
              HasSubstr("d: expected a finite number in ]0"));
  EXPECT_THAT(Error(body + chambers + Key("A", "-1e-6")), HasSubstr("A: expected"));
  EXPECT_THAT(Error(body + chambers + Key("k_dL3", "inf")), HasSubstr("k_dL3: expected a finite"));
}

TEST_F(Segment, LinksThatPointAgainstTheBaseAreRefused) {
  Options options;
  options.place = "0 0 -.043333333333";
  const auto [model, error] = Compile(Arm(options));
  EXPECT_FALSE(model);
  EXPECT_THAT(error,
              AllOf(HasSubstr("body 'link1': expected a place beyond its parent along the z"),
                    HasSubstr("found '0 0 -0.0433333' from it")));
}

TEST_F(Segment, AChainThatLeadsNowhereIsRefused) {
  for (const char* place : {"0 0 0", ".013 0 0"}) {
    Options options;
    options.place = place;
    EXPECT_THAT(Compile(Arm(options)).error, HasSubstr("a tip that is beyond its base along"));
  }
}

TEST_F(Segment, ALengthThatIsNotTheChainsIsRefused) {
  const std::string chambers = Key("actuator", "p1 p2 p3");
  EXPECT_THAT(
      Error(Key("body", "base link3") + chambers + Key("L0", ".132")),
      HasSubstr("L0: expected the length of the chain at rest, 0.130000 m, within 1 %, found "
                "'.132'"));
  EXPECT_THAT(Error(Key("body", "base link2") + chambers + Key("L0", ".13")),
              HasSubstr("the chain at rest, 0.086667 m, within 1 %, found '.13'"));
  Options options;
  options.config += Key("L0", ".1312");
  Model(Arm(options));
}

TEST_F(Segment, AChainOfAnotherInstanceIsRefused) {
  Options options;
  options.more = "<extension><plugin plugin=\"continuum.pcc_segment\"><instance name=\"j\">" +
                 Key("body", "link1 link3") + Key("actuator", "p1 p2 p3") +
                 "</instance></plugin></extension>";
  const auto [model, error] = Compile(Arm(options));
  EXPECT_FALSE(model);
  EXPECT_THAT(error, HasSubstr("continuum.pcc_segment 'j': body: expected a chain that no other "
                               "instance acts on, found 'link1 link3', of which "
                               "continuum.pcc_segment 'i' has 'base link3'"));
  Options series;
  series.config = Key("body", "base link1") + Key("actuator", "p1 p2 p3") + Key("L0", ".0433");
  series.more = options.more;
  Model(Arm(series));
}

TEST_F(Segment, AControlThatIsNoPressureIsRefused) {
  for (const std::string type : {"integrator", "muscle"}) {
    Options options;
    options.p1 = "<general name=\"p1\" joint=\"l1\" gear=\"0\" dyntype=\"" + type + "\"/>";
    const auto [model, error] = Compile(Arm(options));
    EXPECT_FALSE(model) << type;
    EXPECT_THAT(error,
                AllOf(HasSubstr("actuator 'p1': expected dyntype none, filter or filterexact"),
                      HasSubstr("dyntype=\"" + type + "\"")));
  }
}

TEST_F(Segment, AGainOrLagBelowZeroOrOfNoNumberIsRefused) {
  for (const std::string line :
       {"gainprm=\"nan\"", "gainprm=\"-1\"", "dyntype=\"filter\" dynprm=\"-0.007\"",
        "dyntype=\"filter\" dynprm=\"nan\"", "biastype=\"affine\" biasprm=\"inf\""}) {
    Options options;
    options.p1 = "<general name=\"p1\" joint=\"l1\" gear=\"0\" " + line + "/>";
    const auto [model, error] = Compile(Arm(options));
    EXPECT_FALSE(model) << line;
    EXPECT_THAT(error, HasSubstr("actuator 'p1'")) << line;
  }
}

TEST_F(Segment, ASupplyBelowAVacuumOrWithoutEndIsRefused) {
  for (const std::string range : {"ctrllimited=\"true\" ctrlrange=\"-200000 75000\"",
                                  "forcelimited=\"true\" forcerange=\"-101400 75000\"",
                                  "ctrllimited=\"true\" ctrlrange=\"0 inf\""}) {
    Options options;
    options.p1 = "<general name=\"p1\" joint=\"l1\" gear=\"0\" " + range + "/>";
    const auto [model, error] = Compile(Arm(options));
    EXPECT_FALSE(model) << range;
    EXPECT_THAT(error, HasSubstr("actuator 'p1'"));
    EXPECT_THAT(error, HasSubstr("of finite gauge pressures from -101325 Pa on"));
  }
}

TEST_F(Segment, OnlyHingesAcrossAndSlidesAlongTheArmBelongToIt) {
  for (const std::string joint :
       {"type=\"hinge\" axis=\"0 0 1\"", "type=\"slide\" axis=\"1 0 0\""}) {
    std::string xml = Arm({});
    const std::string old = "type=\"slide\" axis=\"0 0 1\"";
    xml.replace(xml.find(old, xml.find("name=\"l2\"")), old.size(), joint);
    const auto [model, error] = Compile(xml);
    EXPECT_FALSE(model) << joint;
    EXPECT_THAT(error,
                HasSubstr("joint 'l2': expected a hinge across or a slide along the z axis"));
    EXPECT_THAT(error, HasSubstr(joint[6] == 'h' ? "a hinge joint along '"
                                                 : "a slide joint along '1 0 0'"));
  }
}

TEST_F(Segment, ItsSensorBelongsToNoObject) {
  Options options;
  options.delta = false;
  std::string xml = Arm(options);
  xml.insert(xml.find("</mujoco>"),
             "<sensor><plugin plugin=\"continuum.pcc_segment\" instance=\"i\" objtype=\"body\" "
             "objname=\"link3\"/></sensor>");
  const auto [model, error] = Compile(xml);
  EXPECT_FALSE(model);
  EXPECT_THAT(error, HasSubstr("expected no object, found body 'link3'"));
}

}  // namespace
}  // namespace continuum
