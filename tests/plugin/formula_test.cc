#include <cmath>
#include <string>
#include <vector>

#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

// A wheel of 0.02 kg m^2 on a hinge, with one effect and a motor.
class Formula : public testing::Engine {
 protected:
  static constexpr double kInertia = 0.02;

  static std::string Wheel(const std::string& effect, const std::string& config) {
    return "<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\"/>" +
           Instance(effect, Key("joint", "q") + config) +
           "<worldbody><body><joint name=\"q\" axis=\"1 0 0\"/>"
           "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"0.02 0.02 0.02\"/></body></worldbody>"
           "<actuator><motor joint=\"q\"/></actuator></mujoco>";
  }
  // The value of a formula at one state, as the torque that the wheel does not feel.
  static double Value(const std::string& formula, double q, double v) {
    const auto m = Model(Wheel("formula", Key("force", formula) + Key("p1", "0.5")));
    const auto d = Data(m);
    d->qpos[0] = q, d->qvel[0] = v;
    mj_forward(m.get(), d.get());
    return -kInertia * d->qacc[0];
  }
  // A message at the key that holds all of these.
  static void Refuses(const char* formula, const std::vector<const char*>& parts) {
    const auto compiled = Compile(Wheel("formula", Key("force", formula)));
    EXPECT_FALSE(compiled.model) << formula;
    EXPECT_THAT(compiled.error, HasSubstr("continuum.formula 'i': force")) << formula;
    for (const char* const part : parts) EXPECT_THAT(compiled.error, HasSubstr(part)) << formula;
  }
  // Angles under a swing of the motor.
  static std::vector<double> Swing(const std::string& effect, const std::string& config) {
    const auto m = Model(Wheel(effect, config));
    const auto d = Data(m);
    std::vector<double> angles;
    for (int k = 0; k < 3000; ++k) {
      d->ctrl[0] = 0.1 * std::sin(5e-3 * k) + 0.05 * std::sin(1.7e-3 * k);
      mj_step(m.get(), d.get());
      angles.push_back(d->qpos[0]);
    }
    return angles;
  }
};

TEST_F(Formula, FollowsTheRulesOfArithmetic) {
  const double q = 0.3, v = -0.7;
  const struct {
    const char* text;
    double value;
  } cases[] = {
      {"2 + 3*4 - 6/2/3", 13},
      {"-2^2", -4},
      {"2^-1", 0.5},
      {"2^3^2", 512},
      {"(1 - -2)*--3", 9},
      {"1e-2 + .5 + 2.", 2.51},
      {"p1*v*abs(v)", 0.5 * v * std::abs(v)},
      {"p2 + p8", 0},
      {"sin(q)^2 + cos(q)^2", 1},
      {"where(v, 1, 2) + 10*where(q, 1, 2)", 12},
      {"min(q, v) + 10*max(q, v) + 100*sign(v)", v + 10 * q - 100},
      {"exp(log(q)) + sqrt(q*q) + tan(atan(q))", 3 * q},
      {"tanh(q) + atan2(v, q) + pow(q, 2)", std::tanh(q) + std::atan2(v, q) + q * q},
      {"a = q*q; b = a + v; a*b + pi", q * q * (q * q + v) + 3.14159265358979},
  };
  for (const auto& c : cases) EXPECT_NEAR(Value(c.text, q, v), c.value, 1e-12) << c.text;
}

TEST_F(Formula, WrittenAsALawOfTheListMovesAsThatLaw) {
  EXPECT_EQ(Swing("formula", Key("force", "s = q*q; p1*s*q") + Key("p1", "0.8")),
            Swing("cubic_stiffness", Key("k3", "0.8")));
  EXPECT_EQ(Swing("formula_friction", Key("level", "p1") + Key("p1", "0.03")),
            Swing("coulomb", Key("tau_c", "0.03")));
  EXPECT_EQ(Swing("formula_friction",
                  Key("level", "p1 + p2*load") + Key("p1", "0.01") + Key("p2", "0.2")),
            Swing("load_friction", Key("tau_c", "0.01") + Key("mu_l", "0.2")));
}

