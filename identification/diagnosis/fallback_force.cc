#include "identification/diagnosis/fallback_force.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "effects/formula.h"
#include "error.h"
#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/fold_comparison.h"
#include "identification/diagnosis/probing.h"

namespace continuum {
namespace {

constexpr std::array kTerms{"p1", "p2*x", "p3*w", "p4*x^2", "p5*x*w", "p6*w^2", "p7*x^3", "p8*w^3"};
constexpr std::array<std::size_t, 3> kOrders{3, 6, 8};  // terms

// Those of one order, on all joints and on each.
std::vector<Hypothesis> Forces(std::size_t terms, const Experiment& e, const Diagnosis& d) {
  std::vector<std::string> skipped;
  return MakeCandidates(
      {{std::string(Formula::kName), "", false, FallbackLaw(terms, d.sizes, d.criteria)}}, e,
      {&d.system}, d.sizes, skipped);
}

}  // namespace

WrittenLaw FallbackLaw(std::size_t terms, const Sizes& sizes, const Criteria& criteria) {
  WrittenLaw law{"no cause", "", {}, std::vector<double>(terms, 0)};
  law.formula =
      fmt::format("x = tanh(q/{:.6g}); w = tanh(v/{:.6g}); {}", sizes.angle, sizes.velocity,
                  fmt::join(kTerms.begin(), kTerms.begin() + terms, " + "));
  for (std::size_t k = 1; k <= terms; ++k) {
    Parameter p;
    p.name = "p" + std::to_string(k);
    p.unit = "N*m";
    p.upper = criteria.fallback_size * sizes.torque, p.lower = -p.upper;
    p.has_initial = true;
    law.parameters.push_back(p);
  }
  return law;
}

std::optional<CandidateResult> FindFallback(const CandidateFitter& fitter, const Diagnosis& d,
                                            const DiagnosisOptions& options) {
  std::optional<CandidateResult> best;
  if (d.before.folds.error.empty()) return best;
  for (const std::size_t terms : kOrders) {
    for (Hypothesis& h : Forces(terms, *fitter.experiment, d)) {
      CandidateResult c{std::move(h)};
      options.Say(DiagnosisStage::kFallback, "at " + c.hypothesis.where);
      try {
        const Problem problem = ProblemOf(c, *fitter.experiment);
        c.fitted = fitter.Fit(problem, {Append(d.before.fit.x, c.hypothesis.null)});
        RecordFolds(fitter, d, c);
      } catch (const Error&) {
        continue;  // it diverges
      }
      if (!HelpsOnFolds(c.record, d.criteria)) continue;
      if (!best || Median(Gains(c.record)) > Median(Gains(best->record))) best = std::move(c);
    }
  }
  return best;
}

}  // namespace continuum
