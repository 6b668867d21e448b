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

RodLaw::RodLaw(const Module& module, const Method& method, const Case& row, double share,
               int pieces)
    : module_(module),
      method_(method),
      p_(share * row.given),
      force_(share * row.load.force),
      gravity_(share * row.load.gravity),
      unit_(module.E * module.SecondMoment() / module.l),
      axes_(static_cast<std::size_t>(pieces), Axis<double>{1, 0, 0}) {
  statics::RodSection section;
  const Vector3d pressures = p_;
  p_.setZero();
  if (At(0, Vector3d::Zero(), Vector3d::Zero(), section)) elastic_ = section.moment_by_zeta;
  p_ = pressures;
}

Vector3d RodLaw::Force(double s) const {
  return module_.l / unit_ * (force_ + (module_.m_fs + module_.m * (1 - s)) * gravity_);
}

Vector3d RodLaw::TipLever() const {
  return module_.l_fs / unit_ * (force_ + 0.5 * module_.m_fs * gravity_);
}

bool RodLaw::FindStretch(const Vector3d& zeta, double n_y, Axis<double>& axis,
                         Reaction<Dual>& reaction) const {
  constexpr double kClosest = 1e-4;  // to a fold of the section, as in rod.cc
  const double scale = module_.E * module_.Area();
  double lambda = axis.lambda;
  for (int round = 0; round < 40; ++round) {
    axis = AxisAt(zeta, lambda);
    if (!(lambda > 0) || !(Margin(module_, method_, axis) > kClosest)) return false;
    const Axis<Dual> seeded{Dual(axis.lambda, 0), Dual(axis.k_1, 1), Dual(axis.k_2, 2)};
    reaction = ReactionOf(module_, method_, p_, Dual(module_.E), Dual(module_.gamma), seeded);
    const auto& v = reaction.n_y.v;
    const double slope = v[0] - (v[1] * axis.k_1 + v[2] * axis.k_2) / lambda;
    const double rest = reaction.n_y.a - n_y;
    if (std::abs(rest) <= 1e-13 * scale) return slope > 0;
    if (!(slope > 0)) return false;
    lambda -= std::clamp(rest / slope, -0.2 * lambda, 0.2 * lambda);
  }
  return false;
}

void RodLaw::Fill(const Vector3d& zeta, const Vector3d& n, const Axis<double>& axis,
                  const Reaction<Dual>& reaction, statics::RodSection& section) const {
  const double G = module_.E / 3, lambda = axis.lambda, l = module_.l;
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
  const Vector3d curved = zeta / module_.l, carried = n * unit_ / module_.l;
  Axis<double>& axis = axes_[static_cast<std::size_t>(piece)];
  Axis<double> found = axis;
  Reaction<Dual> reaction;
  if (!FindStretch(curved, carried.y(), found, reaction)) return false;
  axis = found;
  Fill(curved, carried, axis, reaction, section);
  return true;
}

}  // namespace continuum::stiff_flop
