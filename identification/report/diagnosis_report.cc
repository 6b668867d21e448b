#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "identification/diagnosis/gain.h"
#include "identification/report/candidate_tables.h"
#include "identification/report/diagnosis_output.h"
#include "identification/report/fit_report.h"
#include "identification/report/line_diff.h"
#include "identification/report/missing_force_plots.h"
#include "identification/report/parts.h"
#include "sim/replay/replay.h"
#include "sim/replay/replay_report.h"

namespace continuum {
namespace {

class DiagnosisPage {
 public:
  DiagnosisPage(const Experiment& e, const Diagnosis& d, const ExtensionRun& run,
                std::vector<MissingPart>& missing)
      : e_(e),
        d_(d),
        run_(run),
        missing_(missing),
        unit_(d.pool.unit()),
        page_("Diagnosis", e.model.filename().string() + " against " +
                               std::to_string(e.logs.size()) + " logs") {}

  void Write(const std::filesystem::path& file) {
    Part("verdict", [&] { VerdictBox(); });
    Part("what is wrong", [&] { WhatIsWrong(); });
    Part("the missing force", [&] {
      AddMissing(page_, "missing force", missing_);
      AddMissingForce(page_, d_.missing_force);
    });
    Part("the cause", [&] { TheCause(); });
    Part("the extension", [&] { TheExtension(); });
    Part("the gain", [&] { TheGain(); });
    Part("the residual", [&] { TheResidual(); });
    Part("assumptions", [&] { Assumptions(); });
    page_.Write(file);
  }

 private:
  void Part(const std::string& name, const std::function<void()>& content) {
    AddPart(page_, name, missing_, content);
  }

  void VerdictBox() {
    const std::string v = d_.verdict.word();
    std::string names;
    for (const std::size_t i : d_.verdict.named) {
      names += (names.empty() ? "" : " or ") + d_.candidates[i].hypothesis.Name();
    }
    if (d_.partner) names += ", beside " + d_.partner->hypothesis.Name();
    const Gain gain = GainOf(d_, run_.after);
    page_.Badge(
        d_.Is(Verdict::Kind::kNamed) || d_.Is(Verdict::Kind::kAdequate) ? Tone::kGood : Tone::kWarn,
        v + (names.empty() ? "" : ": the data are consistent with " + names),
        fmt::format("{}. Held-out error {:.4g} to {:.4g} {} ({:.0f} % removed).", d_.verdict.reason,
                    d_.before.error.validate, run_.after.validate, unit_, 100 * gain.removed));
  }

  void WhatIsWrong() {
    page_.Heading("What is wrong");
    page_.Paragraph(
        d_.Is(Verdict::Kind::kAdequate)
            ? "Nothing that is more than noise and the time-discretisation error. The largest "
              "differences are:"
            : "Where the fitted model without any extension differs most from the measurement:");
    AddMissing(page_, "deviations", missing_);
    std::vector<std::string> items;
    for (const Deviation& d : run_.deviations) {
      items.push_back(
          fmt::format("**{}**, {} at {}: the simulation {}.", d.log, d.channel, d.when, d.what));
    }
    page_.List(items);
    for (const Deviation& d : run_.deviations) {
      for (std::size_t l = 0; l < e_.logs.size(); ++l) {
        if (e_.logs[l].label == d.log) Overlay(l, d.channel);
      }
    }
  }

  void Overlay(std::size_t l, const std::string& only = "") {
    std::vector<NamedTrace> traces;
    const auto add = [&](const std::string& name, Style style, const std::vector<Trace>& all) {
      if (all.empty()) return;
      RequireWhole(e_, all);
      traces.push_back({name, style, &all[l]});
    };
    add("before", Style::kBefore, run_.before_traces);
    if (d_.chosen()) add("after", Style::kAfter, run_.after_traces);
    AddOverlay(page_, e_, e_.logs[l], traces, false, only);
  }

