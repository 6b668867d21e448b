#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "models/tdcr/arc.h"
#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// One tendon along one arc, from hole a to hole R_z(psi) a of the next disk, seen by the arc
/// alone.
struct Chord {
  using Gradient = Eigen::Matrix<double, 3, 3>;  ///< columns: by v_x, v_y, psi

  Eigen::Vector3d moment;  ///< of a unit tension about the arc's start, in the untwisted end frame
  Eigen::Vector2d
      start;            ///< unit vector along the chord without z, in the frame of the arc's start
  Eigen::Vector2d end;  ///< the same in the frame of the arc's end
  double length;
  Gradient d_moment;
  Eigen::RowVector3d d_length;
  Eigen::Matrix<double, 2, 3> d_start, d_end;
};

/// The chord c = p + D a - a of length |c| = sqrt(2 B g h + 2 a^2 (1 - cos psi)) with g = l - v.a',
/// h = l - v.a, a' = R_z(psi) a. All distal forces of a tendon add up to -F c/|c| at the hole of
/// the arc's start (its pieces between disks are pairs of opposite forces on one line), so
///
///   moment = -Q^T (a x c)/|c| = -(A b_y, -A b_x, B v x b + a^2 sin psi)/|c|,  b = l a - (v.a) a'.
///
/// @returns false when the chord has no length. Derivatives only when asked for.
bool TendonChord(const Arc& arc, const Eigen::Vector2d& a, bool derivatives, Chord& chord);

/// Tension after a disk over tension before it, (13)-(14): s (1 - x) = mu |N|, N = a + x b with
/// a = -end of the arc before and b = start of the arc after, both without z.
struct FrictionRatio {
  double x = 1;
  Eigen::Vector2d d_end = Eigen::Vector2d::Zero(), d_start = Eigen::Vector2d::Zero();

  FrictionRatio() = default;
  /// s: 1 pulled, -1 released, 0 without friction.
  FrictionRatio(const Eigen::Vector2d& end, const Eigen::Vector2d& start, double mu, int s);
  /// dx/dmu of the ratio of these.
  double ByMu(const Eigen::Vector2d& end, const Eigen::Vector2d& start, double mu, int s) const;
};

/// Frames and origins of all disks for curvatures u_1..u_n (columns of u, [1/m]).
struct Chain {
  std::vector<Eigen::Matrix3d> R;  ///< n + 1, base frame
  std::vector<Eigen::Vector3d> O;  ///< n + 1, [m]
};
/// lengths: of the arcs [m].
Chain Forward(const Eigen::VectorXd& lengths, const Eigen::Matrix3Xd& u);
/// O_1..O_n of Forward, as columns.
Eigen::Matrix3Xd Positions(const Eigen::VectorXd& lengths, const Eigen::Matrix3Xd& u);
/// Of a robot without sections.
inline Eigen::VectorXd EqualArcs(const Robot& robot) {
  return Eigen::VectorXd::Constant(robot.disks, robot.arc());
}

/// Curvature of arc i (1..n) between the first and the last, (1).
inline double Fraction(int i, int n) { return (i - 1.0) / (n - 1.0); }
/// The balance of moments of all arcs, (9)-(23), as a problem for numerics::Newton.
///
/// Unknowns: x = L (u_1, u_n) for C = 6 (Euler arc spline: the six equations (24)-(27)), or
/// x = L (u_1, .., u_n) for a dynamic C (constant curvature piecewise: 3n equations). Residuals
/// over EI/L. An object belongs to one thread: it keeps its scratch memory.
template <int C>
class DiskBalance {
 public:
  using Vector = Eigen::Matrix<double, C, 1>;
  using Matrix = Eigen::Matrix<double, C, C>;

  /// Loads grow from `from` (nothing when not given) to `loads`, which must outlive it.
  DiskBalance(const Robot& robot, const Loads& loads, const Loads* from = nullptr);

