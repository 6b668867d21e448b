#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "effects/effect.h"

namespace continuum {

template <class T>
using Mat3 = Vec<Vec<T, 3>, 3>;  ///< rows

/// The first N ≥ 2 Stumpff functions c_k(w) = Σ_j (−w)^j / (2j + k)!, in which everything about a
/// circular arc of angle θ = √w is smooth:
///
///   c₀ = cos θ,  c₁ = sin θ/θ,  c₂ = (1 − cos θ)/θ²,  c₃ = (θ − sin θ)/θ³, …
///   w c_{k+2} = 1/k! − c_k                                                          (a)
///   dc_k/dw = (k c_{k+2} − c_{k+1})/2                                               (b)
///
/// w ≥ 0 [rad²]. Below w = 10 the last two are summed as a series (the terms left out are below
/// 1e-19 of the first) and (a) leads down; above it (a) leads up from sine and cosine. Either way
/// the absolute error is a few units of rounding.
template <std::size_t N, class T>
Vec<T, N> Stumpff(const T& w) {
  static_assert(N >= 2);
  constexpr std::size_t kTerms = 18;
  // Ratios of neighbouring terms of c_{N−2} and c_{N−1}, less the factor −w.
  constexpr auto kRatio = [] {
    Vec<Vec<double, kTerms>, 2> ratio{};
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < kTerms; ++j) {
        const double top = double(2 * (j + 1) + N - 2 + i);
        ratio[i][j] = 1 / (top * (top - 1));
      }
    }
    return ratio;
  }();
  Vec<T, N> c;
  Vec<double, N> inverse_factorial{1.0, 1.0};
  for (std::size_t k = 2; k < N; ++k) inverse_factorial[k] = inverse_factorial[k - 1] / double(k);
  if (w < 10.0) {
    for (std::size_t i = 0; i < 2; ++i) {
      T sum(1.0);
      for (std::size_t j = kTerms; j-- > 0;) sum = 1.0 - w * kRatio[i][j] * sum;
      c[N - 2 + i] = inverse_factorial[N - 2 + i] * sum;
    }
    for (std::size_t k = N - 2; k-- > 0;) c[k] = inverse_factorial[k] - w * c[k + 2];
  } else {
    const T theta = sqrt(w);
    c[0] = cos(theta);
    c[1] = sin(theta) / theta;
    for (std::size_t k = 2; k < N; ++k) c[k] = (inverse_factorial[k - 2] - c[k - 2]) / w;
  }
  return c;
}

/// Geometry of a segment of constant curvature.
template <class T>
struct PccSegment {
  T L0;  ///< length at rest [m]
  T d;   ///< distance from the centre line at which Δx and Δy are arc length differences [m]
};

/// A point that moves with the segment, in base axes: position [m], jacobian ∂p/∂(Δx, Δy, δL) [1]
/// and the jacobian's rate [1/s].
template <class T>
struct PccPoint {
  Vec<T, 3> position;
  Mat3<T> jacobian, jacobian_rate;
};

/// Pose of the tip in base axes, and the turning of the tip frame: ω_tip = turning · (Δẋ, Δẏ, δL̇),
/// ω_tip [rad/s] in the tip's own axes.
template <class T>
struct PccTip {
  Vec<T, 3> position;
  Mat3<T> rotation;
  Mat3<T> turning;
};

