#pragma once

#include <cstddef>

#include "identification/diagnosis/criteria.h"
#include "identification/diagnosis/verdict.h"

// The decisions of the search, without its fits: numbers in, yes or no out.
namespace continuum {

/// Norm of a probe's residuals that does what is to be explained. calibrated: squares are in units
/// of the noise.
double ProbeTarget(double squares, double freedom, bool calibrated, const Criteria& criteria = {});

/// The share of its size at which a probe of this norm is repeated because it does far too much;
/// 1: it is not.
double SmallerShare(double norm, double target, const Criteria& criteria = {});
/// The same because it does far too little, at most a share at which it comes to its bound.
double LargerShare(double norm, double target, double most, const Criteria& criteria = {});

/// The share of a candidate's size at which its fit starts. explained: by which it explains most to
/// first order; probed: at which it was probed.
double StartShare(double explained, double probed, const Criteria& criteria = {});

/// Whether a start explains as much as the best one.
bool IsAsGood(double explained, double best, const Criteria& criteria = {});

/// Sizes of what a model's error may consist of, in one unit.
struct ErrorParts {
  double noise = 0;
  double step = 0;  ///< time-discretisation error
};

/// The squares that a candidate takes off. promised: to first order, from where both fits ended;
/// here, there: simulated, where both ended and where first order has its least. Far away first
/// order may promise what nothing keeps.
double GainKept(double promised, double here, double there, const Criteria& criteria = {});

/// Whether a fit's error is hardly more than the noise and the time-discretisation error.
bool ReachesNoise(double error, const ErrorParts& parts, const Criteria& criteria = {});

/// Whether an error is no more than noise and time step make together: what shows in it all the
/// same is smaller than they are.
bool IsWithinNoise(double error, const ErrorParts& parts);

/// Whether something of a model's squares wants an explanation: a candidate is significant, or the
/// squares are plainly not noise. freedom: what noise alone would make them.
bool HasSignal(double smallest_p, double squares, double freedom, const Criteria& criteria = {});

/// Squares that a candidate must explain to first order to be fitted. most: what the best one
/// explains; squares: of the model without any.
double FitThreshold(double most, double squares, bool noise_known, const Criteria& criteria = {});

/// The same once a fit reaches the noise.
double FitThresholdAtNoise(double most, const Criteria& criteria = {});

/// The same for candidates that nobody asked for. most: what the best one explains that was.
double UnlistedThreshold(double most, const Criteria& criteria = {});

/// Whether a candidate explains so much of the missing force that it is fitted, whatever first
/// order says. most: what the best one explains; all are shares of its squares.
bool ExplainsForce(double share, double most, const Criteria& criteria = {});

/// Whether so many of all effects had no look that a name may be any of them.
bool TooManyUnseen(std::size_t unseen, std::size_t all, const Criteria& criteria = {});

/// How likely it is at most that one of so many fits gains as much from noise alone: for those that
/// the screen had no time for. gain: twice the logarithm of its likelihood.
double ChanceOfGain(double gain, std::size_t parameters, std::size_t fits);

/// Whether an abandoned fit goes on to its end where none reaches the noise. finished: so many did.
bool WorthFinishing(std::size_t finished, double explained, double most,
                    const Criteria& criteria = {});

/// Whether fits have gone on in vain: so many since one was clearly better than all before it.
bool GoOnInVain(std::size_t since_better, const Criteria& criteria = {});

/// Cost that a fit has to come near. rival: the best cost so far.
double HopelessCost(double rival, const Criteria& criteria = {});

/// Whether a fit that is out of iterations goes on: its last step gained enough.
bool StillGains(double last_gain, double cost, bool noise_known, const Criteria& criteria = {});

/// Whether a fit may come near the best once its sensitivities are known, which lower the squares
/// by up to step_reduction.
bool WorthCompleting(double squares, double best, double step_reduction,
                     const Criteria& criteria = {});

/// Whether the squares above the noise are no more than the time-discretisation error explains, of
/// which there are enough to be seen.
bool ExplainedByStep(double squares, double freedom, double step_squares,
                     const Criteria& criteria = {});

/// Whether squares above the noise fall with the time step, as those that it explains do.
bool FallsWithStep(double before, double after, const Criteria& criteria = {});

/// Whether a time-discretisation error is so uncertain that it is measured at a finer step.
/// roughness: ProjectedResidual::roughness.
bool IsRough(double roughness, const Criteria& criteria = {});

/// Whether a fit removes more than the time step may have added to it. step, base_step:
/// time-discretisation error of the fit and of the model without; removed: error taken off.
bool IsResolved(double step, double base_step, double removed, double noise,
                const Criteria& criteria = {});

/// Two fits of nested or similar laws.
struct FitPair {
  double gain;        ///< likelihood of the first less that of the second
  double difference;  ///< squares by which their residuals differ
  double likelihood;  ///< of the second
};
/// Whether the first, which has more parameters, follows the same motion as the second.
bool SaysTheSame(const FitPair& pair, bool noise_known, const Criteria& criteria = {});

/// Whether directions contain others but for so many of their squares.
bool Contains(double missed, double squares, const Criteria& criteria = {});

/// Whether a candidate is worth cross-validation. before, after: error of the fit without and with
/// it.
bool WorthFolds(double before, double after, const Criteria& criteria = {});

/// Whether two causes together are looked for. over_noise: error with the best single cause over
/// the noise.
bool MayBeTwo(const Verdict& verdict, const LackOfFit& lack, double smallest_p, double over_noise,
              const Criteria& criteria = {});

/// Whether a rich law of its family, which leaves more than noise, may stand for two plain causes:
/// friction that differs by direction for friction and an offset.
bool MayBeTwoPlainer(const Verdict& verdict, bool rich, double over_noise,
                     const Criteria& criteria = {});

/// Whether a partner is worth a search: share of the first one's squares above the noise that some
/// candidate explains, which counts where the time step may explain them too.
bool WorthPartner(double smallest_p, double share, bool of_step, const Criteria& criteria = {});

/// Whether the plain law of a family may be one of two causes where a richer one explains more by
/// itself. Both: what they explain.
bool MayDoBesideAnother(double plain, double richer, const Criteria& criteria = {});

/// Whether a force without a cause is looked for. ceiling_gain: of forces of many terms.
bool WorthFallback(double ceiling_gain, bool noise_limited, const Criteria& criteria = {});

/// Whether an experiment distinguishes two candidates. separation: NextExperiment::separation.
bool Distinguishes(double separation, const Criteria& criteria = {});

}  // namespace continuum
