#include "identification/diagnosis/found_law.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "binding/config.h"
#include "binding/expression.h"
#include "effects/formula.h"
#include "error.h"
#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/law_search.h"
#include "identification/diagnosis/probing.h"
#include "sim/io/interrupt.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;

constexpr std::size_t kFitted = 5;  // suggestions that are simulated
constexpr double kNear = 1.1;       // times the error of the best one

std::string GlobsOfJoints(const std::vector<std::string>& joints) {
  std::string globs = "joint:";
  for (const std::string& joint : joints)
    globs += (&joint == &joints.front() ? "" : " ") + Escaped(joint);
  return globs;
}

std::vector<Hypothesis> HypothesesOf(const SuggestedLaw& suggested, const Experiment& e,
                                     const Diagnosis& d) {
  std::vector<std::string> skipped;
  return MakeCandidates(
      {{std::string(Formula::kName), GlobsOfJoints(suggested.joints), false, suggested.law}}, e,
      {&d.system}, d.sizes, skipped);
}

Vector StartOf(const CandidateResult& c, const Vector& base) {
  std::vector<double> own;
  for (const Parameter& p : c.hypothesis.extra) own.push_back(p.initial);
  return Append(base, own);
}

// Adds it to the others with a fit, unless it diverges. From the model as it is, and as the
// experiment has it: a fit without the law may have gone far to make up for it.
void FitLaw(Hypothesis h, const CandidateFitter& fitter, const Diagnosis& d, const Vector& begin,
            std::vector<CandidateResult>& laws) {
  CandidateResult c{std::move(h)};
  c.record.name = c.hypothesis.Name();
  const Problem problem = ProblemOf(c, *fitter.experiment);
  for (const Vector& base : {d.before.fit.x, begin}) {
    try {
      Fitted fitted = fitter.Fit(problem, {StartOf(c, base)});
      if (!c.was_fitted || fitted.cost < c.fitted.cost) c.fitted = std::move(fitted);
      c.was_fitted = true;
    } catch (const Error&) {
      StopIfRequested();
    }
    if (base.size() == 0 || base == begin) break;
  }
  if (c.was_fitted) laws.push_back(std::move(c));
}

// Of any candidate, if it is less than this.
double LeastError(const std::vector<CandidateResult>& candidates, double least) {
  for (const CandidateResult& c : candidates)
    if (c.was_fitted) least = std::min(least, c.fitted.error.train);
  return least;
}
double LeastError(const Diagnosis& d) { return LeastError(d.candidates, d.after().train); }

std::size_t NumbersOf(const CandidateResult& c) { return c.hypothesis.extra.size(); }

// Those that come near the best first, the plainest before the others: in what is left lengths and
// masses that are a little off show too.
void Sort(std::vector<CandidateResult>& laws, const Diagnosis& d) {
  const double least = LeastError(laws, d.before.error.train);
  const double floor = std::max(kNear * least, d.noise.floor());
  const double near =
      std::hypot(floor, std::sqrt(+d.criteria.structure_share) * d.before.error.train);
  const auto key = [&](const CandidateResult& c) {
    const bool is_near = c.fitted.error.train <= near;
    return std::tuple(!is_near, is_near ? NumbersOf(c) : 0, c.fitted.error.train);
  };
  std::sort(laws.begin(), laws.end(),
            [&](const CandidateResult& a, const CandidateResult& b) { return key(a) < key(b); });
}

// Whether the data say of every size that it is there.
bool AreSizesSure(const CandidateResult& c) {
  const Uncertainty& u = c.fitted.sensitivities->uncertainty;
  const auto amplitudes = c.hypothesis.Amplitudes();
  return std::all_of(amplitudes.begin(), amplitudes.end(), [&](std::size_t i) {
    const Eigen::Index at = c.first_extra() + static_cast<Eigen::Index>(i);
    return u.lower[at] > 0 || u.upper[at] < 0;
  });
}

// With its numbers.
void TellLaw(CandidateResult& law) {
  Hypothesis& h = law.hypothesis;
  std::vector<std::string> names, values;
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    const double value = law.fitted.fit.x[law.first_extra() + static_cast<Eigen::Index>(i)];
    names.push_back(h.extra[i].name);
    values.push_back(value < 0 ? fmt::format("({:.3g})", value) : fmt::format("{:.3g}", value));
  }
  h.where += ": force = " + Expression::Renamed(h.candidate.law->formula, names, values);
}

