#include "models/tdcr/line.h"

#include "models/tdcr/arc.h"
#include "models/tdcr/disks.h"

namespace continuum::tdcr {

Line LineOfArcs(const Robot& robot, const Eigen::Matrix3Xd& u, const Eigen::MatrixXd& tension,
                int per_arc) {
  const Chain chain = Forward(EqualArcs(robot), u);
  const Eigen::Index count = u.cols() * per_arc + 1;
  Line line{Eigen::VectorXd::LinSpaced(count, 0, robot.length),
            Eigen::Matrix3Xd(3, count),
            {},
            std::vector<int>(static_cast<std::size_t>(count), -1),
            Eigen::Matrix3Xd(3, count),
            Eigen::Matrix3Xd(3, u.cols()),
            Eigen::MatrixXd(count, tension.cols())};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index arc = std::min(i / per_arc, u.cols() - 1), within = i - arc * per_arc;
    const auto at = static_cast<std::size_t>(arc);
    const Arc part(robot.arc() * static_cast<double>(within) / per_arc, u.col(arc));
    line.points.col(i) = chain.O[at] + chain.R[at] * part.p();
    line.frames.emplace_back(Eigen::Matrix3d(chain.R[at] * part.Twisted(part.Q())));
    line.u.col(i) << -u(1, arc), u(0, arc), u(2, arc);
    line.tension.row(i) = tension.row(arc);
    if (i % per_arc == 0) {
      line.disk[static_cast<std::size_t>(i)] = static_cast<int>(i / per_arc);
    }
  }
  line.ends << -u.row(1), u.row(0), u.row(2);
  return line;
}

}  // namespace continuum::tdcr
