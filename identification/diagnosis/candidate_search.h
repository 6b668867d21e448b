#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/probing.h"
#include "identification/diagnosis/search_rules.h"

namespace continuum {

/// A fitted model from which to look for one more cause.
struct BaseFit {
  const ModelSpec* system;
  std::vector<Parameter> given;  ///< free parameters of causes that the system has already
  const Fitted* fitted;          ///< complete
  /// Its problem, which remembers simulations; null: those are made anew.
  const Problem* problem = nullptr;
};

/// What the searches of one diagnosis share.
struct SearchContext {
  const CandidateFitter& fitter;
  const Noise& noise;
  const Sizes& sizes;
  const DiagnosisOptions& options;
};

/// Whether b can imitate whatever a does: its directions span a's, or with more parameters it was
/// fitted to the same motion.
bool Contains(const CandidateFitter& fitter, const CandidateResult& b, const CandidateResult& a);

/// One search for one more cause: all candidates to first order, then fits of those that matter.
/// Where the noise is not known nothing is significant, and first order is taken less literally.
class CandidateSearch {
 public:
  CandidateSearch(const SearchContext& context, const BaseFit& base,
                  SearchScope scope = SearchScope::kFew);

  /// What every candidate could explain of the base's residual, to first order and of the missing
  /// force at the measured states, and how often noise alone would let the best of so many do as
  /// well. views: of the forces that are missing at the base; rival: of candidates that nobody
  /// asked for, what they have to outdo: those that plainly do not are dropped after a look at one
  /// log. hopeless: names at places of those that are dropped unless the missing force promises
  /// something.
  void Screen(const std::vector<EquationErrors>& views, const CandidateResult* rival = nullptr,
              const std::set<std::string>& hopeless = {});
  /// Fits those that come near the best to first order, if a candidate is significant or the
  /// residual is plainly not noise; then best first, the others dismissed. beside: a search from
  /// the same base that has been fitted, whose best they have to come near; limit: of fits.
  void Fit(const CandidateSearch* beside = nullptr,
           std::size_t limit = std::numeric_limits<std::size_t>::max());
  /// Fits the best candidates once more, from where the experiment begins instead of where the base
  /// ended; whether any of them is better there.
  bool RefitFromExperimentStart();
  /// Whether the fit of a candidate ended out of step: worse than without it, or than the leading
  /// one's though it explains more of the missing force.
  bool HasLostFits() const;
  /// Takes the candidates of a search from the same base as well.
  void Join(CandidateSearch other);
  /// Takes those of them that were fitted, behind its own, as not listed.
  void JoinUnlisted(CandidateSearch other);

  /// A candidate that was dismissed or not fitted to the end, with a complete fit. Throws Error
  /// when it diverges.
  CandidateResult FitAlone(CandidateResult candidate) const;

  /// Root of the whitened sum of squares of the best model, over what noise would make it.
  double BestOverNoise() const;
  /// The best model of this search: the leading candidate, or null for the base.
  const CandidateResult* leading() const;
  CandidateResult* leading();
  /// Tests of a complete fit's residual.
  LackOfFit TestsOf(const CandidateResult& candidate) const;
  /// The same of the leading candidate's or the base's, with whether the time-discretisation error
  /// explains them.
  LackOfFit LackOf(CandidateResult* candidate) const;
  /// Whether a fit's squares above the noise fall with the time step, at a quarter of it, as the
  /// time-discretisation error does.
  bool FallsWithStep(CandidateResult& candidate) const;
  /// For JudgeLikelihoods, of the fitted candidates.
  std::vector<LikelihoodRecord> Records() const;
  /// The same of the base.
  BaseSquares Base() const;
  /// Twice the logarithm of what a fit gains over the base.
  double Likelihood(const Fitted& fitted) const;
  /// From now on in the unit of noise of another search, so that likelihoods of both compare.
  void CountAs(const CandidateSearch& other);
  /// What a fit takes of the base's squared error above the noise and what the time step adds.
  double ErrorShare(const Fitted& fitted) const;
  /// Names at places of candidates that, to first order, explain little beside one of this search,
  /// in comparison with what the best adds to that one.
  std::set<std::string> HopelessBeside(const CandidateResult& first) const;
  double smallest_p() const { return smallest_p_; }  ///< of all candidates that are not skipped
  /// How much of the base's squares above the noise the best candidate explains, to first order.
  double ExplainableShare() const;

  std::vector<CandidateResult> candidates;  ///< after Fit: the fitted ones
  std::vector<CandidateResult> dismissed;   ///< by the screen, without a fit
  std::vector<std::string> skipped;
  std::vector<std::string> left_out;  ///< for lack of time

