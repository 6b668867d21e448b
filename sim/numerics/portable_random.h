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
    const double radius = std::sqrt(-2 * std::log(Uniform()));
    return radius * std::cos(2 * std::numbers::pi * Uniform());
  }

 private:
  std::mt19937_64 rng_;
};

/// Random numbers that are the same on every library: the engine's that the standard specifies, and
/// the distributions as GNU's libstdc++ draws them (std::uniform_real_distribution,
/// std::normal_distribution), on which published numbers hang. New code takes Random.
template <class Engine>
class LibstdcxxRandom {
 public:
  explicit LibstdcxxRandom(std::uint64_t seed)
      : rng_(static_cast<typename Engine::result_type>(seed)) {}

  /// The engine's next number.
  std::uint64_t Bits() { return rng_(); }

  /// Within [0, 1).
  double Uniform() {
    double number = static_cast<double>(rng_()), range = kRange;
    for (; range < 0x1p53; range *= kRange) number += static_cast<double>(rng_()) * range;
    const double share = number / range;
    return share < 1 ? share : std::nextafter(1.0, 0.0);
  }
  /// Within [low, high).
  double Uniform(double low, double high) { return Uniform() * (high - low) + low; }

  /// Standard normal (Marsaglia's polar method). Numbers come in pairs: every second one is what
  /// the draw before has left over.
  double Normal() {
    if (has_second_) {
      has_second_ = false;
      return second_;
    }
    double x, y, square;
    do {
      x = 2 * Uniform() - 1;
      y = 2 * Uniform() - 1;
      square = x * x + y * y;
    } while (square > 1 || square == 0);
    const double scale = std::sqrt(-2 * std::log(square) / square);
    second_ = x * scale;
    has_second_ = true;
    return y * scale;
  }
  /// The next Normal begins a pair, as that of a new std::normal_distribution does.
  void BeginPair() { has_second_ = false; }

 private:
  static constexpr double kRange = static_cast<double>(Engine::max()) + 1;  // min() is 0

  Engine rng_;
  double second_ = 0;
  bool has_second_ = false;
};

using Random32 = LibstdcxxRandom<std::mt19937>;
using Random64 = LibstdcxxRandom<std::mt19937_64>;

}  // namespace continuum
