#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "sim/numerics/portable_random.h"

namespace continuum::random_diagnoses {

/// Random choices that repeat exactly for a seed.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < 10; ++i) random_.Uniform();  // seeds that are close begin alike
  }

  bool Chance(double share) { return random_.Uniform() < share; }
  double Within(double low, double high) { return low + (high - low) * random_.Uniform(); }
  double Normal() { return random_.Normal(); }
  /// Within [0, count).
  std::size_t Index(std::size_t count) {
    return std::min(count - 1,
                    static_cast<std::size_t>(random_.Uniform() * static_cast<double>(count)));
  }
  /// Within [low, high].
  int Whole(int low, int high) {
    return low + static_cast<int>(Index(static_cast<std::size_t>(high - low + 1)));
  }
  template <class T>
  const T& From(const std::vector<T>& all) {
    return all[Index(all.size())];
  }
  std::string Of(std::initializer_list<const char*> all) {
    return *(all.begin() + Index(all.size()));
  }

 private:
  Random random_;
};

}  // namespace continuum::random_diagnoses
