#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string_view>
#include <vector>

namespace continuum::hidden {

/// What a sensor adds.
enum class NoiseKind { kWhite, kSlow, kOffset, kQuantised, kHeavy };
constexpr std::array<std::string_view, 5> kNoiseNames{"white", "AR 0.95", "offset", "quantised",
                                                      "t4"};

/// One channel of one log with noise of standard deviation sigma:
///   white; AR(1) with coefficient 0.95; white and one offset of the log, each σ/√2; white of σ/4
///   rounded to steps of σ √12; Student's t with 4 degrees of freedom.
inline std::vector<double> WithNoise(std::vector<double> y, NoiseKind kind, double sigma,
                                     std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  std::student_t_distribution<double> heavy(4);
  const double offset = normal(rng) * sigma / std::sqrt(2.0);
  double slow = normal(rng);
  for (double& v : y) {
    switch (kind) {
      case NoiseKind::kWhite:
        v += sigma * normal(rng);
        break;
      case NoiseKind::kSlow:
        v += sigma * slow;
        slow = 0.95 * slow + std::sqrt(1 - 0.95 * 0.95) * normal(rng);
        break;
      case NoiseKind::kOffset:
        v += offset + sigma / std::sqrt(2.0) * normal(rng);
        break;
      case NoiseKind::kQuantised: {
        const double step = sigma * std::sqrt(12.0);
        v = step * std::round((v + sigma / 4 * normal(rng)) / step);
        break;
      }
      case NoiseKind::kHeavy:
        v += sigma / std::sqrt(2.0) * heavy(rng);
        break;
    }
  }
  return y;
}

}  // namespace continuum::hidden
