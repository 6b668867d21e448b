#pragma once

#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace continuum {

struct SwarmOptions {
  int particles = 20, iterations = 40;
  double inertia = 0.7298;  ///< share of its velocity that a particle keeps
  double pull = 1.4962;     ///< towards its own best place and towards that of all
  bool moving = false;      ///< particles start with random velocities instead of at rest
  /// Whether the random numbers of a move are drawn coordinate by coordinate (own, all) or as two
  /// whole vectors (all, own): published numbers hang on it.
  bool by_vector = false;
  std::function<double()> uniform;  ///< random numbers within [0, 1)
};

/// Minimises a cost within a box by particle swarm optimisation, without derivatives: particles fly
/// on by inertia and are pulled to the best places found, with the constriction factor of Clerc and
/// Kennedy (2002). One that would leave the box stops at its wall.
///
///   v = inertia v + pull (u_1 (own best - x) + u_2 (best of all - x)),   x = x + v
///
/// Alternate Evaluate and Move.
class ParticleSwarm {
 public:
  using Vector = Eigen::VectorXd;

  /// Random places within [lower, upper]; the first particle at `first` where it is given.
  ParticleSwarm(Vector lower, Vector upper, SwarmOptions options, const Vector& first = {});

  /// The cost of every particle where it is, infinite or not a number where there is none. Ends
  /// early when the user asks to stop (StopRequested).
  void Evaluate(const std::function<double(const Vector&)>& cost);
  void Move();

  /// The best place so far and its cost; empty and infinite before any cost was finite.
  const Vector& best() const { return best_; }
  double best_cost() const { return best_cost_; }

 private:
  struct Particle {
    Vector place, velocity, best = {};
    double best_cost = std::numeric_limits<double>::infinity();
  };

  Vector Draw();

  Vector lower_, upper_;
  SwarmOptions options_;
  std::vector<Particle> particles_;
  Vector best_;
  double best_cost_ = std::numeric_limits<double>::infinity();
};

}  // namespace continuum