TEST_F(Formula, ActsOnATendonAlongItsLength) {
  const auto m = Model("<mujoco>" +
                       Instance("formula", Key("tendon", "cable") + Key("force", "p1*q + p2*v") +
                                               Key("p1", "30") + Key("p2", "2")) +
                       R"(<worldbody><site name="a"/>
    <body pos="0 0 -1"><joint type="slide" axis="0 0 1"/><geom size="0.1" mass="2"/>
      <site name="b"/></body></worldbody>
  <tendon><spatial name="cable"><site site="a"/><site site="b"/></spatial></tendon></mujoco>)");
  const auto d = Data(m);
  d->qvel[0] = -0.5;  // it lengthens
  mj_forward(m.get(), d.get());
  EXPECT_NEAR(2 * (d->qacc[0] + 9.81), 30 * 1 + 2 * 0.5, 1e-9);
}

// Two wheels that hang on eccentric weights, with a motor each.
class FormulaOfMore : public testing::Engine {
 protected:
  static std::string Arms(const std::string& instance) {
    return "<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\"/>" + instance +
           R"(<worldbody>
  <body><joint name="hip" axis="0 1 0"/>
    <inertial pos="0 0 -0.1" mass="2" diaginertia="0.02 0.02 0.02"/></body>
  <body pos="1 0 0"><joint name="knee" axis="0 1 0"/>
    <inertial pos="0 0 -0.2" mass="1" diaginertia="0.02 0.02 0.02"/></body></worldbody>
  <actuator><motor joint="hip" gear="3"/><motor joint="knee"/></actuator></mujoco>)";
  }
  // What the joints feel of an instance at one state.
  static std::vector<double> Felt(const std::string& joints, const std::string& force,
                                  const std::string& more = "") {
    const auto with =
        Model(Arms(Instance("formula", Key("joint", joints) + Key("force", force) + more)));
    const auto without = Model(Arms(""));
    std::vector<double> felt;
    for (const auto* const m : {&with, &without}) {
      const auto d = Data(*m);
      d->time = 0.5;
      d->qpos[0] = 0.3, d->qpos[1] = -0.4, d->qvel[0] = 0.7, d->qvel[1] = -1.1;
      d->ctrl[0] = 0.2, d->ctrl[1] = -0.6;
      mj_forward(m->get(), d.get());
      for (int i = 0; i < 2; ++i) {
        const double inertia = i == 0 ? 0.02 + 2 * 0.01 : 0.02 + 0.04;
        if (m == &with) felt.push_back(inertia * d->qacc[i]);
        if (m == &without) felt[static_cast<std::size_t>(i)] -= inertia * d->qacc[i];
      }
    }
    return felt;
  }
};

TEST_F(FormulaOfMore, KnowsMotorWeightAndTime) {
  EXPECT_NEAR(Felt("hip", "motor")[0], -0.6, 1e-12);
  EXPECT_NEAR(Felt("knee", "motor*q")[1], -0.6 * 0.4, 1e-12);
  EXPECT_NEAR(Felt("hip", "weight")[0], 2 * 9.81 * 0.1 * std::sin(0.3), 1e-9);
  EXPECT_NEAR(Felt("knee", "abs(weight)*v")[1], 9.81 * 0.2 * std::sin(0.4) * 1.1, 1e-9);
  EXPECT_NEAR(Felt("hip", "p1*time", Key("p1", "2"))[0], -1, 1e-12);
}

TEST_F(FormulaOfMore, KnowsOtherJoints) {
  EXPECT_NEAR(Felt("hip", "q[knee]")[0], 0.4, 1e-12);
  EXPECT_NEAR(Felt("hip", "q*v[knee]")[0], 0.3 * 1.1, 1e-12);
  const auto both = Felt("hip knee", "p1*q[other]", Key("p1", "5"));
  EXPECT_NEAR(both[0], 5 * 0.4, 1e-12);
  EXPECT_NEAR(both[1], -5 * 0.3, 1e-12);
}

// z of T z' = motor² − z at a constant motor: motor² (1 − exp(−t/T)).
TEST_F(FormulaOfMore, HeatFollowsTheSquareOfTheMotor) {
  const auto m = Model(Arms(Instance("formula", Key("joint", "knee") + Key("force", "p1*heat") +
                                                    Key("p1", "0.5") + Key("heat_time", "0.3"))));
  const auto d = Data(m);
  d->ctrl[1] = 0.8;
  for (int k = 0; k < 600; ++k) mj_step(m.get(), d.get());
  ASSERT_EQ(m->npluginstate, 1);
  EXPECT_NEAR(d->plugin_state[0], 0.64 * (1 - std::exp(-2.0)), 1e-12);
}

