#pragma once

#include <cstddef>
#include <vector>

namespace continuum {

/// A value that one unit gave, with the standard error of its own measurement.
struct UnitValue {
  double value, standard_error;
};

/// Values of k units as y_i = μ + u_i + e_i: u_i of standard deviation τ between units, e_i of the
/// units' own standard errors s_i. With weights w_i = 1/(s_i² + τ²) and μ = Σ w_i y_i / Σ w_i,
///
///   Q(τ²) = Σ w_i (y_i − μ)²,   Q(τ²) = k − 1   (τ = 0 where Q(0) is less).
///
/// Estimate of τ: R. C. Paule, J. Mandel, J. Res. Natl. Bur. Stand. 87 (1982) 377. Its 95 %
/// interval, where Q is between the quantiles of χ² with k − 1 degrees of freedom: W. Viechtbauer,
/// Stat. Med. 26 (2007) 37. That of μ, by Student's t and the spread that is there: J. Hartung,
/// G. Knapp, Stat. Med. 20 (2001) 3875, not narrower than Q = k − 1 gives.
struct RandomEffects {
  double mean, mean_low, mean_high;
  double between, between_low, between_high;  ///< τ
  double p;                                   ///< of Q(0) or more, if all units had one value
};

/// Throws Error for less than two units, and for values or standard errors that are not finite, or
/// standard errors that are not positive.
RandomEffects FitRandomEffects(const std::vector<UnitValue>& units);

/// How far a unit lies off all others.
struct UnitDeviation {
  double t;  ///< (y_i − μ₋ᵢ) / √(s_i² + τ₋ᵢ² + Var μ₋ᵢ), with μ₋ᵢ, τ₋ᵢ of the others
  double p;  ///< of a |t| as large, by Student's t with k − 2 degrees of freedom
  bool odd;  ///< p < 0.05 / k: one population in twenty has such a unit by chance
};

/// Of each unit (W. Viechtbauer, M. W.-L. Cheung, Res. Synth. Methods 1 (2010) 112, "studentized
/// deleted residuals"). At least three units; as FitRandomEffects.
std::vector<UnitDeviation> DeviationsOf(const std::vector<UnitValue>& units);

}  // namespace continuum
