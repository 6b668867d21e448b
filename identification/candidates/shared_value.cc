#include "identification/candidates/shared_value.h"

#include <algorithm>

namespace continuum {

SharedValue SharedValueOf(std::span<const double> values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*low == *high) return {*low, Change::Operation::kSet, ""};
  if (*low > 0 || *high < 0) return {1, Change::Operation::kScale, "_factor"};
  return {0, Change::Operation::kAdd, "_added"};
}

}  // namespace continuum
