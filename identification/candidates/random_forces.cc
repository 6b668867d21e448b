#include "identification/candidates/random_forces.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

struct Term {
  double angle, speed, load, phase;
};

std::vector<Term> Draw(std::size_t count, bool loaded, const Sizes& sizes, std::uint64_t seed) {
  Random random(seed);
  std::vector<Term> terms(count);
  for (Term& t : terms) {
    t.angle = 2 * random.Normal() / (0.5 * sizes.angle);
    t.speed = random.Normal();
    t.load = loaded ? random.Normal() / sizes.torque : 0;
    t.phase = 2 * std::numbers::pi * random.Uniform();
  }
  return terms;
}

// scaled: what of a joint's speed the terms see.
template <class Speed>
ForceTerms Force(const std::vector<Term>& terms, const Sizes& sizes, const Speed& scaled) {
  const auto add = [terms, scaled](const mjModel& m, mjData& d, std::span<const double> theta) {
    for (int j = 0; j < m.njnt; ++j) {
      if (m.jnt_type[j] != mjJNT_HINGE && m.jnt_type[j] != mjJNT_SLIDE) continue;
      const int dof = m.jnt_dofadr[j];
      const double q = d.qpos[m.jnt_qposadr[j]], v = scaled(d.qvel[dof]);
      const double load = d.qfrc_actuator[dof];
      for (std::size_t k = 0; k < terms.size(); ++k) {
        if (theta[k] == 0) continue;
        const Term& t = terms[k];
        d.qfrc_applied[dof] +=
            theta[k] * std::cos(t.angle * q + t.speed * v + t.load * load + t.phase);
      }
    }
  };
  return {add, terms.size(), 0.01 * sizes.torque};
}

}  // namespace

ForceTerms RandomForce(std::size_t count, bool loaded, const Sizes& sizes, std::uint64_t seed) {
  return Force(Draw(count, loaded, sizes, seed), sizes,
               [size = sizes.velocity](double v) { return v / size; });
}

ForceTerms RandomFriction(std::size_t count, const Sizes& sizes, std::uint64_t seed) {
  return Force(Draw(count, true, sizes, seed), sizes,
               [size = sizes.velocity](double v) { return std::tanh(10 * v / size); });
}

}  // namespace continuum
