#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "models/statics/slide.h"
#include "models/tdcr/contact_factors.h"
#include "models/tdcr/line.h"
#include "models/tdcr/section_moment.h"
#include "models/tdcr/unit_rod.h"

namespace continuum::tdcr {

/// Kirchhoff rod (inextensible, unshearable) whose tendons run in frictionless channels at a_k(s)
/// in its section, as a shooting problem for numerics::Newton (Rucker & Webster 2011, here without
/// shear and stretch). Everything in units of L and EI/L.
///
///   w_k = e_3 + u x a_k + a_k'       tendon k per unit of rod, |w_k| its stretch           (1)
///   nu = K (u - u_0) + sum_k T_k a_k x w_k/|w_k| = R^T (moment of all dead loads beyond s)  (2)
///   nu' = -u x nu - e_3 x R^T N(s)   N: sum of the dead forces beyond s                    (3)
///   R' = R [u]x,  p' = R e_3,  R(0) = 1,  p(0) = 0,  nu(1) = R^T (dead moment at the tip)  (4)
///
/// (2) is the gradient of the energy (u - u_0).K(u - u_0)/2 + sum T_k |w_k|, so (3) gives u' by its
/// Hessian H: H u' = -u x nu - e_3 x R^T N - dnu/ds, where u stays in dnu/ds: a_k changes along a
/// helix or cone (section_moment.h). The unknown is u(0), the residual R nu(1) less the moment at
/// the tip, seen from the base frame (in the tip's, bending alone would turn the Jacobian over).
/// What a tendon does to the rod, T (t_k' in space) per length with its moment a_k x, and T t_k
/// where it ends, is in (2): it is the tendon's own balance, its pull at a section being T t_k.
///
/// At disks N jumps by their weights and dead forces, R nu by dead moments. Where K, u_0 or a_k'
/// jump, or a tendon ends, nu goes on and u jumps to what (2) asks of it beyond the disk.
///
/// With friction (beyond the paper) the tension falls along the channel, T_k' = -s_k mu T_k |t_k'|
/// with t_k the unit vector of w_k, and T_k' a_k x t_k joins H u' on the left (rubbing.h). s_k is
/// dir_k; where a tendon turns by an angle b at a disk, T_k falls by exp(-s_k mu b). Or, of
/// contacts that remember,
///
///   s_k = SlideFrom(s_before, (b_before - b_k)/eps),  b_k = int_s^1 |w_k|                    (5)
///
/// where b_k is the tendon's length beyond the start of the integrator's step: a contact. All b_k
/// are unknowns after u(0), and (5) residuals after R nu(1). Shares taken from lengths on the way
/// would grow errors by exp(sqrt(mu T |t'| a^2/(EI eps)) s), some 1e15 along a rod.
/// Where all directions are given, only the whole lengths are unknowns, those of the first step.
class RodBalance {
 public:
  /// steps: of the integrator per arc between disks.
  RodBalance(const Robot& robot, const Loads& loads, bool friction, int steps);
  /// With contacts that remember, from loads.from; the loads grow from those of `earlier` (nothing
  /// when not given).
  static RodBalance Remembering(const Robot& robot, const Loads& loads, int steps,
                                const Loads* earlier);

  /// How far the loads have grown from here on: 0 to 1.
  void SetLoad(double load);
  /// Tensions [N] of all tendons that do not grow with the loads; of contacts that remember.
  void SetTension(const Eigen::VectorXd& tension);
  double load() const { return load_; }
  /// Contacts that remember turn from rest to sliding within this [m]: kGivesWay, or more on the
  /// way to a root.
  void SetWidth(double width);
  /// u(0) when nothing acts.
  Eigen::Vector3d Natural() const { return rod_.Arc(0).natural; }
  /// The rod with the loads of now.
  const UnitRod& rod() const { return rod_; }
  bool remembers() const { return remembers_; }
  int unknowns() const {
    return remembers() ? 3 + contacts_ * static_cast<int>(rod_.pull.size()) : 3;
  }
  /// Unknowns of this u(0) [1/L]: with the contacts where they begin; with those given by lengths
  /// of the tendons beyond the starts of as many parts of the rod, parts x tendons [L]; and with
  /// those of the shape that it has where the contacts begin.
  Eigen::VectorXd Unslid(const Eigen::Vector3d& u) const;
  Eigen::VectorXd Unknowns(const Eigen::Vector3d& u, const Eigen::MatrixXd& beyond) const;
  Eigen::VectorXd Slid(const Eigen::Vector3d& u) const;
  void SetSteps(int steps) { steps_ = steps; }
  int steps() const { return steps_; }

