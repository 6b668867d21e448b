#include "sim/numerics/particle_swarm.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Vector = ParticleSwarm::Vector;

SwarmOptions Seeded() {
  SwarmOptions options;
  options.uniform = [random = Random32(1)]() mutable { return random.Uniform(); };
  return options;
}

void ExpectBowlFound(const SwarmOptions& options) {
  const Eigen::Vector3d lower(-1, -1, 0), upper(1, 1, 2);
  ParticleSwarm swarm(lower, upper, options);
  for (int k = 0; k < options.iterations; ++k) {
    swarm.Evaluate([&](const Vector& p) {
      for (int i = 0; i < 3; ++i) {
        EXPECT_GE(p[i], lower[i]);
        EXPECT_LE(p[i], upper[i]);
      }
      return std::pow(p[0] - 0.3, 2) + 2 * std::pow(p[1] + 0.4, 2) + std::pow(p[2] + 1, 2);
    });
    swarm.Move();
  }
  EXPECT_NEAR(swarm.best()[0], 0.3, 1e-3);
  EXPECT_NEAR(swarm.best()[1], -0.4, 1e-3);
  EXPECT_EQ(swarm.best()[2], 0);
}

TEST(ParticleSwarm, FindsTheBottomOfABowlAndStaysInTheBox) { ExpectBowlFound(Seeded()); }

TEST(ParticleSwarm, StartsInMotionToo) {
  SwarmOptions options = Seeded();
  options.moving = options.by_vector = true;
  ExpectBowlFound(options);
}

// v = χ ω v where λ₁ and λ₂ are as good as 0.
TEST(ParticleSwarm, FliesAsItsConstantsSay) {
  SwarmOptions options = Seeded();
  options.moving = true, options.inertia = 0.5, options.constriction = 0.25;
  options.to_own = 1e-300, options.to_all = 0;
  options.particles = 1;
  ParticleSwarm swarm(Eigen::Vector2d(-1e3, -1e3), Eigen::Vector2d(1e3, 1e3), options,
                      Eigen::Vector2d(0, 0));
  std::vector<Vector> places;
  for (int k = 0; k < 4; ++k) {
    swarm.Evaluate([&](const Vector& p) { return places.emplace_back(p).norm(); });
    swarm.Move();
  }
  const Vector first = places[1] - places[0], second = places[2] - places[1];
  EXPECT_GT(first.norm(), 0);
  EXPECT_LT((second - 0.125 * first).norm(), 1e-12 * first.norm());
}

TEST(ParticleSwarm, SettlesWhenCostsAreAlikeAndTheBestStays) {
  SwarmOptions options = Seeded();
  options.cost_tolerance = 1e-3, options.spread_tolerance = 1e-4;
  ParticleSwarm swarm(Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1), options);
  const auto steps = [&](double slope) {
    swarm.Evaluate([&](const Vector& p) { return 1 + slope * p.norm(); });
    return swarm.Settled();
  };
  EXPECT_FALSE(steps(1e-6));  // nothing came before
  EXPECT_TRUE(steps(1e-6));
  EXPECT_FALSE(steps(1));
}

TEST(ParticleSwarm, BeginsAtAGivenPlace) {
  const Vector first = Eigen::Vector2d(0.25, 0.5);
  ParticleSwarm swarm(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), Seeded(), first);
  int asked = 0;
  swarm.Evaluate([&](const Vector& p) { return asked++ == 0 ? (p - first).norm() : 1; });
  EXPECT_EQ(swarm.best_cost(), 0);
  EXPECT_EQ(swarm.best(), first);
}

TEST(ParticleSwarm, FliesOnWhereNothingHasACost) {
  ParticleSwarm swarm(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1), Seeded());
  for (const double none :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    swarm.Evaluate([&](const Vector&) { return none; });
    EXPECT_EQ(swarm.best().size(), 0);
    swarm.Move();
  }
  swarm.Evaluate([](const Vector& p) {
    EXPECT_TRUE(p.allFinite());
    return p.norm();
  });
  EXPECT_TRUE(std::isfinite(swarm.best_cost()));
}

}  // namespace
}  // namespace continuum
