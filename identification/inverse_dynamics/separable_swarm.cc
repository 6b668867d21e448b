#include "identification/inverse_dynamics/separable_swarm.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kStep = 0.1;   // of a parameter's size: of what is linear, any will do
constexpr int kPatience = 5;    // iterations, after which Gauss-Newton is faster where the
constexpr double kFall = 0.99;  // cost has not fallen below this share

// Least squares of the inner parameters where the outer ones are. Slopes that no outer one changes
// are made once.
class Inner {
 public:
  Inner(const TrainEquations& equations, Vector start, const ParameterShapes& shapes)
      : equations_(equations), start_(std::move(start)), shapes_(shapes) {
    slopes_ = equations.Slopes(start_, equations.Residuals(start_), shapes.inner, kStep);
  }

  LinearEquations::Solution At(const Vector& place) {
    Vector x = start_;
    x(shapes_.outer) = place;
    const std::vector<Vector> r = equations_.Residuals(x);
    for (std::size_t i = 0; i < shapes_.inner.size(); ++i)
      if (shapes_.follows[i])
        equations_.Differ(x, r, shapes_.inner[i], kStep, slopes_, static_cast<Eigen::Index>(i));
    return equations_.Linear(x, r, slopes_, shapes_.inner).Solve();
  }

 private:
  const TrainEquations& equations_;
  Vector start_;
  const ParameterShapes& shapes_;
  std::vector<Matrix> slopes_;
};

ParticleSwarm SwarmFor(const Problem& problem, const Vector& start, const ParameterShapes& shapes,
                       const RegressorOptions& options) {
  const auto n = static_cast<Eigen::Index>(shapes.outer.size());
  Vector lower(n), upper(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeParameter& p = problem.parameters()[shapes.outer[i]];
    lower[i] = p.lower, upper[i] = p.upper;
    if (std::isfinite(p.lower) && std::isfinite(p.upper)) continue;
    throw Error::Input("--method regressor",
                       "finite bounds of parameters that do not enter the forces linearly",
                       "'" + p.name + "'");
  }
  SwarmOptions swarm;
  static_cast<SwarmConstants&>(swarm) = options.swarm;
  swarm.moving = swarm.by_vector = true;
  swarm.uniform = [random = Random64(options.seed)]() mutable { return random.Uniform(); };
  return {lower, upper, std::move(swarm), start(shapes.outer)};
}

}  // namespace

SwarmFound SearchSeparable(const Problem& problem, const TrainEquations& equations,
                           const Vector& start, const ParameterShapes& shapes,
                           const RegressorOptions& options) {
  Inner inner(equations, start, shapes);
  ParticleSwarm swarm = SwarmFor(problem, start, shapes, options);
  int done = 0;
  std::vector<double> best;
  const auto stands = [&] {
    return done > kPatience && best[done - 1] > kFall * best[done - 1 - kPatience];
  };
  for (; done < options.swarm.iterations && !swarm.Settled() && !stands() && !StopRequested();
       ++done) {
    swarm.Evaluate([&](const Vector& place) { return inner.At(place).cost; });
    best.push_back(swarm.best_cost());
    if (options.progress)
      options.progress({"particle swarm", static_cast<std::size_t>(done + 1),
                        static_cast<std::size_t>(options.swarm.iterations),
                        fmt::format("cost {:.6g}", swarm.best_cost())});
    swarm.Move();
  }
  if (swarm.best().size() == 0) {
    StopIfRequested();
    throw Error::Job("--method regressor: no place of the swarm has a cost");
  }
  return {inner.At(swarm.best()).x, done};
}

}  // namespace continuum
