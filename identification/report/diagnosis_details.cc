#include "identification/report/diagnosis_details.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "identification/diagnosis/gain.h"
#include "identification/report/candidate_tables.h"
#include "identification/report/diagnosis_summary.h"
#include "identification/report/diagnosis_words.h"
#include "identification/report/fit_report.h"
#include "identification/report/line_diff.h"
#include "identification/report/missing_force_plots.h"
#include "identification/report/parts.h"
#include "sim/io/rounded.h"
#include "sim/replay/replay.h"
#include "sim/replay/replay_report.h"

namespace continuum {
namespace {

// Of one log, before and after.
std::vector<NamedTrace> Traces(const Experiment& e, const ExtensionRun& run, std::size_t l) {
  std::vector<NamedTrace> traces;
  const auto add = [&](const std::string& name, Style style, const std::vector<Trace>& all) {
    if (all.empty()) return;
    RequireWhole(e, all);
    traces.push_back({name, style, &all[l]});
  };
  add(run.offered ? "before" : "simulated", Style::kBefore, run.before_traces);
  if (run.offered) add("after", Style::kAfter, run.after_traces);
  return traces;
}

class DiagnosisDetails {
 public:
  DiagnosisDetails(Page& page, const Experiment& e, const Diagnosis& d, const ExtensionRun& run,
                   std::vector<MissingPart>& missing)
      : page_(page), e_(e), d_(d), run_(run), missing_(missing), unit_(d.pool.unit()) {}

  void Add() {
    page_.Heading("Details");
    Fold("Candidates and statistics", [&] { Candidates(); });
    if (!d_.Is(Verdict::Kind::kUnexplained)) Fold("The missing force", [&] { TheMissingForce(); });
    Fold("Parameters", [&] { Parameters(); });
    Fold("Errors", [&] { Errors(); });
    Fold("Assumptions", [&] { Assumptions(); });
    Fold("Other deviations", [&] { Deviations(); });
    Fold("All logs", [&] { AllLogs(); });
    Fold("Lines of the MJCF that change",
         [&] { page_.Code(LineDiff(run_.model_before, run_.extended.xml), "diff"); });
  }

 private:
  // A part of its own, closed.
  void Fold(const std::string& name, const std::function<void()>& content) {
    AddPart(page_, name, missing_, [&] { page_.Details(name, content); });
  }

  void Candidates() {
    page_.Paragraph("Verdict: **" + d_.verdict.word() + "**. " + d_.verdict.reason + ".");
    if (d_.candidates.empty()) {
      std::string text = "No candidate was fitted.";
      for (const Dismissed& c : d_.dismissed) text += " " + c.effect + ": " + WhyNotFitted(c) + ".";
      page_.Paragraph(text);
    } else {
      Shares();
      if (d_.noise_limited) AddLikelihoodTable(page_, d_);
      AddFoldTable(page_, d_);
    }
    AddMissing(page_, "view by the missing force", missing_);
    AddSecondView(page_, d_);
    WhyNotTheOthers();
    if (d_.verdict.named.size() > 1) {
      page_.Paragraph(fmt::format(
          "The next experiment has an expected separation of {:.3g}, in "
          "units of twice the log-likelihood{}.",
          d_.next.separation, d_.noise.known() ? "" : " if the residual were white noise"));
    }
  }

  void Shares() {
    BarsSpec bars{d_.noise_limited ? "Share of what is above the noise that each candidate explains"
                                   : "Error removed on left-out logs, median over the folds",
                  {d_.noise_limited ? "explained" : "error removed", "%"},
                  {},
                  {}};
    double placebo = -1;
    for (std::size_t i = 0; i < d_.candidates.size(); ++i) {
      const auto& c = d_.candidates[i];
      const auto& all = d_.verdict.named;
      const bool named = std::find(all.begin(), all.end(), i) != all.end();
      bars.bars.push_back({c.hypothesis.NameAtPlace(), 100 * Share(d_, c), 0, named});
      auto p = c.record.placebo_gains;
      std::sort(p.begin(), p.end());
      const auto last = static_cast<double>(p.size()) - 1;
      if (!p.empty())
        placebo = std::max(
            placebo, p[static_cast<std::size_t>(InPercent(rules().placebo_share) * last / 100)]);
    }
    if (placebo > -1) {
      bars.marks.push_back(
          {fmt::format("{:.0f} % of random forces stay below", InPercent(rules().placebo_share)),
           100 * placebo});
    }
    if (!d_.noise_limited) bars.marks.push_back({"asked for", InPercent(rules().median_gain)});
    page_.Bars(bars);
  }

  void WhyNotTheOthers() {
    std::vector<std::string> items;
    for (const auto& c : d_.candidates) {
      std::string why;
      for (const auto& f : c.failures) why += (why.empty() ? "" : "; ") + f;
      if (!why.empty()) items.push_back("**" + c.hypothesis.NameAtPlace() + "**: " + why + ".");
    }
    for (const Dismissed& c : d_.dismissed) {
      if (d_.noise_limited) break;  // in the table of likelihoods
      items.push_back(fmt::format(
          "**{} at {}**: explains {} of the squared error to first order, and "
          "was not fitted: {}.",
          c.effect, c.where, Percent(c.explained / d_.before.cost, 1), WhyNotFitted(c)));
    }
    if (items.empty()) return;
    page_.Paragraph("Why the others are not named:");
    page_.List(items);
  }

  void TheMissingForce() {
    AddMissing(page_, "missing force", missing_);
    AddMissingForce(page_, d_.missing_force);
  }

  void Parameters() {
    const Fitted& last = d_.last();
    AddParameterTable(page_, d_.parameters, last.fit.x, last.sensitivities.value().uncertainty);
  }