  using Factors = ContactFactors;
  template <class T>
  bool operator()(const T* x, T* f) const;
  /// Of contacts that remember.
  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const;

  struct Shape {
    Eigen::Matrix3Xd disks;  ///< O_1..O_n [m]
    /// kappa_x = u_y, kappa_y = -u_x, tau in the middles [1/m]; for an even number of steps.
    Eigen::Matrix3Xd middles;
    std::vector<Eigen::Quaterniond> frames;  ///< R at the ends of all steps, from R(0) = 1
    Eigen::Matrix3Xd points;                 ///< p there [L]
    Eigen::Matrix3Xd u;                      ///< u there, from the place on [1/L]
    Eigen::Matrix3Xd ends;                   ///< u where arcs end, before the disks [1/L]
    Eigen::MatrixXd tension;                 ///< T_k there [EI/L^2]
    Eigen::MatrixXd way;                     ///< int |w_k| to there, of contacts that remember [L]
    Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< R nu(1)
    bool valid = false;
  };
  /// What was integrated last is not integrated again.
  const Shape& Integrate(const Eigen::VectorXd& x) const;
  /// A shape in metres and newtons.
  Line LineOf(const Shape& shape) const;
  /// Where contacts that remember stand at x.
  Contacts ContactsAt(const Eigen::VectorXd& x) const;
  /// They slide from there: loads.from, or where they were told to go on from.
  const Contacts& from() const { return slid_from_; }
  void GoOnFrom(const Eigen::VectorXd& x);
  /// Lengths of the tendons beyond the contacts that find their directions, over kGivesWay; empty
  /// when there are none. And whether some of these neither slide on nor have turned.
  Eigen::VectorXd SlidAt(const Eigen::VectorXd& x) const;
  bool SomeRest(const Eigen::VectorXd& x) const;