namespace pcc {

/// Where a point is, p = L (u f, v f, h) with (u, v) = (Δx, Δy)/d [rad], w = u² + v², L = L0 + δL,
/// and two functions of w with their first two derivatives.
template <class T>
struct Profile {
  Vec<T, 3> f, h;
};

/// c_k and its first two derivatives by (b), times scale, scale ξ², scale ξ⁴ for c_k(ξ² w).
template <std::size_t N, class T>
Vec<T, 3> Derivatives(const Vec<T, N>& c, std::size_t k, double scale = 1, double xi2 = 1) {
  const double n = double(k);
  return {scale * c[k], 0.5 * scale * xi2 * (n * c[k + 2] - c[k + 1]),
          0.25 * scale * xi2 * xi2 * (n * (n + 2) * c[k + 4] - (2 * n + 1) * c[k + 3] + c[k + 2])};
}

template <class T>
PccPoint<T> Point(const PccSegment<T>& s, const Vec<T, 3>& delta, const Vec<T, 3>& rate,
                  const Profile<T>& profile) {
  const auto& [f, f1, f2] = profile.f;
  const auto& [h, h1, h2] = profile.h;
  const T u = delta[0] / s.d, v = delta[1] / s.d, length = s.L0 + delta[2];
  const T ud = rate[0] / s.d, vd = rate[1] / s.d, wd = 2.0 * (u * ud + v * vd);
  const T fd = f1 * wd, f1d = f2 * wd, h1d = h2 * wd;

  const Mat3<T> bend{{{f + 2.0 * u * u * f1, 2.0 * u * v * f1, u * f},
                      {2.0 * u * v * f1, f + 2.0 * v * v * f1, v * f},
                      {2.0 * u * h1, 2.0 * v * h1, h}}};
  const T uvd = 2.0 * ((ud * v + u * vd) * f1 + u * v * f1d);
  const Mat3<T> bend_rate{{{fd + 4.0 * u * ud * f1 + 2.0 * u * u * f1d, uvd, ud * f + u * fd},
                           {uvd, fd + 4.0 * v * vd * f1 + 2.0 * v * v * f1d, vd * f + v * fd},
                           {2.0 * (ud * h1 + u * h1d), 2.0 * (vd * h1 + v * h1d), h1 * wd}}};

  PccPoint<T> point{{length * u * f, length * v * f, length * h}, bend, bend_rate};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      point.jacobian[i][j] *= length / s.d;
      point.jacobian_rate[i][j] = (length * bend_rate[i][j] + rate[2] * bend[i][j]) / s.d;
    }
  }
  return point;
}

template <class T>
T SquaredAngle(const PccSegment<T>& s, const Vec<T, 3>& delta) {
  return (delta[0] * delta[0] + delta[1] * delta[1]) / (s.d * s.d);
}

}  // namespace pcc

/// Point of the centre line at the fraction xi ∈ [0, 1] of its length (9), carried along:
/// p = L (u ξ² c₂, v ξ² c₂, ξ c₁) at ξ² w. xi = 1 is the tip (3).
template <class T>
PccPoint<T> PccCentreLine(const PccSegment<T>& s, double xi, const Vec<T, 3>& delta,
                          const Vec<T, 3>& rate) {
  const double xi2 = xi * xi;
  const auto c = Stumpff<7>(T(xi2 * pcc::SquaredAngle(s, delta)));
  return pcc::Point<T>(s, delta, rate,
                       {pcc::Derivatives(c, 2, xi2, xi2), pcc::Derivatives(c, 1, xi, xi2)});
}

/// Centre of gravity of a uniform centre line (8): ∫₀¹ p dξ = L (u c₃, v c₃, c₂).
template <class T>
PccPoint<T> PccCentroid(const PccSegment<T>& s, const Vec<T, 3>& delta, const Vec<T, 3>& rate) {
  const auto c = Stumpff<8>(pcc::SquaredAngle(s, delta));
  return pcc::Point<T>(s, delta, rate, {pcc::Derivatives(c, 3), pcc::Derivatives(c, 2)});
}

/// Pose of the tip (2), (3). The rotation vector is (−v, u, 0), so that Δx > 0 bends toward +x.
template <class T>
PccTip<T> PccTipPose(const PccSegment<T>& s, const Vec<T, 3>& delta) {
  const T u = delta[0] / s.d, v = delta[1] / s.d, length = s.L0 + delta[2];
  const auto [c0, c1, c2, c3] = Stumpff<4>(pcc::SquaredAngle(s, delta));
  return {{length * u * c2, length * v * c2, length * c1},
          {{{1.0 - u * u * c2, -u * v * c2, u * c1},
            {-u * v * c2, 1.0 - v * v * c2, v * c1},
            {-u * c1, -v * c1, c0}}},
          {{{-u * v * c3 / s.d, (u * u * c3 - 1.0) / s.d, T(0.0)},
            {(1.0 - v * v * c3) / s.d, u * v * c3 / s.d, T(0.0)},
            {v * c2 / s.d, -u * c2 / s.d, T(0.0)}}}};
}

