#include "models/statics/nearest.h"

#include <algorithm>
#include <functional>
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

// (1) under drives; infinite where nothing stands.
using CostAt = std::function<double(const VectorXd&)>;

// Drives that lower (1) by the share `least` or more, one of them more or less: where contacts turn
// back a tangent says nothing, and a step along it may find none.
std::optional<VectorXd> Poll(const CostAt& cost, const Place& place, double low, double high,
                             double least) {
  const double size = std::max(place.w.cwiseAbs().mean(), 1e-2);
  for (const double share : {0.3, 0.1, 0.03, 0.01}) {
    double lowest = (1 - least) * place.Cost();
    std::optional<VectorXd> best;
    for (Eigen::Index i = 0; i < place.w.size(); ++i) {
      for (const double sign : {-1, 1}) {
        VectorXd w = place.w;
        w[i] = std::clamp(w[i] + sign * share * size, low, high);
        if (w[i] == place.w[i]) continue;
        const double next = cost(w);
        if (next > lowest) continue;
        lowest = next;
        best = std::move(w);
      }
    }
    if (best) return best;
  }
  return std::nullopt;
}

}  // namespace

Reached Nearest(const StandUnder& stand, const PointsUnder& points, const VectorXd& start,
                const Target& target, double unit, double length) {
  constexpr int kMostRounds = 40;
  constexpr double kLongest = 1, kShortest = 0.05, kArmijo = 0.1, kSettled = 1e-3;
  const auto at = [&](const VectorXd& w) -> std::optional<Place> {
    const auto stands = stand(unit * w);
    if (!stands) return std::nullopt;
    return Place{w, (stands->points - target.values) / length, stands->slopes * (unit / length)};
  };
  const CostAt cost = [&](const VectorXd& w) {
    const auto stands = points(unit * w);
    if (!stands) return std::numeric_limits<double>::infinity();
    return Place{w, (*stands - target.values) / length, {}}.Cost();
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
    std::optional<Place> next;
    const bool worth = gain >= kSettled * now;
    for (double share = 1; share > kShortest && worth; share /= 2) {
      next = at(place->w + share * step);
      if (next && next->Cost() < now - kArmijo * share * gain) break;
      next.reset();
    }
    if (worth && !next) {
      if (const auto better = Poll(cost, *place, low, high, kSettled)) next = at(*better);
    }
    settled = !next || next->Cost() > (1 - kSettled) * now;
    if (next) place = std::move(next);
  }
  if (!place) return reached;
  reached.drives = unit * place->w;
  reached.miss = target.Miss(target.values + length * place->off);
  reached.outcome.residual = reached.miss / length;
  reached.outcome.status = settled ? numerics::Status::kOk : numerics::Status::kNoConvergence;
  reached.outcome.why = settled ? "" : "the search comes nearer step by step, and was ended";
  return reached;
}

}  // namespace continuum::statics
