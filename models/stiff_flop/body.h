#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <type_traits>
#include <vector>

#include "models/stiff_flop/even.h"
#include "models/stiff_flop/module.h"

namespace continuum::stiff_flop {

/// Deformed section: area [m²] and second moments Int x*², Int z*² [m⁴] about the fixed axis.
template <class T>
struct Section {
  T area, x2, z2;
};

/// Point j of n of the integral over a disk. Sines and cosines would take most of the time of a
/// section: they are kept for rules of up to kKeptPoints, as many as any section needs that is not
/// about to fold.
struct DiskPoint {
  double cosine, sine2;

  DiskPoint(int j, int n) {
    const double angle = std::numbers::pi * j / (n + 1);
    cosine = std::cos(angle);
    sine2 = std::pow(std::sin(angle), 2);
  }
};

inline constexpr int kKeptPoints = 96;

inline const std::vector<DiskPoint>& KeptPoints(int n) {
  static const std::vector<std::vector<DiskPoint>> kTables = [] {
    std::vector<std::vector<DiskPoint>> tables(kKeptPoints + 1);
    for (int count = 1; count <= kKeptPoints; ++count) {
      for (int j = 1; j <= count; ++j) tables[count].emplace_back(j, count);
    }
    return tables;
  }();
  return kTables[n];
}

/// A solid cylinder that is stretched by lambda and bent to curvature kappa of its deformed axis; x
/// of the undeformed section points to the centre of bending, u = 1 - kappa x, A = 1/sqrt(lambda).
///
///   law         x*                        z*             stretch along the axis
///   fixed       x                         z              (Hooke)                            (11)
///   elongation  A x                       A z            lambda                             (34)
///   simple      2 A (1 - sqrt u)/kappa    A z/sqrt u     lambda u                           (35)
///   planar      (1 - sqrt D)/kappa        A z            lambda sqrt D                   (39-42)
///   general     (1 - sqrt D)/kappa        A z/sqrt u     lambda sqrt D                   (44-47)
///
/// with D = 1 - 2 kappa h, h = A x (planar) or 2 A (1 - u^(3/2))/(3 kappa) (general). All keep the
/// volume. Energies are per E l/6, so that the neo-Hookean ones are Int (I_1 - 3) dx dz with
///
///   (1) elongation  I_1 = lambda² + 2/lambda
///   (2) simple      I_1 = lambda² u² + 2/(lambda u)
///   (3) planar, general  I_1 = h_x²/D + lambda² D + (z*/z)² + (dz*/dx)²
///
/// (3) carries D in its second term: by (37) the axial stretch is lambda (1 - kappa x*).
///
/// Integrals over x = r s with weight sqrt(1 - s²) by Gauss-Chebyshev points of the second kind, as
/// many as the nearest singularity (u = 0 or D = 0) asks for.
template <class T>
class Body {
 public:
  Body(BodyLaw law, const Bend<T>& bend) : law_(law), lambda_(bend.lambda), kappa_(bend.kappa) {
    using std::sqrt;
    contraction_ = 1.0 / sqrt(lambda_);
  }

  /// How far a cylinder of radius r is from folding, 1 or less, negative beyond: the smaller of
  /// 1 - kappa r and D(r).
  double Margin(double r) const {
    const Body<double> plain = value();
    const double room = 1 - std::abs(plain.kappa_) * r;
    if (room <= 0 || !Shifts()) return room;
    return std::min(room, Body<double>(law_, {plain.lambda_, std::abs(plain.kappa_)}).D(r));
  }

  /// x* of a point of the middle plane z = 0 [m].
  T Shifted(double x) const {
    using std::sqrt;
    if (law_ == BodyLaw::kFixed) return T(x);
    if (law_ == BodyLaw::kElongation) return contraction_ * x;
    if (law_ == BodyLaw::kSimple) return contraction_ * (2 * x) / (1.0 + sqrt(1.0 - kappa_ * x));
    return 2.0 * H(x) / (1.0 + sqrt(D(x)));
  }

  /// z*/z where x is [-].
  T Width(double x) const {
    using std::sqrt;
    if (law_ == BodyLaw::kFixed) return T(1.0);
    if (law_ == BodyLaw::kElongation || law_ == BodyLaw::kPlanar) return contraction_;
    return contraction_ / sqrt(1.0 - kappa_ * x);
  }

  /// Energy of a cylinder of radius r per E l/6 [m²].
  T Energy(double r) const {
    using std::sqrt;
    const double disk = std::numbers::pi * r * r;
    const T bend2 = kappa_ * kappa_ * (r * r);
    const T lambda2 = lambda_ * lambda_;
    switch (law_) {
      case BodyLaw::kFixed: {
        const T strain = lambda_ - 1.0;
        return 3 * disk * lambda_ * (0.25 * bend2 + strain * strain);
      }
      case BodyLaw::kElongation:
        return disk * (lambda2 + 2.0 / lambda_ - 3.0);
      case BodyLaw::kSimple:
        return disk *
               (lambda2 * (1.0 + 0.25 * bend2) + 4.0 / (lambda_ * (1.0 + sqrt(1.0 - bend2))) - 3.0);
      case BodyLaw::kPlanar:
        return disk * (2.0 / (lambda_ * (1.0 + sqrt(1.0 - 4.0 * bend2 / lambda_))) + lambda2 +
                       1.0 / lambda_ - 3.0);
      case BodyLaw::kGeneral:
        break;
    }
    return OfPair([r](const auto& body) { return std::array{body.IntegratedInvariant(r)}; })[0];
  }

