// What every force law promises.
#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "support/law_suite.h"

namespace continuum {
namespace {

using namespace testing;  // NOLINT: the lists of a typed suite

template <class E>
struct EveryForce : ::testing::Test {
  std::mt19937 rng{0};
};
TYPED_TEST_SUITE(EveryForce, Forces::Into<Types>, EffectName);

TYPED_TEST(EveryForce, NeverCreatesEnergy) {
  using E = TypeParam;
  constexpr int kZ = static_cast<int>(E::kStates.size()), kN = 2 + kZ;
  using Gradient = Eigen::Matrix<double, kN, 1>;
  using Dual = Eigen::AutoDiffScalar<Gradient>;
  std::normal_distribution<double> n;
  for (int k = 0; k < 1000; ++k) {
    const auto p = RandomParams<E>(this->rng);
    ParamsOf<E, Dual> dual;
    for (std::size_t i = 0; i < p.size(); ++i) dual[i] = Dual(p[i]);
    Vec<Dual, kZ> z;
    const Dual x(n(this->rng), kN, 0), v(n(this->rng), kN, 1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < kZ; ++i) z[i] = Dual(unit(this->rng), kN, 2 + i);
    const auto r = E::template Eval<Dual>({x, v}, z, dual);
    double rate = r.stored.derivatives()[0] * v.value();
    for (int i = 0; i < kZ; ++i) rate += r.stored.derivatives()[2 + i] * r.zdot[i].value();
    const double power = r.force.value() * v.value();
    ASSERT_GE(power - rate, -1e-12 * (1 + std::abs(power)));
  }
}

TYPED_TEST(EveryForce, IsConsistentInItsUnits) {
  using E = TypeParam;
  constexpr std::size_t kZ = E::kStates.size();
  const std::string x(E::kPort.x), force(E::kPort.force);
  ExpectConsistentUnits<E>([&](Quantities& in, const ParamsOf<E, double>& p) {
    const Port<double> port{in.Normal(1, x), in.Normal(1, x + "/s")};
    Vec<double, kZ> z;
    for (std::size_t i = 0; i < kZ; ++i) z[i] = in.Uniform(-1, 1, E::kStates[i].unit);
    const auto reply = E::template Eval<double>(port, z, p);
    const auto next = E::template Step<double>(z, port, in.In(0.01, "s"), p);
    std::vector<Answer> all{{reply.force, force}, {reply.stored, force + "*" + x}};
    for (std::size_t i = 0; i < kZ; ++i) {
      const std::string unit(E::kStates[i].unit);
      all.push_back({reply.zdot[i], unit + "/s"}), all.push_back({next[i], unit});
    }
    return all;
  });
}

TYPED_TEST(EveryForce, DoesNothingAtItsNull) {
  using E = TypeParam;
  const Vec<double, E::kStates.size()> z{};
  EXPECT_EQ(E::template Eval<double>({0.3, 0.2}, z, NullParams<E>()).force, 0);
}

template <class E>
struct EveryForceWithStates : ::testing::Test {
  std::mt19937 rng{0};
};
TYPED_TEST_SUITE(EveryForceWithStates, ForcesWithStates::Into<Types>, EffectName);

// Step at constant v against Runge-Kutta on Eval's rates.
TYPED_TEST(EveryForceWithStates, StepsThemExactly) {
  using E = TypeParam;
  constexpr std::size_t kZ = E::kStates.size();
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 50; ++k) {
    const auto p = RandomParams<E>(this->rng);
    Vec<double, kZ> z;
    for (double& value : z) value = unit(this->rng);
    const Port<double> q{0, 0.02 * unit(this->rng)};
    const double h = 0.01;
    const auto exact = E::template Step<double>(z, q, h, p);
    const auto rate = [&](const Vec<double, kZ>& s) {
      return E::template Eval<double>(q, s, p).zdot;
    };
    const int steps = 2000;
    for (int i = 0; i < steps; ++i) {
      const double dt = h / steps;
      const auto a = rate(z);
      auto mid = z;
      for (std::size_t j = 0; j < kZ; ++j) mid[j] += dt / 2 * a[j];
      const auto b = rate(mid);
      for (std::size_t j = 0; j < kZ; ++j) z[j] += dt * b[j];
    }
    for (std::size_t j = 0; j < kZ; ++j)
      EXPECT_NEAR(z[j], exact[j], 1e-6);  // midpoint rule: dt² error
  }
}

}  // namespace
}  // namespace continuum
