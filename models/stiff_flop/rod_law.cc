#include "models/stiff_flop/rod_law.h"

#include <cmath>

namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;

// Where (1) gives a section with zeta and stretch lambda.
Axis<double> AxisAt(const Vector3d& zeta, double lambda) {
  return {lambda, -zeta.z() / lambda, -zeta.x() / lambda};
}

}  // namespace

RodLaw::RodLaw(const ModuleSeries& series, const Method& method, const Case& row, double share,
               int pieces)
    : series_(series),
      method_(method),
      force_(share * row.load.force),
      gravity_(share * row.load.gravity),
      pieces_(pieces),
      length_(series.length()),
      unit_(series.unit()),
      elastic_(series.size(), Eigen::Matrix3d::Identity()),
      axes_(series.size() * static_cast<std::size_t>(pieces), Axis<double>{1, 0, 0}) {
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Eigen::VectorXd pressures = share * series.PressuresOf(i, row.given);
    p_.emplace_back(Eigen::VectorXd::Zero(pressures.size()));
    statics::RodSection section;
    const int first = static_cast<int>(i) * pieces;
    if (At(first, Vector3d::Zero(), Vector3d::Zero(), section))
      elastic_[i] = section.moment_by_zeta;
    p_.back() = pressures;
  }
}

std::vector<double> RodLaw::Lengths() const {
  std::vector<double> lengths;
  for (const Module& module : series_.modules) {
    lengths.insert(lengths.end(), static_cast<std::size_t>(pieces_),
                   module.l / (length_ * pieces_));
  }
  return lengths;
}

Vector3d RodLaw::Force(double s) const {
  std::size_t at = 0;
  double way = s * length_;
  while (at + 1 < series_.size() && way > series_[at].l) way -= series_[at++].l;
  const double beyond = series_[at].m * (1 - way / series_[at].l);
  return length_ / unit_ * (series_.Above(at, force_, gravity_) + beyond * gravity_);
}

Vector3d RodLaw::Lever(int node) const {
  if (node % pieces_ != 0) return Vector3d::Zero();
  return series_.Lever(ModuleOf(node - 1), force_, gravity_) / unit_;
}

bool RodLaw::FindStretch(std::size_t at, const Vector3d& zeta, double n_y, Axis<double>& axis,
                         Reaction<Dual>& reaction) const {
  constexpr double kClosest = 1e-4;  // to a fold of the section, as in rod.cc
  const Module& module = series_[at];
  const double scale = module.E * module.Area();
  double lambda = axis.lambda;
  for (int round = 0; round < 40; ++round) {
    axis = AxisAt(zeta, lambda);
    if (!(lambda > 0) || !(Margin(module, method_, axis) > kClosest)) return false;
    const Axis<Dual> seeded{Dual(axis.lambda, 0), Dual(axis.k_1, 1), Dual(axis.k_2, 2)};
    reaction = ReactionOf(module, method_, p_[at], Dual(module.E), Dual(module.gamma), seeded);
    const auto& v = reaction.n_y.v;
    const double slope = v[0] - (v[1] * axis.k_1 + v[2] * axis.k_2) / lambda;
    const double rest = reaction.n_y.a - n_y;
    if (std::abs(rest) <= 1e-13 * scale) return slope > 0;
    if (!(slope > 0)) return false;
    lambda -= std::clamp(rest / slope, -0.2 * lambda, 0.2 * lambda);
  }
  return false;
}

void RodLaw::Fill(std::size_t at, const Vector3d& zeta, const Vector3d& n, const Axis<double>& axis,
                  const Reaction<Dual>& reaction, statics::RodSection& section) const {
  const double G = series_[at].E / 3, lambda = axis.lambda, l = length_;
  // d(lambda, k_1, k_2) by (zeta, n).
  Eigen::Matrix<double, 3, 6> by = Eigen::Matrix<double, 3, 6>::Zero();
  by(1, 2) = by(2, 0) = -1 / lambda;
  const Eigen::RowVector3d n_y = reaction.n_y.v.transpose();
  const Vector3d stretched(1, -axis.k_1 / lambda, -axis.k_2 / lambda);
  Eigen::Matrix<double, 1, 6> rest = -n_y * by;
  rest[4] += 1;
  by += stretched * rest / n_y.dot(stretched);

  section.moment = Vector3d(reaction.M_x.a, G * reaction.polar.a * zeta.y(), reaction.M_z.a);
  section.stretch = Vector3d(n.x() / (G * reaction.area.a), lambda, n.z() / (G * reaction.area.a));
  Eigen::Matrix<double, 3, 6> moment, stretch;
  moment.row(0) = reaction.M_x.v.transpose() * by;
  moment.row(1) = G * zeta.y() * (reaction.polar.v.transpose() * by);
  moment(1, 1) += G * reaction.polar.a;
  moment.row(2) = reaction.M_z.v.transpose() * by;
  const Eigen::Matrix<double, 1, 6> area = reaction.area.v.transpose() * by / reaction.area.a;
  stretch.row(0) = -section.stretch.x() * area;
  stretch.row(1) = by.row(0);
  stretch.row(2) = -section.stretch.z() * area;
  stretch(0, 3) += 1 / (G * reaction.area.a);
  stretch(2, 5) += 1 / (G * reaction.area.a);
  section.moment /= unit_;
  section.moment_by_zeta = moment.leftCols<3>() / (unit_ * l);
  section.moment_by_n = moment.rightCols<3>() / l;
  section.stretch_by_zeta = stretch.leftCols<3>() / l;
  section.stretch_by_n = stretch.rightCols<3>() * unit_ / l;
}

bool RodLaw::At(int piece, const Vector3d& zeta, const Vector3d& n, statics::RodSection& section) {
  const Vector3d curved = zeta / length_, carried = n * unit_ / length_;
  const std::size_t at = ModuleOf(piece);
  Axis<double>& axis = axes_[static_cast<std::size_t>(piece)];
  Axis<double> found = axis;
  Reaction<Dual> reaction;
  if (!FindStretch(at, curved, carried.y(), found, reaction)) return false;
  axis = found;
  Fill(at, curved, carried, axis, reaction, section);
  return true;
}

}  // namespace continuum::stiff_flop
