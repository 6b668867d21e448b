#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace continuum {

/// Random numbers that are the same on every library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : rng_(seed) {}
  /// Within (0, 1).
  double Uniform() { return (static_cast<double>(rng_() >> 11) + 0.5) * 0x1p-53; }
  /// Standard normal (Box-Muller).
  double Normal() {
    return std::sqrt(-2 * std::log(Uniform())) * std::cos(2 * std::numbers::pi * Uniform());
  }

 private:
  std::mt19937_64 rng_;
};

}  // namespace continuum
