#pragma once

#include "effects/effect.h"

namespace continuum {

/// An encoder whose disc or magnet is off the axis: its error repeats over the turn.
///
///   y_meas(t) = y + cosine cos(n y) + sine sin(n y),  y = y(t)              (1)
///
/// cosine, sine in the unit of the output · n = harmonic [1/output]: 1/rad for a disc off its axis,
/// 2/rad for a magnet that is tilted. For angles that are read in rad. No candidate by itself: over
/// less than a turn a bias and a scale say the same. Source: doebelin2003.
struct SensorEccentricity {
  static constexpr std::string_view kName = "sensor_eccentricity", kSource = "doebelin2003",
                                    kSummary = "an encoder that is off the axis";
  static constexpr bool kOnlyListed = true;
  static constexpr std::array kPlaces{Place::kSensor};
  static constexpr std::array kParams{Signed("cosine", "output", 0), Signed("sine", "output", 0),
                                      Param{"harmonic", "1/output", 0, kInfinity, 1, kAsIs, 1}};

  template <class T, class Signal>
  static T Eval(const Signal& signal, double t, const Vec<T, 3>& p) {
    const auto& [cosine, sine, n] = p;
    const T y = signal(t);
    return y + cosine * cos(n * y) + sine * sin(n * y);  // (1)
  }
};

}  // namespace continuum
