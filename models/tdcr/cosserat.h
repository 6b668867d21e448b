#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "models/tdcr/unit_rod.h"

namespace continuum::tdcr {

/// Kirchhoff rod (inextensible, unshearable) whose tendons run in frictionless channels along
/// curves parallel to it, as a shooting problem for numerics::Newton. Everything in units of L and
/// EI/L.
///
///   w_k = e_3 + u x a_k              tendon k per unit of rod, |w_k| its stretch           (1)
///   nu = K (u - u_0) + sum_k T_k a_k x w_k/|w_k| = R^T (moment of all dead forces beyond s) (2)
///   nu' = -u x nu - e_3 x R^T N(s)   N: sum of the dead forces beyond s                    (3)
///   R' = R [u]x,  p' = R e_3,  R(0) = 1,  p(0) = 0,  nu(1) = 0                             (4)
///
/// (2) is the gradient of the energy u.Ku/2 + sum T_k |w_k|, so (3) gives u' by its Hessian H:
/// H u' = -u x nu - e_3 x R^T N. The unknown is u(0), the residual R nu(1), seen from the base
/// frame (in the tip's, bending alone would turn the Jacobian over). Disk masses are forces at s =
/// i/n, where N jumps and u does not.
///
/// With friction (beyond the paper) the tension falls along the channel, T_k' = -dir_k mu T_k
/// |t_k'| with t_k the unit vector of w_k, and T_k' a_k x t_k joins H u' on the left (rubbing.h).
class RodBalance {
 public:
  using Vector = Eigen::Vector3d;

  /// steps: of the integrator per piece between disks.
  RodBalance(const Robot& robot, const Loads& loads, bool friction, int steps);

  /// All loads are multiplied by this from here on.
  void SetLoad(double load) { load_ = load; }
  double load() const { return load_; }
  void SetSteps(int steps) { steps_ = steps; }
  int steps() const { return steps_; }

  template <class T>
  bool operator()(const T* x, T* f) const;

  struct Shape {
    Eigen::Matrix3Xd disks;  ///< O_1..O_n [m]
    /// kappa_x = u_y, kappa_y = -u_x, tau in the middles [1/m]; for an even number of steps.
    Eigen::Matrix3Xd middles;
    std::vector<Eigen::Quaterniond> frames;  ///< R at the ends of all steps, from R(0) = 1
    Eigen::Vector3d residual = Eigen::Vector3d::Zero();  ///< R nu(1)
    bool valid = false;
  };
  /// What was integrated last is not integrated again.
  const Shape& Integrate(const Vector& x) const;

 private:
  // kRubbing: tendons whose tension falls along the rod, at most; 0 without friction.
  template <class T, int kRubbing>
  struct State;
  template <class T, int kRubbing>
  bool Slope(const State<T, kRubbing>& y, const Eigen::Vector3d& force,
             State<T, kRubbing>& dy) const;
  template <class T, int kRubbing>
  void Rub(const State<T, kRubbing>& y, const Eigen::Matrix<T, 3, 3>& hessian,
           const Eigen::Matrix<T, 3, 1>& right, State<T, kRubbing>& dy) const;
  template <class T, int kRubbing>
  Eigen::Matrix<T, 3, 1> Moment(const State<T, kRubbing>& y) const;
  template <class T, int kRubbing, class AtNode>
  bool Walk(const T* x, Eigen::Matrix<T, 3, 1>& end, AtNode&& at_node) const;
  // Walk with room for as many tensions as there are.
  template <class T, class AtNode>
  bool WalkAny(const T* x, Eigen::Matrix<T, 3, 1>& end, AtNode&& at_node) const;
  Eigen::Vector3d DeadForce(int piece, double s) const;

  double length_;
  UnitRod rod_;
  int steps_;
  double load_ = 1;

  struct Integrated {
    Vector x = Vector::Constant(std::numeric_limits<double>::quiet_NaN());
    double load = 0;
    int steps = 0;
    Shape shape;
  };
  mutable std::array<Integrated, 2> integrated_;  ///< the last two
};

}  // namespace continuum::tdcr
