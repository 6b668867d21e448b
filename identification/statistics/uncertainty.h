#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/fit/fit.h"

namespace continuum {

/// Standard errors and correlations of a fit, allowing for residuals that are correlated in time:
///
///   Cov = n/(n − k) H⁻¹ S H⁻¹,   H = Σ JᵀJ
///
/// (of a robust loss ρ: H = Σ Jᵀρ''J, and ρ' for r) of whitened residuals, with S once from the
/// autoregressive model of each block's residuals (NoiseFrom), Σ Jᵀ Cov(r) J, and once from the
/// scores s_t = Jᵀ_t r_t themselves,
///
///   S = Σ_blocks Σ_lags w(lag) Σ_t s_t s_{t+lag}ᵀ
///
/// with Bartlett weights and Andrews' bandwidth for AR(1) scores (heteroskedasticity and
/// autocorrelation consistent, newey1987, andrews1991; of what lasts long it sees too little). Of
/// each parameter the larger variance counts. n: independent rows, k: parameters that they tell of.
/// Intervals end at the bounds; that of a parameter at a bound goes from there inwards, and as its
/// true value may lie inside, it counts as free for the others too. One without effect may be
/// anything that its bounds allow (standard error: that of an even distribution); so may all where
/// rows are no more than parameters.
struct Uncertainty {
  Problem::Vector standard_error, lower, upper;  ///< 95 % interval, within the bounds
  Problem::Vector step = {};  ///< what a fine time step would add to the value; empty: not known
  Problem::Matrix correlation;
  Problem::Matrix information;  ///< H; zero for parameters at a bound
  std::vector<bool> at_bound;
  std::string lacks = {};  ///< in words, what the user did not wait for; empty: nothing

  bool known() const { return !standard_error.hasNaN(); }  ///< else only values are, and at_bound
};
struct Scores {       ///< of rows that follow each other in time; a row of zeros was not measured
  Problem::Vector r;  ///< slopes of the loss: for least squares the residuals
  Problem::Matrix J;
  Problem::Vector curvature;  ///< of the loss: for least squares ones
};
Uncertainty UncertaintyFrom(const Problem& problem, const Problem::Vector& x,
                            const std::vector<Scores>& blocks);
/// The same with one block per counted channel of every log that has a Jacobian.
Uncertainty UncertaintyOf(const Problem& problem, const Problem::Vector& x,
                          const std::vector<Problem::Vector>& r,
                          const std::vector<Problem::Matrix>& J, const Whitening& whitening = {},
                          double soft = 0);

/// Whole effect of a step, of order h, over what a quarter of it shows.
inline constexpr double kWholeStep = 4.0 / 3;
/// The same of order √h, as seen where machines stick and slip.
inline constexpr double kWholeRoot = 2;

/// The same problem at a quarter of its time step.
Problem AtQuarter(const Problem& problem);

/// The robot has no time step, a simulation has. Intervals reach over what the same fit gives at a
/// fine one too, x + step, which is kept. quarter: what a quarter of the step h changes of x:
///
///   step = 4/3 quarter
void ReachOver(const Problem& problem, const Problem::Vector& quarter, Uncertainty& u);
/// The same to first order. With s, what the step h adds to the residuals (the first column of
/// Problem::StepEffects, h against h/4):
///
///   quarter = H⁻¹ Jᵀ s
void AllowForStep(const Problem& problem, const std::vector<Problem::Matrix>& J,
                  const std::vector<Problem::Matrix>& step, const Whitening& whitening,
                  Uncertainty& u);
/// J with mean slopes for columns: over the distance at which a parameter changes the residuals r
/// at x as much as the time step does. Where the cost is full of valleys, slopes within one say
/// little.
std::vector<Problem::Matrix> Secants(const Problem& problem, const Problem::Vector& x,
                                     const std::vector<Problem::Vector>& r,
                                     const std::vector<Problem::Matrix>& J,
                                     const std::vector<Problem::Matrix>& step,
                                     const Whitening& whitening);
/// Where first order did not foretell that (machines stick and slip, and the cost has many
/// valleys), s says how large the step's effect is, not where it pulls: intervals reach further to
/// both sides, by those of UncertaintyOf with 4/3 s for residuals.
void ReachFurther(const Problem& problem, const Problem::Vector& x,
                  const std::vector<Problem::Matrix>& J, const std::vector<Problem::Matrix>& step,
                  const Whitening& whitening, Uncertainty& u);
/// Where the time step moves a value by more than its standard error, a fit at a quarter of the
/// step, from x, tells what a fine one gives: intervals are made anew to reach over that, and
/// further (over twice its move, and by ReachFurther) where first order did not foretell half of
/// it. r, J, step: of the logs of the fit, as above; u: after AllowForStep.
void ReachByFineFit(const Problem& problem, const Problem::Vector& x,
                    const std::vector<Problem::Vector>& r, const std::vector<Problem::Matrix>& J,
                    const std::vector<Problem::Matrix>& step, const FitOptions& options,
                    Uncertainty& u);
/// All of these in one, from the logs of the fit; of where another log begins from that log alone,
/// given all else: what a fit.json states. r: residuals at x; the loss of the experiment may be
/// robust. Derivatives are central differences: one-sided ones bend what the step is said to
/// change. Once the user has asked to stop, errors, intervals and correlations are not known (NaN).
Uncertainty IntervalsOf(const Problem& problem, const Problem::Vector& x,
                        const std::vector<Problem::Vector>& r,
                        const std::function<void(const std::string&)>& progress = {});

}  // namespace continuum
