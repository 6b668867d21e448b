#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace continuum::twin_pivot {

/// A value of the robot: one for all sections, or one for each.
class PerSection {
 public:
  PerSection(double value = 0) : values_{value} {}  // NOLINT: a number is one for all sections
  explicit PerSection(std::vector<double> values) : values_(std::move(values)) {}

  double operator[](int section) const {
    return values_.size() == 1 ? values_.front() : values_[static_cast<std::size_t>(section)];
  }
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> values_;
};

}  // namespace continuum::twin_pivot