  /// Deformed disk of radius r.
  Section<T> Deformed(double r) const {
    const double disk = std::numbers::pi * r * r;
    if (law_ == BodyLaw::kFixed || law_ == BodyLaw::kElongation) {
      const T shrink = law_ == BodyLaw::kFixed ? T(1.0) : 1.0 / lambda_;
      const T second = shrink * shrink * (disk * r * r / 4);
      return {shrink * disk, second, second};
    }
    const std::array<T, 3> sums = OfPair([r](const auto& body) { return body.Sums(r); });
    return {sums[0], sums[1], sums[2]};
  }

  Body<double> value() const { return {law_, Bend<double>{Value(lambda_), Value(kappa_)}}; }

 private:
  template <class>
  friend class Body;

  bool Shifts() const { return law_ == BodyLaw::kPlanar || law_ == BodyLaw::kGeneral; }

  // h; the general law's (1 - u^(3/2))/kappa without its 0/0.
  T H(double x) const {
    using std::sqrt;
    if (law_ == BodyLaw::kPlanar) return contraction_ * x;
    const T u = 1.0 - kappa_ * x;
    return contraction_ * (2 * x / 3) * (1.0 + u + u * u) / (1.0 + u * sqrt(u));
  }

  T D(double x) const { return 1.0 - 2.0 * kappa_ * H(x); }

  // f(*this), where f(body) is an array of functions of lambda and kappa only.
  template <class F>
  auto OfPair(const F& f) const {
    if constexpr (std::is_same_v<T, double>) {
      return f(*this);
    } else {
      using Pair = ceres::Jet<double, 2>;
      const Bend<Pair> bend{Pair(Value(lambda_), 0), Pair(Value(kappa_), 1)};
      const auto pairs = f(Body<Pair>(law_, bend));
      std::array<T, std::tuple_size_v<std::remove_const_t<decltype(pairs)>>> lifted;
      for (std::size_t i = 0; i < lifted.size(); ++i) lifted[i] = Lift(pairs[i], lambda_, kappa_);
      return lifted;
    }
  }

  // (3) of the general law; over |z| < width the mean of z² is width²/3.
  T IntegratedInvariant(double r) const {
    T sum(0.0);
    Disk(r, [&](double x, double width2, double weight) {
      const T u = 1.0 - kappa_ * x;
      const T d = D(x);
      const T slope = kappa_ * kappa_ * (width2 / 12) / (u * u * u);
      sum += weight * ((u / d + 1.0 / u + slope) / lambda_ + lambda_ * lambda_ * d - 3.0);
    });
    return sum;
  }

  // Area, Int x*², Int z*².
  std::array<T, 3> Sums(double r) const {
    using std::sqrt;
    std::array<T, 3> sums = {T(0.0), T(0.0), T(0.0)};
    const bool simple = law_ == BodyLaw::kSimple;
    Disk(r, [&](double x, double width2, double weight) {
      const T u = 1.0 - kappa_ * x;
      const T root = sqrt(simple ? u : D(x));
      const T shifted = (simple ? contraction_ * x : H(x)) / (0.5 * (1.0 + root));
      const T area = weight / (lambda_ * (simple ? u : root));
      const T z2 = area * (width2 / 3) / lambda_;
      sums[0] += area;
      sums[1] += area * shifted * shifted;
      sums[2] += law_ == BodyLaw::kPlanar ? z2 : z2 / u;
    });
    return sums;
  }

  // Where on the real axis, in units of r, the nearest singularity of the integrands lies.
  double Singularity(double r) const {
    const double kappa = std::abs(Value(kappa_));
    const double root = std::sqrt(Value(lambda_));
    double at = 1;
    if (law_ == BodyLaw::kPlanar) at = root / 2;
    if (law_ == BodyLaw::kGeneral && root < 4.0 / 3)
      at = 1 - std::cbrt(std::pow(1 - 0.75 * root, 2));
    return std::max(at / std::max(kappa * r, 1e-6), 1 + 1e-9);
  }

  // Errors fall as rho^(-2 n) with rho the sum of the half axes of the ellipse through the
  // singularity; poles of up to third order cost a few points more.
  int Points(double r) const {
    const double s = Singularity(r);
    return 6 + static_cast<int>(std::ceil(18 / std::log(s + std::sqrt(s * s - 1))));
  }

  // Calls f(x, (half width at x)², weight) with the weights of an integral over the disk.
  template <class F>
  void Disk(double r, const F& f) const {
    const int n = Points(r);
    const auto add = [&](const DiskPoint& at) {
      const double width2 = r * r * at.sine2;
      f(r * at.cosine, width2, 2 * std::numbers::pi / (n + 1) * width2);
    };
    if (n <= kKeptPoints) {
      for (const DiskPoint& at : KeptPoints(n)) add(at);
    } else {
      for (int j = 1; j <= n; ++j) add(DiskPoint(j, n));
    }
  }

  BodyLaw law_;
  T lambda_, kappa_;
  T contraction_;  // A_1 = A_3
};

}  // namespace continuum::stiff_flop
