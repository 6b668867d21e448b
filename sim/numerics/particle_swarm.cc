#include "sim/numerics/particle_swarm.h"

#include <cmath>
#include <utility>

#include "sim/io/interrupt.h"

namespace continuum {

ParticleSwarm::ParticleSwarm(Vector lower, Vector upper, SwarmOptions options, const Vector& first)
    : lower_(std::move(lower)), upper_(std::move(upper)), options_(std::move(options)) {
  const Vector range = upper_ - lower_;
  for (int i = 0; i < options_.particles; ++i) {
    Particle p{lower_ + Draw().cwiseProduct(range), Vector::Zero(range.size())};
    if (options_.moving) {
      const Vector back = Draw(), forth = Draw();
      p.velocity = range.cwiseProduct(forth - back) / 2;
    }
    particles_.push_back(std::move(p));
  }
  if (first.size() > 0) particles_.front().place = first;
}

ParticleSwarm::Vector ParticleSwarm::Draw() {
  Vector numbers(lower_.size());
  for (double& number : numbers) number = options_.uniform();
  return numbers;
}

void ParticleSwarm::Evaluate(const std::function<double(const Vector&)>& cost) {
  const double before = best_cost_;
  std::vector<double> costs;
  for (Particle& p : particles_) {
    if (StopRequested()) return;
    const double value = costs.emplace_back(cost(p.place));
    if (value < p.best_cost) p.best_cost = value, p.best = p.place;
    if (value < best_cost_) best_cost_ = value, best_ = p.place;
  }
  Judge(costs, before);
}

void ParticleSwarm::Judge(const std::vector<double>& costs, double best_before) {
  const auto all = Eigen::Map<const Vector>(costs.data(), std::ssize(costs));
  const double mean = all.mean(), spread = std::sqrt((all.array() - mean).square().mean());
  settled_ = best_before - best_cost_ < options_.cost_tolerance * std::abs(best_before) &&
             spread < options_.spread_tolerance * std::abs(mean);
}

void ParticleSwarm::Move() {
  for (Particle& p : particles_) {
    Vector own(p.place.size()), all(p.place.size());
    if (options_.by_vector) {
      all = Draw();
      own = Draw();
    } else {
      for (Eigen::Index i = 0; i < own.size(); ++i)
        own[i] = options_.uniform(), all[i] = options_.uniform();
    }
    if (p.best.size() == 0) p.best = p.place;
    const Vector& goal = best_.size() > 0 ? best_ : p.best;
    const Vector to_own = own.cwiseProduct(p.best - p.place);
    const Vector to_all = all.cwiseProduct(goal - p.place);
    p.velocity = options_.inertia * p.velocity;
    if (options_.by_vector) {  // rounded as in the published runs
      p.velocity = p.velocity + options_.to_own * to_own + options_.to_all * to_all;
    } else {
      p.velocity += options_.to_own * (to_own + options_.to_all / options_.to_own * to_all);
    }
    p.velocity *= options_.constriction;
    const Vector next = p.place + p.velocity;
    p.place = next.cwiseMax(lower_).cwiseMin(upper_);
    p.velocity = (next.array() == p.place.array()).select(p.velocity, 0);
  }
}

}  // namespace continuum
