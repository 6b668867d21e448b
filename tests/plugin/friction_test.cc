#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "effects/all.h"
#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

constexpr double kTauMu = 0.0314, kTauC = 0.0413, kS = 0.7472, kVd = 0.2994;
constexpr double kBreakaway = kTauC * (1 + kS);

class Friction : public testing::Engine {
 protected:
  // One flywheel of 0.02 kg m^2 about x, torque by a motor; gravity does no work.
  static std::string Wheel(const std::string& effect, const std::string& config,
                           const std::string& option = "", const std::string& joint = "",
                           bool motor = true) {
    return "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\" " + option + "/>" +
           Instance(effect, Key("joint", "q") + config) +
           "<worldbody><body name=\"wheel\"><joint name=\"q\" axis=\"1 0 0\" " + joint +
           "/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"0.02 0.02 "
           "0.02\"/></body></worldbody>" +
           (motor ? "<actuator><motor joint=\"q\"/></actuator>" : "") + "</mujoco>";
  }
  static std::string TableThree() {
    return Key("tau_mu", "0.0314") + Key("tau_c", "0.0413") + Key("S", "0.7472") +
           Key("v_d", "0.2994");
  }
};

class Integrators : public Friction, public ::testing::WithParamInterface<const char*> {
 protected:
  static std::string Option() { return std::string("integrator=\"") + GetParam() + "\""; }
  static std::string Model1() {
    std::string xml = Wheel("stribeck", TableThree());
    xml.replace(xml.find("integrator=\"implicitfast\""), 25, Option());
    return xml;
  }
};
INSTANTIATE_TEST_SUITE_P(All, Integrators,
                         ::testing::Values("Euler", "RK4", "implicitfast", "implicit"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(Integrators, HoldsBelowBreakawayWithoutCreep) {
  const auto m = Model(Model1());
  for (const double share : {-0.95, 0.5, 0.95}) {
    const auto d = Data(m);
    d->ctrl[0] = share * kBreakaway;
    RunUntil(m, d, 1);
    const double start = d->qpos[0];
    RunUntil(m, d, 61);
    EXPECT_LT(std::abs(d->qpos[0] - start), 1e-6);
    EXPECT_LT(std::abs(start), 1e-4);  // presliding
  }
}

TEST_P(Integrators, BreaksAwayAtTheStaticLevel) {
  const auto m = Model(Model1());
  const auto d = Data(m);
  const double start = 0.9 * kBreakaway, rate = 0.002;  // N m, N m/s
  while (std::abs(d->qvel[0]) < 1e-3 && d->time < 20) {
    d->ctrl[0] = start + rate * d->time;
    mj_step(m.get(), d.get());
  }
  // Past the level the wheel needs sqrt(2 I v/rate) = 0.14 s to 1 mrad/s: 3e-4 N m.
  EXPECT_NEAR(d->ctrl[0], kBreakaway, 0.01 * kBreakaway);
}

const Vec<double, 5> kTableThree{kTauMu, kTauC, kS, kVd, 1};

// Reference: the same wheel with sgn(v), by classical Runge-Kutta at 10 us; it never reverses.
double Reference(double torque, double t_end) {
  double v = 0, q = 0;
  const double h = 1e-5;
  const auto f = [&](double w) {
    return (torque - kTauMu * w - Stribeck::Level(FrictionState<double>{0, w, 0}, kTableThree)) /
           0.02;
  };
  for (double t = 0; t < t_end - h / 2; t += h) {
    const double a = f(v), b = f(v + h / 2 * a), c = f(v + h / 2 * b), e = f(v + h * c);
    q += h * (v + h / 6 * (a + b + c));
    v += h / 6 * (a + 2 * b + 2 * c + e);
  }
  return q;
}

TEST_P(Integrators, SlidesAsTheStiffReference) {
  for (const auto& [h, tolerance] : {std::tuple{2e-3, 0.02}, std::tuple{5e-4, 0.005}}) {
    const auto m = Model(Model1());
    m->opt.timestep = h;
    const auto d = Data(m);
    d->ctrl[0] = 1.2 * kBreakaway;
    RunUntil(m, d, 2);
    const double exact = Reference(1.2 * kBreakaway, 2);
    EXPECT_NEAR(d->qpos[0], exact, tolerance * exact);
  }
}

// The torque changes with the model's steps. Reference: steps of 5 us in which friction stops the
// wheel or takes off what it can.
TEST_P(Integrators, ReversesAsTheStiffReference) {
  constexpr double kFine = 5e-6, kInertia = 0.02;
  for (const auto& [h, tolerance] : {std::tuple{2e-3, 0.02}, std::tuple{5e-4, 0.005}}) {
    const auto m = Model(Model1());
    m->opt.timestep = h;
    const auto d = Data(m);
    double q = 0, v = 0, worst = 0, most = 0;
    while (d->time < 2) {
      d->ctrl[0] = 3 * kBreakaway * std::sin(2 * M_PI * d->time);
      for (double t = 0; t < h - kFine / 2; t += kFine) {
        const double level = Stribeck::Level(FrictionState<double>{0, v, 0}, kTableThree),
                     free = v + kFine / kInertia * (d->ctrl[0] - kTauMu * v),
                     stop = level * kFine / kInertia,
                     after = std::copysign(std::max(0.0, std::abs(free) - stop), free);
        q += kFine * (v + after) / 2, v = after;
      }
      mj_step(m.get(), d.get());
      worst = std::max(worst, std::abs(d->qpos[0] - q)), most = std::max(most, std::abs(q));
    }
    EXPECT_LT(worst, tolerance * most) << h;
  }
}

// A spring k and dry friction τ_c take 2 τ_c/k off the amplitude in every half swing, and hold what
// is left once it is within τ_c/k: 0.53 − 6·0.0826 rad.
TEST_P(Integrators, HoldsTheOffsetThatIsLeftOfASwing) {
  std::string xml = Wheel("coulomb", Key("tau_c", "0.0413"), "", "stiffness=\"1\"");
  xml.replace(xml.find("integrator=\"implicitfast\""), 25, Option());
  for (const auto& [h, tolerance] : {std::tuple{2e-3, 0.01}, std::tuple{5e-4, 0.0025}}) {
    const auto m = Model(xml);
    m->opt.timestep = h;
    const auto d = Data(m);
    d->qpos[0] = 0.53;
    RunUntil(m, d, 10);
    const double offset = 0.53 - 6 * 0.0826;
    EXPECT_NEAR(d->qpos[0], offset, tolerance * offset) << h;
    const double held = d->qpos[0];
    RunUntil(m, d, 70);
    EXPECT_NEAR(d->qpos[0], held, 1e-6);
  }
}

TEST_F(Friction, HoldsWithoutAnyActuator) {
  const auto m = Model(Wheel("stribeck", TableThree(), "", "", /*motor=*/false));
  const auto d = Data(m);
  d->qfrc_applied[0] = 0.9 * kBreakaway;
  RunUntil(m, d, 61);
  EXPECT_LT(std::abs(d->qpos[0]), 1e-4);
}

TEST_F(Friction, UnderDiscreteCreepsAtMostByTheStatedRate) {
  std::string xml = Wheel("stribeck", TableThree());
  xml.replace(xml.find("integrator=\"implicitfast\""), 25, "integrator=\"discrete\"");
  const auto m = Model(xml);
  const auto d = Data(m);
  d->ctrl[0] = 0.5 * kBreakaway;
  RunUntil(m, d, 1);
  const double start = d->qpos[0];
  RunUntil(m, d, 11);
  EXPECT_LT(std::abs(d->qpos[0] - start), 2e-4 * 10);
}

TEST_F(Friction, TwoEffectsOnOneJointAddUp) {
  std::string xml = Wheel("coulomb", Key("tau_c", "0.03"));
  xml.insert(xml.find("</extension>"),
             "<plugin plugin=\"continuum.load_friction\"><instance name=\"j\">" +
                 Key("joint", "q") + Key("tau_c", "0.02") + Key("mu_l", "0") +
                 "</instance></plugin>");
  const auto m = Model(xml);
  const auto d = Data(m);
  d->ctrl[0] = 0.0495;
  RunUntil(m, d, 20);
  EXPECT_LT(std::abs(d->qpos[0]), 1e-4);
  d->ctrl[0] = 0.0505;
  RunUntil(m, d, 25);
  EXPECT_GT(std::abs(d->qpos[0]), 0.1);
}

// Every dry friction of the list, with all of its parameters at work.
struct Law {
  std::string name, config;
};
std::vector<Law> Laws() {
  std::vector<Law> laws;
  All::ForEach([&]<class E>() {
    if constexpr (FrictionLaw<E>) {
      Law law{std::string(E::kName), ""};
      for (const Param& p : E::kParams) {
        if constexpr (requires { E::kGive; }) {
          if (p.name == E::kParams[E::kGive].name) continue;  // only where it is alone
        }
        const double value = p.initial != 0 ? p.initial : 0.003;
        law.config +=
            "<config key=\"" + std::string(p.name) + "\" value=\"" + std::to_string(value) + "\"/>";
      }
      laws.push_back(law);
    }
  });
  return laws;
}

TEST_F(Friction, OfEveryPairOnOneJointAddsUpInLevelAndDamping) {
  struct Drag {
    double level, damping;
  };
  const auto drag = [](const std::vector<Law>& on, double q, double v) {
    std::string xml = Wheel("coulomb", "");
    const std::size_t begin = xml.find("<extension>"), end = xml.find("</extension>");
    std::string all = "<extension>";
    for (std::size_t i = 0; i < on.size(); ++i) {
      all += "<plugin plugin=\"continuum." + on[i].name + "\"><instance name=\"i" +
             std::to_string(i) + "\">" + Key("joint", "q") + on[i].config + "</instance></plugin>";
    }
    const auto m = Model(xml.replace(begin, end - begin, all));
    const auto d = Data(m);
    d->qpos[0] = q, d->qvel[0] = v, d->ctrl[0] = 0.02;
    mj_forward(m.get(), d.get());
    return Drag{d->efc_frictionloss[0], m->dof_damping[0]};
  };
  const auto laws = Laws();
  EXPECT_GE(laws.size(), 5);
  for (const Law& a : laws) {
    for (const Law& b : laws) {
      for (const auto& [q, v] : {std::pair{0.0, 0.0}, {0.4, 0.2}, {-0.7, -0.3}}) {
        const Drag both = drag({a, b}, q, v), one = drag({a}, q, v), other = drag({b}, q, v);
        EXPECT_NEAR(both.level, one.level + other.level, 1e-15) << a.name << " and " << b.name;
        EXPECT_NEAR(both.damping, one.damping + other.damping, 1e-15) << a.name << ", " << b.name;
      }
    }
  }
}

// An instance of Stribeck friction besides the one of Wheel.
std::string AndStribeck(std::string xml, const std::string& config) {
  return xml.insert(xml.find("</extension>"),
                    "<plugin plugin=\"continuum.stribeck\"><instance name=\"j\">"
                    "<config key=\"joint\" value=\"q\"/>" +
                        config + "</instance></plugin>");
}

TEST_F(Friction, TwoStribecksMoveAsOneOfTheirSum) {
  const auto config = [](double share) {
    return Key("tau_mu", std::to_string(share * 0.03)) +
           Key("tau_c", std::to_string(share * 0.04)) + Key("S", "0.7") + Key("v_d", "0.3");
  };
  const auto path = [](const std::string& xml) {
    const auto m = Model(xml);
    const auto again = Data(m), d = Data(m);  // a second mjData finds the damping already there
    d->ctrl[0] = 0.1;
    RunUntil(m, d, 1);
    d->ctrl[0] = 0;
    RunUntil(m, d, 2);
    return d->qpos[0];
  };
  const double one = path(Wheel("stribeck", config(1)));
  EXPECT_GT(one, 0.1);
  EXPECT_NEAR(path(AndStribeck(Wheel("stribeck", config(0.7)), config(0.3))), one, 1e-12);
}

TEST_F(Friction, DampingOfTheMjcfIsTheSumOfTheLawsOrNone) {
  const auto with = [](const std::string& damping) {
    return AndStribeck(Wheel("stribeck", TableThree(), "", damping), Key("tau_mu", "0.02"));
  };
  EXPECT_NEAR(Model(with(""))->dof_damping[0], kTauMu + 0.02, 1e-15);
  Model(with("damping=\"0.0514\""));
  EXPECT_THAT(Compile(with("damping=\"0.0314\"")).error,
              HasSubstr("joint 'q': expected native damping 0 or equal to tau_mu = 0.0514"));
}

TEST_F(Friction, NativeFrictionlossIsKeptAndAddedTo) {
  const auto m = Model(Wheel("coulomb", Key("tau_c", "0.03"), "", "frictionloss=\"0.02\""));
  const auto d = Data(m);
  mj_forward(m.get(), d.get());
  EXPECT_DOUBLE_EQ(d->efc_frictionloss[0], 0.05);
}

// A pendulum held by its servo: the gear carries m g l. Level = tau_c + mu_l * load.
TEST_F(Friction, LoadGrowsWithTheTorqueThroughTheGear) {
  const auto build = [](const std::string& load) {
    return "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\"/>" +
           Instance("load_friction", Key("joint", "q") + Key("tau_c", "0.01") + Key("mu_l", "0.2") +
                                         Key("load", load)) +
           R"(<worldbody><body><joint name="q" axis="0 1 0"/>
              <inertial pos="0.1 0 0" mass="0.5" diaginertia="1e-4 1e-4 1e-4"/></body></worldbody>
              <actuator><motor joint="q"/></actuator></mujoco>)";
  };
  const double gravity = 0.5 * 9.81 * 0.1;  // about +y, pulls the mass down
  for (const double torque : {0.0, -0.3, -gravity, 0.4}) {
    const auto m = Model(build("transmitted"));
    const auto d = Data(m);
    d->ctrl[0] = torque;
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->efc_frictionloss[0], 0.01 + 0.2 * 0.5 * std::abs(torque - gravity), 1e-12);
    const auto m2 = Model(build("actuator"));
    const auto d2 = Data(m2);
    d2->ctrl[0] = torque;
    mj_forward(m2.get(), d2.get());
    EXPECT_NEAR(d2->efc_frictionloss[0], 0.01 + 0.2 * std::abs(torque), 1e-12);
  }
}

