#pragma once

#include <algorithm>
#include <bit>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "effects/braid.h"
#include "models/stiff_flop/even.h"
#include "models/stiff_flop/module.h"

namespace continuum::stiff_flop {

/// Wall of one braided tube of undeformed inner and outer radius r_1 and r_2, bent with its axis.
///
/// A point at radius r and angle psi (0 toward the centre of bending) moves to radius x r, its
/// fibre is stretched by y. With lambda, kappa of the tube's own axis:
///
///   fixed       x = 1, y = lambda                                                     (16)
///   elongation  x² = BraidSection(cot²γ, lambda²), y = lambda                         (12)
///   constant    x² + c² (y² - 1) = 1, y = lambda (1 - kappa r x cos ψ), c = cot γ     (29)
///   exact       as constant, but c = (1 + 2 cos²ψ) cot γ_e, cos γ_e = lambda cos γ    (25-28)
///
/// (1) radius  the root of the quadratic in x that tends to 1 as c -> 0
/// (2) wall    I_1 = x² + y² + 1/(x y)², incompressible
/// (3) gas     area = Int (x(psi, r_1) r_1)²/2 dpsi
///
/// Integrals over psi by the trapezoidal rule, over r by panels of ten Gauss points; both are
/// refined until they change by less than 1e-10, so that their own error is near rounding.
template <class T>
class Chamber {
 public:
  Chamber(ChamberLaw law, const T& gamma, double r_1, double r_2, const Bend<T>& bend)
      : law_(law), r_1_(r_1), r_2_(r_2), lambda_(bend.lambda), kappa_(bend.kappa) {
    using std::cos;
    using std::sin;
    const T cosine = cos(gamma);
    const T sine = sin(gamma);
    const T free = 1.0 - lambda_ * lambda_ * cosine * cosine;
    room_ = law == ChamberLaw::kFixed ? 1 : Value(free);
    const T cot2 = cosine * cosine / (sine * sine);
    if (law == ChamberLaw::kElongation) {
      square_ = BraidSection<T>(cot2, lambda_ * lambda_);
      uniform_cot2_ = cot2;
    }
    if (law == ChamberLaw::kConstant) cot2_ = cot2;
    if (law == ChamberLaw::kExact) cot2_ = lambda_ * lambda_ * cosine * cosine / free;
    law_value_ = {Value(square_), Value(cot2_)};
  }

  /// How far the wall is from its limits, 1 or less, negative beyond: the thread is straight
  /// (lambda cos gamma = 1), the radius (1) has come down to 0 where the thread lies flattest, or
  /// fibres toward the centre of bending have no length left. Inside, all of (1) to (3) exist.
  double Margin() const {
    const double fold = std::abs(Value(kappa_)) * r_2_;
    if (!Bends() || room_ <= 0) return std::min(room_, 1 - fold);
    const double c2 = (law_ == ChamberLaw::kExact ? 9 : 1) * law_value_.cot2;
    const double lambda = Value(lambda_);
    return std::min({room_, 1 + c2 * (1 - lambda * lambda), 1 - fold * std::sqrt(1 + c2)});
  }

  /// (1).
  T Radius(double cosine, double r) const {
    using std::sqrt;
    if (!Bends()) return sqrt(square_);
    const T k = kappa_ * (r * cosine);
    return Root(Cot2(cosine, cot2_), lambda_ * lambda_, k);
  }

  /// y, for x = Radius(cosine, r).
  T Fibre(double cosine, double r, const T& x) const {
    return Bends() ? lambda_ * (1.0 - kappa_ * x * (r * cosine)) : lambda_;
  }

  /// Lead angle of the thread at Radius(cosine, r): a thread with the law's slope c against the
  /// section follows the wall, cot = c y/x [rad]. `fixed`: rings, pi/2.
  T LeadAngle(double cosine, double r) const {
    using std::atan2;
    using std::sqrt;
    const T x = Radius(cosine, r);
    const T slope = sqrt(Bends() ? Cot2(cosine, cot2_) : uniform_cot2_);
    return atan2(x, slope * Fibre(cosine, r, x));
  }

  /// (3) [m²]; NaN when the refinement does not end.
  T GasArea() const {
    const double disk = std::numbers::pi * r_1_ * r_1_;
    const auto square = [](const auto& x, const auto&) { return x * x; };
    return RingMean(r_1_, Intervals(r_1_, square), square) * disk;
  }

  /// Int (I_1 - 3) da over the undeformed wall [m²], (2).
  T Wall() const {
    const int intervals =
        Intervals(r_2_, [](const auto& x, const auto& y) { return Invariant(x, y) + 3.0; });
    const auto integral = [&](const auto& chamber, int panels) {
      return chamber.Radial(intervals, panels);
    };
    if (!Bends()) return integral(*this, 1);
    const Chamber<double> plain = value();
    int panels = 1;
    double coarse = integral(plain, panels);
    while (true) {
      const double fine = integral(plain, 2 * panels);
      panels *= 2;
      if (!std::isfinite(fine) || std::abs(fine - coarse) <= 1e-10 * Scale()) break;
      if (panels >= kMostPanels) return T(std::numeric_limits<double>::quiet_NaN());
      coarse = fine;
    }
    // The last doubling only confirmed the previous one.
    return integral(*this, std::max(1, panels / 2));
  }

