#include "models/statics/wind.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <utility>

namespace continuum::statics {
namespace {

using Eigen::VectorXd;

VectorXd StepOf(const Stand& at, const Target& target) {
  constexpr double kRank = 1e-6;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> slopes;
  slopes.setThreshold(kRank);
  slopes.compute(at.slopes);
  return slopes.solve(target.values - at.points);
}

}  // namespace

VectorXd WithRoom(const VectorXd& lengths, const VectorXd& tension) {
  constexpr double kRoom = 1e-2, kSlack = 1e-9;
  const double slack = kSlack * std::max(tension.maxCoeff(), 1e-9);
  return lengths + kRoom * (tension.array() <= slack).select(lengths, 0);
}

std::optional<Reached> NoPretension(const Target& target, double EA) {
  if (target.low <= 0 || EA > 0) return std::nullopt;
  Reached reached;
  reached.outcome.why =
      "taut cables that do not stretch share their tension in no way of their own: give the robot "
      "their EA, or low 0";
  return reached;
}

Reached Wind(const StandUnder& stand, VectorXd lengths, const Target& target, double length) {
  constexpr int kMostRounds = 20;
  constexpr double kClose = 1e-6, kShortest = 1e-3, kArmijo = 0.1;
  Reached reached;
  auto at = stand(lengths);
  if (!at) {
    reached.outcome.why = "the lengths of the tensions that reach it lead to no stable shape";
    return reached;
  }
  reached.miss = target.Miss(at->points);
  bool nearer = true;
  while (nearer && reached.miss > kClose * length && reached.outcome.iterations++ < kMostRounds) {
    const VectorXd step = StepOf(*at, target);
    nearer = false;
    for (double share = 1; share > kShortest && !nearer; share /= 2) {
      auto next = stand(lengths + share * step);
      const double miss = next ? target.Miss(next->points) : reached.miss;
      nearer = miss < (1 - kArmijo * share) * reached.miss;
      if (!nearer) continue;
      lengths += share * step;
      reached.miss = miss;
      at = std::move(next);
    }
  }
  reached.drives = lengths;
  reached.outcome.residual = reached.miss / length;
  if (reached.miss <= kClose * length) {
    reached.outcome.status = numerics::Status::kOk;
  } else {
    reached.outcome.why = fmt::format("the search for lengths ends {:.3g} m off", reached.miss);
  }
  return reached;
}

}  // namespace continuum::statics