/// (Δx, Δy, δL) of the arc that starts at the base along +z and ends at the tip position [m]:
/// tan(θ/2) = ρ/z with ρ² = x² + y², L = |p|/c₁(w/4). Inverse of (3) for z > 0 (|θ| < π).
template <class T>
Vec<T, 3> PccFromTip(const PccSegment<T>& s, const Vec<T, 3>& tip) {
  const auto& [x, y, z] = tip;
  const T slope2 = (x * x + y * y) / (z * z);
  T ratio(1.0);  // atan(t)/t, t = √slope2
  if (slope2 < 0.1) {
    T sum(0.0);
    for (int j = 15; j > 0; --j) sum = slope2 * (1.0 / (2 * j + 1) - sum);
    ratio -= sum;
  } else {
    using std::atan;
    ratio = atan(sqrt(slope2)) / sqrt(slope2);
  }
  const T u = 2.0 * ratio * x / z, v = 2.0 * ratio * y / z;
  const T length = sqrt(x * x + y * y + z * z) / Stumpff<2>(T(0.25 * (u * u + v * v)))[1];
  return {s.d * u, s.d * v, length - s.L0};
}

/// Three chambers, 2π/3 apart at the radius r_ch around a centre that is off by (x_m, y_m) [m].
template <class T>
struct PccChambers {
  T r_ch, x_m, y_m, A;
};

/// What the pressures do to the tip, in its axes: a force along z [N] and moments [N m].
template <class T>
struct PccLoad {
  T f_z, m_x, m_y;
};

/// Centre of chamber i in the section (22)-(24): chamber 1 lies at −x.
template <class T>
Vec<T, 2> PccChamber(const PccChambers<T>& c, int i) {
  static const Vec<double, 2> kDirection[] = {
      {-1, 0}, {0.5, -std::sqrt(0.75)}, {0.5, std::sqrt(0.75)}};
  return {c.r_ch * kDirection[i][0] - c.x_m, c.r_ch * kDirection[i][1] - c.y_m};
}

/// (21) from Σ r_i × (A p_i e_z): f_z = A Σ p_i, m_x = A Σ r_iy p_i, m_y = −A Σ r_ix p_i, with
/// gauge pressures [Pa]. Pressure in chamber 1 (r_1x < 0) bends toward +x.
template <class T>
PccLoad<T> PccPressureLoad(const PccChambers<T>& c, const Vec<T, 3>& pressure) {
  PccLoad<T> load{T(0.0), T(0.0), T(0.0)};
  for (int i = 0; i < 3; ++i) {
    const Vec<T, 2> r = PccChamber(c, i);
    const T force = c.A * pressure[i];
    load.f_z += force;
    load.m_x += r[1] * force;
    load.m_y -= r[0] * force;
  }
  return load;
}

/// Generalised forces [N] on (Δx, Δy, δL) of a load that acts at the tip in tip axes while its
/// opposite acts at the base (25)-(26), with (μ_x, μ_y) = (m_y, −m_x):
///
///   τ_Δx = (L u c₃ f_z + μ_x (1 − v² c₃) + μ_y u v c₃)/d
///   τ_Δy = (L v c₃ f_z + μ_y (1 − u² c₃) + μ_x u v c₃)/d
///   τ_δL = c₁ f_z
template <class T>
Vec<T, 3> PccTipForces(const PccSegment<T>& s, const Vec<T, 3>& delta, const PccLoad<T>& load) {
  const T u = delta[0] / s.d, v = delta[1] / s.d, length = s.L0 + delta[2];
  const auto [c0, c1, c2, c3] = Stumpff<4>(pcc::SquaredAngle(s, delta));
  const T mu_x = load.m_y, mu_y = -load.m_x, push = length * c3 * load.f_z, twist = u * v * c3;
  return {(u * push + mu_x * (1.0 - v * v * c3) + mu_y * twist) / s.d,
          (v * push + mu_y * (1.0 - u * u * c3) + mu_x * twist) / s.d, c1 * load.f_z};
}

/// Generalised forces [N] of closed chambers, Σ p_i ∂V_i/∂(Δx, Δy, δL) with the chamber volume
/// V_i = A (L − r_ix u − r_iy v): (μ_x/d, μ_y/d, f_z). It counts the pressure on the bent side
/// walls, which the tip load (25)-(26) leaves out; both agree where the segment is straight.
template <class T>
Vec<T, 3> PccVolumeForces(const PccSegment<T>& s, const PccLoad<T>& load) {
  return {load.m_y / s.d, -load.m_x / s.d, load.f_z};
}

}  // namespace continuum