TEST_F(FormulaOfMore, SaysWhatIsMissing) {
  const auto refusal = [](const std::string& config) {
    return Compile(Arms(Instance("formula", config))).error;
  };
  EXPECT_THAT(refusal(Key("joint", "hip") + Key("force", "q[ankle]")),
              HasSubstr("no joint 'ankle'"));
  EXPECT_THAT(refusal(Key("joint", "hip") + Key("force", "q[other]")),
              HasSubstr("a law on two joints, found 1"));
  EXPECT_THAT(refusal(Key("joint", "hip") + Key("force", "motor[knee]")), HasSubstr("column 1"));
  EXPECT_THAT(refusal(Key("joint", "hip") + Key("force", "heat")), HasSubstr("'heat_time'"));
  EXPECT_THAT(refusal(Key("joint", "hip") + Key("force", "q[knee")), HasSubstr("column 2"));
}

TEST_F(Formula, LevelBelowZeroIsNoFriction) {
  EXPECT_EQ(Swing("formula_friction", Key("level", "-1")),
            Swing("formula_friction", Key("level", "0")));
}

// As a force that is no number does.
TEST_F(Formula, MujocoWarnsOfALevelThatIsNoNumber) {
  for (const auto& [effect, key] : {std::pair{"formula_friction", "level"}, {"formula", "force"}}) {
    for (const char* const text : {"0.02*sqrt(q - 1)", "log(q - 1)", "q/q"}) {
      const auto m = Model(Wheel(effect, Key(key, text)));
      const auto d = Data(m);
      d->ctrl[0] = 0.1;
      mj_step(m.get(), d.get());
      EXPECT_GT(d->warning[mjWARN_BADQACC].number, 0) << effect << " " << text;
    }
  }
}

TEST_F(Formula, FrictionHoldsAtRest) {
  const auto m = Model(Wheel("formula_friction", Key("level", "0.03 + 0.01*cos(q)")));
  const auto d = Data(m);
  d->ctrl[0] = 0.039;
  RunUntil(m, d, 1);
  EXPECT_LT(std::abs(d->qvel[0]), 1e-9);
  d->ctrl[0] = 0.041;
  RunUntil(m, d, 2);
  EXPECT_GT(d->qvel[0], 1e-3);
}

TEST_F(Formula, SaysWhereItIsWrong) {
  const struct {
    const char *text, *column, *expected;
  } cases[] = {
      {"p1*", "column 4", "found the end of the formula"},
      {"p1*w", "column 4", "one of q, v, motor, weight, time, heat, p1"},
      {"p1 p2", "column 4", "an operator or the end, found 'p2'"},
      {"sin q", "column 5", "'(' of sin"},
      {"max(q)", "column 6", "',' of max"},
      {"(q", "column 3", "')'"},
      {"q = 2; q", "column 1", "a new name for a part"},
      {"a = q", "column 6", "';' after the part 'a'"},
      {"1..2", "column 3", "an operator"},
  };
  for (const auto& c : cases) Refuses(c.text, {c.column, c.expected});
  EXPECT_THAT(Compile(Wheel("formula", "")).error, HasSubstr("the key 'force'"));
}

TEST_F(Formula, RefusesConstantsThatAreNotFinite) {
  const struct {
    const char *text, *column, *found;
  } cases[] = {
      {"1/0", "column 3", "from '/', found infinity"},
      {"q + -1/(2 - 2)*v", "column 14", "from '/', found -infinity"},
      {"a = 0; q*log(a)", "column 15", "from 'log', found -infinity"},
      {"where(q, 1, sqrt(-1))", "column 20", "from 'sqrt', found none"},
      {"exp(1000)", "column 9", "from 'exp', found infinity"},
  };
  for (const auto& c : cases) Refuses(c.text, {c.column, "a finite constant", c.found});
  EXPECT_NEAR(Value("q/(1 + 0)", 0.3, 0), 0.3, 1e-12);
}

TEST_F(Formula, RefusesWhatDoesNotFitItsStack) {
  const std::string deep = std::string(300, '(') + "q" + std::string(300, ')');
  EXPECT_THAT(Compile(Wheel("formula", Key("force", deep))).error,
              HasSubstr("fewer parentheses within each other"));
  std::string parts;
  for (int i = 0; i < 300; ++i) parts += "a" + std::to_string(i) + " = q; ";
  EXPECT_THAT(Compile(Wheel("formula", Key("force", parts + "q"))).error,
              HasSubstr("a shorter formula"));
  std::string sum = "q";  // long is not deep
  for (int i = 0; i < 5000; ++i) sum += " + q";
  EXPECT_TRUE(Compile(Wheel("formula", Key("force", sum))).model);
}

}  // namespace
}  // namespace continuum
