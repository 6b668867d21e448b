#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "identification/diagnosis/result.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/parallel.h"

namespace continuum {

/// Where a fit begins, and its slopes there if they are known (FitOptions::slopes).
struct FitStart {
  Problem::Vector x;
  Problem::Matrix slopes = {};
};

/// How the models of one diagnosis are fitted and compared.
struct CandidateFitter {
  const Experiment* experiment;
  Whitening whitening = {};  ///< inactive when the noise is not known
  int iterations = 15;
  Criteria criteria = {};
  /// ProcessorSeconds at which fits end with what they have reached, and new ones are not begun.
  double until = std::numeric_limits<double>::infinity();

  bool TimeIsOver() const { return EndRequested() || ProcessorSeconds() > until; }
  /// Whether there is time for something that a verdict stands without; if not, it is left out.
  bool HasTimeFor(const std::string& what, std::vector<std::string>& left_out) const {
    if (!TimeIsOver()) return true;
    left_out.push_back(what);
    return false;
  }

  /// Fits on the train logs and scores train and validate; rival: cost of a fit that this one must
  /// come near to be worth its iterations; idle: FitOptions::idle. Throws Error when it diverges.
  Fitted Fit(const Problem& problem, FitStart start,
             double rival = std::numeric_limits<double>::infinity(), bool idle = true) const;
  /// Fit of the experiment's own parameters, from its start or, where that leads to a wrong place,
  /// by the equations of motion: its error would be blamed on effects.
  Fitted FitNull(const Problem& problem) const;
  /// Where a fit over short horizons from x ends (OnShortHorizons); nothing where there are none.
  std::vector<Problem::Vector> OverShortHorizons(const Problem& problem,
                                                 const Problem::Vector& x) const;
  /// A fit on the train logs by slopes at a point and over a wider range in turn, as `identify`
  /// does.
  continuum::Fit FitWidely(const Problem& problem, const Problem::Vector& x) const;
  /// Adds sensitivities and intervals, what the time step leaves open, and with these the cost to
  /// first order.
  void Complete(const Problem& problem, Fitted& fitted) const;
  /// ReachByFineFit, for complete fits.
  void FitFinely(const Problem& problem, const std::optional<Problem::Vector>& fine,
                 Fitted& fitted) const;
  /// A few iterations from a complete fit of nearly the same problem, whose sensitivities it keeps.
  /// Throws Error when it diverges.
  Fitted Continue(const Problem& problem, const Fitted& fitted) const;
  /// Fit and Complete.
  Fitted FitAll(const Problem& problem, const Problem::Vector& start) const;
  /// Adds the sensitivities of the validate logs to a complete fit, once.
  void CompleteOnValidate(const Problem& problem, Fitted& fitted) const;
  /// Leaves out each fold in turn, of a complete fit, once.
  void AddFolds(const Problem& problem, const std::vector<Fold>& folds, Fitted& fitted) const;
  /// The residual of a complete fit to first order.
  ProjectedResidual ProjectedResidualOf(const Fitted& fitted) const;
  /// The same of some logs alone.
  ProjectedResidual ProjectedResidualOf(const Fitted& fitted, const std::vector<bool>& use) const;
  /// How far the trajectories of a complete fit at the time step h and at h/4 are apart [pooled
  /// unit].
  double StepError(const Problem& problem, const Fitted& fitted) const;
  /// Whether the time-discretisation error explains a complete fit's squares above the noise: then
  /// they are no sign of another cause.
  bool ExplainedByStep(const Fitted& fitted) const;

 private:
  FitOptions Options() const;
  FitOptions FewSteps() const;
  SimulatedSquares SimulatedSquaresOf(const Problem& problem, const Fitted& fitted,
                                      const Problem::Vector& shift) const;
  Problem::Matrix SlopesOf(const Problem& problem, const Fitted& fitted) const;
  std::vector<Problem::Vector> StepColumn(const Fitted& fitted) const;
};

/// The problem of a candidate's model with its free parameters.
Problem ProblemOf(const CandidateResult& candidate, const Experiment& experiment);

/// An error without an independent part of it: √(a² − b²), 0 where the part is larger.
double WithoutPart(double error, double part);
/// Its square.
double SquaresWithoutPart(double error, double part);

}  // namespace continuum
