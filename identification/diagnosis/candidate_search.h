#pragma once

#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/candidate_fitter.h"

namespace continuum {

/// A fitted model from which to look for one more cause.
struct Base {
  const ModelSpec* system;
  std::vector<Parameter> given;  ///< free parameters of causes that the system has already
  const Fitted* fitted;          ///< complete
};

/// Whether b can imitate whatever a does: its directions span a's, or with more parameters it was
/// fitted to the same motion.
bool Contains(const CandidateFitter& trials, const CandidateResult& b, const CandidateResult& a);

/// One search for one more cause: all candidates to first order, then fits of those that matter.
/// Where the noise is not known nothing is significant, and first order is taken less literally.
class CandidateSearch {
 public:
  CandidateSearch(const CandidateFitter& trials, const Base& base, const Noise& noise,
                  const Sizes& sizes, const DiagnosisOptions& options,
                  SearchScope places = SearchScope::kFew);

  /// What every candidate could explain of what the base leaves, and how often noise alone would
  /// let the best of so many do as well.
  void Screen();
  /// Fits those that first order does not leave far behind, if a candidate is significant or what
  /// is left is plainly not noise; then best first, the others left behind. beside: a round from
  /// the same base that has been fitted, whose best they have to come near.
  void Fit(const CandidateSearch* beside = nullptr);
  /// Fits the best candidates once more, from where the experiment begins instead of where the base
  /// ended; whether any of them is better there.
  bool StartAnew();
  /// Takes the candidates of a round from the same base as well.
  void Join(CandidateSearch other);
  /// Takes those of them that were fitted, behind its own, as not listed.
  void JoinUnlisted(CandidateSearch other);

  /// A candidate that was left behind or not fitted to the end, with a complete fit. Throws Error
  /// when it diverges.
  CandidateResult FitAlone(CandidateResult candidate) const;

  /// Root of the whitened sum of squares that the best model leaves, over what noise would leave.
  double BestLeaves() const;
  /// The best model of this round: the leading candidate, or null for the base.
  const CandidateResult* leading() const;
  LackOfFit LackOf(const CandidateResult& candidate) const;
  LackOfFit LackOfBase() const;
  /// Whether what a fit leaves falls with the time step, at a quarter of it, as what the step adds.
  bool GoesWithTheStep(const CandidateResult& candidate) const;
  /// For JudgeLikelihoods, of the fitted candidates.
  std::vector<LikelihoodRecord> Records() const;
  double smallest_p() const;  ///< of all candidates that are not skipped, fitted or not
  /// How much of what the base leaves above the noise the best candidate explains, to first order.
  double Promise() const;

  std::vector<CandidateResult> candidates;   ///< after Fit: the fitted ones
  std::vector<CandidateResult> left_behind;  ///< by the screen, without a fit
  std::vector<std::string> skipped;

  static constexpr double kModelLimited = 3;  ///< times the noise: more is plainly not noise

 private:
  Significance Significant(const Remainder& left, const std::vector<std::vector<Probe>>& probes);
  bool SomethingIsLeft() const;
  double MostExplained() const;
  double HowMuchIsNeeded() const;
  bool NearTheNoise(const Fitted& fitted) const;
  double Likelihood(const Fitted& fitted) const;
  void FitOne(CandidateResult& c, double rival) const;
  static std::vector<Problem::Vector> FromTheOutset(const Problem& problem,
                                                    const CandidateResult& c);
  bool FitAnew(CandidateResult& c) const;
  bool FallsTo(const Problem& fine, const CandidateResult& c, const Fitted& finer) const;
  void GoOn(const Problem& problem, CandidateResult& c, double rival) const;
  void FitBeyond(CandidateResult& c, double rival) const;
  void SecondChances();
  std::vector<Problem::Vector> StartsAsGood(const CandidateResult& c, std::size_t best,
                                            const Remainder& left) const;
  Problem::Vector BestOf(const Problem& problem, const std::vector<Problem::Vector>& starts) const;
  static double TakenOff(const Fitted& fitted);
  void CompleteTheBest(double best);
  void AtAFineStep(CandidateResult& c) const;
  LackOfFit LackAt(const Problem& problem, const CandidateResult& c, const Fitted& fitted) const;
  static bool RaiseDelays(const CandidateResult& c, double step, Problem::Vector& x);
  std::string FlawOf(const Problem& problem, const Fitted& fitted) const;
  void Dismiss();
  void Rank();
  void TellApart();

  const CandidateFitter& trials_;
  Base base_;
  Problem base_problem_;
  const Noise& noise_;
  const Sizes& sizes_;
  const DiagnosisOptions& options_;
  double smallest_p_ = 1;
  double inflation_ = 1;  // of what rounding errors explain over whitened noise
  double left_ = 0;       // squares that the base leaves
};

}  // namespace continuum
