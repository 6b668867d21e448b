#pragma once

#include "effects/effect.h"

namespace continuum {

/// A vector sensor that is mounted at an angle.
///
///   y_meas(t) = R(axis, angle) y(t)                                       (1)
///   R y = y cos + (a × y) sin + a (a · y) (1 − cos),  a = axis/|axis|     (2)
///
/// angle [rad] · axis [1] in the frame of y. Source: rodrigues1840.
struct Misalignment {
  static constexpr std::string_view kName = "misalignment", kSource = "rodrigues1840",
                                    kSummary = "a vector sensor that is mounted at an angle";
  static constexpr std::array kPlaces{Place::kSensor};
  static constexpr std::array kParams{Signed("angle", "rad", 0),
                                      Param{"axis_x", "1", -kInfinity, kInfinity, 0, kAsIs},
                                      Param{"axis_y", "1", -kInfinity, kInfinity, 0, kAsIs},
                                      Param{"axis_z", "1", -kInfinity, kInfinity, 1, kAsIs}};

  template <class T, class Signal>
  static Vec<T, 3> Eval(const Signal& signal, double t, const Vec<T, 4>& p) {
    const auto& [angle, ax, ay, az] = p;
    const Vec<T, 3> y = signal(t);
    const T length = sqrt(ax * ax + ay * ay + az * az);
    if (angle == 0.0 || length == 0.0) return y;
    const Vec<T, 3> a{ax / length, ay / length, az / length};
    const T c = cos(angle), s = sin(angle);
    const T along = (a[0] * y[0] + a[1] * y[1] + a[2] * y[2]) * (1.0 - c);
    return {y[0] * c + (a[1] * y[2] - a[2] * y[1]) * s + a[0] * along,  // (2)
            y[1] * c + (a[2] * y[0] - a[0] * y[2]) * s + a[1] * along,
            y[2] * c + (a[0] * y[1] - a[1] * y[0]) * s + a[2] * along};
  }
};

}  // namespace continuum
