#pragma once

#include <span>
#include <string>
#include <vector>

#include "identification/catalog.h"
#include "identification/fit.h"

namespace continuum {

/// A model that may have made the data: the experiment's own, or that with one more effect.
struct Hypothesis {
  std::string effect;   ///< empty: the model as it is
  std::string variant;  ///< of a choice: "load=actuator"
  std::string where;    ///< in words: "joint q"
  System system;
  std::vector<Parameter> extra;  ///< free parameters of the effect
  EffectInstance instance;  ///< the plugin instance, for effects that need one (else no effect)
  std::string replaces;     ///< instance whose place it takes
  std::vector<std::vector<double>> starts;  ///< values of extra to begin a search from
  /// Values of extra at which the effect is absent; NaN for those that mean nothing then.
  std::vector<double> null = {};

  /// Which of extra (values: theirs) says how large the effect is: the largest, in units of its
  /// bounds, of those that say whether the effect is there.
  std::size_t Main(std::span<const double> values) const;
  /// Those of extra that say whether the effect is there.
  std::vector<std::size_t> Amplitudes() const;
  std::string Name() const { return variant.empty() ? effect : effect + " (" + variant + ")"; }
};

/// What a search may assume about sizes, measured on the experiment's own simulation.
struct Sizes {
  double torque = 1;     ///< typical generalized force on the joints [N*m]
  double angle = 1;      ///< typical joint range [rad]
  double velocity = 1;   ///< typical joint speed [rad/s]
  double tension = 1;    ///< typical force along tendons [N]
  double mass = 1;       ///< mass of the moving bodies [kg]
  double inertia = 1;    ///< inertia that a joint sees [kg*m^2]
  double period = 0.01;  ///< median sampling interval [s]
};
Sizes SizesOf(const Problem& problem, const Problem::Vector& x);

/// The candidates of an experiment that make sense in its model, one Hypothesis per effect and
/// choice; skipped: one sentence for each that does not.
std::vector<Hypothesis> MakeCandidates(const Experiment& experiment, const System& system,
                                       const Sizes& sizes, std::vector<std::string>& skipped);

}  // namespace continuum
