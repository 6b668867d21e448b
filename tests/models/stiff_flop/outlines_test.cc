#include "models/stiff_flop/outlines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/stiff_flop/published.h"
#include "models/stiff_flop/tubes.h"

namespace continuum::stiff_flop {
namespace {

constexpr int kPoints = 4000;

double Area(const Outline& o) {
  double area = 0;
  for (std::size_t j = 0; j + 1 < o.x.size(); ++j) {
    area += 0.5 * (o.x[j] * o.z[j + 1] - o.x[j + 1] * o.z[j]);
  }
  return std::abs(area);
}

Module Loose() {
  Module module = Published();
  module.gamma = 1.4;
  return module;
}

constexpr Axis<double> kBent{1.15, 18, -9};

TEST(StiffFlopOutlines, EncloseTheAreasOfTheSection) {
  const Module module = Loose();
  for (const Method& method : Method::All()) {
    const auto outlines = OutlinesOf(module, method, kBent, kPoints);
    ASSERT_EQ(outlines.size(), 8u);
    const Body<double> body(method.body, kBent.bend());
    const double outer = body.Deformed(module.r_2).area, inner = body.Deformed(module.r_1).area;
    EXPECT_NEAR(Area(outlines[0]), outer, 1e-5 * outer);
    EXPECT_NEAR(Area(outlines[1]), inner, 1e-5 * inner);
    const BaseSection section = Describe(module, method, kBent);
    for (std::size_t i = 0; i < 3; ++i) {
      const double gas = std::numbers::pi * section.r_G[i] * section.r_G[i];
      EXPECT_EQ(outlines[2 + 2 * i].part, "bore_" + std::to_string(i + 1));
      EXPECT_NEAR(Area(outlines[2 + 2 * i]), gas, 1e-5 * gas);
    }
  }
}

// A thread over an angle dpsi was r dpsi/sin(gamma) long, and still is.
TEST(StiffFlopOutlines, ThreadsKeepTheirLength) {
  const Module module = Loose();
  const double gamma = module.gamma;
  const Method method{BodyLaw::kGeneral, ChamberLaw::kConstant};
  const auto outlines = OutlinesOf(module, method, kBent, 40);
  const double phi = std::atan2(kBent.k_2, kBent.k_1);
  const double r_od = TubeDistance(module, method.body, kBent.lambda);
  const Outline& bore = outlines[2];
  double low = 2, high = 0;
  for (std::size_t j = 0; j < bore.x.size(); ++j) {
    const double dx = bore.x[j] - r_od, dz = bore.z[j];
    const double radius = std::hypot(dx, dz) / module.r_c1;
    EXPECT_NEAR(radius / std::sin(bore.gamma[j]), 1 / std::sin(gamma), 1e-9);
    low = std::min(low, bore.gamma[j]), high = std::max(high, bore.gamma[j]);
    // psi counts from toward the centre of bending.
    EXPECT_NEAR(std::remainder(std::atan2(-dz, dx) - phi - bore.psi[j], 2 * std::numbers::pi), 0,
                1e-9);
  }
  EXPECT_GT(high - low, 1e-3);
}

TEST(StiffFlopOutlines, AStraightTubeHasTheLeadAngleOfTheResults) {
  const Module module = Loose();
  const Axis<double> straight{1.2, 0, 0};
  for (const ChamberLaw law :
       {ChamberLaw::kFixed, ChamberLaw::kElongation, ChamberLaw::kConstant}) {
    const Method method{BodyLaw::kFixed, law};
    const double is = OutlinesOf(module, method, straight, 4)[2].gamma[1];
    EXPECT_NEAR(is, Describe(module, method, straight).gamma_e[0], 1e-9);
  }
}

}  // namespace
}  // namespace continuum::stiff_flop
