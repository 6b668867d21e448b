#pragma once

#include <string>
#include <vector>

#include "models/spa/chain_error.h"

namespace continuum {

/// How the chain's distance from the analytic actuator shrinks with the number of its links, in
/// decimal logarithms: δ and torque, a curve for each time step, and the slope N⁻⁴.
class LinksChart {
 public:
  void Add(int links, double timestep, const SpaGap& gap);
  /// Throws Error for fewer than one row.
  std::string Svg() const;

 private:
  struct Curve {
    double timestep;
    std::vector<double> links, delta, torque;  // lg N, lg %
  };
  std::vector<Curve> curves_;
};

}  // namespace continuum
