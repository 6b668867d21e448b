#pragma once

#include <cmath>
#include <vector>

#include "pendulum.h"

namespace continuum::testing {

/// A wheel on a spring with dry friction, by hand:
///
///   J q'' = u − k q − b q' − τ_f,   |τ_f| ≤ τ_c
struct Wheel {
  double inertia, stiffness, damping, tau_c = 0;  // kg m², N m/rad, N m s/rad, N m

  /// Angle [rad] at every row (kPeriod) from rest at 0, torques held.
  std::vector<double> Run(const std::vector<double>& u) const {
    constexpr double h = 2e-5;
    double q = 0, v = 0;
    std::vector<double> angle;
    for (const double torque : u) {
      angle.push_back(q);
      for (int k = 0; k < std::lround(kPeriod / h); ++k) {
        const double free = v + h * (torque - stiffness * q - damping * v) / inertia;
        const double stop = h * tau_c / inertia;
        v = std::abs(free) <= stop ? 0 : free - std::copysign(stop, free);
        q += h * v;
      }
    }
    return angle;
  }
};

/// Torques [N m] of rows that turn a wheel to and fro, every second the other way, from rest.
inline std::vector<double> ToAndFro(int rows = 300) {
  std::vector<double> u(30, 0);
  for (int k = 30; k < rows; ++k) u.push_back(k * 8 / 1000 % 2 ? 6 : -5);
  return u;
}

}  // namespace continuum::testing
