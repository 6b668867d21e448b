#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace continuum::page {

/// The finite values seen so far.
class Range {
 public:
  void Add(double value) {
    if (!std::isfinite(value)) return;
    low_ = empty_ ? value : std::fmin(low_, value);
    high_ = empty_ ? value : std::fmax(high_, value);
    empty_ = false;
  }
  bool empty() const { return empty_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  bool empty_ = true;
  double low_ = 0, high_ = 0;
};

struct Tick {
  double value;
  std::string text;
};

/// Round tick values (1, 2, 5 times a power of ten) inside [low, high], about `count` of them.
std::vector<Tick> Ticks(double low, double high, int count);

/// A linear map from values to pixels; a range without width is widened so that it can be drawn.
class Scale {
 public:
  Scale(const Range& range, double from, double to, double margin = 0.04);

  double operator()(double value) const {
    return from_ + (value - low_) / (high_ - low_) * (to_ - from_);
  }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_, high_, from_, to_;
};

}  // namespace continuum::page
