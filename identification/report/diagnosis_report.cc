#include "identification/report/diagnosis_output.h"

#include <functional>

#include <fmt/format.h>

#include "binding/effect_catalog.h"
#include "identification/report/diagnosis_details.h"
#include "identification/report/diagnosis_words.h"
#include "identification/report/missing_force_plots.h"
#include "identification/report/model_changes.h"
#include "identification/report/parts.h"

namespace continuum {
namespace {

// The first page: what the owner of the logs wants to know. Everything statistical is folded away
// below it.
class DiagnosisPage {
 public:
  DiagnosisPage(const Experiment& e, const Diagnosis& d, const ExtensionRun& run,
                std::vector<MissingPart>& missing)
      : e_(e),
        d_(d),
        run_(run),
        missing_(missing),
        page_("Diagnosis", e.model.filename().string() + " against " +
                               std::to_string(e.logs.size()) + " logs") {}

  void Write(const std::filesystem::path& file) {
    Part("verdict", [&] { VerdictBox(); });
    Part("what is wrong", [&] { WhatIsWrong(); });
    Part("the cause", [&] { TheCause(); });
    Part("the extension", [&] { TheExtension(); });
    Part("the gain", [&] { TheGain(); });
    Part("what is still wrong", [&] { WhatRemains(); });
    Part("next", [&] { WhatNext(); });
    AddDetails(page_, e_, d_, run_, missing_);
    page_.Write(file);
  }

 private:
  void Part(const std::string& name, const std::function<void()>& content) {
    AddPart(page_, name, missing_, content);
  }
  bool Is(Verdict::Kind kind) const { return d_.Is(kind); }

  void VerdictBox() {
    if (d_.interrupted)
      page_.Badge(Tone::kWarn, "Interrupted: this is the best so far",
                  "Run it again to the end before you rely on it.");
    const bool good = Is(Verdict::Kind::kNamed) || Is(Verdict::Kind::kAdequate);
    page_.Badge(good ? Tone::kGood : Tone::kWarn, HeadlineOf(d_), BadgeDetail());
  }

  std::string BadgeDetail() const {
    std::string text = Is(Verdict::Kind::kAdequate) || Is(Verdict::Kind::kUnexplained)
                           ? WhyInWords(d_)
                           : "How sure: **" + InWords(CertaintyOf(d_)) + "**.";
    if (d_.chosen()) text += WithIt() + GainInWords(d_, run_) + ".";
    return text;
  }

  std::string WithIt() const {
    if (OnlyCorrections(d_)) return " With both ";
    return Is(Verdict::Kind::kAmbiguous) ? " With the first " : " With it ";
  }

  // In words, and the largest difference as a picture.
  void WhatIsWrong() {
    page_.Heading("What is wrong");
    AddMissing(page_, "deviations", missing_);
    if (run_.deviations.empty()) {
      page_.Paragraph("No difference between simulation and measurement was found.");
      return;
    }
    constexpr std::size_t kShown = 3;
    page_.Paragraph(Is(Verdict::Kind::kAdequate) && d_.verdict.numbers_off == 0
                        ? "Nothing that these logs show. The largest differences, with the "
                          "model's parameters fitted:"
                        : "With its parameters fitted the model differs most from the measurement "
                          "here:");
    std::vector<std::string> items;
    for (const Deviation& one : run_.deviations) {
      if (items.size() < kShown) items.push_back(DeviationInWords(one));
    }
    page_.List(items);
    AddOverlayOf(page_, e_, run_, run_.deviations.front());
  }

