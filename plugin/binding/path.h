#pragma once

#include "binding/cable_friction.h"

namespace continuum {

/// A Path law on spatial tendons.
template <PathLaw E>
class BoundPath : public CableFriction {
 public:
  BoundPath(const mjModel& m, const Config& config)
      : CableFriction(m, config, ReadParams<E>(config)), law_(config.Read(E::kChoices[0])) {}

 private:
  double Band(double theta) const override {
    return E::template Band<double>(theta, law_, AsParams<E>(p_));
  }

  int law_;
};

}  // namespace continuum