 private:
  std::vector<Probe> Probes(const CandidateResult& c, const ProjectedResidual& residual,
                            const std::vector<std::size_t>& starts) const;
  void SimulateCoarsely();
  void ProbeOne(CandidateResult& c, const ProjectedResidual& residual,
                const std::vector<std::size_t>& starts);
  std::vector<CandidateResult*> CheapestFirst();
  std::vector<CandidateResult*> InOrderOfForce();
  double LookAt(const CandidateResult& c, const ProjectedResidual& residual) const;
  void KeepThoseThatMayOutdo(const CandidateResult& best);
  void DropHopeless(const std::set<std::string>& names);
  void LookAtError(CandidateResult& c) const;
  void ProbeAll(const ProjectedResidual& residual, bool sees_forces);
  Significance Significant(const ProjectedResidual& residual,
                           const std::vector<std::vector<Probe>>& probes);
  std::optional<EquationStart> LookAtForce(const EquationErrors& view,
                                           const CandidateResult& c) const;
  void LookAtOtherShapes(const EquationErrors& view, const CandidateResult& c,
                         std::optional<EquationStart>& found) const;
  void LookAtForces(const EquationErrors& view, const CandidateResult* rival);
  double MostExplained() const;
  bool IsWorthAFit(const CandidateResult& c, double needed) const;
  double Threshold() const;
  static double Promise(const CandidateResult& c, double most);
  void OrderByPromise();
  std::size_t Order();
  void OrderAlike(std::size_t different);
  /// What the fits so far have reached, and what those to come must promise.
  struct Race {
    double needed;
    std::size_t limit;
    double rival = kInfinity, best = kInfinity;  // costs
    bool reached = false;
  };
  void FitInOrder(std::size_t next, std::size_t end, Race& race);
  void FitBeside(const std::vector<CandidateResult*>& some, const Race& race);
  bool Count(const CandidateResult& c, Race& race) const;
  std::vector<CandidateResult*> RicherThanBest();
  const CandidateResult* Best() const;
  std::vector<CandidateResult*> NextWave(double needed, std::size_t most, std::size_t& next,
                                         std::size_t end);
  bool ReachesNoise(const Fitted& fitted) const;
  bool TakesMainShare(const Fitted& fitted) const;
  bool IsEnough(const Fitted& fitted) const;
  void LeaveOthers(double needed, std::size_t next, std::size_t end);
  void SayFit(const CandidateResult& c, double needed) const;
  static constexpr std::size_t kStartsTried = 2;
  void FitOne(CandidateResult& c, double rival, std::size_t tried = kStartsTried) const;
  std::optional<Problem::Vector> MakeRoom(const Problem& problem, const Problem::Vector& x) const;
  bool StepAsBase(Problem& problem) const;
  std::vector<CandidateResult*> MostPromising();
  static std::vector<Problem::Vector> ExperimentStarts(const Problem& problem,
                                                       const CandidateResult& c);
  bool RefitFromStart(CandidateResult& c) const;
  bool IsLost(const CandidateResult& c) const;
  static std::vector<Problem::Vector> StartsWithoutBase(const Problem& problem,
                                                        const CandidateResult& c);
  std::vector<Problem::Vector> StartsNextToBase(const Hypothesis& h) const;
  bool RefitFrom(const Problem& problem, CandidateResult& c,
                 const std::vector<Problem::Vector>& starts) const;
  /// Whether first order in the step does not hold.
  bool IsRough(const Fitted& fitted) const;
  bool FitsBetterAtFineStep(CandidateResult& c) const;
  /// Whether its squares above the noise fall, by the directions that both fits know.
  bool FallsTo(const CandidateResult& c, const Fitted& finer) const;
  void Continue(const Problem& problem, CandidateResult& c, double rival) const;
  void GoOnWidely(const Problem& problem, CandidateResult& c, double rival) const;
  void WidenRanges(CandidateResult& c, double rival) const;
  void FitPlainer();
  void FinishAbandoned();
  std::vector<Problem::Vector> OtherStarts(const CandidateResult& c, std::size_t best,
                                           const ProjectedResidual& residual) const;
  FitStart BestOf(const Problem& problem, const std::vector<Problem::Vector>& all,
                  std::size_t tried = kStartsTried) const;
  ProjectedResidual ScreenedResidual() const;
  static double StepReduction(const Fitted& fitted);
  void CompleteCompetitive(const Fitted* known);
  bool CompleteOne(CandidateResult& c, double best) const;
  void RefitAtQuarterStep(CandidateResult& c) const;
  void Mend(const Problem& problem, CandidateResult& c) const;
  bool IsSoundAtQuarterStep(const Problem& problem, CandidateResult& c) const;
  LackOfFit LackAt(const Problem& problem, const CandidateResult& c, const Fitted& fitted) const;
  static bool RaiseDelays(const CandidateResult& c, double step, Problem::Vector& x);
  std::string FlawOf(const Problem& problem, const Fitted& fitted) const;
  void Dismiss();
  void Rank();
  void ComputeLambda();
  double DistanceOf(const Fitted& a, const Fitted& b) const;
  double HeldOutError(const Fitted& fitted) const;

  const CandidateFitter& fitter_;
  BaseFit base_;
  Problem base_problem_;
  struct Coarse {
    double step;  // [s]
    std::vector<Problem::Vector> residuals;
  };
  std::optional<Coarse> coarse_;
  const Noise& noise_;
  const Sizes& sizes_;
  const DiagnosisOptions options_;
  const Criteria& criteria_;
  double smallest_p_ = 1;
  double inflation_ = 1;     // of what rounding errors explain over whitened noise
  double base_squares_ = 0;  // of the base's residual
};

}  // namespace continuum
