#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace continuum {

struct SwarmOptions {
  int particles = 20, iterations = 40;
  unsigned seed = 1;
  std::function<void(int done, int of)> progress = [](int, int) {};
};

/// Minimises cost over a box by a particle swarm with the constriction coefficients 0.7298 and
/// 1.4962; particles that leave the box stop at its wall. Returns the best point.
template <std::size_t N, class Cost>
std::array<double, N> Swarm(const std::array<double, N>& lower, const std::array<double, N>& upper,
                            Cost&& cost, const SwarmOptions& options = {}) {
  struct Particle {
    std::array<double, N> place, velocity{}, best;
    double best_cost = std::numeric_limits<double>::infinity();
  };
  std::mt19937 random(options.seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Particle> swarm(options.particles);
  for (Particle& p : swarm) {
    for (std::size_t i = 0; i < N; ++i)
      p.place[i] = lower[i] + unit(random) * (upper[i] - lower[i]);
  }
  Particle best = swarm[0];
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    for (Particle& p : swarm) {
      const double value = cost(p.place);
      if (value < p.best_cost) p.best_cost = value, p.best = p.place;
      if (value < best.best_cost) best = p;
    }
    for (Particle& p : swarm) {
      for (std::size_t i = 0; i < N; ++i) {
        p.velocity[i] =
            0.7298 * p.velocity[i] + 1.4962 * (unit(random) * (p.best[i] - p.place[i]) +
                                               unit(random) * (best.best[i] - p.place[i]));
        const double next = p.place[i] + p.velocity[i];
        p.place[i] = std::clamp(next, lower[i], upper[i]);
        if (next != p.place[i]) p.velocity[i] = 0;
      }
    }
    options.progress(iteration + 1, options.iterations);
  }
  return best.best;
}

}  // namespace continuum