  void Errors() {
    AddMissing(page_, "contrast of the conditions", missing_);
    const Gain gain = GainOf(d_, run_.after);
    const auto row = [&](const std::string& name, const TwoErrors& e) {
      return std::vector<std::string>{name, fmt::format("{:.4g}", e.train),
                                      fmt::format("{:.4g}", e.validate)};
    };
    page_.Table(
        {"model", "train [" + unit_ + "]", "validate [" + unit_ + "]"},
        {row("before", d_.before.error), row("after", run_.after),
         row(d_.noise_limited ? "noise (floor)" : "ceiling: " + d_.ceiling_by, d_.ceiling_error)},
        {fmt::format(
            "Free simulation of every log. Noise: {}. Gain: {}, whole trials resampled; {}.",
            NoiseInWords(), GainInWords(d_, run_), ExplainableInWords(gain))});
    if (const std::string contrast = ContrastInWords(d_); !contrast.empty())
      page_.Paragraph("Between conditions: " + contrast + ".");
    page_.Paragraph(Reached());
  }

  static std::string ExplainableInWords(const Gain& gain) {
    return gain.explainable ? Percent(*gain.explainable) + " of what is explainable above the noise"
                            : "the error before is not above the noise";
  }

  std::string NoiseInWords() const {
    return d_.noise.rms > 0 ? fmt::format("{:.3g} {} ({})", d_.noise.rms, unit_, d_.noise.source)
                            : "not known";
  }

  std::string Reached() const {
    const std::string text = ModelLimited(d_, run_.after) ? "The data are model-limited. "
                                                          : "The data are noise-limited. ";
    if (NothingHelps(d_))
      return text +
             "Nothing that was tried, forces without a name among it, does better on the held-out "
             "logs.";
    return text +
           fmt::format("The extension reaches {} of what {} on the held-out logs.",
                       Percent(ShareReached(d_, run_.after)),
                       d_.noise_limited ? "lies above the noise" : d_.ceiling_by + " reaches");
  }

  void Deviations() {
    std::vector<std::string> items;
    for (const Deviation& one : run_.deviations) items.push_back(DeviationInWords(one));
    page_.List(items);
    for (std::size_t i = 1; i < run_.deviations.size(); ++i)
      AddOverlayOf(page_, e_, run_, run_.deviations[i]);
  }

  void AllLogs() {
    for (std::size_t l = 0; l < e_.logs.size(); ++l)
      AddOverlay(page_, e_, e_.logs[l], Traces(e_, run_, l), false);
  }

  // The rules that decided, with the numbers that were used.
  std::string RulesInWords() const {
    const Criteria& c = rules();
    if (d_.noise_limited) {
      return fmt::format(
          "A cause is named by its likelihood, when noise alone would let one of the candidates do "
          "as well in less than {:.2g} % of such data and every rival of another family is clearly "
          "behind. Where its residual has more than noise, which smooth forces or shifts of the "
          "channels explain, it also has to take {:.0f} % of the squared error above the noise, "
          "and "
          "to help on logs left out.",
          InPercent(c.significance), InPercent(c.main_share));
    }
    return fmt::format(
        "A cause is named when the error falls in at least {better:.0f} % of the folds and by at "
        "least {gain:.0f} % in the median, its size agrees over the folds within {spread:.0f} %, "
        "it beats {placebos:.0f} % of random smooth forces with as many parameters, and it is "
        "clearly better than every other candidate in paired folds: in {better:.0f} % of them, by "
        "more than one standard error and by more than {margin:.0f} % of the other's error, or "
        "what {placebos:.0f} % of those forces remove. Of a law and one that contains it the "
        "plainer is named, unless it is clearly worse. No probability is given: on such data none "
        "would be calibrated.",
        fmt::arg("better", InPercent(c.folds_better)), fmt::arg("gain", InPercent(c.median_gain)),
        fmt::arg("spread", InPercent(c.amplitude_spread)),
        fmt::arg("placebos", InPercent(c.placebo_share)),
        fmt::arg("margin", InPercent(c.fold_margin)));
  }

  void Assumptions() {
    AddMissing(page_, "log check", missing_);
    std::vector<std::string> items{
        RulesInWords(),
        fmt::format("The model's own time step moves the trajectories by {:.3g} {} (h against "
                    "h/4); nothing smaller is named.",
                    d_.noise.step, unit_),
        d_.noise.source == "replicates"
            ? fmt::format("The noise comes from {} pairs of {}.", d_.noise.pairs,
                          NoiseSourceInWords(d_.noise))
            : "There are no replicates: \"unexplained\" may be noise that is not white."};
    for (const auto& s : d_.skipped) items.push_back("Not tried: " + s + ".");
    for (const Finding& f : run_.findings) {
      if (f.severity != Finding::Severity::kInfo)
        items.push_back("Log check, " + f.log + ": " + f.text);
    }
    page_.List(items);
  }

  const Criteria& rules() const { return d_.criteria; }
  static double InPercent(double share) { return 100 * share; }

  Page& page_;
  const Experiment& e_;
  const Diagnosis& d_;
  const ExtensionRun& run_;
  std::vector<MissingPart>& missing_;
  std::string unit_;
};

}  // namespace

void AddDetails(Page& page, const Experiment& e, const Diagnosis& d, const ExtensionRun& run,
                std::vector<MissingPart>& missing) {
  DiagnosisDetails(page, e, d, run, missing).Add();
}

void AddOverlayOf(Page& page, const Experiment& e, const ExtensionRun& run,
                  const Deviation& deviation) {
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    if (e.logs[l].label == deviation.log)
      AddOverlay(page, e, e.logs[l], Traces(e, run, l), true, deviation.channel);
  }
}

}  // namespace continuum
