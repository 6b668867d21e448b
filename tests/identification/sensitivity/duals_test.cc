// Sensitivities of the smooth path against dual numbers carried through equations written by hand.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <ceres/jet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gradient.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using std::sin;
using testing::Gradient;
using testing::Sensitivities;

constexpr int kRows = 150;  // at 10 ms

constexpr double Held(int row) { return row < 60 ? 0.4 : -0.2; }

// (I + m l²) q'' = u − k q − c q' − m g l sin q; the inertia I of the bob grows with its mass.
struct Swing {
  static constexpr int kStates = 2, kParameters = 3;
  static constexpr std::array<double, kStates> kStart{};
  static constexpr std::array<double, kParameters> kValues{0.5, 0.02, 0.3};  // k, c, m
  inline static const std::vector<Gradient> kGradients{{"k", "joint:q", "stiffness", 0.5},
                                                       {"c", "joint:q", "damping", 0.02},
                                                       {"m", "body:bob", "mass", 0.3}};

  template <class T>
  static std::array<T, kStates> Rate(const std::array<T, kStates>& y,
                                     const std::array<T, kParameters>& p, double u) {
    const auto& [k, c, m] = p;
    const T inertia = m * (0.2 * 0.2 + 1e-3 / 0.3);
    return {y[1], (u - k * y[0] - c * y[1] - m * 9.81 * 0.2 * sin(y[0])) / inertia};
  }

  static std::string Body() {
    return "<body name='bob'><joint name='q' axis='0 1 0' stiffness='0.5' damping='0.02'/>"
           "<inertial pos='0 0 -0.2' mass='0.3' diaginertia='1e-3 1e-3 1e-3'/></body></worldbody>"
           "<actuator><motor name='u' joint='q'/></actuator>";
  }
};

// m₁ x₁'' = G a − k₁ x₁ − k (x₁ − x₂),  m₂ x₂'' = k (x₁ − x₂) − c x₂',  T a' = u − a.
struct Train {
  static constexpr int kStates = 5, kParameters = 4;
  static constexpr std::array<double, kStates> kStart{0, 0, 0, 0, Held(0)};    // a lag is settled
  static constexpr std::array<double, kParameters> kValues{12, 0.05, 3, 0.7};  // k, T, G, m₂
  inline static const std::vector<Gradient> kGradients{{"k", "tendon:link", "stiffness", 12},
                                                       {"T", "actuator:u", "dynprm[0]", 0.05},
                                                       {"G", "actuator:u", "gainprm[0]", 3},
                                                       {"m2", "body:second", "mass", 0.7}};

  template <class T>
  static std::array<T, kStates> Rate(const std::array<T, kStates>& y,
                                     const std::array<T, kParameters>& p, double u) {
    const auto& [k, lag, gain, m2] = p;
    const T pull = k * (y[0] - y[2]);
    return {y[1], (gain * y[4] - 20.0 * y[0] - pull) / 0.4, y[3], (pull - 0.3 * y[3]) / m2,
            (u - y[4]) / lag};
  }

  static std::string Body() {
    return "<body name='first'><joint name='q' type='slide' axis='1 0 0' stiffness='20'/>"
           "<inertial pos='0 0 0' mass='0.4' diaginertia='1 1 1'/></body>"
           "<body name='second'><joint name='x2' type='slide' axis='1 0 0' damping='0.3'/>"
           "<inertial pos='0 0 0' mass='0.7' diaginertia='1 1 1'/></body></worldbody>"
           "<tendon><fixed name='link' stiffness='12' springlength='0'><joint joint='q' coef='1'/>"
           "<joint joint='x2' coef='-1'/></fixed></tendon>"
           "<actuator><general name='u' joint='q' dyntype='filterexact' dynprm='0.05' "
           "gainprm='3'/></actuator>";
  }
};

// d y₀ / d ln p of every row: Runge-Kutta of fourth order at 0.1 ms.
template <class System>
std::vector<std::vector<double>> ByDuals() {
  using Dual = ceres::Jet<double, System::kParameters>;
  using State = std::array<Dual, System::kStates>;
  std::array<Dual, System::kParameters> p;
  for (int i = 0; i < System::kParameters; ++i) p[i] = Dual(System::kValues[i], i);
  State y;
  for (int i = 0; i < System::kStates; ++i) y[i] = Dual(System::kStart[i]);
  const auto along = [&](const State& rate, double h) {
    State there = y;
    for (int i = 0; i < System::kStates; ++i) there[i] += h * rate[i];
    return there;
  };
  constexpr double kStep = 1e-4;
  std::vector<std::vector<double>> slopes(System::kParameters);
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < System::kParameters; ++i)
      slopes[i].push_back(y[0].v[i] * System::kValues[i]);
    for (int step = 0; step < 100; ++step) {
      const State a = System::Rate(y, p, Held(row));
      const State b = System::Rate(along(a, kStep / 2), p, Held(row));
      const State c = System::Rate(along(b, kStep / 2), p, Held(row));
      const State d = System::Rate(along(c, kStep), p, Held(row));
      for (int i = 0; i < System::kStates; ++i)
        y[i] += kStep / 6 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
  }
  return slopes;
}

template <class System>
class DualsTest : public testing::Bench {
 protected:
  // The worst error of all parameters.
  double Error(const Sensitivities& how) const {
    Write("model.xml", "<mujoco><option gravity='0 0 -9.81'/><worldbody>" + System::Body() +
                           "<sensor><jointpos name='q' joint='q'/></sensor></mujoco>");
    std::string csv = "time,u,q\n";
    for (int k = 0; k < kRows; ++k) csv += fmt::format("{:.2f},{},0\n", 0.01 * k, Held(k));
    Write("log.csv", csv);
    const Experiment e = Experiment::Read(
        Write("e.yaml",
              "format: 1\nmodel: model.xml\nstart: rest\ninputs: [{column: u, unit: '1', "
              "actuator: u}]\noutputs: [{column: q, unit: '1', sensor: q}]\n"
              "logs: [{file: log.csv}]\n"));
    const auto expected = ByDuals<System>();
    double worst = 0;
    for (int i = 0; i < System::kParameters; ++i) {
      const auto slopes = testing::Slopes(e, System::kGradients[i], how);
      worst = std::max(worst, testing::SlopeError(slopes, {expected[i]}));
    }
    return worst;
  }
};

using Systems = ::testing::Types<Swing, Train>;
TYPED_TEST_SUITE(DualsTest, Systems);

TYPED_TEST(DualsTest, AgreeWithSensitivities) { EXPECT_LT(this->Error({}), 1e-6); }

// What such a comparison must not let pass.
TYPED_TEST(DualsTest, SeeThatTheParametersOwnTermIsMissing) {
  EXPECT_GT(this->Error({.move = 0}), 0.1);
}

TYPED_TEST(DualsTest, SeeAFlippedSign) { EXPECT_GT(this->Error({.move = -kPerturbation}), 0.1); }

TYPED_TEST(DualsTest, SeeThatErrorsAreNotControlled) {
  EXPECT_GT(this->Error({.how = {1e-2, 1e-2, false}}), 1e-4);
}

}  // namespace
}  // namespace continuum
