#pragma once

#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace continuum {

/// Constants of a swarm, by default those of the constriction factor of Clerc and Kennedy (2002).
struct SwarmConstants {
  int particles = 20, iterations = 40;
  double inertia = 0.7298;      ///< ω: share of its velocity that a particle keeps
  double to_own = 1.4962;       ///< λ₁ > 0: pull towards its own best place
  double to_all = 1.4962;       ///< λ₂: towards that of all
  double constriction = 1;      ///< χ: share of the whole velocity
  double cost_tolerance = 0;    ///< least relative fall of the best cost in an iteration
  double spread_tolerance = 0;  ///< least standard deviation of all costs over their mean
};

struct SwarmOptions : SwarmConstants {
  bool moving = false;  ///< particles start with random velocities instead of at rest
  /// Whether the random numbers of a move are drawn coordinate by coordinate (own, all) or as two
  /// whole vectors (all, own): published numbers hang on it.
  bool by_vector = false;
  std::function<double()> uniform;  ///< random numbers within [0, 1)
};

/// Minimises a cost within a box by particle swarm optimisation, without derivatives: particles fly
/// on by inertia and are pulled to the best places found. One that would leave the box stops at its
/// wall.
///
///   v = χ (ω v + λ₁ u₁ (own best − x) + λ₂ u₂ (best of all − x)),   x = x + v
///
/// Alternate Evaluate and Move, until the iterations or the swarm are done.
class ParticleSwarm {
 public:
  using Vector = Eigen::VectorXd;

  /// Random places within [lower, upper]; the first particle at `first` where it is given.
  ParticleSwarm(Vector lower, Vector upper, SwarmOptions options, const Vector& first = {});

  /// The cost of every particle where it is, infinite or not a number where there is none. Ends
  /// early when the user asks to stop (StopRequested).
  void Evaluate(const std::function<double(const Vector&)>& cost);
  void Move();
  /// Whether in the last Evaluate the best cost fell by less than its tolerance, and the costs of
  /// all particles differed by less than theirs. Never where one of these is 0.
  bool Settled() const { return settled_; }

  /// The best place so far and its cost; empty and infinite before any cost was finite.
  const Vector& best() const { return best_; }
  double best_cost() const { return best_cost_; }

 private:
  struct Particle {
    Vector place, velocity, best = {};
    double best_cost = std::numeric_limits<double>::infinity();
  };

  Vector Draw();
  void Judge(const std::vector<double>& costs, double best_before);

  Vector lower_, upper_;
  SwarmOptions options_;
  std::vector<Particle> particles_;
  Vector best_;
  double best_cost_ = std::numeric_limits<double>::infinity();
  bool settled_ = false;
};

}  // namespace continuum
