#include "identification/report/candidate_tables.h"

#include <algorithm>

#include <fmt/format.h>

#include "sim/io/rounded.h"

namespace continuum {

void AddSecondView(Page& page, const Diagnosis& d) {
  std::vector<const CandidateResult*> seen;
  for (const auto& c : d.candidates) {
    if (c.by_equation) seen.push_back(&c);
  }
  if (seen.empty()) return;
  constexpr std::size_t kShown = 6;
  std::stable_sort(seen.begin(), seen.end(), [](const auto* a, const auto* b) {
    return a->by_equation->share > b->by_equation->share;
  });
  BarsSpec bars{"A second view: share of the missing force that each candidate explains",
                {"of its squares", "%"},
                {},
                {}};
  for (const CandidateResult* c : seen) {
    if (bars.bars.size() == kShown) break;
    const bool chosen = c == d.chosen();
    bars.bars.push_back({c->hypothesis.NameAtPlace(), 100 * c->by_equation->share, 0, chosen});
  }
  page.Bars(bars);
  page.Paragraph(
      "From the measured states alone, without simulating: sensor noise, twice differentiated, "
      "is most of this force on many logs, so that small shares may be all there is to explain. "
      "Only candidates that were fitted are here.");
}

void AddLikelihoodTable(Page& page, const Diagnosis& d) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& c : d.candidates) {
    rows.push_back({c.hypothesis.Name(), c.hypothesis.where,
                    c.fitted.complete() ? Fixed(c.likelihood, 1) : "",
                    std::to_string(c.hypothesis.extra.size()), fmt::format("{:.2g}", c.p),
                    d.Is(Verdict::Kind::kUnexplained) ? "" : fmt::format("{:.3f}", c.probability),
                    Fixed(c.lambda, 1)});
  }
  for (const auto& c : d.dismissed) {
    rows.push_back({c.effect, c.where, "", "", fmt::format("{:.2g}", c.p), "", ""});
  }
  page.Table(
      {"candidate", "where", "2 ln L gained", "parameters", "p, family-wise", "posterior",
       "lambda"},
      rows,
      {"Twice the log-likelihood over the model without it, empty where it was not completed; p: "
       "how often noise alone lets one of all candidates do as well to first order; posterior: "
       "each candidate as likely before, and none where no candidate explains the data; lambda: "
       "what of the best candidate this one cannot "
       "imitate on these logs" +
       fmt::format(" (below about {:g} they are hard to distinguish). The residual of the best "
                   "one has p = {:.2g} against smooth forces and {:.2g} against shifts of the "
                   "channels.",
                   +d.criteria.separation, d.lack_of_fit.force, d.lack_of_fit.channel)});
}

void AddFoldTable(Page& page, const Diagnosis& d) {
  if (d.before.folds.error.empty()) return;
  std::vector<std::string> header{"candidate"};
  for (const Fold& f : d.folds) header.push_back("without " + f.name);
  std::vector<std::vector<std::string>> rows{{"as it is"}};
  for (const double error : d.before.folds.error) rows[0].push_back(fmt::format("{:.4g}", error));
  for (const auto& c : d.candidates) {
    if (c.record.after.empty()) continue;
    rows.push_back({c.hypothesis.NameAtPlace()});
    for (const double error : c.record.after) rows.back().push_back(fmt::format("{:.4g}", error));
  }
  if (!d.ceiling.error.empty()) rows.push_back({"ceiling: " + d.ceiling_by});
  for (const double error : d.ceiling.error) rows.back().push_back(fmt::format("{:.4g}", error));
  page.Table(
      header, rows,
      {"Error [" + d.pool.unit() + "] on the logs left out, after refitting on the others."});
}

}  // namespace continuum
