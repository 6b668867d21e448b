#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {

/// a, b, c of mu(theta) with their standard errors.
struct FrictionFit {
  Friction value, stderror;
  double rms = 0;  ///< sqrt(SSR/n)
  int n = 0;

  std::string Json() const;
};

/// Unweighted least squares of a theta^2 + b theta + c to mu, as in section 5 of the paper.
/// stderror = sqrt(diag((X'X)^-1) SSR/(n - 3)). theta [rad] has at least three different values, n
/// is at least 4.
FrictionFit FitFriction(const std::vector<double>& theta, const std::vector<double>& mu);

/// FRICTION.csv: `theta` [rad], the cable against the disc's normal on the weight's side; `m` [kg],
/// the weight; `F_SC` [N], the force sensor. mu = |F_SC - 9.81 m| / (9.81 m sin theta).
/// @throws Error (file:line, column) for bad numbers or too few rows or angles.
FrictionFit CalibrateFriction(const std::filesystem::path& file);

}  // namespace continuum::twin_pivot
