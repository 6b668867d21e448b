#include "effects/braid.h"

#include <numbers>
#include <random>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "effects/pcc_segment.h"

namespace continuum {
namespace {

using Three = Vec<double, 3>;

constexpr double kLength = 0.044, kReference = 0.0125, kArea = 39.3e-6;

Braid::Params<double> Module(double cot2_gamma) {
  return {kLength, kReference, 8.5e-3, 3e-4, -2e-4, kArea, cot2_gamma};
}
PccSegmentLaw::Params<double> Chambers() {
  return {kLength, kReference, 8.5e-3, 3e-4, -2e-4, kArea, 0, 0, 0, 0, 0, 0};
}
double Cot2(double gamma) { return std::pow(std::tan(gamma), -2); }

// (1) solved for the radius of a thread that is laid out flat.
TEST(BraidLaw, TheThreadKeepsItsLength) {
  for (const double gamma : {0.6, 1.0, 1.5}) {
    for (const double stretch : {0.8, 1.0, 1.15}) {
      const double radius2 = BraidSection(Cot2(gamma), stretch * stretch);
      EXPECT_NEAR(radius2 * std::pow(std::sin(gamma), 2) + std::pow(stretch * std::cos(gamma), 2),
                  1, 1e-14);
    }
  }
}

// A straight segment whose three chambers hold the same pressure is one braided muscle.
TEST(BraidLaw, WithItsSegmentItPushesAsAMuscleAndNotAtAllAt54Point7Degrees) {
  const double pressure = 7e4;
  for (const double gamma : {0.5, 0.9, 1.2, 1.55}) {
    for (const double stretch : {0.85, 1.0, 1.1}) {
      auto braid = Module(Cot2(gamma));
      auto segment = Chambers();
      braid[3] = braid[4] = segment[3] = segment[4] = 0;
      const Three delta{0, 0, (stretch - 1) * kLength};
      const Three all{pressure, pressure, pressure};
      const double push = Braid::Eval<double>(delta, {}, all, 0, braid)[2] +
                          PccSegmentLaw::Eval<double>(delta, {}, all, 1, segment)[2];
      const double thread = std::pow(stretch * std::cos(gamma), 2);
      const double muscle = kArea * (1 - 3 * thread) / std::pow(std::sin(gamma), 2);
      EXPECT_NEAR(push, 3 * pressure * muscle, 1e-12 * std::abs(pressure * kArea) + 1e-11);
    }
  }
  const double none = Cot2(std::acos(std::sqrt(1.0 / 3)));
  EXPECT_NEAR(Braid::Eval<double>({}, {}, {1e5, 0, 0}, 0, Module(none))[2], -1e5 * kArea, 1e-12);
}

// (4) is the derivative of (3), taken by duals.
TEST(BraidLaw, TheGasDoesTheWorkOfItsVolume) {
  using Dual = ceres::Jet<double, 3>;
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int k = 0; k < 100; ++k) {
    const auto p = Module(std::abs(unit(rng)));
    const Three pressure{1e5 * unit(rng), 1e5 * unit(rng), 1e5 * unit(rng)};
    const Three delta{0.01 * unit(rng), 0.01 * unit(rng), 0.005 * unit(rng)};
    Dual work(0.0);
    for (int i = 0; i < 3; ++i) {
      const auto r = PccChamber(PccChambers<double>{p[2], p[3], p[4], p[5]}, i);
      const Dual x(delta[0], 0), y(delta[1], 1), l(delta[2], 2);
      const Dual length = kLength + l - (r[0] * x + r[1] * y) / kReference;
      const Dual stretch = length / kLength;
      work += pressure[i] * kArea * length * (BraidSection(Dual(p[6]), stretch * stretch) - 1.0);
    }
    const Three force = Braid::Eval<double>(delta, {}, pressure, 0, p);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(force[i], work.v[i], 1e-12 * (1 + std::abs(force[i])));
  }
}

TEST(BraidLaw, RingsLeaveTheSegmentAsItIs) {
  for (const double force : Braid::Eval<double>({.01, .02, .003}, {}, {1e5, 2e4, 0}, 0, Module(0)))
    EXPECT_EQ(force, 0);
}

}  // namespace
}  // namespace continuum
