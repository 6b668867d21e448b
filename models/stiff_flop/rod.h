#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "models/stiff_flop/case.h"
#include "models/stiff_flop/tubes.h"
#include "sim/numerics/solver.h"

namespace continuum::stiff_flop {

/// What the sections of a rod had left when it was last integrated with derivatives.
struct Reserve {
  /// Smallest Margin(...).
  double domain = std::numeric_limits<double>::infinity();
  /// Smallest determinant of a section's tangent stiffness over that of the unloaded section;
  /// 0 = the section carries no more.
  double stiffness = std::numeric_limits<double>::infinity();
  /// Whether tension alone and bending alone are stiff as well.
  bool plain = true;
};

/// A section that has been solved, in the unknowns and scaled loads of its equations: where to
/// start a section under a similar load.
struct SolvedSection {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d load = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();  ///< of the tangent; 0: not known
};

/// Whether two sections are too far apart to be neighbours on a path of rising load: a fifth of the
/// stretch or of the curvature that folds.
bool IsJump(const Module& module, const Axis<double>& from, const Axis<double>& to);

/// The initial value problem of a module under a fraction of its pressures and loads: forward.h.
///
/// A section is solved from the one before it, so that a rod stays on one branch.
class Rod {
 public:
  /// Derivatives by M(0) per unit() (three), gamma and E.
  using Dual = ceres::Jet<double, 5>;
  /// rho, quaternion w x y z, M.
  template <class T>
  using State = Eigen::Matrix<T, 10, 1>;

  /// module and method must outlive the rod.
  Rod(const Module& module, const Method& method, const Case& row, double fraction, int steps);

  /// A base section near the one to come. Without it the first integration raises pressures and
  /// load of the base section from zero.
  void StartFrom(const Axis<double>& base);

  int steps() const { return steps_; }
  /// E J_0/l [N m].
  double unit() const { return unit_; }

  /// From the base, with M(0) = moment unit(), to s = l. False when a section cannot carry its
  /// load inside the domain.
  bool Integrate(const Eigen::Vector3d& moment, State<double>& tip);
  bool Integrate(const Eigen::Vector3d& moment, State<Dual>& tip);

  /// M(l) minus the moment of mount and tip force, per unit().
  template <class T>
  Eigen::Matrix<T, 3, 1> Mismatch(const State<T>& tip) const;

  /// The states at steps() + 1 even stations; empty when a section cannot carry its load.
  std::vector<State<double>> States(const Eigen::Vector3d& moment);
  /// Their places: the axis.
  std::vector<Eigen::Vector3d> Line(const Eigen::Vector3d& moment);

  /// Strains at the base and reserve of the last integration (the latter with derivatives only).
  const Axis<double>& base() const { return base_; }
  const Reserve& reserve() const { return reserve_; }

  /// Unit vector d_2 of a state.
  template <class T>
  static Eigen::Matrix<T, 3, 1> Tangent(const State<T>& state);

 private:
  template <class T>
  struct Strain {
    Eigen::Matrix<T, 3, 1> xi, zeta;
  };

  template <class T>
  bool Run(const Eigen::Vector3d& moment, State<T>& state, std::vector<State<double>>* states);
  template <class T>
  bool Slope(const State<T>& state, double s, State<T>& slope);
  bool Strains(const Eigen::Vector3d& n, const Eigen::Vector3d& M, Strain<double>& strain);
  bool Strains(const Eigen::Matrix<Dual, 3, 1>& n, const Eigen::Matrix<Dual, 3, 1>& M,
               Strain<Dual>& strain);
  bool Raise(const Eigen::Vector3d& load, Eigen::Vector3d& x,
             const numerics::Options& options) const;
  bool SolveSection(const Eigen::Vector3d& load);
  bool FollowNeighbour(const Eigen::Vector3d& load);
  bool SearchSection(const Eigen::Vector3d& load);
  void Keep(const Eigen::Matrix3d& inverse);
  void Watch(const Eigen::Matrix3d& tangent);
  Eigen::Vector3d Force(double s) const;

  const Module& module_;
  const Method& method_;
  Eigen::Vector3d p_, force_, gravity_;
  int steps_;
  double unit_;
  double at_rest_;  // determinant of the tangent of the unloaded section
  bool cold_ = true;
  std::vector<SolvedSection> solved_;  // of this integration or the one before, in order
  std::size_t next_ = 0;               // the one to come
  Axis<double> section_ = {1, 0, 0};   // the last one that was solved
  Axis<double> base_ = {1, 0, 0};
  Reserve reserve_;
};

}  // namespace continuum::stiff_flop
