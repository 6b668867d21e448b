#include "identification/fit/swarm_fit.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/particle_swarm.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

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

// Particles between the bounds, the first at the start.
ParticleSwarm SwarmFor(const Problem& problem, const SwarmFitOptions& options) {
  const auto n = static_cast<Eigen::Index>(problem.parameters().size());
  Vector lower(n), upper(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    lower[k] = problem.parameters()[k].lower;
    upper[k] = problem.parameters()[k].upper;
  }
  SwarmOptions swarm;
  swarm.particles = options.particles;
  swarm.pull = 1.49618;
  swarm.moving = swarm.by_vector = true;
  swarm.uniform = [random = Random64(options.seed)]() mutable { return random.Uniform(); };
  return {lower, upper, std::move(swarm), problem.Start()};
}

void Say(const SwarmFitOptions& options, int generations, double cost, std::size_t simulations) {
  if (!options.progress) return;
  options.progress({"particle swarm", static_cast<std::size_t>(generations),
                    static_cast<std::size_t>(options.iterations),
                    fmt::format("cost {:.6g}, {} simulations", cost, simulations)});
}

}  // namespace

Fit FitBySwarm(const Problem& problem, const std::vector<bool>& use,
               const SwarmFitOptions& options) {
  RequireBounds(problem);
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t before = problem.evaluations();
  ParticleSwarm swarm = SwarmFor(problem, options);
  Fit fit;
  for (; fit.iterations < options.iterations && !StopRequested(); ++fit.iterations) {
    swarm.Evaluate([&](const Vector& x) { return CostAt(problem, x, use, options.soft); });
    if (!std::isfinite(swarm.best_cost())) {
      StopIfRequested();
      throw Error::Job("the simulation diverges at all particles");
    }
    fit.trace.push_back(swarm.best_cost());
    Say(options, fit.iterations + 1, swarm.best_cost(), problem.evaluations());
    swarm.Move();
  }
  fit.x = swarm.best();
  fit.cost = swarm.best_cost();
  fit.converged = fit.iterations == options.iterations;
  fit.message = fit.converged ? "all generations done" : "interrupted";
  fit.evaluations = problem.evaluations() - before;
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return fit;
}

}  // namespace continuum
