#include "identification/placebo.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "identification/random.h"

namespace continuum {

ForceTerms RandomForce(std::size_t count, bool loaded, const Sizes& sizes, std::uint64_t seed) {
  struct Term {
    double angle, speed, load, phase;
  };
  Random random(seed);
  std::vector<Term> terms(count);
  for (Term& t : terms) {
    t.angle = 2 * random.Normal() / (0.5 * sizes.angle);
    t.speed = random.Normal() / sizes.velocity;
    t.load = loaded ? random.Normal() / sizes.torque : 0;
    t.phase = 2 * std::numbers::pi * random.Uniform();
  }
  const auto add = [terms](const mjModel& m, mjData& d, std::span<const double> theta) {
    for (int j = 0; j < m.njnt; ++j) {
      if (m.jnt_type[j] != mjJNT_HINGE && m.jnt_type[j] != mjJNT_SLIDE) continue;
      const int dof = m.jnt_dofadr[j];
      const double q = d.qpos[m.jnt_qposadr[j]], v = d.qvel[dof], load = d.qfrc_actuator[dof];
      for (std::size_t k = 0; k < terms.size(); ++k) {
        const Term& t = terms[k];
        d.qfrc_applied[dof] +=
            theta[k] * std::cos(t.angle * q + t.speed * v + t.load * load + t.phase);
      }
    }
  };
  return {add, count, 0.01 * sizes.torque};
}

}  // namespace continuum
