#pragma once

#include "binding/cable_friction.h"

namespace continuum {

/// A Path law on spatial tendons.
template <PathLaw E>
class BoundPath : public CableFriction {
 public:
  BoundPath(const mjModel& m, const Config& config)
      : CableFriction(m, config, ReadParams<E>(config)), law_(config.Read(E::kChoices[0])) {}

  void BandSlopes(double theta, double& by_theta, std::span<double> by_parameter) const override {
    constexpr std::size_t kN = 1 + kParamCount<E>;
    using T = Dual<kN>;
    const T band = E::template Band<T>(T(theta, 0), law_, DualParams<kN>(AsParams<E>(p_), 1));
    by_theta = band.d[0];
    std::copy(band.d.begin() + 1, band.d.end(), by_parameter.begin());
  }

  int GiveParameter() const override {
    if constexpr (requires { E::kGive; }) return E::kGive;
    return -1;
  }

 private:
  void Bands(std::span<const double> theta, std::span<double> band) const override {
    const auto p = AsParams<E>(p_);
    for (std::size_t k = 0; k < theta.size(); ++k) {
      band[k] = E::template Band<double>(theta[k], law_, p);
    }
  }

  int law_;
};

}  // namespace continuum