TEST_F(Friction, PositionFrictionFollowsTheAngle) {
  const auto m = Model(
      Wheel("position_friction", Key("tau_c", "0.03") + Key("c", "0.02") + Key("s", "-0.05")));
  const auto d = Data(m);
  for (const double q : {0.0, 0.7, 1.6, -2.0}) {
    d->qpos[0] = q;
    mj_forward(m.get(), d.get());
    EXPECT_NEAR(d->efc_frictionloss[0],
                std::max(0.0, 0.03 + 0.02 * std::cos(q) - 0.05 * std::sin(q)), 1e-15);
  }
}

TEST_F(Friction, ABallJointHoldsAndSlides) {
  const std::string xml =
      "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
      Instance("stribeck", Key("joint", "q") + TableThree()) +
      R"(<worldbody><body><joint name="q" type="ball"/>
         <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.03 0.04"/></body></worldbody></mujoco>)";
  const auto m = Model(xml);
  const auto d = Data(m);
  d->qfrc_applied[0] = 0.7 * kBreakaway;
  d->qfrc_applied[2] = -0.7 * kBreakaway;
  RunUntil(m, d, 1);
  const double w = d->qpos[0];
  RunUntil(m, d, 61);
  EXPECT_NEAR(d->qpos[0], w, 1e-9);
  EXPECT_GT(d->qpos[0], 1 - 1e-8);
  d->qfrc_applied[1] = 1.5 * kBreakaway;
  RunUntil(m, d, 62);
  EXPECT_GT(std::abs(d->qvel[1]), 0.5);
}

