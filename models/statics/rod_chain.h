#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

#include "models/statics/block_tridiagonal.h"
#include "models/statics/skew.h"

namespace continuum::statics {

/// What a section answers to its strains zeta (curvature and twist) and its force n, both seen from
/// the section, with derivatives.
struct RodSection {
  Eigen::Vector3d moment;   ///< M [N m]
  Eigen::Vector3d stretch;  ///< Gamma = dp/ds, seen from the section
  Eigen::Matrix3d moment_by_zeta, moment_by_n, stretch_by_zeta, stretch_by_n;
};

/// A rod clamped at s = 0 and free at its end, cut into pieces, equal ones if nothing else is said:
/// the frames R_0 = 1, R_1, .., R_N of its nodes are the unknowns. It says how stable an
/// equilibrium of the whole rod is, and it can fall from one that is not.
///
/// Dead forces make the internal force F(s) known beforehand, so that the energy is a sum over
/// pieces of h w(zeta, R^T F), with M = dw/dzeta and -Gamma = dw/dn. A turn phi(s) of the sections,
/// in the base frame, R -> exp(phi) R, has
///
///   dzeta = R^T phi',  dn = R^T F x phi,  t = R Gamma,  m = R M
///   g_i = m_i - m_i+1 + h/2 [(F x t)_i + (F x t)_i+1],  m_N+1 = t_N x P                     (1)
///
/// g_i is what turns node i back; (1) is m' = F x t. P: dead force times its lever beyond the tip,
/// along the last tangent: `Lever(N)`. A rigid part at node i between two pieces acts the same way,
/// by `Lever(i)`: g_i is more by P_i x t_i. A law without levers has no such function. Where the
/// law has `DeadMoment(node)`, g_i is less by it: a dead moment [N m] at node i = 1..N, base frame.
/// Middles of pieces stand for pieces: the error falls with the square of their number.
///
/// Law: `static constexpr bool kShear` (false: Gamma is the axis), `length()`, `axis()`,
/// `Force(s)` [N] of all loads beyond s in 0..1, `Lever(node)` [N m], `elastic()` or
/// `ElasticOf(piece)`: dM/dzeta of the unloaded section, `Prepare(zeta)` with the strains of all
/// pieces, `At(piece, zeta, n, section)`, false out of the domain.
template <class Law>
class RodChain {
 public:
  using Shape = std::vector<Eigen::Quaterniond>;  ///< N + 1 frames
  using Step = Eigen::Matrix3Xd;                  ///< phi_1..phi_N [rad]

  RodChain(Law& law, int pieces)
      : RodChain(law, std::vector<double>(At(pieces), law.length() / pieces)) {
    for (int i = 0; i < pieces; ++i) middle_[At(i)] = (i + 0.5) / pieces;
  }
  /// Pieces of these lengths.
  RodChain(Law& law, std::vector<double> lengths)
      : law_(law),
        pieces_(static_cast<int>(lengths.size())),
        h_(std::move(lengths)),
        middle_(h_.size()),
        zeta_(3, pieces_),
        residual_(3, pieces_),
        stiffness_(pieces_),
        metric_(pieces_) {
    double start = 0;
    for (std::size_t i = 0; i < h_.size(); ++i) {
      middle_[i] = (start + h_[i] / 2) / law.length();
      start += h_[i];
    }
  }

  int pieces() const { return pieces_; }

  /// Whether the shape is in the domain; then residual() and tangents are its own.
  bool Linearize(const Shape& shape) { return Assemble<true>(shape); }
  bool ResidualAt(const Shape& shape) { return Assemble<false>(shape); }
  const Step& residual() const { return residual_; }
  /// Whether the shape is in the domain and its tangent with `shift` times the stiffness of the
  /// unloaded rod is definite: Linearize and Definite at once, for little work.
  bool DefiniteAt(const Shape& shape, double shift) {
    shift_ = shift;
    const bool inside = Assemble<true>(shape);
    shift_ = 0;
    return inside && stiffness_.NegativeDirections() == 0;
  }

  /// Negative eigenvalues of the tangent, and of the tangent with `shift` times the stiffness of
  /// the unloaded rod added.
  int UnstableDirections() const { return stiffness_.Plus(kNeutral, metric_).NegativeDirections(); }
  bool Definite(double shift) const {
    return stiffness_.Plus(shift + kNeutral, metric_).NegativeDirections() == 0;
  }
  Eigen::MatrixXd Dense() const { return stiffness_.Dense(); }
  /// (tangent + shift unloaded) x = b.
  Step Solve(double shift, const Step& b) const { return stiffness_.Plus(shift, metric_).Solve(b); }
  Step Unloaded(const Step& x) const { return metric_.Times(x); }

  Shape Moved(const Shape& shape, const Step& phi) const {
    Shape moved = shape;
    for (int i = 1; i <= pieces_; ++i) {
      const Eigen::Vector3d half = 0.5 * phi.col(i - 1);
      const Eigen::Quaterniond turn(1, half.x(), half.y(), half.z());
      moved[At(i)] = (turn.normalized() * shape[At(i)]).normalized();
    }
    return moved;
  }

  /// Strains of the pieces [1/length], of the shape that was looked at last.
  const Eigen::Matrix3Xd& zeta() const { return zeta_; }

