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

using Axes = std::vector<Axis<double>>;  ///< of the lower end of every module, as a rule

/// Whether any of them is.
bool IsJump(const ModuleSeries& series, const Axes& from, const Axes& to);
/// Those of unstrained modules.
Axes Unstrained(const ModuleSeries& series);

/// The initial value problem of modules in series under a fraction of their pressures and loads:
/// forward.h.
///
/// A section is solved from the one before it, so that a module stays on one branch.
class Rod {
 public:
  /// Derivatives by M(0) per unit() (three), gamma and E.
  using Dual = ceres::Jet<double, 5>;
  /// rho, quaternion w x y z, M.
  template <class T>
  using State = Eigen::Matrix<T, 10, 1>;

  /// series and method must outlive the rod. steps: of every module.
  Rod(const ModuleSeries& series, const Method& method, const Case& row, double fraction,
      int steps);
  Rod(ModuleSeries&&, const Method&, const Case&, double, int) = delete;

  /// Lower sections of the modules near those to come. Without them the first integration raises
  /// pressures and load of these sections from zero.
  void StartFrom(const Axes& bases);

  /// From the base, with M(0) = moment ModuleSeries::unit(), to the end of the last soft part.
  /// False when a section cannot carry its load inside the domain.
  bool Integrate(const Eigen::Vector3d& moment, State<double>& tip);
  bool Integrate(const Eigen::Vector3d& moment, State<Dual>& tip);

  /// M there minus the moment of the last mount and the tip force, per unit.
  template <class T>
  Eigen::Matrix<T, 3, 1> Mismatch(const State<T>& tip) const;

  /// Of every module the states at its steps + 1 even stations; empty when a section cannot carry
  /// its load.
  std::vector<std::vector<State<double>>> States(const Eigen::Vector3d& moment);
  /// Strains of the sections there.
  std::vector<Axes> Sections(const Eigen::Vector3d& moment);
  /// The places of the states: the axes.
  std::vector<std::vector<Eigen::Vector3d>> Lines(const Eigen::Vector3d& moment);

  /// Strains at the lower ends and reserve of the last integration (the latter with derivatives
  /// only).
  const Axes& bases() const { return bases_; }
  const Reserve& reserve() const { return reserve_; }

  /// Unit vector d_2 of a state.
  template <class T>
  static Eigen::Matrix<T, 3, 1> Tangent(const State<T>& state);

 private:
  template <class T>
  struct Strain {
    Eigen::Matrix<T, 3, 1> xi, zeta;
  };

  using Stations = std::vector<std::vector<State<double>>>;

  template <class T>
  bool Run(const Eigen::Vector3d& moment, State<T>& state, Stations* stations);
  template <class T>
  bool RunModule(State<T>& state, Stations* stations);
  template <class T>
  void Enter(std::size_t module, State<T>& state);
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
  const Module& module() const { return series_[at_]; }

  const ModuleSeries& series_;
  const Method& method_;
  std::vector<Eigen::VectorXd> p_;  // of every module
  Eigen::Vector3d force_, gravity_;
  int steps_;
  double unit_;
  std::vector<double> at_rest_;  // determinants of the tangents of unloaded sections, by module
  std::size_t at_ = 0;           // the module that is looked at
  std::vector<bool> known_;      // whether a section of the module has been solved
  std::vector<SolvedSection> solved_;  // of this integration or the one before, in order
  std::size_t first_ = 0, next_ = 0;   // of the module; the one to come
  Axis<double> section_ = {1, 0, 0};   // the last one that was solved
  Axes bases_;
  Reserve reserve_;
};

}  // namespace continuum::stiff_flop
