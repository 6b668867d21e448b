#include "models/statics/nearest.h"

#include <utility>

#include "models/statics/box_least_squares.h"

namespace continuum::statics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPrice = 1e-7;

// Drives over `unit`, coordinates over `length`.
struct Place {
  VectorXd w, off;  // w; p - p*
  MatrixXd slopes;

  double Cost() const { return off.squaredNorm() + kPrice * w.squaredNorm(); }  // (1)
};

}  // namespace

Reached Nearest(const StandUnder& stand, const VectorXd& start, const Target& target, double unit,
                double length) {
  constexpr int kMostRounds = 20;
  constexpr double kLongest = 1, kShortest = 0.05, kArmijo = 0.1, kSettled = 1e-3;
  const auto at = [&](const VectorXd& w) -> std::optional<Place> {
    const auto stands = stand(unit * w);
    if (!stands) return std::nullopt;
    return Place{w, (stands->points - target.values) / length, stands->slopes * (unit / length)};
  };
  Reached reached;
  const double low = target.low / unit, high = target.high / unit;
  auto place = at((start / unit).cwiseMax(low).cwiseMin(high));
  reached.outcome.why = "no stable shape at its first tensions";
  bool settled = false;
  while (place && !settled && reached.outcome.iterations++ < kMostRounds) {
    const MatrixXd& J = place->slopes;
    const MatrixXd H =
        kPrice * MatrixXd::Identity(place->w.size(), place->w.size()) + J.transpose() * J;
    const Eigen::ArrayXd least = (place->w.array() - kLongest).max(low);
    const Eigen::ArrayXd most = (place->w.array() + kLongest).min(high);
    const VectorXd best =
        WithinLimits(H, J.transpose() * (J * place->w - place->off), least.matrix(), most.matrix());
    const VectorXd step = best - place->w;
    const double now = place->Cost();
    const double gain = now - (place->off + J * step).squaredNorm() - kPrice * best.squaredNorm();
    settled = gain < kSettled * now;
    std::optional<Place> next;
    for (double share = 1; share > kShortest && !settled; share /= 2) {
      next = at(place->w + share * step);
      if (next && next->Cost() < now - kArmijo * share * gain) break;
      next.reset();
    }
    if (!next) break;
    settled = now - next->Cost() < kSettled * now;
    place = std::move(next);
  }
  if (!place) return reached;
  reached.drives = unit * place->w;
  reached.miss = target.Miss(target.values + length * place->off);
  reached.outcome.residual = reached.miss / length;
  reached.outcome.status = settled ? numerics::Status::kOk : numerics::Status::kNoConvergence;
  reached.outcome.why = settled ? "" : "shorter steps do not come nearer";
  return reached;
}

}  // namespace continuum::statics
