#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "effects/all.h"
#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Force : public testing::Engine {
 protected:
  // A flywheel of 0.02 kg m^2 on a hinge; gravity does no work.
  static std::string Wheel(const std::string& effect, const std::string& config,
                           const std::string& joint = "", const std::string& option = "") {
    return "<mujoco><option timestep=\"1e-3\" integrator=\"implicitfast\" " + option + "/>" +
           (effect.empty() ? "" : Instance(effect, Key("joint", "q") + config)) +
           "<compiler angle=\"radian\"/><worldbody><body><joint name=\"q\" axis=\"1 0 0\" " +
           joint +
           "/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"0.02 0.02 0.02\"/></body>"
           "</worldbody><actuator><motor joint=\"q\"/></actuator></mujoco>";
  }
  static constexpr double kInertia = 0.02;
};

TEST_F(Force, CubicStiffnessIsTheNativeThirdCoefficient) {
  const std::string rest = "ref=\"0.3\" springref=\"-0.1\" ";
  const auto ours = Model(Wheel("cubic_stiffness", Key("k3", "0.8"), rest + "stiffness=\"0.1\""));
  const auto native = Model(Wheel("", "", rest + "stiffness=\"0.1 0 0.8\""));
  const auto d = Data(ours), e = Data(native);
  for (int k = 0; k < 20; ++k) {
    d->qpos[0] = e->qpos[0] = -1 + 0.1 * k;
    mj_forward(ours.get(), d.get()), mj_forward(native.get(), e.get());
    EXPECT_NEAR(d->qacc[0], e->qacc[0], 1e-12);
  }
}

std::vector<std::string> warnings;

TEST_F(Force, AWarningNamesTheJointWhereDirectionalDampingCreatesEnergy) {
  const auto warnings_of = [](const std::string& d, const std::string& damping) {
    warnings.clear();
    mju_user_warning = [](const char* text) { warnings.emplace_back(text); };
    const auto m = Model(Wheel("directional_viscous", Key("b", "0.02") + Key("d", d),
                               "damping=\"" + damping + "\""));
    Data(m);
    mju_user_warning = [](const char*) {};
    return warnings;
  };
  EXPECT_THAT(warnings_of("-0.06", "0.05"), IsEmpty());
  EXPECT_THAT(warnings_of("0.07", "0.05"), IsEmpty());
  EXPECT_THAT(warnings_of("-0.08", "0.05"),
              ElementsAre(HasSubstr("creates energy at joint 'q', as d is more than b and")));
}

TEST_F(Force, MaxwellCreepsUnderLoadWithTheSpeedOfItsDamper) {
  const auto m = Model(Wheel("maxwell", Key("k_m", "0.5") + Key("tau_m", "0.4")));
  const auto d = Data(m);
  d->ctrl[0] = 0.06;
  RunUntil(m, d, 20);
  const double early = d->qpos[0];
  RunUntil(m, d, 30);
  EXPECT_NEAR((d->qpos[0] - early) / 10, 0.06 / (0.5 * 0.4), 1e-9);
}

// With a spring k in parallel (standard linear solid) a step of torque gives k_m + k at once and k
// in the end, approached with the retardation time tau_m (k_m + k)/k.
TEST_F(Force, MaxwellAndSpringRetardAsTheStandardLinearSolid) {
  const double k = 1, k_m = 2, tau_m = 0.5, torque = 0.1;
  const auto m = Model(
      Wheel("maxwell", Key("k_m", "2") + Key("tau_m", "0.5"), "stiffness=\"1\" damping=\"0.2\""));
  const auto d = Data(m);
  d->ctrl[0] = torque;
  RunUntil(m, d, 4);
  const double a = torque / k - d->qpos[0];
  RunUntil(m, d, 5);
  const double b = torque / k - d->qpos[0];
  // The wheel's damper 0.2 and inertia shift the slow pole: root of the third-order polynomial
  // (I s^2 + 0.2 s + k)(1 + tau_m s) + k_m tau_m s nearest to -k/(tau_m (k + k_m)).
  double s = -k / (tau_m * (k + k_m));
  for (int i = 0; i < 50; ++i) {
    s = -(kInertia * s * s + 0.2 * s + k) * (1 + tau_m * s) / (k_m * tau_m);
  }
  EXPECT_NEAR(std::log(a / b), -s, 1e-3 * -s);
}

