#include "effects/supply_sag.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace continuum {
namespace {

// Motors on a battery by Ohm's law: V = V_0 − R_s Σ |i_j|, i_j = d_j V/R_j at duties d_j, found by
// bisection of what the battery and the motors say of V.
struct Circuit {
  double V_0 = 12, R_s = 0.4, k = 0.8;         // V, Ohm, N m/A
  std::vector<double> R{2.5, 1.6, 4}, duty{};  // Ohm, 1

  double Torque(std::size_t i, double V) const { return k * duty[i] * V / R[i]; }
  double Voltage() const {
    double low = 0, high = V_0;
    for (int n = 0; n < 100; ++n) {
      const double V = 0.5 * (low + high);
      double current = 0;
      for (std::size_t i = 0; i < duty.size(); ++i) current += std::abs(Torque(i, V)) / k;
      (V_0 - R_s * current > V ? low : high) = V;
    }
    return low;
  }
};

TEST(SupplySag, IsOhmsLawOfABatteryAndItsMotors) {
  for (const auto& duty : std::vector<std::vector<double>>{
           {1, 1, 1}, {1, 0, 0}, {-1, 0.3, 0.1}, {0.01, -0.02, 0}, {0, 0, 0}}) {
    const Circuit circuit{.duty = duty};
    const double r = circuit.R_s / (circuit.k * circuit.V_0);
    double load = 0;
    for (std::size_t i = 0; i < duty.size(); ++i) load += std::abs(circuit.Torque(i, circuit.V_0));
    const double share = SupplySag::Share<double>(load, {r}), V = circuit.Voltage();
    for (std::size_t i = 0; i < duty.size(); ++i)
      EXPECT_NEAR(share * circuit.Torque(i, circuit.V_0), circuit.Torque(i, V), 1e-13);
  }
}

// However hard they are driven.
TEST(SupplySag, GivesAllMotorsTogetherNoMoreThanTheShortCircuit) {
  for (const double load : {1.0, 1e3, 1e12}) {
    const double together = load * SupplySag::Share<double>(load, {0.2});
    EXPECT_LT(together, 1 / 0.2);
    EXPECT_NEAR(together, 1 / 0.2, 1 / (0.2 * 0.2 * load));
  }
}

// Equation (1) holds for what they give.
TEST(SupplySag, FallsByWhatIsDrawn) {
  const double r = 0.3, load = 2.2, share = SupplySag::Share<double>(load, {r});
  EXPECT_DOUBLE_EQ(share, 1 - r * share * load);
}

}  // namespace
}  // namespace continuum
