#pragma once

#include <array>
#include <cmath>

namespace continuum {

/// A number and its derivatives with respect to N others: the scalar of a law whose slopes are
/// asked for. Comparisons look at the number alone.
template <std::size_t N>
struct Dual {
  double a = 0;
  std::array<double, N> d{};

  Dual() = default;
  Dual(double value) : a(value) {}  // implicit: laws mix them with constants
  Dual(double value, std::size_t i) : a(value) { d[i] = 1; }

  /// f(x) of slope f'(x).
  static Dual Of(const Dual& x, double value, double slope) {
    Dual y(value);
    for (std::size_t i = 0; i < N; ++i) y.d[i] = x.d[i] == 0 ? 0 : slope * x.d[i];
    return y;
  }
  /// f(x, y) of slopes ∂f/∂x and ∂f/∂y.
  static Dual Of(const Dual& x, const Dual& y, double value, double by_x, double by_y) {
    Dual f(value);
    for (std::size_t i = 0; i < N; ++i) f.d[i] = by_x * x.d[i] + by_y * y.d[i];
    return f;
  }

  friend Dual operator-(const Dual& x) { return Of(x, -x.a, -1); }
  friend Dual operator+(const Dual& x, const Dual& y) { return Of(x, y, x.a + y.a, 1, 1); }
  friend Dual operator-(const Dual& x, const Dual& y) { return Of(x, y, x.a - y.a, 1, -1); }
  friend Dual operator*(const Dual& x, const Dual& y) { return Of(x, y, x.a * y.a, y.a, x.a); }
  friend Dual operator/(const Dual& x, const Dual& y) {
    const double q = x.a / y.a;
    return Of(x, y, q, 1 / y.a, -q / y.a);
  }
  friend Dual& operator+=(Dual& x, const Dual& y) { return x = x + y; }
  friend Dual& operator-=(Dual& x, const Dual& y) { return x = x - y; }
  friend bool operator<(const Dual& x, const Dual& y) { return x.a < y.a; }
  friend bool operator>(const Dual& x, const Dual& y) { return x.a > y.a; }
  friend bool operator<=(const Dual& x, const Dual& y) { return x.a <= y.a; }
  friend bool operator>=(const Dual& x, const Dual& y) { return x.a >= y.a; }
  friend bool operator==(const Dual& x, const Dual& y) { return x.a == y.a; }

  friend Dual abs(const Dual& x) { return Of(x, std::abs(x.a), x.a < 0 ? -1 : 1); }
  friend Dual cos(const Dual& x) { return Of(x, std::cos(x.a), -std::sin(x.a)); }
  friend Dual sin(const Dual& x) { return Of(x, std::sin(x.a), std::cos(x.a)); }
  friend Dual exp(const Dual& x) { return Of(x, std::exp(x.a), std::exp(x.a)); }
  friend Dual log(const Dual& x) { return Of(x, std::log(x.a), 1 / x.a); }
  friend Dual sqrt(const Dual& x) { return Of(x, std::sqrt(x.a), 0.5 / std::sqrt(x.a)); }
  friend Dual tan(const Dual& x) {
    const double t = std::tan(x.a);
    return Of(x, t, 1 + t * t);
  }
  friend Dual atan(const Dual& x) { return Of(x, std::atan(x.a), 1 / (1 + x.a * x.a)); }
  friend Dual tanh(const Dual& x) {
    const double t = std::tanh(x.a);
    return Of(x, t, 1 - t * t);
  }
};

}  // namespace continuum