// The same law, stepped finely on the same wheel under a slow swing of torque.
template <class E>
double Reference(const ParamsOf<E, double>& p, double end) {
  const double h = 1e-6;
  double q = 0, v = 0;
  Vec<double, E::kStates.size()> z{};
  const int steps = static_cast<int>(std::lround(end / h));
  for (int k = 0; k < steps; ++k) {
    const double torque = 0.15 * std::sin(6 * k * h);
    v += h / 0.02 * (torque - E::template Eval<double>({q, v}, z, p).force);
    q += h * v;
    z = E::template Step<double>(z, {q, v}, h, p);
  }
  return q;
}

template <class E>
std::string Config(const ParamsOf<E, double>& p) {
  std::string text;
  for (std::size_t i = 0; i < p.size(); ++i) {
    text += "<config key=\"" + std::string(E::kParams[i].name) + "\" value=\"" +
            std::to_string(p[i]) + "\"/>";
  }
  return text;
}

class Convergence : public Force {
 protected:
  template <class E>
  void Expect(const ParamsOf<E, double>& p) {
    const double exact = Reference<E>(p, 1.5);
    const auto m = Model(Wheel(std::string(E::kName), Config<E>(p)));
    double before = kInfinity, error = 0;
    for (const double h : {1e-3, 5e-4, 2.5e-4}) {
      m->opt.timestep = h;
      const auto d = Data(m);
      for (int k = 0; k < std::lround(1.5 / h); ++k) {
        d->ctrl[0] = 0.15 * std::sin(6 * d->time);
        mj_step(m.get(), d.get());
      }
      error = std::abs(d->qpos[0] - exact);
      // First order, a half; 1e-6 is the reference's own error.
      EXPECT_LT(error, 0.65 * before + 1e-6) << h;
      before = error;
    }
    EXPECT_LT(error, 0.01 * std::abs(exact));
  }
};

TEST_F(Convergence, LugreSlidesAsTheFineReference) { Expect<Lugre>({20, 0.3, 0.05, 0.5, 0.3}); }
TEST_F(Convergence, BoucWenSlidesAsTheFineReference) { Expect<BoucWen>({0.05, 60, 0.7, 1.5}); }
TEST_F(Convergence, DahlSlidesAsTheFineReference) { Expect<Dahl>({5, 0.05}); }
TEST_F(Convergence, MaxwellMovesAsTheFineReference) { Expect<Maxwell>({0.5, 0.1}); }

TEST_F(Force, LugreHoldsBelowBreakawayAndLetsGoAtIt) {
  const auto m =
      Model(Wheel("lugre", Key("sigma_0", "200") + Key("sigma_1", "2.8") + Key("tau_c", "0.04") +
                               Key("S", "0.75") + Key("v_s", "0.3")));
  m->opt.timestep = 5e-4;
  const auto d = Data(m);
  const double level = 0.04 * 1.75;
  const auto ramp = [&](double from, double to, double duration) {
    const double start = d->time;
    while (d->time < start + duration && std::abs(d->qvel[0]) < 1e-2) {
      d->ctrl[0] = from + (to - from) * (d->time - start) / duration;
      mj_step(m.get(), d.get());
    }
  };
  ramp(0, 0.95 * level, 2);
  RunUntil(m, d, 4);
  const double held = d->qpos[0];
  RunUntil(m, d, 30);
  EXPECT_NEAR(d->qpos[0], held, 1e-9);
  ramp(0.95 * level, 1.1 * level, 10);
  // Rate 1 mN m/s: beyond the level sqrt(2 I v/rate) = 0.63 s to 10 mrad/s, 6.6e-4 N m.
  EXPECT_NEAR(d->ctrl[0], level, 0.01 * level);
}

}  // namespace
}  // namespace continuum
