#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "models/statics/rod_chain.h"
#include "models/tdcr/unit_rod.h"

namespace continuum::tdcr {

/// A section of the rod in channels of cosserat.h as a law for statics::RodChain, in units of L and
/// EI/L: moment K (u - u_0) + sum T_k d|w_k|/du, w_k = e_3 + u x a_k + a_k'. Arcs between disks are
/// cut into equally many pieces; holes are those in the middles of pieces.
///
/// With friction T_k falls from piece to piece by exp(-s mu angle), the angle between the tendon's
/// directions in the middles of two pieces, s the share of friction of the contact between them.
class RodLaw {
 public:
  static constexpr bool kShear = false;

  /// pieces: a multiple of the arcs. share: of the contacts along the rod, rows x tendons, held as
  /// they are; empty: the directions of the rod's tendons.
  RodLaw(UnitRod rod, int pieces, Eigen::MatrixXd share = {});

  bool friction() const { return rod_.friction; }
  int pulling() const { return static_cast<int>(rod_.pull.size()); }
  bool has_moments() const { return rod_.has_moments(); }

  double length() const { return 1; }
  Eigen::Vector3d axis() const { return Eigen::Vector3d::UnitZ(); }
  Eigen::Matrix3d ElasticOf(int piece) const {
    return rod_.Arc(ArcOf(piece)).stiffness.asDiagonal();
  }
  std::vector<double> lengths() const;  ///< of the pieces
  Eigen::Vector3d DeadMoment(int node) const;
  bool OneArc(int piece, int other) const { return ArcOf(piece) == ArcOf(other); }
  Eigen::Vector3d Force(double s) const;
  bool Prepare(const Eigen::Matrix3Xd& zeta);
  bool At(int piece, const Eigen::Vector3d& u, const Eigen::Vector3d& n,
          statics::RodSection& section) const;

  /// T_k in the middles of the pieces, tendons x pieces, and the moment of a unit of it, d|w_k|/du.
  const Eigen::MatrixXd& tension() const { return tension_; }
  Eigen::Vector3d LeverOf(int piece, int tendon, const Eigen::Vector3d& u) const;
  /// Lengths of the tendons beyond the starts of pieces of these curvatures, pieces x tendons [L].
  Eigen::MatrixXd Beyond(const Eigen::Matrix3Xd& zeta) const;
  /// s of the contact between piece i - 1 and piece i (0: at the base); 1 without contacts that
  /// remember.
  double Share(int i, int tendon) const;
  /// With which stiffness that contact holds the tendon beyond it [EI/L^3]: those that rest, and
  /// at the base winches.
  double Holds(int i, int tendon) const;
  /// Winches: stiffness of every tendon [EI/L^3], 0 when it is slack.
  void SetWinches(Eigen::VectorXd stiffness) { winches_ = std::move(stiffness); }
  bool holds() const { return share_.size() > 0 || winches_.size() > 0; }

 private:
  int ArcOf(int piece) const { return piece / per_arc_; }
  ChannelPoint Hole(int piece, int tendon) const;
  bool Runs(int piece, int tendon) const {
    return rod_.Runs(static_cast<std::size_t>(tendon), ArcOf(piece));
  }
  double Length(int piece) const { return rod_.Arc(ArcOf(piece)).length() / per_arc_; }
  void LoseTension(int tendon, const Eigen::Matrix3Xd& zeta);

  UnitRod rod_;
  int pieces_, per_arc_;
  Eigen::MatrixXd share_, tension_;
  Eigen::VectorXd winches_;
};

/// Negative eigenvalues of the symmetric part of the whole rod's tangent at the shape that `chain`
/// was linearized at; with friction the tensions follow the turn of the sections as the contacts
/// slide, and contacts that rest hold the tendon beyond them.
int UnstableDirections(const statics::RodChain<RodLaw>& chain, const RodLaw& law,
                       const statics::RodChain<RodLaw>::Shape& shape);

}  // namespace continuum::tdcr