 private:
  static constexpr double kNeutral = 1e-9;  // a turn about an axis of symmetry costs nothing

  static std::size_t At(int i) { return static_cast<std::size_t>(i); }

  Eigen::Matrix3d ElasticOf(int piece) const {
    if constexpr (requires { law_.ElasticOf(piece); }) {
      return law_.ElasticOf(piece);
    } else {
      return law_.elastic();
    }
  }

  void FindStrains(const Shape& shape) {
    for (int i = 0; i < pieces_; ++i) {
      Eigen::Quaterniond turn = shape[At(i)].conjugate() * shape[At(i + 1)];
      if (turn.w() < 0) turn.coeffs() *= -1;
      const double sine = turn.vec().norm();
      const double angle = 2 * std::atan2(sine, turn.w());
      zeta_.col(i) = turn.vec() * ((sine > 1e-8 ? angle / sine : 2.0) / h_[At(i)]);
    }
  }

  template <bool kTangent>
  bool Assemble(const Shape& shape) {
    FindStrains(shape);
    if (!law_.Prepare(zeta_)) return false;
    residual_.setZero();
    if (kTangent) {
      stiffness_.SetZero();
      metric_.SetZero();
    }
    for (int i = 0; i < pieces_; ++i) {
      if (!AddPiece<kTangent>(i, shape[At(i)], shape[At(i + 1)])) return false;
    }
    if constexpr (requires { law_.Lever(1); }) AddLevers<kTangent>(shape);
    return residual_.allFinite();
  }

  template <bool kTangent>
  bool AddPiece(int i, const Eigen::Quaterniond& from, Eigen::Quaterniond to) {
    if (from.dot(to) < 0) to.coeffs() *= -1;
    const Eigen::Matrix3d R =
        Eigen::Quaterniond(from.coeffs() + to.coeffs()).normalized().toRotationMatrix();
    const Eigen::Vector3d F = law_.Force(middle_[At(i)]);
    RodSection section;
    if (!law_.At(i, zeta_.col(i), R.transpose() * F, section)) return false;
    const Eigen::Vector3d m = R * section.moment, t = R * section.stretch;
    const Eigen::Vector3d push = 0.5 * h_[At(i)] * F.cross(t);
    residual_.col(i) += m + push;
    if (i > 0) residual_.col(i - 1) += push - m;
    if constexpr (requires { law_.DeadMoment(i + 1); }) residual_.col(i) -= law_.DeadMoment(i + 1);
    if (kTangent) AddTangent(i, R, F, m, t, section);
    return true;
  }

  // dm = A d + N a and h/2 F x dt = G d + H a for d = (phi_1 - phi_0)/h, a = (phi_0 + phi_1)/2.
  void AddTangent(int i, const Eigen::Matrix3d& R, const Eigen::Vector3d& F,
                  const Eigen::Vector3d& m, const Eigen::Vector3d& t, const RodSection& section) {
    const auto turned = [&](const Eigen::Matrix3d& x) -> Eigen::Matrix3d {
      return R * x * R.transpose();
    };
    const double h = h_[At(i)];
    const Eigen::Matrix3d by_F = Skew(F);
    const Eigen::Matrix3d elastic = ElasticOf(i) / h;
    Eigen::Matrix3d A = turned(section.moment_by_zeta / h + shift_ * elastic), N = -0.5 * Skew(m);
    Eigen::Matrix3d G = Eigen::Matrix3d::Zero(), H = -0.25 * h * by_F * Skew(t);
    if constexpr (Law::kShear) {
      N += 0.5 * turned(section.moment_by_n) * by_F;
      G = 0.5 * by_F * turned(section.stretch_by_zeta);
      H += 0.25 * h * by_F * turned(section.stretch_by_n) * by_F;
    }
    Couple(i, A + N + G + H, N - A + H - G, G + H - A - N, A - G + H - N, stiffness_);
    if (shift_ != 0) return;
    const Eigen::Matrix3d E = turned(elastic);
    Couple(i, E, -E, -E, E, metric_);
  }

  // Blocks (row, column) of the piece's two ends.
  void Couple(int i, const Eigen::Matrix3d& end_end, const Eigen::Matrix3d& end_start,
              const Eigen::Matrix3d& start_end, const Eigen::Matrix3d& start_start,
              BlockTridiagonal& matrix) const {
    matrix.diagonal(i) += end_end;
    if (i == 0) return;
    matrix.lower(i) += end_start;
    matrix.upper(i) += start_end;
    matrix.diagonal(i - 1) += start_start;
  }

  template <bool kTangent>
  void AddLevers(const Shape& shape) {
    for (int node = 1; node <= pieces_; ++node) {
      const Eigen::Vector3d P = law_.Lever(node);
      if (P.isZero(0)) continue;
      const Eigen::Vector3d t = shape[At(node)] * law_.axis();
      residual_.col(node - 1) += P.cross(t);
      if (kTangent) stiffness_.diagonal(node - 1) -= Skew(P) * Skew(t);
    }
  }

  Law& law_;
  int pieces_;
  std::vector<double> h_, middle_;  ///< lengths of the pieces; their middles over the whole length
  double shift_ = 0;
  Eigen::Matrix3Xd zeta_, residual_;
  BlockTridiagonal stiffness_, metric_;
};

}  // namespace continuum::statics
