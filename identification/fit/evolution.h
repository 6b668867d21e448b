#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace continuum {

/// How an evolution begins, and how long it goes on.
struct EvolutionOptions {
  std::size_t generations = 40;
  std::size_t in_vain = 40;  ///< generations after which it ends without a point below this cost
  double lower = std::numeric_limits<double>::infinity();
  double flat = 1e-4;  ///< share of the cost; generations that differ by less are the last
  std::uint64_t seed = 1;
};

/// The best point and its cost.
struct Evolved {
  Eigen::VectorXd y;
  double cost = 0;
  std::size_t evaluations = 0;
};

/// Looks for a lower cost in a valley whose floor has ripples, which slopes follow and stop in.
///
/// The (μ/μ_w, λ) evolution strategy with covariance matrix adaptation: in each generation λ points
/// are drawn around a mean, y = m + σ B z, z ~ N(0, 1); the mean moves to the better half of them,
/// and the covariance B Bᵀ learns the directions in which the mean has moved. Source: N. Hansen,
/// "The CMA evolution strategy: a tutorial", arXiv:1604.00772, with its standard constants.
/// cost: of the points of a generation, infinite where there is none; first: m; spread: σB at the
/// start, [n × n]. Repeats with the same seed.
Evolved Evolve(const std::function<std::vector<double>(const std::vector<Eigen::VectorXd>&)>& costs,
               const Eigen::VectorXd& first, const Eigen::MatrixXd& spread,
               const EvolutionOptions& options);

}  // namespace continuum
