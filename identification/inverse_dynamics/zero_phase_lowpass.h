#pragma once

#include <vector>

namespace continuum {

/// A Butterworth low-pass of fourth order, run forward and backward: no phase, half the amplitude
/// (−6 dB) at the cutoff [share of the sampling rate, below 0.5]. Beyond its ends the signal goes
/// on turned about its end points.
std::vector<double> LowPass(const std::vector<double>& y, double cutoff);

/// dy/dt by central differences over five rows, fewer at the ends; step: the sampling period [s].
/// Of a sine of the angular frequency w it is (w step)⁴/30 low.
std::vector<double> Derivative(const std::vector<double>& y, double step);

}  // namespace continuum
