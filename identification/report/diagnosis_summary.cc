#include "identification/report/diagnosis_summary.h"

#include <algorithm>

#include <fmt/format.h>

#include "identification/diagnosis/gain.h"
#include "identification/report/diagnosis_words.h"
#include "identification/report/model_changes.h"
#include "sim/io/rounded.h"

namespace continuum {
namespace {

// Without the marks of a page.
std::string Plain(std::string text) {
  for (const std::string mark : {"**", "`"}) {
    for (auto at = text.find(mark); at != text.npos; at = text.find(mark))
      text.erase(at, mark.size());
  }
  return text;
}

std::string Ranking(const Experiment& e, const Diagnosis& d) {
  constexpr std::size_t kShown = 6;
  std::string text = "ranking  ";
  if (d.candidates.empty()) text += " no candidate was fitted";
  for (std::size_t i = 0; i < std::min(kShown, d.candidates.size()); ++i) {
    const CandidateResult& c = d.candidates[i];
    text += fmt::format("{} {} {}", i ? "," : "", c.hypothesis.NameAtPlace(), Percent(Share(d, c)));
  }
  if (d.candidates.size() > kShown) text += fmt::format(" … ({} in all)", d.candidates.size());
  text += "\n";
  if (e.all_candidates) return text;  // of so many some always have no place in a model
  for (const std::string& why : d.skipped) text += "not tried " + why + "\n";
  return text;
}

// What is named, and what the data do not distinguish from it.
std::string CauseLines(const Diagnosis& d) {
  std::string text;
  const auto add = [&](const std::string& how, const Hypothesis& h, const Fitted& fitted,
                       Eigen::Index begin, const std::string& note) {
    text += fmt::format("{} {}{}: {}", how, h.NameAtPlace(), note,
                        Plain(ValuesInWords(h, fitted, begin)));
  };
  const auto add_partner = [&](const std::string& how) {
    add(how, d.partner->hypothesis, d.chosen()->fitted, d.before.fit.x.size(), "");
    for (const std::string& other : d.partner->equivalent) text += ", or " + other;
    text += "\n";
  };
  const bool two = d.partner && d.chosen();
  const bool partner_first = two && d.partner->main;
  const auto label = [](bool corrects, bool first) {
    return corrects ? "corrects " : first ? "cause    " : "and      ";
  };
  if (partner_first) add_partner(label(d.partner->Corrects(), true));
  for (const std::size_t i : d.verdict.named) {
    const CandidateResult& c = d.candidates[i];
    const char* const first = label(two && d.partner->OtherCorrects(), !partner_first);
    add(i == d.verdict.named.front() ? first : "   or    ", c.hypothesis, c.fitted, c.first_extra(),
        "");
    text += "\n";
  }
  for (const CandidateResult& c : d.unlisted) {
    add("   or    ", c.hypothesis, c.fitted, c.first_extra(), " (not asked for)");
    text += "\n";
  }
  if (two && !partner_first) add_partner(label(d.partner->Corrects(), false));
  return text;
}

// Of the values that the model had already.
std::string ChangeLines(const Diagnosis& d, const ExtensionRun& run) {
  std::string text;
  for (const std::string& change : FittedValuesInWords(d, run))
    text += "changes   " + Plain(change) + "\n";
  return text;
}

std::string ErrorLines(const Diagnosis& d, const ExtensionRun& run) {
  const std::string unit = d.pool.unit();
  std::string text = fmt::format("error     train {:.4g} -> {:.4g} {}", d.before.error.train,
                                 run.after.train, unit);
  if (d.before.error.validate > 0)
    text += fmt::format(", validate {:.4g} -> {:.4g} {}", d.before.error.validate,
                        run.after.validate, unit);
  text += "\n";
  text += "gain      " + GainInWords(d, run) + "\n";
  for (const std::string& fold : WorseFoldsInWords(d)) text += "worse     " + fold + "\n";
  text += d.noise.rms > 0
              ? fmt::format("noise     {:.3g} {} ({}), time step {:.3g} {}\n", d.noise.rms, unit,
                            NoiseSourceInWords(d.noise), d.noise.step, unit)
              : fmt::format("noise     not known, time step {:.3g} {}\n", d.noise.step, unit);
  if (!d.noise_limited)
    text += fmt::format("ceiling   {:.4g} {} on validate with {}\n", d.ceiling_error.validate, unit,
                        d.ceiling_by);
  return text;
}

std::string DeviationLines(const Diagnosis& d, const std::vector<Deviation>& deviations) {
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
      "no cause, but a smooth force at {} takes {} off the error in the median of the folds",
      c.hypothesis.where, Percent(Median(Gains(c.record))));
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
  std::string text = fmt::format("verdict   {}{} ({}): {}\n",
                                 d.interrupted ? "interrupted, the best so far: " : "",
                                 d.verdict.word(), InWords(CertaintyOf(d)), WhyInWords(d));
  text += CauseLines(d) + ChangeLines(d, run) + ErrorLines(d, run);
  text += "residual  " + RemainsInWords(d, run) + "\n";
  text += DeviationLines(d, run.deviations);
  for (const std::string& bound : AtBoundInWords(d, run)) text += "at bound  " + bound + "\n";
  if (const std::string contrast = ContrastInWords(d); !contrast.empty())
    text += "between   " + contrast + "\n";
  if (d.fallback) text += fmt::format("fallback  {}, in {}\n", FallbackInWords(d), kFallbackModel);
  text += Ranking(e, d);
  for (const std::string& step : NextStepsInWords(e, d, run))
    text += "next      " + Plain(step) + "\n";
  return text;
}

}  // namespace continuum
