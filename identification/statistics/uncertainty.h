#pragma once

#include <vector>

#include "identification/problem/problem.h"
#include "identification/result/uncertainty.h"
#include "identification/statistics/whitening.h"

namespace continuum {

/// Rows that follow each other in time, and how the loss follows the parameters there.
struct Scores {
  Problem::Vector r;          ///< [row] slopes of the loss: for least squares the residuals
  Problem::Matrix J;          ///< [rows × parameters]; a row of zeros was not measured
  Problem::Vector curvature;  ///< [row] of the loss: for least squares ones
};

/// Standard errors and correlations of a fit, allowing for residuals that are correlated in time:
///
///   Cov = n/(n − k) H⁻¹ S H⁻¹,   H = Σ JᵀJ
///
/// (of a robust loss ρ: H = Σ Jᵀρ''J, and ρ' for r) of whitened residuals, with S once from the
/// autoregressive model of each block's residuals (NoiseFrom), Σ Jᵀ Cov(r) J, and once from the
/// scores s_t = Σ Jᵀ_t r_t of all blocks of a motion themselves,
///
///   S = Σ_motions Σ_lags w(lag) Σ_t s_t s_{t+lag}ᵀ
///
/// with Bartlett weights and Andrews' bandwidth for AR(1) scores (heteroskedasticity and
/// autocorrelation consistent, newey1987, andrews1991; of what lasts long it sees too little). So
/// what a model gets wrong in all channels at once counts as one error. Of each parameter the
/// larger variance counts. n: independent rows, k: parameters that they determine. Intervals end at
/// the bounds; that of a parameter at a bound goes from there inwards, and as its true value may
/// lie inside, it counts as free for the others too. One without effect may be anything that its
/// bounds allow (standard error: that of an even distribution); so may all where rows are no more
/// than parameters. motions: [motion][block], the blocks of one motion with the same rows.
Uncertainty UncertaintyFrom(const Problem& problem, const Problem::Vector& x,
                            const std::vector<std::vector<Scores>>& motions);
/// The same with one block per counted channel of every log that has a Jacobian. Replicates (logs
/// l = 1 … m of one motion) count as their mean and their differences, which leaves sums of squares
/// as they are: noise is in all of them, an error of the model in the mean alone.
///
///   r'_1 = Σ r_l / √m,   r'_j = (r_1 + … + r_{j−1} − (j − 1) r_j) / √(j (j − 1)),   J' likewise
Uncertainty UncertaintyOf(const Problem& problem, const Problem::Vector& x,
                          const std::vector<Problem::Vector>& r,
                          const std::vector<Problem::Matrix>& J, const Whitening& whitening = {},
                          double soft = 0);

/// Which values stand at one of their bounds, to a millionth of their scale.
std::vector<bool> AtBounds(const Problem& problem, const Problem::Vector& x);
/// The columns of each log times √ρ'' of its rows, the curvature of the soft L1 loss at residuals r
/// (soft 0: as they are).
std::vector<Problem::Matrix> WeightedByCurvature(std::vector<Problem::Matrix> columns, double soft,
                                                 const std::vector<Problem::Vector>& r);
/// Moves the ends of the intervals by low ≤ 0 and high ≥ 0 [parameter], within the bounds.
void Widen(const Problem& problem, const Problem::Vector& low, const Problem::Vector& high,
           Uncertainty& u);

/// Whole effect of a step, of order h, over what a quarter of it shows.
inline constexpr double kWholeStep = 4.0 / 3;
/// The same of order √h, as seen where machines stick and slip.
inline constexpr double kWholeRoot = 2;

/// The same problem at a quarter of its time step.
Problem AtQuarter(const Problem& problem);

/// Extends intervals to the value that the same fit gives at a fine time step, x + step, which is
/// kept: the robot has no time step, a simulation has. quarter: what a quarter of the step h
/// changes of x,
///
///   step = 4/3 quarter
void WidenByStep(const Problem& problem, const Problem::Vector& quarter, Uncertainty& u);
/// The same to first order. With s, what the step h adds to the residuals (the first column of
/// Problem::StepEffects, h against h/4):
///
///   quarter = H⁻¹ Jᵀ s
void AllowForStep(const Problem& problem, const std::vector<Problem::Matrix>& J,
                  const std::vector<Problem::Matrix>& step, const Whitening& whitening,
                  Uncertainty& u);
/// Extends intervals to both sides by what first order in the time step leaves out. Of an effect
/// e(h) = a h + b h², a quarter of the step shows ¾ a h + 15/16 b h², so that x + step is off by
/// what b h²/4 moves; the third column of Problem::StepEffects is b h²/8.
void AllowForSecondOrder(const Problem& problem, const std::vector<Problem::Matrix>& J,
                         const std::vector<Problem::Matrix>& step, const Whitening& whitening,
                         Uncertainty& u);
/// Standard errors from what a simulation without a time step would leave, as the robot has none:
/// an error that repeats is no noise. To first order, where that leaves less than r does:
///
///   r' = r − 4/3 s + J step
///
/// u: after WidenByStep or AllowForStep, which widens them again; soft: of a robust loss.
void LeaveOutStep(const Problem& problem, const Problem::Vector& x,
                  const std::vector<Problem::Vector>& r, const std::vector<Problem::Matrix>& J,
                  const std::vector<Problem::Matrix>& step, const Whitening& whitening, double soft,
                  Uncertainty& u);
/// Mean slopes in place of J's [log][rows × parameters]: over the distance at which a parameter
/// changes the residuals r at x as much as the time step does. Where the cost has many local
/// minima, slopes within one mean little.
std::vector<Problem::Matrix> Secants(const Problem& problem, const Problem::Vector& x,
                                     const std::vector<Problem::Vector>& r,
                                     const std::vector<Problem::Matrix>& J,
                                     const std::vector<Problem::Matrix>& step,
                                     const Whitening& whitening);
/// Extends intervals to both sides by those of UncertaintyOf with 4/3 s for residuals: where first
/// order did not predict the effect of the time step (machines stick and slip, and the cost has
/// many local minima), s says how large that effect is, not its direction.
void WidenByStepSize(const Problem& problem, const Problem::Vector& x,
                     const std::vector<Problem::Matrix>& J,
                     const std::vector<Problem::Matrix>& step, const Whitening& whitening,
                     Uncertainty& u);

}  // namespace continuum