TEST_F(Friction, ABallJointBreaksAwayAtTheSameTorqueInAllDirections) {
  const auto m =
      Model("<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\" gravity=\"0 0 0\"/>" +
            Instance("stribeck", Key("joint", "q") + TableThree()) +
            R"(<worldbody><body><joint name="q" type="ball"/>
         <inertial pos="0 0 0" mass="1" diaginertia="0.02 0.02 0.02"/></body></worldbody></mujoco>)");
  for (int k = 1; k < 27; ++k) {
    const double way[3] = {k % 3 - 1.0, k / 3 % 3 - 1.0, k / 9 - 1.0};
    const double length = mju_norm3(way);
    if (length == 0) continue;
    for (const double share : {0.98, 1.02}) {
      const auto d = Data(m);
      for (int i = 0; i < 3; ++i) d->qfrc_applied[i] = share * kBreakaway * way[i] / length;
      RunUntil(m, d, 5);
      const double turned = 2 * std::acos(std::min(1.0, std::abs(d->qpos[0])));
      if (share < 1)
        EXPECT_LT(turned, 1e-4) << way[0] << way[1] << way[2];
      else
        EXPECT_GT(turned, 0.1) << way[0] << way[1] << way[2];
    }
  }
}

TEST_F(Friction, ATendonHoldsALoadOnItsRow) {
  const std::string xml =
      "<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\"/>" +
      Instance("coulomb", Key("tendon", "t") + Key("tau_c", "10")) +
      R"(<worldbody><body><joint name="x" type="slide" axis="0 0 1"/><geom size=".1" mass="1"/>
         </body></worldbody><tendon><fixed name="t"><joint joint="x" coef="1"/></fixed></tendon>
         </mujoco>)";
  const auto m = Model(xml);
  const auto d = Data(m);
  RunUntil(m, d, 1);
  const double x = d->qpos[0];
  RunUntil(m, d, 61);
  EXPECT_LT(std::abs(d->qpos[0] - x), 1e-6);
}

