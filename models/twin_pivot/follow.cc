#include "models/twin_pivot/follow.h"

#include <numeric>
#include <optional>

#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/reach.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Vector3d;

// Every disc on the path, in the base frame.
statics::Target DiscsOnPath(const Robot& robot, const PathLine& path, std::size_t point,
                            double base) {
  statics::Target target;
  target.coordinate.resize(static_cast<std::size_t>(3 * robot.Joints()));
  std::iota(target.coordinate.begin(), target.coordinate.end(), 0);
  target.values.resize(3 * robot.Joints());
  for (int m = 1; m <= robot.Joints(); ++m) {
    const double s = path.s(point) - (robot.Length() - robot.Place(m));
    target.values.segment<3>(3 * (m - 1)) = path.At(s) - Vector3d(base, 0, 0);
  }
  target.low = path.low(point);
  target.high = path.high(point);
  return target;
}

Eigen::VectorXd Off(const Robot& robot, const PathLine& path, double base,
                    const Eigen::VectorXd& beta) {
  const auto discs = DiscFrames(robot, beta);
  Eigen::VectorXd off(robot.Joints());
  for (int m = 1; m <= robot.Joints(); ++m) {
    const Vector3d place = discs[static_cast<std::size_t>(m)].translation();
    off[m - 1] = path.Distance(place + Vector3d(base, 0, 0));
  }
  return off;
}

}  // namespace

std::vector<Following> Follow(const Robot& robot, const Load& load, Method method,
                              const PathLine& path) {
  std::vector<Following> rows;
  std::optional<std::size_t> last;  // that was solved
  for (std::size_t point = 0; point < path.points(); ++point) {
    Following row;
    row.load = load;
    row.base = path.Base(point, robot.Length());
    std::optional<Before> before;
    if (last) {
      before.emplace(Before{rows[*last].load, rows[*last].solution});
      row.load.tension = rows[*last].load.tension;
    }
    const Before* const from = before ? &*before : nullptr;
    const auto target = DiscsOnPath(robot, path, point, row.base);
    const auto reached = Approach(robot, row.load, method, target, from);
    row.miss = reached.miss;
    row.solution.outcome = reached.outcome;
    row.settled = reached.outcome.ok();
    if (reached.drives.size() > 0) {
      row.load.tension.assign(reached.drives.begin(), reached.drives.end());
      row.solution = SolveGoingOn(robot, row.load, method, from);
      row.off = Off(robot, path, row.base, row.solution.beta);
      last = point;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace continuum::twin_pivot
