#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "binding/effect_catalog.h"
#include "sim/experiment/experiment.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// A model that may have made the data: the experiment's own, or that with one more effect.
struct Hypothesis {
  std::string effect;   ///< empty: the model as it is; of a law of the experiment: its name
  std::string variant;  ///< of a choice: "load=actuator"
  std::string where;    ///< its place: "joint q"
  ModelSpec system;
  std::vector<Parameter> extra;  ///< free parameters of the effect
  EffectInstance instance;  ///< the plugin instance, for effects that need one (else no effect)
  std::string replaces;     ///< instance whose place it takes
  std::vector<std::vector<double>> starts;  ///< values of extra to begin a search from
  /// Values of extra at which the effect is absent; NaN for those that mean nothing then.
  std::vector<double> null = {};

  /// Free parameters of the causes that its system has already; they come before extra.
  std::vector<Parameter> given = {};

  Candidate candidate = {};               ///< what the experiment asks for
  int option = 0;                         ///< of the effect's choice
  Place place = Place::kWorld;            ///< kind of the objects on which it acts
  std::vector<std::string> objects = {};  ///< their names (ObjectSet)
  /// In which each parameter of its card is shown, by name; empty for pure numbers.
  std::map<std::string, std::string> units = {};

  std::vector<Parameter> Free() const;  ///< given and extra
  /// Which of extra (values: theirs) says how large the effect is: the largest, in units of its
  /// bounds, of those that say whether the effect is there.
  std::size_t Main(std::span<const double> values) const;
  /// Those of extra that say whether the effect is there.
  std::vector<std::size_t> Amplitudes() const;
  /// The value of extra[i] at a share of what `value` does; at none the effect is absent.
  double AtShare(std::size_t i, double value, double share) const;
  /// Indices of the starts whose nuisances (null: NaN), which shape the effect, are those of the
  /// first start, or are others.
  std::vector<std::size_t> StartsOfShape(bool first) const;
  /// Whether extra[i] may leave the value at which the effect is absent on one side only.
  bool OneSign(std::size_t i) const {
    return extra[i].lower >= null[i] || extra[i].upper <= null[i];
  }
  /// Whether it is one of the measurement: nothing of the model is other.
  bool OnlyMeasured() const;
  /// The effect on whose card (EffectNamed) its parameters are.
  const std::string& Card() const { return instance.effect.empty() ? effect : instance.effect; }
  std::string Name() const { return variant.empty() ? effect : effect + " (" + variant + ")"; }
  std::string NameAtPlace() const { return Name() + " at " + where; }
};

}  // namespace continuum
