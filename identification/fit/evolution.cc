#include "identification/fit/evolution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Eigenvalues>

#include "sim/io/interrupt.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

// Of the best half of a generation, and how fast means and covariance follow it (tutorial, table
// 1).
struct Rates {
  explicit Rates(double n) : points(4 + static_cast<int>(3 * std::log(n))), weights(points / 2) {
    for (Eigen::Index i = 0; i < weights.size(); ++i)
      weights[i] = std::log(0.5 * (points + 1)) - std::log(static_cast<double>(i) + 1);
    weights /= weights.sum();
    effective = 1 / weights.squaredNorm();
    sigma = (effective + 2) / (n + effective + 5);
    damping = 1 + 2 * std::max(0.0, std::sqrt((effective - 1) / (n + 1)) - 1) + sigma;
    path = (4 + effective / n) / (n + 4 + 2 * effective / n);
    one = 2 / ((n + 1.3) * (n + 1.3) + effective);
    many = std::min(1 - one, 2 * (effective - 2 + 1 / effective) / ((n + 2) * (n + 2) + effective));
    length = std::sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n));
  }

  int points;
  Vector weights;
  double effective, sigma, damping, path, one, many;
  double length;  // of a standard normal vector, expected
};

// Mean, step size and covariance.
class Population {
 public:
  Population(const Vector& first, const Matrix& spread)
      : mean_(first),
        n_(static_cast<double>(first.size())),
        rates_(n_),
        covariance_(spread * spread.transpose()),
        path_(Vector::Zero(first.size())),
        step_path_(Vector::Zero(first.size())) {
    Decompose();
  }

  std::vector<Vector> Draw(Random& random) const {
    std::vector<Vector> points;
    for (int i = 0; i < rates_.points; ++i) {
      Vector z(mean_.size());
      for (double& one : z) one = random.Normal();
      points.push_back(mean_ + step_ * axes_ * (lengths_.array() * z.array()).matrix());
    }
    return points;
  }

  // best: the points of a generation, best first.
  void Follow(const std::vector<Vector>& best, std::size_t generation) {
    const Vector before = mean_;
    mean_.setZero();
    for (Eigen::Index i = 0; i < rates_.weights.size(); ++i)
      mean_ += rates_.weights[i] * best[static_cast<std::size_t>(i)];
    const Vector moved = (mean_ - before) / step_;
    const Vector white = axes_ * ((axes_.transpose() * moved).array() / lengths_.array()).matrix();
    step_path_ = (1 - rates_.sigma) * step_path_ +
                 std::sqrt(rates_.sigma * (2 - rates_.sigma) * rates_.effective) * white;
    const double grown = 1 - std::pow(1 - rates_.sigma, 2 * (static_cast<double>(generation) + 1));
    const bool calm = step_path_.norm() / std::sqrt(grown) < (1.4 + 2 / (n_ + 1)) * rates_.length;
    path_ *= 1 - rates_.path;
    if (calm) path_ += std::sqrt(rates_.path * (2 - rates_.path) * rates_.effective) * moved;
    const double kept = calm ? 0 : rates_.path * (2 - rates_.path);
    covariance_ *= 1 - rates_.one - rates_.many + rates_.one * kept;
    covariance_ += rates_.one * path_ * path_.transpose();
    for (Eigen::Index i = 0; i < rates_.weights.size(); ++i) {
      const Vector y = (best[static_cast<std::size_t>(i)] - before) / step_;
      covariance_ += rates_.many * rates_.weights[i] * y * y.transpose();
    }
    step_ *= std::exp(rates_.sigma / rates_.damping * (step_path_.norm() / rates_.length - 1));
    Decompose();
  }

 private:
  void Decompose() {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance_);
    axes_ = solver.eigenvectors();
    const double most = solver.eigenvalues().maxCoeff();
    lengths_ = solver.eigenvalues().cwiseMax(1e-14 * most).cwiseSqrt();
  }

  Vector mean_;
  double n_;
  Rates rates_;
  Matrix covariance_;
  Vector path_, step_path_;
  double step_ = 1;
  Matrix axes_;     // of the covariance
  Vector lengths_;  // along these
};

}  // namespace

Evolved Evolve(const std::function<std::vector<double>(const std::vector<Vector>&)>& costs,
               const Vector& first, const Matrix& spread, const EvolutionOptions& options) {
  Random random(options.seed);
  Population population(first, spread);
  Evolved best{first, std::numeric_limits<double>::infinity()};
  for (std::size_t g = 0; g < options.generations && !StopRequested(); ++g) {
    const std::vector<Vector> points = population.Draw(random);
    const std::vector<double> cost = costs(points);
    best.evaluations += points.size();
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cost[a] < cost[b]; });
    std::vector<Vector> sorted;
    for (const std::size_t i : order) sorted.push_back(points[i]);
    if (cost[order[0]] < best.cost) best.y = sorted[0], best.cost = cost[order[0]];
    if (cost[order.back()] - cost[order.front()] <= options.flat * best.cost) break;
    if (g + 1 >= options.in_vain && !(best.cost < options.lower)) break;
    population.Follow(sorted, g);
  }
  return best;
}

}  // namespace continuum