  /// The same tube without derivatives.
  Chamber<double> value() const {
    return {law_,           room_,        r_1_, r_2_, law_value_.square, law_value_.cot2,
            Value(lambda_), Value(kappa_)};
  }

 private:
  template <class>
  friend class Chamber;
  static constexpr int kFewestIntervals = 4;
  static constexpr int kMostIntervals = 1 << 11;
  static constexpr int kMostPanels = 1 << 6;

  Chamber(ChamberLaw law, double room, double r_1, double r_2, double square, double cot2,
          double lambda, double kappa)
      : law_(law),
        room_(room),
        r_1_(r_1),
        r_2_(r_2),
        lambda_(lambda),
        kappa_(kappa),
        square_(square),
        cot2_(cot2),
        law_value_{square, cot2} {}

  bool Bends() const { return law_ == ChamberLaw::kConstant || law_ == ChamberLaw::kExact; }

  template <class S>
  S Cot2(double cosine, const S& cot2) const {
    if (law_ != ChamberLaw::kExact) return cot2;
    const double local = 1 + 2 * cosine * cosine;
    return cot2 * (local * local);
  }

  template <class S>
  static S Root(const S& c2, const S& lambda2, const S& k) {
    using std::sqrt;
    const S a = c2 * lambda2 * k;
    const S lead = 1.0 + a * k;
    return (a + sqrt(1.0 + c2 * (1.0 - lambda2) + a * k * (1.0 + c2))) / lead;
  }

  // Mean over the circle of f(x, y); f is even in psi.
  template <class F>
  T RingMean(double r, int intervals, const F& f) const {
    if (!Bends()) return f(Radius(1, r), lambda_);
    if (intervals == 0) return T(std::numeric_limits<double>::quiet_NaN());
    T sum(0.0);
    const std::vector<double>& cosines = Chamber<double>::Cosines(intervals);
    for (int j = 0; j <= intervals; ++j) {
      const double cosine = cosines[j];
      const T x = Radius(cosine, r);
      const double weight = (j == 0 || j == intervals ? 0.5 : 1.0) / intervals;
      sum += weight * f(x, Fibre(cosine, r, x));
    }
    return sum;
  }

  template <class S>
  static S Invariant(const S& x, const S& y) {
    const S xy = x * y;
    return x * x + y * y + 1.0 / (xy * xy) - 3.0;
  }

  T Radial(int intervals, int panels) const {
    T sum(0.0);
    const double width = (r_2_ - r_1_) / panels;
    for (int panel = 0; panel < panels; ++panel) {
      const double middle = r_1_ + (panel + 0.5) * width;
      using Rule = boost::math::quadrature::gauss<double, 10>;
      for (std::size_t i = 0; i < Rule::abscissa().size(); ++i) {
        for (const double side : {-1.0, 1.0}) {
          const double r = middle + side * 0.5 * width * Rule::abscissa()[i];
          const double weight = Rule::weights()[i] * width * std::numbers::pi * r;
          sum += weight * RingMean(r, intervals, Invariant<T>);
        }
      }
    }
    return sum;
  }

  double Scale() const { return 3 * std::numbers::pi * (r_2_ * r_2_ - r_1_ * r_1_); }

  // Intervals of [0, pi] that the mean of f(x, y) > 0 at radius r needs; 0 when it has none.
  template <class F>
  int Intervals(double r, const F& f) const {
    if (!Bends()) return 1;
    const Chamber<double> plain = value();
    double coarse = plain.RingMean(r, kFewestIntervals, f);
    for (int n = 2 * kFewestIntervals; n <= kMostIntervals; n *= 2) {
      const double fine = plain.RingMean(r, n, f);
      if (!std::isfinite(fine)) return 0;
      if (std::abs(fine - coarse) <= 1e-10 * fine) return n;
      coarse = fine;
    }
    return 0;
  }

  // cos(pi j/n), j = 0..n, for n = kFewestIntervals 2^k.
  static const std::vector<double>& Cosines(int n) {
    static const std::vector<std::vector<double>> kTables = [] {
      std::vector<std::vector<double>> tables;
      for (int count = kFewestIntervals; count <= kMostIntervals; count *= 2) {
        std::vector<double>& table = tables.emplace_back();
        for (int j = 0; j <= count; ++j) table.push_back(std::cos(std::numbers::pi * j / count));
      }
      return tables;
    }();
    return kTables[std::countr_zero(static_cast<unsigned>(n / kFewestIntervals))];
  }

  struct Law {
    double square, cot2;
  };

  ChamberLaw law_;
  double room_ = 1;
  double r_1_, r_2_;
  T lambda_, kappa_;
  T square_ = T(1.0);        // x² where it is uniform
  T cot2_ = T(0.0);          // c² at psi = pi/2 of a bending wall
  T uniform_cot2_ = T(0.0);  // of one that only lengthens
  Law law_value_{1, 0};
};

}  // namespace continuum::stiff_flop