  /// How far the loads have grown from here on: 0 to 1.
  void SetLoad(double load);
  /// Tensions [N] that do not grow with the loads.
  void SetTension(const Eigen::VectorXd& tension);
  int unknowns() const { return C == Eigen::Dynamic ? 3 * robot_.disks : C; }
  bool operator()(const double* x, double* f) const;
  bool Jacobian(const Vector& x, Vector& f, Matrix& jacobian) const;
  /// J_0^-1 J or J_0^-1 f, J_0 that of the rod without loads: (e_y, -e_x, -e_z/(1 + nu)) in every
  /// block.
  template <class M>
  M RelativeToUnloaded(const M& rows) const {
    M relative = rows;
    for (int i = 0; i < unknowns(); i += 3) {
      relative.row(i) = -rows.row(i + 1);
      relative.row(i + 1) = rows.row(i);
      relative.row(i + 2) = -(1 + robot_.nu) * rows.row(i + 2);
    }
    return relative;
  }
  /// The stiffness of the whole segment over EI/L for a tangent over that without loads:
  /// generalized forces are sums over arcs, which for C = 6 share the two ends' curvatures
  /// linearly.
  Matrix Stiffness(const Matrix& relative) const;
  /// Curvatures of the arcs [1/m], 3 x n.
  Eigen::Matrix3Xd Curvatures(const Vector& x) const;
  /// Where the contacts stand at x.
  Contacts ContactsAt(const Vector& x) const;
  /// As those of RodBalance.
  const Contacts& from() const { return slid_from_; }
  void GoOnFrom(const Vector& x) {
    if (loads_.AsItSlides()) slid_from_ = ContactsAt(x);
  }
  Eigen::VectorXd SlidAt(const Vector& x) const;
  bool SomeRest(const Vector& x) const { return tdcr::SomeRest(ContactsAt(x)); }
  /// Lengths of the tendons in every arc, n x m [m].
  Eigen::MatrixXd LengthsAt(const Vector& x) const;
  /// Tensions at x, of every arc and tendon [N].
  Eigen::MatrixXd TensionsAt(const Vector& x) const;

 private:
  using Columns = Eigen::Matrix<double, 3, C>;
  using Row = Eigen::Matrix<double, 1, C>;

  // Of what is `to` at full load and `from` before.
  template <class Load>
  Load Now(const Load& to, const Load& from) const {
    return load_ * to + (1 - load_) * from;
  }
  Eigen::Vector3d Curvature(const double* x, int i) const;
  template <class Target, class Local>
  void Scatter(int i, const Local& local, Target& target) const;
  template <bool kDerivatives>
  bool Assemble(const double* x) const;
  template <bool kDerivatives>
  bool AddTendons() const;
  template <bool kDerivatives>
  void FindShares(std::size_t tendon) const;
  template <bool kDerivatives>
  void AddDeadForces() const;
  void Project(const double* x, double* f) const;

  const Robot& robot_;
  const Loads& loads_;
  Loads from_;
  Contacts slid_from_;
  double load_ = 1;
  std::vector<double> pull_;  ///< tensions now [N]
  bool pulls_grow_ = true;
  double mass_;  ///< of one disk and its arc [kg]
  std::vector<Eigen::Vector2d> holes_;
  mutable std::vector<Arc> arcs_;
  mutable std::vector<Eigen::Vector3d> m_;  ///< moments in the untwisted end frames [N m]
  mutable std::vector<Columns> dm_;
  mutable std::vector<Eigen::Matrix3d> R_, G_;
  mutable std::vector<Eigen::Vector3d> O_;
  mutable std::vector<Columns> dO_, dphi_, dphi_end_;
  mutable std::vector<Chord> chords_;  ///< of one tendon
  mutable std::vector<double> share_;  ///< of its contacts, by how it slides
  mutable std::vector<Row> dshare_;
  mutable Eigen::MatrixXd tension_;  ///< when asked for
};

extern template class DiskBalance<6>;
extern template class DiskBalance<Eigen::Dynamic>;

}  // namespace continuum::tdcr
