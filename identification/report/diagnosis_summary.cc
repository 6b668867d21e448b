#include "identification/report/diagnosis_summary.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "identification/diagnosis/gain.h"

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
    text += fmt::format(
        ", {} = {:.4g}{}", h.extra[k].name, fitted.fit.x[at],
        fitted.complete() ? IntervalInWords(fitted.sensitivities->uncertainty, fitted.fit.x[at], at)
                          : "");
  }
  return text;
}

// The experiment's own parameters that a fit has put at a bound.
std::string BoundsInWords(const std::vector<FreeParameter>& parameters, const Fitted& fitted) {
  std::string text;
  if (!fitted.complete()) return text;
  const auto& bound = fitted.sensitivities->uncertainty.at_bound;
  for (std::size_t i = 0; i < std::min(bound.size(), parameters.size()); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (bound[i] && !parameters[i].IsStart()) {
      text += fmt::format("{}{} = {:.4g}", text.empty() ? "" : ", ", parameters[i].name,
                          fitted.fit.x[at]);
    }
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

// What is named, and what the data do not distinguish from it.
std::string CausesInWords(const Diagnosis& d) {
  std::string text;
  const auto add = [&](const CandidateResult& c, const std::string& how, const std::string& note) {
    text += fmt::format("{} {}{}{}\n", how, c.hypothesis.NameAtPlace(), note,
                        ValuesInWords(c.hypothesis, c.fitted, c.first_extra()));
  };
  for (const std::size_t i : d.verdict.named)
    add(d.candidates[i], i == d.verdict.named.front() ? "cause    " : "   or    ", "");
  for (const CandidateResult& c : d.unlisted) add(c, "   or    ", " (not listed)");
  if (!d.partner || !d.chosen()) return text;
  text +=
      fmt::format("and       {} at {}{}", d.partner->hypothesis.Name(), d.partner->hypothesis.where,
                  ValuesInWords(d.partner->hypothesis, d.chosen()->fitted, d.before.fit.x.size()));
  for (const std::string& other : d.partner->equivalent) text += ", or " + other;
  return text + "\n";
}

std::string ErrorsInWords(const Diagnosis& d, const TwoErrors& after) {
  const Gain gain = GainOf(d, after);
  const std::string unit = d.pool.unit();
  std::string text = fmt::format(
      "error     train {:.4g} -> {:.4g} {u}, validate {:.4g} -> {:.4g} {u}\n", d.before.error.train,
      after.train, d.before.error.validate, after.validate, fmt::arg("u", unit));
  text += fmt::format(
      "gain      {:.0f} % of the held-out error ({}), {:.0f} % of what is explainable\n",
      100 * gain.removed,
      d.gain_interval ? fmt::format("{:.0f} .. {:.0f} %", 100 * d.gain_interval->low,
                                    100 * d.gain_interval->high)
                      : "interval not computed",
      100 * gain.explainable);
  text += d.noise.rms > 0
              ? fmt::format(
                    "noise     {:.3g} {} ({}), time step {:.3g}; the error is {:.1f} times both\n",
                    d.noise.rms, unit, d.noise.source, d.noise.step,
                    after.train / std::hypot(d.noise.rms, d.noise.step))
              : fmt::format("noise     not known, time step {:.3g} {}\n", d.noise.step, unit);
  if (d.noise_limited) {
    text += fmt::format(
        "residual  p = {:.2g} (smooth forces), {:.2g} (channels); significant below {:g}{}\n",
        d.lack_of_fit.force, d.lack_of_fit.channel, +d.criteria.lack_of_fit,
        d.noise.step > 0 ? ", without the time-discretisation error" : "");
  } else {
    text += fmt::format("ceiling   {:.4g} {} on validate with {}\n", d.ceiling_error.validate, unit,
                        d.ceiling_by);
  }
  return text;
}

std::string DeviationsInWords(const Diagnosis& d, const std::vector<Deviation>& deviations) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, deviations.size()); ++i) {
    const Deviation& one = deviations[i];
    text += fmt::format("{}{} {} at {}: the simulation {}\n",
                        d.Is(Verdict::Kind::kAdequate) ? "largest   " : "wrong     ", one.log,
                        one.channel, one.when, one.what);
  }
  return text;
}

}  // namespace

std::string FallbackInWords(const Diagnosis& d) {
  const CandidateResult& c = *d.fallback;
  return fmt::format(
      "no cause, but a smooth force at {} takes {:.0f} % off the error in the median of the folds",
      c.hypothesis.where, 100 * Median(Gains(c.record)));
}

std::string ContrastInWords(const Diagnosis& d) {
  if (!d.contrast) return "";
  std::string text = fmt::format(
      "runs under different conditions differ by {:.4g} {} beyond the "
      "model",
      *d.contrast, d.pool.unit());
  const CandidateResult* best = nullptr;
  for (const CandidateResult& c : d.candidates) {
    if (c.contrast && (!best || *c.contrast < *best->contrast)) best = &c;
  }
  if (best)
    text += fmt::format(", {:.4g} with {}", *best->contrast, best->hypothesis.NameAtPlace());
  return text + "; what it gets wrong in both cancels";
}

std::string Summary(const Experiment& e, const Diagnosis& d, const ExtensionRun& run) {
  std::string text = fmt::format("verdict   {}: {}\n", d.verdict.word(), d.verdict.reason);
  text += CausesInWords(d) + ErrorsInWords(d, run.after) + DeviationsInWords(d, run.deviations);
  text += BoundsInWords(d.parameters_before, d.last());
  if (const std::string contrast = ContrastInWords(d); !contrast.empty())
    text += "between   " + contrast + "\n";
  if (d.fallback) text += fmt::format("fallback  {}, in {}\n", FallbackInWords(d), kFallbackModel);
  text += Ranking(e, d);
  if (d.verdict.named.size() > 1)
    text += fmt::format("next      {} (separation {:.3g}){}\n", d.next.input, d.next.separation,
                        d.next.log ? fmt::format(", in {}", kNextInputs) : "");
  return text;
}

}  // namespace continuum
