#include "identification/fit/swarm_fit.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

// Clerc and Kennedy: χ and χ φ/2 for φ = 4.1.
constexpr double kInertia = 0.7298, kPull = 1.49618;

struct Particle {
  Vector at, speed, best;
  double cost = std::numeric_limits<double>::infinity();
};

void RequireBounds(const Problem& problem) {
  for (const FreeParameter& p : problem.parameters()) {
    if (std::isfinite(p.lower) && std::isfinite(p.upper)) continue;
    throw Error::Input("--method pso", "finite bounds of every parameter", "'" + p.name + "'");
  }
}

// ½ Σ r², or its robust form; infinite where the simulation diverges.
double CostAt(const Problem& problem, const Vector& x, const std::vector<bool>& use, double soft) {
  double cost = 0;
  for (const Vector& r : problem.Residuals(x, use)) {
    for (const double v : r)
      cost += soft > 0 ? soft * soft * (std::sqrt(1 + v * v / (soft * soft)) - 1) : 0.5 * v * v;
  }
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

}  // namespace

Fit FitBySwarm(const Problem& problem, const std::vector<bool>& use,
               const SwarmFitOptions& options) {
  RequireBounds(problem);
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t before = problem.evaluations();
  const auto n = static_cast<Eigen::Index>(problem.parameters().size());
  Vector lower(n), range(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    lower[k] = problem.parameters()[k].lower;
    range[k] = problem.parameters()[k].upper - lower[k];
  }
  std::mt19937_64 rng(options.seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto random = [&] { return Vector::NullaryExpr(n, [&] { return uniform(rng); }).eval(); };
  std::vector<Particle> swarm(options.particles);
  for (Particle& p : swarm) {
    p.at = lower + range.cwiseProduct(random());
    p.speed = range.cwiseProduct(random() - random()) / 2;
  }
  swarm.front().at = problem.Start();

  Fit fit;
  fit.cost = std::numeric_limits<double>::infinity();
  for (; fit.iterations < options.iterations && !StopRequested(); ++fit.iterations) {
    for (Particle& p : swarm) {
      if (StopRequested()) break;
      const double cost = CostAt(problem, p.at, use, options.soft);
      if (cost < p.cost) p.cost = cost, p.best = p.at;
      if (cost < fit.cost) fit.cost = cost, fit.x = p.at;
    }
    if (!std::isfinite(fit.cost)) {
      StopIfRequested();
      throw Error::Job("the simulation diverges at all particles");
    }
    fit.trace.push_back(fit.cost);
    if (options.progress) {
      options.progress(fmt::format("generation {:2}  cost {:.6g}  {} simulations", fit.iterations,
                                   fit.cost, problem.evaluations()));
    }
    for (Particle& p : swarm) {
      if (!p.best.size()) p.best = p.at;
      p.speed = kInertia * p.speed + kPull * random().cwiseProduct(p.best - p.at) +
                kPull * random().cwiseProduct(fit.x - p.at);
      const Vector next = p.at + p.speed;
      p.at = problem.Clamp(next);
      p.speed = (next.array() == p.at.array()).select(p.speed, 0);
    }
  }
  fit.converged = fit.iterations == options.iterations;
  fit.message = fit.converged ? "all generations done" : "interrupted";
  fit.evaluations = problem.evaluations() - before;
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return fit;
}

}  // namespace continuum
