#include "identification/fit/swarm_fit.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/io/yaml.h"
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
  static_cast<SwarmConstants&>(swarm) = options.swarm;
  swarm.moving = swarm.by_vector = true;
  swarm.uniform = [random = Random64(options.seed)]() mutable { return random.Uniform(); };
  return {lower, upper, std::move(swarm), problem.Start()};
}

void Say(const SwarmFitOptions& options, int generations, double cost, std::size_t simulations) {
  if (!options.progress) return;
  options.progress({"particle swarm", static_cast<std::size_t>(generations),
                    static_cast<std::size_t>(options.swarm.iterations),
                    fmt::format("cost {:.6g}, {} simulations", cost, simulations)});
}

}  // namespace

SwarmConstants ReadSwarm(const std::filesystem::path& experiment) {
  SwarmConstants c = SwarmFitOptions{}.swarm;
  const auto y = Yaml::Read(experiment).Find("swarm");
  if (!y) return c;
  y->Only({"particles", "iterations", "momentum", "cognitive", "social", "constriction",
           "cost_tolerance", "spread_tolerance"});
  const auto whole = [&](const std::string& key, int usual) {
    const auto given = y->Find(key);
    if (!given) return usual;
    given->Number(1, 1e6);
    return given->Integer();
  };
  c.particles = whole("particles", c.particles), c.iterations = whole("iterations", c.iterations);
  c.inertia = y->NumberOr("momentum", c.inertia, 0, 1);
  c.to_own = y->NumberOr("cognitive", c.to_own, 1e-9, 100);
  c.to_all = y->NumberOr("social", c.to_all, 0, 100);
  c.constriction = y->NumberOr("constriction", c.constriction, 1e-9, 1);
  c.cost_tolerance = y->NumberOr("cost_tolerance", c.cost_tolerance, 0, 1);
  c.spread_tolerance = y->NumberOr("spread_tolerance", c.spread_tolerance, 0, 1);
  return c;
}

Fit FitBySwarm(const Problem& problem, const std::vector<bool>& use,
               const SwarmFitOptions& options) {
  RequireBounds(problem);
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t before = problem.evaluations();
  ParticleSwarm swarm = SwarmFor(problem, options);
  Fit fit;
  const int most = options.swarm.iterations;
  for (; fit.iterations < most && !swarm.Settled() && !StopRequested(); ++fit.iterations) {
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
  fit.converged = fit.iterations == most || swarm.Settled();
  fit.message = swarm.Settled() ? "the swarm has settled"
                : fit.converged ? "all generations done"
                                : "interrupted";
  fit.evaluations = problem.evaluations() - before;
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return fit;
}

}  // namespace continuum