// An effect of the catalog that is not listed and explains nearly as much of the missing force;
// none: empty.
std::string AsGoodAsALaw(const std::vector<SuggestedLaw>& laws, const EquationErrors& view,
                         const Experiment& e, const Diagnosis& d, const DiagnosisOptions& options) {
  constexpr double kNearly = 0.9;
  double share = 0;
  for (const SuggestedLaw& law : laws) share = std::max(share, law.share);
  std::vector<Candidate> wanted;
  for (const std::string& name : Unlisted(e, options.candidates)) {
    if (EffectNamed(name).kin.family != kInertia) wanted.push_back({name, "", false});
  }
  std::vector<std::string> skipped;
  double best = kNearly * share;
  std::string name;
  for (const Hypothesis& h : MakeCandidates(wanted, e, {&d.system}, d.sizes, skipped)) {
    StopIfRequested();
    const Problem problem(e, h.system, h.Free());
    const auto first = view.From(h, problem, 0);
    if (!first) continue;
    const EquationStart found = view.BestShape(h, problem, *first);
    if (found.share > best) best = found.share, name = h.NameAtPlace();
  }
  return name;
}

// Whether a law takes the main share, which no candidate does, and half of what the best one
// leaves; or it leaves nothing but noise, or a tenth. Else what a candidate leaves may be anything
// small, and a law bends to that.
bool IsBetterLaw(const Diagnosis& d, const CandidateResult& law, double unlisted) {
  constexpr double kHalf = 0.5, kTenth = 0.1;
  const auto above = [&](double error) { return SquaresWithoutPart(error, d.noise.floor()); };
  const double left = above(law.fitted.error.train);
  const double main = (1 - d.criteria.main_share) * above(d.before.error.train);
  const double best = above(std::min(unlisted, LeastError(d)));
  if (best > main) return left <= std::min(main, kHalf * best);
  return left <= kTenth * best || law.fitted.error.train <= d.criteria.near_noise * d.noise.floor();
}

}  // namespace

bool WantsALaw(const Diagnosis& d, double unlisted) {
  if (d.folds.empty() || d.Is(Verdict::Kind::kAdequate)) return false;
  if (d.before.error.train > d.criteria.model_limited * d.noise.floor())
    return std::min(unlisted, LeastError(d)) > d.criteria.near_noise * d.noise.floor();
  return d.Is(Verdict::Kind::kUnexplained) && d.verdict.explained_by.empty();
}

void TakeLaw(CandidateResult law, Diagnosis& d) {
  if (d.partner) d.candidates.clear();  // they are beside it
  d.partner.reset();
  d.candidates.push_back(std::move(law));
  d.noise_limited = false;
}

FoundLaw FindLaw(const CandidateFitter& fitter, const EquationErrors& view, const Diagnosis& d,
                 const DiagnosisOptions& options, double unlisted) {
  const Experiment& e = *fitter.experiment;
  if (!view.any()) return {};
  const auto suggested = SuggestLaws(LawRows(e, view, d.folds), options.seed, kFitted);
  if (suggested.empty()) return {};
  options.Say(DiagnosisStage::kJudgement, "effects that say what a law does");
  const bool compared = std::isfinite(unlisted);
  const std::string effect = compared ? "" : AsGoodAsALaw(suggested, view, e, d, options);
  if (!effect.empty())
    return {{},
            effect + " explains as much of the missing force as any formula, and is not listed"};
  const Vector begin = Problem(e, d.system).Start();
  std::vector<CandidateResult> laws;
  for (const SuggestedLaw& one : suggested) {
    if (!laws.empty() && fitter.TimeIsOver()) break;
    options.Say(DiagnosisStage::kJudgement, "law " + one.law.formula);
    for (Hypothesis& h : HypothesesOf(one, e, d)) FitLaw(std::move(h), fitter, d, begin, laws);
  }
  if (laws.empty()) return {};
  Sort(laws, d);
  for (CandidateResult& c : laws) {
    fitter.Complete(ProblemOf(c, e), c.fitted);
    if (!AreSizesSure(c)) continue;
    if (!IsBetterLaw(d, c, unlisted)) break;
    TellLaw(c);
    return {std::move(c), ""};
  }
  return {};
}

std::optional<LawPicture> PictureOfLaw(const Experiment& e, const Diagnosis& d) {
  const CandidateResult* const c = d.chosen();
  if (!c || c->hypothesis.effect != Formula::kName || !c->hypothesis.given.empty()) return {};
  const Problem without(e, d.system), with = ProblemOf(*c, e);
  const Vector& x = c->fitted.fit.x;
  const auto missing = MissingForces(without, x.head(c->first_extra()), without.AllLogs());
  const auto left = MissingForces(with, x, with.AllLogs());
  std::optional<LawPicture> best;
  double most = 0;
  for (std::size_t j = 0; j < left.size(); ++j) {
    LawPicture picture{missing[j], missing[j].force};
    double squares = 0;
    for (std::size_t k = 0; k < picture.law.size(); ++k) {
      picture.law[k] -= left[j].force[k];
      squares += picture.law[k] * picture.law[k];
    }
    if (squares > most) most = squares, best = std::move(picture);
  }
  return best;
}

}  // namespace continuum
