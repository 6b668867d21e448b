// A diagnosis told on the terminal.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "identification/report/diagnosis_output.h"

namespace continuum {
namespace {

// Interval, bound, and the value at a fine step where that rounds to another.
std::string IntervalInWords(const Uncertainty& u, double value, Eigen::Index at) {
  std::vector<std::string> words;
  if (u.lower.size() > at && std::isfinite(u.upper[at] - u.lower[at]))
    words.push_back(fmt::format("{:.4g} .. {:.4g}", u.lower[at], u.upper[at]));
  if (!u.at_bound.empty() && u.at_bound[at]) words.push_back("at its bound");
  if (u.step.size() > at && std::isfinite(u.step[at])) {
    const std::string fine = fmt::format("{:.3g}", value + u.step[at]);
    if (fine != fmt::format("{:.3g}", value)) words.push_back(fine + " at a fine step");
  }
  return words.empty() ? "" : fmt::format(" ({})", fmt::join(words, "; "));
}

std::string ValuesInWords(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin) {
  std::string text;
  for (std::size_t k = 0; k < h.extra.size(); ++k) {
    const Eigen::Index at = begin + static_cast<Eigen::Index>(k);
    text += fmt::format(", {} = {:.4g}{}", h.extra[k].name, fitted.fit.x[at],
                        IntervalInWords(fitted.uncertainty, fitted.fit.x[at], at));
  }
  return text;
}

// The experiment's own parameters that a fit has put at a bound.
std::string BoundsInWords(const Problem& null, const Fitted& fitted) {
  std::string text;
  const auto& bound = fitted.uncertainty.at_bound;
  for (std::size_t i = 0; i < std::min(bound.size(), null.parameters().size()); ++i) {
    const FreeParameter& p = null.parameters()[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (bound[i] && !p.IsStart())
      text += fmt::format("{}{} = {:.4g}", text.empty() ? "" : ", ", p.name, fitted.fit.x[at]);
  }
  return text.empty() ? "" : "at bound  " + text + "\n";
}

std::string Ranking(const Experiment& e, const Diagnosis& d) {
  constexpr std::size_t kShown = 6;
  std::string text = "ranking  ";
  if (d.candidates.empty()) text += " no candidate was fitted";
  for (std::size_t i = 0; i < std::min(kShown, d.candidates.size()); ++i) {
    const CandidateResult& c = d.candidates[i];
    text +=
        fmt::format("{} {} {:.0f} %", i ? "," : "", c.hypothesis.NameAtPlace(), 100 * Share(d, c));
  }
  if (d.candidates.size() > kShown) text += fmt::format(" … ({} in all)", d.candidates.size());
  text += "\n";
  if (e.all_candidates) return text;  // of so many some always have no place in a model
  for (const std::string& why : d.skipped) text += "not tried " + why + "\n";
  return text;
}

}  // namespace

std::string Summary(const Experiment& e, const Diagnosis& d, const DiagnosisFiles& told) {
  const Gain gain = GainOf(d, told.after);
  const std::string unit = d.pool.unit();
  std::string text = fmt::format("verdict   {}: {}\n", d.verdict.text, d.verdict.reason);
  const auto tell = [&](const CandidateResult& c, const std::string& how, const std::string& note) {
    text += fmt::format("{} {}{}{}\n", how, c.hypothesis.NameAtPlace(), note,
                        ValuesInWords(c.hypothesis, c.fitted, c.own()));
  };
  for (const std::size_t i : d.verdict.named)
    tell(d.candidates[i], i == d.verdict.named.front() ? "cause    " : "   or    ", "");
  for (const CandidateResult& c : d.unlisted) tell(c, "   or    ", " (not listed)");
  if (d.partner && d.chosen()) {
    text += fmt::format(
        "and       {} at {}{}", d.partner->hypothesis.Name(), d.partner->hypothesis.where,
        ValuesInWords(d.partner->hypothesis, d.chosen()->fitted, d.before.fit.x.size()));
    for (const std::string& other : d.partner->equivalent) text += ", or " + other;
    text += "\n";
  }
  text += fmt::format("error     train {:.4g} -> {:.4g} {u}, validate {:.4g} -> {:.4g} {u}\n",
                      d.before.error.train, told.after.train, d.before.error.validate,
                      told.after.validate, fmt::arg("u", unit));
  text += fmt::format(
      "gain      {:.0f} % of the held-out error ({:.0f} .. {:.0f} %), {:.0f} % of what is "
      "explainable\n",
      100 * gain.removed, 100 * d.gain_low, 100 * d.gain_high, 100 * gain.explainable);
  text +=
      d.noise.rms > 0
          ? fmt::format(
                "noise     {:.3g} {} ({}), time step {:.3g}; what remains is {:.1f} times both\n",
                d.noise.rms, unit, d.noise.source, d.noise.step,
                told.after.train / std::hypot(d.noise.rms, d.noise.step))
          : fmt::format("noise     not known, time step {:.3g} {}\n", d.noise.step, unit);
  if (d.noise_limited) {
    text += fmt::format(
        "left      p = {:.2g} (smooth forces), {:.2g} (channels); significant below {:g}{}\n",
        d.lack.force, d.lack.channel, LikelihoodRules{}.lack,
        d.noise.step > 0 ? ", without what the time step adds" : "");
  } else {
    text += fmt::format("ceiling   {:.4g} {} on validate with {}\n", d.ceiling_error.validate, unit,
                        d.ceiling_by);
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(3, told.wrong.size()); ++i) {
    const Deviation& w = told.wrong[i];
    text += fmt::format("{}{} {} at {}: the simulation {}\n",
                        d.verdict.text == "adequate" ? "largest   " : "wrong     ", w.log,
                        w.channel, w.when, w.what);
  }
  text += BoundsInWords(Problem(e, d.system), d.chosen() ? d.chosen()->fitted : d.before);
  if (const std::string between = BetweenInWords(e, d); !between.empty())
    text += "between   " + between + "\n";
  if (d.fallback) {
    text += fmt::format("fallback  {}, in {}\n", FallbackInWords(d), kFallbackModel);
  }
  text += Ranking(e, d);
  if (d.verdict.named.size() > 1)
    text += fmt::format("next      {} (separation {:.3g}){}\n", d.next.input, d.next.separation,
                        d.next.log ? fmt::format(", in {}", kNextInputs) : "");
  return text;
}

}  // namespace continuum
