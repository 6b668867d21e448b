#include "identification/diagnosis/fallback_force.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "effects/formula.h"
#include "error.h"
#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/fold_comparison.h"

namespace continuum {
namespace {

constexpr double kMost = 0.2;  // of the typical torque, each term
constexpr std::array kTerms{"p1", "p2*x", "p3*w", "p4*x^2", "p5*x*w", "p6*w^2", "p7*x^3", "p8*w^3"};
constexpr std::array<std::size_t, 3> kOrders{3, 6, 8};  // terms

WrittenLaw Law(std::size_t terms, const Sizes& sizes) {
  WrittenLaw law{"no cause", "", {}, std::vector<double>(terms, 0)};
  law.formula =
      fmt::format("x = tanh(q/{:.6g}); w = tanh(v/{:.6g}); {}", sizes.angle, sizes.velocity,
                  fmt::join(kTerms.begin(), kTerms.begin() + terms, " + "));
  for (std::size_t k = 1; k <= terms; ++k) {
    Parameter p;
    p.name = "p" + std::to_string(k);
    p.unit = "N*m";
    p.upper = kMost * sizes.torque, p.lower = -p.upper;
    p.has_initial = true;
    law.parameters.push_back(p);
  }
  return law;
}

bool Helps(const FoldRecord& record) {
  const Rules rules;
  const auto gains = Gains(record);
  const auto better = std::count_if(gains.begin(), gains.end(), [](double g) { return g > 0; });
  return Median(gains) >= rules.median_gain &&
         static_cast<double>(better) >= rules.folds_better * static_cast<double>(gains.size());
}

// Those of one order, on all joints and on each.
std::vector<Hypothesis> Forces(std::size_t terms, const Experiment& e, const Diagnosis& d) {
  Experiment wanted = e;
  wanted.all_candidates = false;
  wanted.candidates = {{std::string(Formula::kName), "", false, Law(terms, d.sizes)}};
  std::vector<std::string> skipped;
  return MakeCandidates(wanted, {&d.system}, d.sizes, skipped);
}

}  // namespace

std::optional<CandidateResult> FindFallback(const CandidateFitter& trials, const Diagnosis& d,
                                            const DiagnosisOptions& options) {
  std::optional<CandidateResult> best;
  if (d.before.folds.error.empty()) return best;
  for (const std::size_t terms : kOrders) {
    for (Hypothesis& h : Forces(terms, *trials.experiment, d)) {
      CandidateResult c{std::move(h)};
      options.Say("a force without a cause at " + c.hypothesis.where);
      try {
        const Problem problem = c.ProblemOf(*trials.experiment);
        c.fitted = trials.Fit(problem, Append(d.before.fit.x, c.hypothesis.null));
        RecordFolds(trials, d, c);
      } catch (const Error&) {
        continue;  // it diverges
      }
      if (!Helps(c.record)) continue;
      if (!best || Median(Gains(c.record)) > Median(Gains(best->record))) best = std::move(c);
    }
  }
  return best;
}

}  // namespace continuum
