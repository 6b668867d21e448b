#include "models/twin_pivot/follow.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "models/statics/limited_search.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/reach.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Vector3d;

// Linear systems of one point of a path: then it is given up. Those of way.csv take 59603 at most.
constexpr long kMostOfPoint = 600000;

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

// Where else a search may begin: on from the last two rows, and with the tensions of one section
// smaller or larger.
std::vector<std::vector<double>> OtherStarts(const Robot& robot, const std::vector<double>& now,
                                             const std::vector<double>* before) {
  std::vector<std::vector<double>> starts;
  if (before != nullptr) {
    starts.push_back(now);
    for (std::size_t j = 0; j < now.size(); ++j) starts.back()[j] += now[j] - (*before)[j];
  }
  for (int section = 0; section < robot.Sections(); ++section) {
    for (const double share : {0.7, 1.4}) {
      starts.push_back(now);
      for (int j = 0; j < robot.Cables(); ++j) {
        if (robot.SectionOfCable(j) != section) continue;
        starts.back()[static_cast<std::size_t>(j)] *= share;
      }
    }
  }
  return starts;
}

// Approach from several tensions. Once contacts turn back there are many minima: where the search
// from the first tensions of all does not end where that from the last ones does, more are tried.
class Leader {
 public:
  Leader(const Robot& robot, const Load& load, Method method, const statics::Target& target,
         const Before* from)
      : robot_(robot), load_(load), method_(method), target_(target), from_(from) {}

  statics::Reached Lead(const std::vector<double>& first, const std::vector<double>* before) {
    constexpr double kSame = 0.01;
    const std::vector<double> now = load_.tension;
    nearest_ = Approach(robot_, load_, method_, target_, from_);
    if (from_ == nullptr) return nearest_;
    const double miss = nearest_.miss, other = Try(first);
    const bool small = std::max(miss, other) < kExact * robot_.Length();
    if (small || std::abs(other - miss) <= kSame * miss) return nearest_;
    for (const auto& start : OtherStarts(robot_, now, before)) Try(start);
    return nearest_;
  }

 private:
  static constexpr double kExact = 1e-5;  // nearer is not asked for

  // How near it comes.
  double Try(const std::vector<double>& start) {
    load_.tension = start;
    const auto reached = Approach(robot_, load_, method_, target_, from_);
    if (reached.drives.size() > 0 && reached.miss < nearest_.miss) nearest_ = reached;
    return reached.miss;
  }

  const Robot& robot_;
  Load load_;
  Method method_;
  const statics::Target& target_;
  const Before* from_;
  statics::Reached nearest_;
};

}  // namespace

std::vector<Following> Follow(const Robot& robot, const Load& load, Method method,
                              const PathLine& path) {
  std::vector<Following> rows;
  std::optional<std::size_t> last, last_but_one;  // that were solved
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
    const auto reached = statics::LimitedSearch(kMostOfPoint, [&] {
      return Leader(robot, row.load, method, target, from)
          .Lead(load.tension, last_but_one ? &rows[*last_but_one].load.tension : nullptr);
    });
    row.miss = reached.miss;
    row.solution.outcome = reached.outcome;
    row.settled = reached.outcome.ok();
    if (reached.drives.size() > 0) {
      row.load.tension.assign(reached.drives.begin(), reached.drives.end());
      row.solution = SolveGoingOn(robot, row.load, method, from);
      row.off = Off(robot, path, row.base, row.solution.beta);
      last_but_one = std::exchange(last, point);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace continuum::twin_pivot