 private:
  // kRubbing: tendons whose tension falls along the rod, at most; 0 without friction. kSlides:
  // contacts remember.
  template <class T, int kRubbing, bool kSlides>
  struct State;
  struct Place {
    int arc;
    double s;
  };
  template <class T, int kRubbing, bool kSlides>
  bool AddTendons(const Place& at, const State<T, kRubbing, kSlides>& y, SectionMoment<T>& sum,
                  State<T, kRubbing, kSlides>* dy) const;
  template <class T, int kRubbing, bool kSlides>
  bool Slope(const Place& at, const State<T, kRubbing, kSlides>& y, const T* share,
             State<T, kRubbing, kSlides>& dy) const;
  template <class T, int kRubbing, bool kSlides>
  void Rub(const Place& at, const State<T, kRubbing, kSlides>& y,
           const Eigen::Matrix<T, 3, 3>& hessian, const Eigen::Matrix<T, 3, 1>& right,
           const T* share, State<T, kRubbing, kSlides>& dy) const;
  template <class T, int kRubbing, bool kSlides>
  bool Jump(int arc, const T* share, State<T, kRubbing, kSlides>& y) const;
  template <class T, int kRubbing, bool kSlides>
  void LoseAtDisk(int arc, const T* share, const State<T, kRubbing, kSlides>& before,
                  State<T, kRubbing, kSlides>& y) const;
  template <class T>
  SectionMoment<T> Elastic(int arc, const Eigen::Matrix<T, 3, 1>& u) const {
    return {u, rod_.Arc(arc).natural, rod_.Arc(arc).stiffness};
  }
  template <class T, int kRubbing, bool kSlides>
  State<T, kRubbing, kSlides> Base(const T* x) const;
  template <class T, int kRubbing>
  void Slide(int step, const T* x, const State<T, kRubbing, true>& y, T* share, T* end) const;
  template <class T, int kRubbing, bool kSlides>
  void End(const T* x, const State<T, kRubbing, kSlides>& y, T* end) const;
  template <class T, int kRubbing, bool kSlides, class AtNode>
  bool Advance(int step, const T* share, State<T, kRubbing, kSlides>& y, AtNode&& at_node) const;
  template <class T, int kRubbing, bool kSlides, class AtNode>
  bool Walk(const T* x, T* end, int first, State<T, kRubbing, kSlides> y, AtNode&& at_node) const;
  template <class T, int kRubbing, bool kSlides, class AtNode>
  bool WalkAll(const T* x, T* end, AtNode&& at_node) const;
  template <int kRubbing>
  bool JacobianOf(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const;
  // By whole walks from where an unknown acts, or by steps that are chained.
  template <int kRubbing>
  bool ByWalks(const Eigen::VectorXd& x, const std::vector<State<double, kRubbing, true>>& at,
               const std::vector<Eigen::Index>& coupled, Eigen::MatrixXd& jacobian) const;
  template <int kRubbing>
  bool BySteps(const Eigen::VectorXd& x, const std::vector<State<double, kRubbing, true>>& at,
               const std::vector<Eigen::Index>& coupled, Eigen::MatrixXd& jacobian) const;
  template <int kRubbing>
  bool StepSlopes(const Eigen::VectorXd& x, int step, const State<double, kRubbing, true>& y,
                  Eigen::MatrixXd& slopes) const;
  template <int kRubbing>
  void EndSlopes(const Eigen::VectorXd& x, const State<double, kRubbing, true>& y,
                 Eigen::MatrixXd& slopes) const;
  // WalkAll with room for as many tensions as there are.
  template <class T, bool kSlides, class AtNode>
  bool WalkAny(const T* x, T* end, AtNode&& at_node) const;
  // (5), of a tendon whose direction is not given.
  template <class T>
  T Share(int step, std::size_t tendon, const T& beyond) const {
    const int direction = rod_.direction[tendon];
    if (direction != kAsItSlides) return T(direction);
    const auto k = static_cast<Eigen::Index>(tendon);
    const double before = slid_from_.share.size() > 0 ? slid_from_.share(step, k) : 0;
    return statics::SlideFrom(before, T((length_ / width_) * (beyond_before_(step, k) - beyond)));
  }
  // Lengths of the tendons beyond their starts, of lengths in the steps [L].
  static void SumBeyond(Eigen::MatrixXd& length);
  // Per tendon, steps x tendons, of the rod when nothing acts [L].
  Eigen::MatrixXd RestLengths(int steps) const;
  template <class T>
  const T& Beyond(const T* x, int contact, std::size_t tendon) const {
    return x[3 + static_cast<std::size_t>(contact) * rod_.pull.size() + tendon];
  }
  // Unknowns that move more than their own residual.
  std::vector<Eigen::Index> Coupled(const Eigen::VectorXd& x) const;

  double length_;
  double unit_;  ///< EI/L^2 [N]
  int tendons_, disks_;
  UnitRod to_, from_, rod_;
  int steps_;
  bool remembers_ = false;
  Contacts slid_from_;
  int contacts_ = 0;               ///< per tendon, whose b is an unknown: all, or the first
  Eigen::MatrixXd beyond_before_;  ///< b_before of every step and tendon [L]
  double load_ = 1;
  double width_ = kGivesWay;

  // What was integrated.
  void Forget();

  struct Integrated {
    Eigen::VectorXd x;
    double load = 0;
    int steps = 0;
    Shape shape;
  };
  mutable std::array<Integrated, 2> integrated_;  ///< the last two
};

}  // namespace continuum::tdcr