TEST_F(Friction, StribeckDampingIsNativeAndMustNotContradictTheJoint) {
  const auto m = Model(Wheel("stribeck", TableThree()));
  EXPECT_EQ(m->dof_damping[0], kTauMu);
  Model(Wheel("stribeck", TableThree(), "", "damping=\"0.0314\""));
  EXPECT_THAT(Compile(Wheel("stribeck", TableThree(), "", "damping=\"0.1\"")).error,
              HasSubstr("joint 'q': expected native damping 0 or equal to tau_mu"));
}

// Solvers in the dual space keep a matrix of their own, in one form for each form of the Jacobian.
TEST_F(Friction, EverySolverSwingsAndStopsAlike) {
  const auto swing = [](const std::string& option) {
    const auto m = Model("<mujoco><option timestep=\"2e-3\" integrator=\"implicitfast\" " + option +
                         "/>" + Instance("coulomb", Key("joint", "*") + Key("tau_c", "1")) +
                         R"(<worldbody><body><joint name="a" axis="0 1 0"/>
        <geom type="capsule" size=".02" fromto="0 0 0 .3 0 0"/><body pos=".3 0 0">
        <joint name="b" axis="0 1 0"/><geom type="capsule" size=".02" fromto="0 0 0 .3 0 0"/>
        </body></body></worldbody></mujoco>)");
    const auto d = Data(m);
    RunUntil(m, d, 3);
    EXPECT_LT(std::abs(d->qvel[0]), 1e-6) << option;
    return d->qpos[0];
  };
  const double newton = swing("");
  for (const std::string solver : {"PGS", "CG", "Newton\" noslip_iterations=\"3"}) {
    for (const std::string jacobian : {"dense", "sparse"}) {
      const std::string option = "solver=\"" + solver + "\" jacobian=\"" + jacobian + "\"";
      EXPECT_NEAR(swing(option), newton, 1e-4) << option;
    }
  }
}

TEST_F(Friction, WarnsWhereItIsWeakOrAbsent) {
  static std::string warning;
  mju_user_warning = [](const char* text) { warning = text; };
  const auto weak = [](const std::string& effect, const std::string& config) {
    std::string xml = Wheel(effect, config);  // warnings come once for a name
    return xml.replace(xml.find("name=\"i\""), 8, "name=\"weak\"");
  };
  std::string xml = weak("coulomb", "");
  xml.replace(xml.find("integrator=\"implicitfast\""), 25, "integrator=\"discrete\"");
  Data(Model(xml));
  EXPECT_THAT(warning, HasSubstr("discrete"));
  xml = weak("coulomb", "");
  xml.replace(xml.find("/>"), 2, "><flag frictionloss=\"disable\"/></option>");
  Data(Model(xml));
  EXPECT_THAT(warning, HasSubstr("frictionloss"));
  Data(Model(weak("stribeck", Key("k_v", "500"))));
  EXPECT_THAT(warning, HasSubstr("k_v does nothing"));
  mju_user_warning = [](const char*) {};
}

}  // namespace
}  // namespace continuum
