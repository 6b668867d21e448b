#pragma once

#include "identification/diagnosis/diagnosis.h"

namespace continuum {

/// How the models of one diagnosis are fitted and compared.
struct CandidateFitter {
  const Experiment* experiment;
  Whitening whitening;  ///< inactive when the noise is not known
  int iterations = 15;

  /// Fits on the train logs and scores train and validate; rival: cost of a fit that this one must
  /// come near to be worth its iterations; idle: FitOptions::idle. Throws Error when it diverges.
  Fitted Fit(const Problem& problem, const Problem::Vector& start,
             double rival = std::numeric_limits<double>::infinity(), bool idle = true) const;
  /// Fit of the experiment's own parameters, from its start or, where that leads to a wrong place,
  /// by the equations of motion: what is left there would be blamed on effects.
  Fitted FitNull(const Problem& problem) const;
  /// What else there is to know of a fit: sensitivities and intervals, what the time step leaves
  /// open, and with these the cost to first order.
  void Complete(const Problem& problem, Fitted& fitted) const;
  /// ReachByFineFit, for complete fits.
  void FitFinely(const Problem& problem, Fitted& fitted) const;
  /// A few iterations from a fit of nearly the same problem, complete. Throws Error when it
  /// diverges.
  Fitted GoOn(const Problem& problem, const Fitted& fitted) const;
  /// Fit and Complete.
  Fitted FitAll(const Problem& problem, const Problem::Vector& start) const;
  /// Leaves out each fold in turn.
  void AddFolds(const Problem& problem, const std::vector<Fold>& folds, Fitted& fitted) const;
  /// What a fit leaves, to first order; needs the noise.
  Remainder LeftBy(const Fitted& fitted) const;
  /// The starts of a candidate, each as directions from the null fit; probed at a share of the
  /// start where that does far more than is left to explain, and once more where it does far less.
  std::vector<Probe> Probes(const Hypothesis& h, const Problem& problem, const Fitted& null,
                            const Remainder& left) const;
  /// Where to begin a candidate's fit: a start of its own, with sizes from its probe. What does
  /// nothing without the others begins at excess times its start: first order says little of it.
  Problem::Vector StartFrom(const Hypothesis& h, const Fitted& null, const Probe& probe,
                            const Explained& explained, double excess = 1) const;
  /// How far the trajectories at the time step h and at h/4 are apart [pooled unit].
  double StepEffect(const Problem& problem, const Fitted& fitted) const;
  /// Whether what a candidate leaves above the noise is no more than what its time step adds, and
  /// that is enough to be seen in the noise: then it is no sign of another cause.
  bool WithinStep(const Fitted& fitted) const;
  /// Tests of what no candidate covers, at the step of the fit's problem; inflation: of noise along
  /// any direction.
  LackOfFit LackIn(const Problem& problem, const std::vector<Parameter>& extra,
                   const Fitted& fitted, const Sizes& sizes, double inflation,
                   std::uint64_t seed) const;

 private:
  FitOptions Options() const;
  FitOptions FewSteps() const;
  std::vector<Problem::Vector> StepColumn(const Fitted& fitted) const;
};

/// What an error has beyond an independent part of it: √(a² − b²), 0 where the part is larger.
double Beyond(double error, double part);

/// Parameters that are known, and then those of a candidate.
Problem::Vector Append(const Problem::Vector& known, const std::vector<double>& own);

}  // namespace continuum