  void TheCause() {
    if (Is(Verdict::Kind::kAdequate)) return;
    page_.Heading("The cause");
    std::vector<std::string> items;
    const auto add = [&](const Hypothesis& h, const Fitted& fitted, Eigen::Index begin,
                         const std::string& note) {
      items.push_back(fmt::format("**{}**, {}{}: {}.", h.NameAtPlace(),
                                  EffectNamed(h.Card()).summary, note,
                                  ValuesInWords(h, fitted, begin)));
    };
    if (d_.partner && d_.chosen())
      add(d_.partner->hypothesis, d_.last(), d_.before.fit.x.size(), "");
    for (const std::size_t i : d_.verdict.named) {
      const CandidateResult& c = d_.candidates[i];
      add(c.hypothesis, c.fitted, c.first_extra(), "");
    }
    for (const CandidateResult& c : d_.unlisted)
      add(c.hypothesis, c.fitted, c.first_extra(), " (not asked for)");
    page_.List(items);
    page_.Paragraph("How sure: **" + InWords(CertaintyOf(d_)) + "**. " + WhyInWords(d_));
    AddMissing(page_, "picture of the law", missing_);
    if (d_.law_picture)
      AddLaw(page_, *d_.law_picture, d_.chosen()->hypothesis.candidate.law->formula);
    if (Is(Verdict::Kind::kUnexplained)) {
      page_.Heading("The force that is missing", 3);
      AddMissing(page_, "missing force", missing_);
      AddMissingForce(page_, d_.missing_force);
    }
  }

  void TheExtension() {
    page_.Heading("What the extension changes");
    AddMissing(page_, "extended model", missing_);
    AddMissing(page_, "parameters", missing_);
    if (!run_.offered)
      page_.Paragraph(
          "No cause was added: `extended.xml` is the model with its parameters fitted.");
    if (Is(Verdict::Kind::kAmbiguous) && run_.offered)
      page_.Paragraph(OnlyCorrections(d_) ? "It has both." : "It has the first of these causes.");
    const auto changes = ChangesInWords(d_, run_);
    if (changes.empty()) {
      page_.Paragraph("Nothing.");
    } else {
      page_.List(changes);
    }
    if (run_.offered)
      page_.Paragraph(
          "`extended.xml` runs in plain MuJoCo with the plugin. `extended.yaml` is the experiment "
          "that belongs to it.");
  }

  void TheGain() {
    if (!d_.chosen()) return;
    page_.Heading("What it gains");
    AddMissing(page_, "errors of the extended files", missing_);
    AddMissing(page_, "interval of the gain", missing_);
    page_.Paragraph(WithIt().substr(1) + GainInWords(d_, run_) + "." + HeldOutErrors());
    const auto worse = WorseFoldsInWords(d_);
    if (worse.empty()) return;
    page_.Badge(Tone::kWarn, "It does not help everywhere", "");
    page_.List(worse);
  }

  std::string HeldOutErrors() const {
    const std::string unit = d_.pool.unit();
    if (!(d_.before.error.validate > 0)) return "";
    return fmt::format(" On logs that no fit has seen: {:.3g} → {:.3g} {}.{}",
                       d_.before.error.validate, run_.after.validate, unit,
                       unit == "std" ? " 1 std is the standard deviation of a channel." : "");
  }

  void WhatRemains() {
    page_.Heading("What is still wrong");
    page_.Paragraph(RemainsInWords(d_, run_));
    AddMissing(page_, "fallback", missing_);
    if (d_.fallback)
      page_.Paragraph("There is " + FallbackInWords(d_) + ". `" + kFallbackModel +
                      "` has it as a formula, to simulate with where these logs went. It explains "
                      "nothing and has no memory.");
  }

  void WhatNext() {
    page_.Heading("What to do next");
    AddMissing(page_, "next experiment", missing_);
    const auto steps = NextStepsInWords(e_, d_, run_);
    if (steps.empty()) {
      page_.Paragraph("Nothing: the model follows these logs as far as their noise shows.");
    } else {
      page_.List(steps);
    }
  }

  const Experiment& e_;
  const Diagnosis& d_;
  const ExtensionRun& run_;
  std::vector<MissingPart>& missing_;
  Page page_;
};

}  // namespace

void WriteDiagnosisReport(const Experiment& e, const Diagnosis& d, const ExtensionRun& run,
                          const std::filesystem::path& file, std::vector<MissingPart>& missing) {
  DiagnosisPage(e, d, run, missing).Write(file);
}

}  // namespace continuum