  void TheCause() {
    page_.Heading("The cause");
    if (d_.candidates.empty()) {
      std::string text = "No candidate was fitted.";
      for (const Dismissed& c : d_.dismissed)
        text += " To first order " + c.effect + " removes next to nothing.";
      for (const std::string& why : d_.skipped) text += " " + why + ".";
      page_.Paragraph(text);
      return;
    }
    Shares();
    if (d_.noise_limited) AddLikelihoodTable(page_, d_);
    AddFoldTable(page_, d_);
    AddMissing(page_, "view by the missing force", missing_);
    AddSecondView(page_, d_);
    WhyNotTheOthers();
    AddMissing(page_, "next experiment", missing_);
    if (d_.verdict.named.size() > 1) NextExperimentText();
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
            placebo, p[static_cast<std::size_t>(Percent(rules().placebo_share) * last / 100)]);
    }
    if (placebo > -1) {
      bars.marks.push_back(
          {fmt::format("{:.0f} % of random forces stay below", Percent(rules().placebo_share)),
           100 * placebo});
    }
    if (!d_.noise_limited) bars.marks.push_back({"asked for", Percent(rules().median_gain)});
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
      items.push_back(
          fmt::format("**{} at {}**: explains {:.1f} % of the squared error to first order, and "
                      "was not fitted.",
                      c.effect, c.where, 100 * c.explained / d_.before.cost));
    }
    page_.Details("Why the others are not named", [&] { page_.List(items); });
  }

  void NextExperimentText() {
    page_.Heading("The next experiment", 3);
    page_.Paragraph(
        fmt::format("To distinguish them: {}. Expected separation {:.3g}, in units of twice the "
                    "log-likelihood{}.{}",
                    d_.next.input, d_.next.separation,
                    d_.noise.known() ? "" : " if the residual were white noise",
                    d_.next.log ? fmt::format(" Its inputs: {}.", kNextInputs) : ""));
  }

  void TheExtension() {
    page_.Heading("The extension");
    AddMissing(page_, "extended model", missing_);
    page_.Paragraph(
        d_.chosen() ? "`extended.xml` runs in plain MuJoCo with the plugin; `extended.yaml` is the "
                      "experiment that belongs to it."
                    : "Nothing was added: `extended.xml` is the model with refitted parameters.");
    AddMissing(page_, "parameters", missing_);
    const Fitted& last = d_.last();
    AddParameterTable(page_, d_.parameters, last.fit.x, last.sensitivities.value().uncertainty);
    page_.Code(LineDiff(run_.model_before, run_.extended.xml), "diff");
  }

  void TheGain() {
    page_.Heading("The gain");
    AddMissing(page_, "errors of the extended files", missing_);
    AddMissing(page_, "interval of the gain", missing_);
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
        {fmt::format("Free simulation of every log. Noise: {}. {:.0f} % of the held-out error "
                     "removed, {}; {:.0f} % of what is explainable above the noise.",
                     NoiseInWords(), 100 * gain.removed, GainIntervalInWords(),
                     100 * gain.explainable)});
    if (const std::string contrast = ContrastInWords(d_); !contrast.empty())
      page_.Paragraph("Between conditions: " + contrast + ".");
  }

  std::string GainIntervalInWords() const {
    if (!d_.gain_interval) return "interval not computed";
    return fmt::format("{:.0f} … {:.0f} % (95 %, whole trials resampled)",
                       100 * d_.gain_interval->low, 100 * d_.gain_interval->high);
  }

  std::string NoiseInWords() const {
    return d_.noise.rms > 0 ? fmt::format("{:.3g} {} ({})", d_.noise.rms, unit_, d_.noise.source)
                            : "not known";
  }

  void TheResidual() {
    page_.Heading("The residual");
    const std::string over = d_.noise.rms > 0
                                 ? fmt::format("The error is {:.1f} times the noise: the data",
                                               run_.after.train / d_.noise.rms)
                                 : "These logs do not show how large the noise is; they";
    std::string text = fmt::format(
        "{} are {}. ", over, ModelLimited(d_, run_.after) ? "model-limited" : "noise-limited");
    text +=
        NothingHelps(d_)
            ? "Nothing that was tried, forces without a name among it, does better on the "
              "held-out logs."
            : fmt::format("The extension reaches {:.0f} % of what {} on the held-out logs.",
                          100 * ShareReached(d_, run_.after),
                          d_.noise_limited ? "lies above the noise" : d_.ceiling_by + " reaches");
    page_.Paragraph(text);
    AddMissing(page_, "fallback", missing_);
    if (d_.fallback) {
      page_.Paragraph(
          "There is " + FallbackInWords(d_) + ". `" + kFallbackModel +
          "` has it as a formula: something to simulate with where these logs went, and "
          "no explanation. It has no memory.");
    }
    page_.Details("All logs", [&] {
      for (std::size_t l = 0; l < e_.logs.size(); ++l) Overlay(l);
    });
  }

  // The rules that decided, with the numbers that were used.
  std::string RulesInWords() const {
    const Criteria& c = rules();
    if (d_.noise_limited) {
      return fmt::format(
          "Noise is the whole residual of the best model, so likelihoods are calibrated. A cause "
          "is named when noise alone would let one of the candidates do as well in less than "
          "{:.2g} % of such data, the residual has nothing that smooth forces or shifts of the "
          "channels explain, and every rival is clearly less likely.",
          Percent(c.significance));
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
        fmt::arg("better", Percent(c.folds_better)), fmt::arg("gain", Percent(c.median_gain)),
        fmt::arg("spread", Percent(c.amplitude_spread)),
        fmt::arg("placebos", Percent(c.placebo_share)), fmt::arg("margin", Percent(c.fold_margin)));
  }

  void Assumptions() {
    page_.Heading("Assumptions");
    AddMissing(page_, "log check", missing_);
    std::vector<std::string> items{
        RulesInWords(),
        fmt::format("The model's own time step moves the trajectories by {:.3g} {} (h against "
                    "h/4); nothing smaller is named.",
                    d_.noise.step, unit_),
        d_.noise.source == "replicates"
            ? fmt::format("The noise comes from {} pairs of replicates.", d_.noise.pairs)
            : "There are no replicates: \"unexplained\" may be noise that is not white."};
    for (const auto& s : d_.skipped) items.push_back("Not tried: " + s + ".");
    for (const Finding& f : run_.findings) {
      if (f.severity != Finding::Severity::kInfo)
        items.push_back("Log check, " + f.log + ": " + f.text);
    }
    page_.List(items);
  }

  const Criteria& rules() const { return d_.criteria; }
  static double Percent(double share) { return 100 * share; }

  const Experiment& e_;
  const Diagnosis& d_;
  const ExtensionRun& run_;
  std::vector<MissingPart>& missing_;
  std::string unit_;
  Page page_;
};

}  // namespace

void WriteDiagnosisReport(const Experiment& e, const Diagnosis& d, const ExtensionRun& run,
                          const std::filesystem::path& file, std::vector<MissingPart>& missing) {
  DiagnosisPage(e, d, run, missing).Write(file);
}

}  // namespace continuum
