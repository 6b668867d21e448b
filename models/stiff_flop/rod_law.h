#pragma once

#include <vector>

#include "models/statics/rod_chain.h"
#include "models/stiff_flop/elastic.h"

namespace continuum::stiff_flop {

/// A section of the module (elastic.h) as a law for statics::RodChain, under a share of pressures
/// and loads, in units of l and E J_0/l: the stretch lambda is the one that carries n_y,
///
///   n_y(lambda, k) = n_y,  zeta_x = -lambda k_2,  zeta_z = -lambda k_1                      (1)
///
/// moments are those of the section there, with their derivatives by (1).
class RodLaw {
 public:
  static constexpr bool kShear = true;

  /// module, method and row must outlive it.
  RodLaw(const Module& module, const Method& method, const Case& row, double share, int pieces);

  double length() const { return 1; }
  Eigen::Vector3d axis() const { return Eigen::Vector3d::UnitY(); }
  Eigen::Vector3d Force(double s) const;
  Eigen::Vector3d TipLever() const;
  Eigen::Matrix3d elastic() const { return elastic_; }
  bool Prepare(const Eigen::Matrix3Xd& /*zeta*/) { return true; }
  bool At(int piece, const Eigen::Vector3d& zeta, const Eigen::Vector3d& n,
          statics::RodSection& section);
  /// The strains that At has found last for a piece.
  const Axis<double>& axis(int piece) const { return axes_[static_cast<std::size_t>(piece)]; }

 private:
  using Dual = ceres::Jet<double, 3>;  // by lambda, k_1, k_2

  bool FindStretch(const Eigen::Vector3d& zeta, double n_y, Axis<double>& axis,
                   Reaction<Dual>& reaction) const;
  void Fill(const Eigen::Vector3d& zeta, const Eigen::Vector3d& n, const Axis<double>& axis,
            const Reaction<Dual>& reaction, statics::RodSection& section) const;

  const Module& module_;
  const Method& method_;
  Eigen::Vector3d p_, force_, gravity_;
  double unit_;  // E J_0/l [N m]
  Eigen::Matrix3d elastic_ = Eigen::Matrix3d::Identity();
  std::vector<Axis<double>> axes_;
};

}  // namespace continuum::stiff_flop
