#pragma once

#include "effects/effect.h"

namespace continuum {

/// A sensor that reads too much or too little.   y_meas(t) = scale y(t),  scale [1].
struct SensorScale {
  static constexpr std::string_view kName = "sensor_scale", kSource = "doebelin2003",
                                    kSummary = "a sensor that reads too much or too little";
  static constexpr std::array kPlaces{Place::kSensor};
  static constexpr std::array kParams{Param{"scale", "1", -kInfinity, kInfinity, 1, 1}};

  template <class T, class Signal>
  static T Eval(const Signal& y, double t, const Vec<T, 1>& p) {
    return p[0] * y(t);
  }
};

}  // namespace continuum
