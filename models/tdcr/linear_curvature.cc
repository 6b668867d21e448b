#include "models/tdcr/linear_curvature.h"

#include "models/statics/skew.h"

namespace continuum::tdcr {

using statics::Skew;

LinearCurvature::LinearCurvature(const Robot& robot) {
  const std::vector<Section> sections = robot.Sections();
  sections_ = static_cast<Eigen::Index>(sections.size());
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const auto n = static_cast<int>(sections[s].disks.size());
    for (int i = 1; i <= n; ++i) {
      const auto disk = static_cast<int>(arcs_.size());
      const double length =
          robot.has_sections() ? robot.Place(disk + 1) - robot.Place(disk) : robot.arc();
      arcs_.push_back({length, static_cast<Eigen::Index>(6 * s), n > 1 ? Fraction(i, n) : 0.5});
    }
  }
}

Eigen::Matrix3Xd LinearCurvature::Curvatures(const Eigen::VectorXd& ends) const {
  Eigen::Matrix3Xd u(3, arcs());
  Eigen::Index i = 0;
  for (const OneArc& arc : arcs_) {
    u.col(i++) =
        (1 - arc.share) * ends.segment<3>(arc.first) + arc.share * ends.segment<3>(arc.first + 3);
  }
  return u;
}

Eigen::Matrix3Xd LinearCurvature::Positions(const Eigen::Matrix3Xd& u) const {
  Eigen::VectorXd lengths(arcs());
  for (Eigen::Index i = 0; i < lengths.size(); ++i) {
    lengths[i] = arcs_[static_cast<std::size_t>(i)].length;
  }
  return tdcr::Positions(lengths, u);
}

std::vector<Eigen::Matrix3Xd> LinearCurvature::Gradient(const Eigen::Matrix3Xd& u) const {
  std::vector<Eigen::Matrix3Xd> gradient;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Matrix3Xd dO = Eigen::Matrix3Xd::Zero(3, unknowns()), dphi = dO;
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const auto& [length, first, w] = arcs_[i];
    const Arc arc(length, u.col(static_cast<Eigen::Index>(i)));
    Eigen::Matrix3d dp = Eigen::Matrix3d::Zero(), turn;
    dp.leftCols<2>() = length * R * arc.dp();
    const Eigen::Matrix3d next = R * arc.Twisted(arc.Q());
    turn.leftCols<2>() = length * R * arc.Rotation();
    turn.col(2) = length * next.col(2);
    dO -= Skew(R * arc.p()) * dphi;
    dO.middleCols<3>(first) += (1 - w) * dp;
    dO.middleCols<3>(first + 3) += w * dp;
    dphi.middleCols<3>(first) += (1 - w) * turn;
    dphi.middleCols<3>(first + 3) += w * turn;
    R = next;
    gradient.push_back(dO);
  }
  return gradient;
}

}  // namespace continuum::tdcr
