#include "identification/diagnosis/second_by_folds.h"

#include <utility>

#include <fmt/format.h>

#include "identification/diagnosis/cause_pairs.h"
#include "identification/diagnosis/fold_comparison.h"
#include "sim/io/rounded.h"

namespace continuum {
namespace {

constexpr std::size_t kSeconds = 4;  // that are fitted

// The candidates beside a first cause, with a verdict on them. options: of the search.
Diagnosis Beside(const SearchContext& context, const CandidateResult& first, const Diagnosis& d) {
  const Experiment& e = *context.fitter.experiment;
  CandidateSearch search = ScreenBeside(context, first);
  search.Fit(nullptr, kSeconds);
  Diagnosis beside(e, first.hypothesis.system);
  beside.criteria = d.criteria, beside.noise = d.noise, beside.sizes = d.sizes;
  beside.folds = d.folds, beside.before = first.fitted;
  beside.candidates = std::move(search.candidates);
  CompareByFolds(context.fitter, context.options, beside, first.hypothesis.Free());
  return beside;
}

// Of the squares above the noise, what a second cause takes on top of the first.
double ShareOfSecond(const TwoErrors& first, const TwoErrors& both, const Diagnosis& d) {
  return SquaresWithoutPart(first.train, both.train) /
         SquaresWithoutPart(d.before.error.train, d.noise.known() ? d.noise.floor() : 0);
}

}  // namespace

void AddSecondByFolds(const SearchContext& context, Diagnosis& d) {
  const Hypothesis first = d.chosen()->hypothesis;
  const auto inside =
      context.options.Inside(DiagnosisStage::kSecondCause, "beside " + first.NameAtPlace());
  Diagnosis beside = Beside({context.fitter, context.noise, context.sizes, inside}, *d.chosen(), d);
  if (!beside.Is(Verdict::Kind::kNamed)) return;
  // The way in which a first cause is simulated leaves as little.
  const TwoErrors &one = d.chosen()->fitted.error, &both = beside.after();
  if (ShareOfSecond(one, both, d) < d.criteria.second_share) {
    d.remaining.would_take =
        fmt::format("{} would take {} of what is left", beside.chosen()->hypothesis.NameAtPlace(),
                    Percent(1 - both.train / one.train));
    return;
  }
  d.candidates = std::move(beside.candidates), d.verdict = std::move(beside.verdict);
  for (CandidateResult& c : d.candidates) {
    if (!c.record.after.empty()) c.record.before = d.before.folds.error;
  }
  const CandidateResult& second = *d.chosen();
  const std::string name = second.hypothesis.NameAtPlace();
  RaiseCeiling(d, first.NameAtPlace() + " and " + name, second.fitted.folds, second.fitted.error);
  d.verdict.reason = fmt::format("{} passes all rules, and beside it {}: {}", first.NameAtPlace(),
                                 name, d.verdict.reason);
  d.partner = Partner{first};
}

}  // namespace continuum
