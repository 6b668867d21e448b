#pragma once

#include <algorithm>
#include <cmath>

namespace continuum {

/// Dry friction as an elasto-plastic bristle, for solvers of differential equations. With the level
/// of the law, the speed v, the give g and the deflection ζ of the bristle over g,
///
///   τ_f = level u,   u = ζ + T v/g within ±1                                       (1)
///   ζ' = v/g  at rest (|u| < 1),   ζ' = (±1 − ζ)/T  in sliding (u = ±1)            (2)
///
/// level [N*m or N] · g [rad or m] by how much friction gives before it slides · T [s] how fast.
/// In sliding it is the level itself. At rest it is a spring with a damper: a load below the level
/// moves the joint by less than g, and then not at all. (1) and (2) go on without a jump where
/// sliding begins and ends, and so do derivatives of the motion. Neither knows the parameters of
/// the law, which act through the level alone. Opposes v; never creates energy.
///
/// Source: dupont2002 (true stick of an elasto-plastic bristle); the damper limits with the spring.
struct Bristle {
  static constexpr double kGive = 1e-5;  ///< g of a law without its own [rad or m]
  static constexpr double kTime = 0.01;  ///< T [s]: rests are overdamped, and sharp in speed

  double u;     ///< share of the level
  double rate;  ///< ζ' [1/s]

  Bristle(double deflection, double v, double give) {
    const double free = deflection + kTime * v / give;
    u = std::clamp(free, -1.0, 1.0);
    rate = u == free ? v / give : (u - deflection) / kTime;
  }
};

}  // namespace continuum
