#pragma once

#include <vector>

#include "models/statics/rod_chain.h"
#include "models/stiff_flop/elastic.h"

namespace continuum::stiff_flop {

/// Sections of modules in series (elastic.h) as a law for statics::RodChain, under a share of
/// pressures and loads, in units of ModuleSeries::length() and ModuleSeries::unit(): the stretch
/// lambda is the one that carries n_y,
///
///   n_y(lambda, k) = n_y,  zeta_x = -lambda k_2,  zeta_z = -lambda k_1                      (1)
///
/// moments are those of the section there, with their derivatives by (1).
class RodLaw {
 public:
  static constexpr bool kShear = true;

  /// series, method and row must outlive it. pieces: of every module.
  RodLaw(const ModuleSeries& series, const Method& method, const Case& row, double share,
         int pieces);
  RodLaw(ModuleSeries&&, const Method&, const Case&, double, int) = delete;

  double length() const { return 1; }
  Eigen::Vector3d axis() const { return Eigen::Vector3d::UnitY(); }
  Eigen::Vector3d Force(double s) const;
  Eigen::Vector3d Lever(int node) const;
  Eigen::Matrix3d ElasticOf(int piece) const { return elastic_[ModuleOf(piece)]; }
  /// Of all pieces, for the chain.
  std::vector<double> Lengths() const;
  bool Prepare(const Eigen::Matrix3Xd& /*zeta*/) { return true; }
  bool At(int piece, const Eigen::Vector3d& zeta, const Eigen::Vector3d& n,
          statics::RodSection& section);
  /// The strains that At has found last for a piece.
  const Axis<double>& axis(int piece) const { return axes_[static_cast<std::size_t>(piece)]; }

 private:
  using Dual = ceres::Jet<double, 3>;  // by lambda, k_1, k_2

  std::size_t ModuleOf(int piece) const { return static_cast<std::size_t>(piece / pieces_); }
  bool FindStretch(std::size_t module, const Eigen::Vector3d& zeta, double n_y, Axis<double>& axis,
                   Reaction<Dual>& reaction) const;
  void Fill(std::size_t module, const Eigen::Vector3d& zeta, const Eigen::Vector3d& n,
            const Axis<double>& axis, const Reaction<Dual>& reaction,
            statics::RodSection& section) const;

  const ModuleSeries& series_;
  const Method& method_;
  std::vector<Eigen::VectorXd> p_;
  Eigen::Vector3d force_, gravity_;
  int pieces_;
  double length_, unit_;
  std::vector<Eigen::Matrix3d> elastic_;  // of every module
  std::vector<Axis<double>> axes_;
};

}  // namespace continuum::stiff_flop
