#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace continuum::stick_slip {

/// A slider on a spring, with dry friction, by hand and exactly:
///
///   m q'' = u − k q − b q' − f,   |f| ≤ τ_c,   f = τ_c sgn q' where it slides
///
/// Inputs are held between rows, so that each phase of sliding is a damped oscillation, which ends
/// where its speed is zero; there the slider sticks while |u − k q| ≤ τ_c.
struct Slider {
  double tau_c = 3, stiffness = 200, damping = 4, mass = 0.5;  // N, N/m, N s/m, kg

  struct Motion {
    std::vector<double> q;  ///< [row] position [m]
    double stuck = 0;       ///< share of the rows at which it does not move
  };

  /// From rest at 0.
  Motion Run(const std::vector<double>& u, double period) const {
    Motion motion;
    double q = 0, v = 0;
    for (const double force : u) {
      motion.q.push_back(q);
      motion.stuck += (v == 0) / static_cast<double>(u.size());
      for (double left = period; left > 0 && Slides(q, v, force);) left -= Slide(q, v, force, left);
    }
    return motion;
  }

 private:
  bool Slides(double q, double v, double u) const {
    return v != 0 || std::abs(u - stiffness * q) > tau_c;
  }

  // Until it stops, at most for so long; returns for how long.
  double Slide(double& q, double& v, double u, double most) const {
    const double way = v != 0 ? v : u - stiffness * q;
    const double rest = (u - std::copysign(tau_c, way)) / stiffness;
    const double a = damping / (2 * mass), w = std::sqrt(stiffness / mass - a * a);
    const double y = q - rest, pull = a * v + stiffness / mass * y;
    double stop = std::atan2(w * v, pull) / w;  // v(t) = exp(−at) (v cos wt − pull/w sin wt)
    if (stop <= 0) stop += std::numbers::pi / w;
    const double t = std::min(stop, most), e = std::exp(-a * t);
    q = rest + e * (y * std::cos(w * t) + (v + a * y) / w * std::sin(w * t));
    v = stop <= most ? 0 : e * (v * std::cos(w * t) - pull / w * std::sin(w * t));
    return t;
  }
};

}  // namespace continuum::stick_slip
