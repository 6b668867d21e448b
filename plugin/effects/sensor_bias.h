#pragma once

#include "effects/effect.h"

namespace continuum {

/// A sensor that is off by a constant.   y_meas(t) = y(t) + bias,  bias in the unit of the output.
struct SensorBias {
  static constexpr std::string_view kName = "sensor_bias", kSource = "doebelin2003",
                                    kSummary = "a sensor that is off by a constant";
  static constexpr std::array kPlaces{Place::kSensor};
  static constexpr std::array kParams{Signed("bias", "output", 0)};

  template <class T, class Signal>
  static T Eval(const Signal& y, double t, const Vec<T, 1>& p) {
    return y(t) + p[0];
  }
};

}  // namespace continuum
