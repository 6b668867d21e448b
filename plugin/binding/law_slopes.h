#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "binding/dual.h"

namespace continuum {

/// A number that a law reads or gives.
struct Number {
  enum class Kind {
    kPosition,       ///< of a degree of freedom, where a step begins [rad or m]
    kSpeed,          ///< the same, of its speed
    kPositionAfter,  ///< where the step ends
    kSpeedAfter,
    kSpringRest,         ///< of the spring of a degree of freedom, an attribute of the model
    kLength,             ///< of a tendon, where a step begins [m]
    kRate,               ///< of its length [m/s]
    kTendonRest,         ///< ends of the range in which its spring rests [2 tendon, 2 tendon + 1]
    kState,              ///< of the instance, before the step
    kParameter,          ///< of its card
    kTorqueTransmitted,  ///< actuators less other forces at a degree of freedom (gear_load.h)
    kTorqueActuator,     ///< actuators alone
    kYield,              ///< what a row of the solver gives way under its force [row]
    kControl,            ///< of an actuator, as it meets it: late, within its range
    kInput,              ///< the same with what signals add
    kActuator,           ///< force of an actuator before its gear; signals see it without its range
    kActuatorNext,       ///< the same after a signal
    kActuatorRate,       ///< speed of an actuator, with its gear
    kGain,               ///< of an actuator, gainprm[0]
    kBias,               ///< biasprm [3 actuator + i]
    kGear,               ///< gear[0]
    kRange,              ///< forcerange [2 actuator + i]
    kScratch,            ///< sums of the instance's own
    kForce,              ///< generalized, at a degree of freedom [N*m or N]
    kPull,               ///< along a tendon, as MuJoCo counts it: a spring pulls with < 0 [N]
    kLevel,              ///< largest force of a row of the solver [row]
    kOffset,             ///< position of a row, from its anchor [row]
    kNext,               ///< a state of the instance, after the step
  } kind;
  int index;
};

/// ∂ of / ∂ by.
struct Slope {
  Number of, by;
  double value;
};

/// How what a law gives follows what it reads, in one step of a simulation: the partial derivatives
/// that are not zero.
struct LawSlopes {
  std::vector<Slope> signals;  ///< of kInput and kActuatorNext
  std::vector<Slope> forces;   ///< of kForce and kPull
  std::vector<Slope> levels;   ///< of kLevel and kOffset
  std::vector<Slope> next;     ///< of kNext
  struct Pull {
    int tendon;
    double value;  ///< kPull itself [N]: tendons' moment arms move too
  };
  std::vector<Pull> pulls;
  int scratch = 0;  ///< how many sums the slopes of forces and of signals each make on their way

  void Clear() {
    signals.clear(), forces.clear(), levels.clear(), next.clear(), pulls.clear();
    scratch = 0;
  }
};

/// What a step of a simulation was that mjData does not say any more once it is taken: the law's
/// states before it, positions [nq] and speeds [nv] after it; what actuators meet and give
/// [nactuator] as far as the signals before this one go, which a signal brings up to date.
struct StepTaken {
  const double *z, *qpos, *qvel;
  const double* control = nullptr;            ///< kControl
  double *input = nullptr, *force = nullptr;  ///< kInput, kActuator
};

/// Adds factor · value, whose derivatives are with respect to the numbers `by`.
template <std::size_t N>
void Put(std::vector<Slope>& to, Number of, const Dual<N>& value, const std::array<Number, N>& by,
         double factor = 1) {
  for (std::size_t i = 0; i < N; ++i) {
    if (value.d[i] != 0) to.push_back({of, by[i], factor * value.d[i]});
  }
}

/// A law's parameters as duals, of which the first is derivative number `first`.
template <std::size_t N, std::size_t P>
std::array<Dual<N>, P> DualParams(const std::array<double, P>& p, std::size_t first) {
  std::array<Dual<N>, P> duals;
  for (std::size_t i = 0; i < P; ++i) duals[i] = Dual<N>(p[i], first + i);
  return duals;
}

}  // namespace continuum
