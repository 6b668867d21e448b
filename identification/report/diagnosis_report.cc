#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "identification/inverse_dynamics/missing_force.h"
#include "identification/report/diagnosis_output.h"
#include "identification/report/fit_report.h"
#include "sim/replay/replay.h"
#include "sim/replay/replay_report.h"

namespace continuum {
namespace {

class DiagnosisPage {
 public:
  DiagnosisPage(const Experiment& e, const Diagnosis& d, const DiagnosisFiles& told)
      : e_(e),
        d_(d),
        told_(told),
        unit_(d.pool.unit()),
        page_("Diagnosis", e.model.filename().string() + " against " +
                               std::to_string(e.logs.size()) + " logs") {}

  void Write(const std::filesystem::path& file) {
    VerdictBox();
    WhatIsWrong();
    TheCause();
    TheExtension();
    TheGain();
    WhatIsLeft();
    Assumptions();
    page_.Write(file);
  }

 private:
  void VerdictBox() {
    const std::string& v = d_.verdict.text;
    std::string names;
    for (const std::size_t i : d_.verdict.named) {
      names += (names.empty() ? "" : " or ") + d_.candidates[i].hypothesis.Name();
    }
    if (d_.partner) names += ", beside " + d_.partner->hypothesis.Name();
    const Gain gain = GainOf(d_, told_.after);
    page_.Badge(
        v == "named" || v == "adequate" ? Tone::kGood : Tone::kWarn,
        v + (names.empty() ? "" : ": the data are consistent with " + names),
        fmt::format("{}. Held-out error {:.4g} to {:.4g} {} ({:.0f} % removed).", d_.verdict.reason,
                    d_.before.error.validate, told_.after.validate, unit_, 100 * gain.removed));
  }

  void WhatIsWrong() {
    page_.Heading("What is wrong");
    page_.Paragraph(
        d_.verdict.text == "adequate"
            ? "Nothing that can be told from noise and the time step. The largest differences are:"
            : "Where the fitted model without any extension parts most from the measurement:");
    std::vector<std::string> items;
    for (const Deviation& w : told_.wrong) {
      items.push_back(
          fmt::format("**{}**, {} at {}: the simulation {}.", w.log, w.channel, w.when, w.what));
    }
    page_.List(items);
    for (const Deviation& w : told_.wrong) {
      for (std::size_t l = 0; l < e_.logs.size(); ++l) {
        if (e_.logs[l].label == w.log) Overlay(l, w.channel);
      }
    }
    Missing();
  }

  void Overlay(std::size_t l, const std::string& only = "") {
    std::vector<NamedTrace> traces{{"before", Style::kBefore, &told_.before_traces[l]}};
    if (d_.chosen()) traces.push_back({"after", Style::kAfter, &told_.after_traces[l]});
    AddOverlay(page_, e_, e_.logs[l], traces, false, only);
  }

  void Missing() {
    const MissingForce f = FindMissingForce(Problem(e_, d_.system), d_.before.fit.x);
    if (f.joint.empty()) {
      page_.Paragraph("The missing force cannot be shown: not every joint is measured.");
      return;
    }
    page_.Heading("The missing force on joint " + f.joint, 3);
    page_.Paragraph(
        "Mass times the difference between the measured acceleration and the model's at the "
        "measured "
        "state. Line: median in bins, band: quartiles.");
    Scatter(f, f.angle, f.slides ? Axis{"position", "m"} : Axis{"angle", "rad"});
    Scatter(f, f.velocity, {"velocity", f.slides ? "m/s" : "rad/s"});
    Scatter(f, f.load, f.slides ? Axis{"actuator force", "N"} : Axis{"actuator torque", "N*m"});
    Scatter(f, f.time, {"time", "s"});
  }

  void Scatter(const MissingForce& f, const std::vector<double>& x, const Axis& axis) {
    const Axis missing{"missing force", f.slides ? "N" : "N*m"};
    ScatterSpec spec{"over " + axis.label, axis, missing, {}, {}, true};
    PointGroup points{"rows", {}, {}, Style::kResidual};
    const std::size_t stride = std::max<std::size_t>(1, x.size() / 1500);
    for (std::size_t k = 0; k < x.size(); k += stride)
      points.x.push_back(x[k]), points.y.push_back(f.force[k]);
    std::vector<std::size_t> order(x.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return x[a] < x[b]; });
    Trend trend{"median", {}, {}, {}, {}, Style::kAfter};
    constexpr std::size_t kBins = 20;
    for (std::size_t b = 0; b < kBins; ++b) {
      std::vector<double> xs, ys;
      for (std::size_t k = b * order.size() / kBins; k < (b + 1) * order.size() / kBins; ++k) {
        xs.push_back(x[order[k]]), ys.push_back(f.force[order[k]]);
      }
      if (ys.size() < 4) continue;
      std::sort(ys.begin(), ys.end());
      trend.x.push_back(Median(xs));
      trend.y.push_back(Median(ys));
      trend.low.push_back(ys[ys.size() / 4]);
      trend.high.push_back(ys[3 * ys.size() / 4]);
    }
    spec.groups.push_back(points);
    spec.trends.push_back(trend);
    page_.Scatter(spec);
  }

  void TheCause() {
    page_.Heading("The cause");
    if (d_.candidates.empty()) {
      std::string text = "No candidate was fitted.";
      for (const Dismissed& c : d_.dismissed)
        text += " To first order " + c.effect + " takes off next to nothing.";
      for (const std::string& why : d_.skipped) text += " " + why + ".";
      page_.Paragraph(text);
      return;
    }
    BarsSpec bars{d_.noise_limited ? "Share of what is above the noise that each candidate explains"
                                   : "Error removed on left-out logs, median over the folds",
                  {d_.noise_limited ? "explained" : "error removed", "%"},
                  {},
                  {}};
    double placebo = -1;
    for (std::size_t i = 0; i < d_.candidates.size(); ++i) {
      const auto& c = d_.candidates[i];
      const bool named =
          std::find(d_.verdict.named.begin(), d_.verdict.named.end(), i) != d_.verdict.named.end();
      bars.bars.push_back({c.hypothesis.NameAtPlace(), 100 * Share(d_, c), 0, named});
      auto p = c.record.placebo_gains;
      std::sort(p.begin(), p.end());
      if (!p.empty()) placebo = std::max(placebo, p[(p.size() - 1) * 95 / 100]);
    }
    if (placebo > -1) bars.marks.push_back({"95 % of random forces stay below", 100 * placebo});
    if (!d_.noise_limited) bars.marks.push_back({"asked for", 10});
    page_.Bars(bars);
    if (d_.noise_limited) LikelihoodTable();
    FoldTable();
    SecondView();
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
    if (d_.verdict.named.size() > 1) {
      page_.Heading("The next experiment", 3);
      page_.Paragraph(
          fmt::format("To tell them apart: {}. Expected separation {:.3g}, in units of twice the "
                      "log-likelihood{}.{}",
                      d_.next.input, d_.next.separation,
                      d_.noise.known() ? "" : " if what remains were white noise",
                      d_.next.log ? fmt::format(" Its inputs: {}.", kNextInputs) : ""));
    }
  }

  // What the missing force itself says, without a simulation.
  void SecondView() {
    std::vector<const CandidateResult*> seen;
    for (const auto& c : d_.candidates) {
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
      const bool chosen = c == d_.chosen();
      bars.bars.push_back({c->hypothesis.NameAtPlace(), 100 * c->by_equation->share, 0, chosen});
    }
    page_.Bars(bars);
    page_.Paragraph(
        "From the measured states alone, without simulating: sensor noise, twice differentiated, "
        "is most of this force on many logs, so that small shares may be all there is to explain. "
        "Only candidates that were fitted are here.");
  }

  void LikelihoodTable() {
    std::vector<std::vector<std::string>> rows;
    for (const auto& c : d_.candidates) {
      rows.push_back({c.hypothesis.Name(), c.hypothesis.where,
                      c.fitted.complete ? fmt::format("{:.1f}", c.likelihood) : "",
                      std::to_string(c.hypothesis.extra.size()), fmt::format("{:.2g}", c.p),
                      fmt::format("{:.3f}", c.probability), fmt::format("{:.1f}", c.apart)});
    }
    for (const auto& c : d_.dismissed) {
      rows.push_back({c.effect, c.where, "", "", fmt::format("{:.2g}", c.p), "", ""});
    }
    page_.Table(
        {"candidate", "where", "2 ln L gained", "parameters", "p, family-wise", "posterior",
         "lambda"},
        rows,
        {"Twice the log-likelihood over the model without it, empty for those left far behind; p: "
         "how often noise alone lets one of all candidates do as well to first order; posterior: "
         "each candidate as likely before; lambda: what of the best candidate this one cannot "
         "imitate on these logs (below about 15 they are hard to tell apart). What the best one "
         "leaves has p = " +
         fmt::format("{:.2g} against smooth forces and {:.2g} against shifts of the channels.",
                     d_.lack.force, d_.lack.channel)});
  }

  void FoldTable() {
    if (d_.before.folds.error.empty()) return;
    std::vector<std::string> header{"candidate"};
    for (const Fold& f : d_.folds) header.push_back("without " + f.name);
    std::vector<std::vector<std::string>> rows{{"as it is"}};
    for (const double error : d_.before.folds.error)
      rows[0].push_back(fmt::format("{:.4g}", error));
    for (const auto& c : d_.candidates) {
      if (c.record.after.empty()) continue;
      rows.push_back({c.hypothesis.NameAtPlace()});
      for (const double error : c.record.after) rows.back().push_back(fmt::format("{:.4g}", error));
    }
    if (!d_.ceiling.error.empty()) rows.push_back({"ceiling: " + d_.ceiling_by});
    for (const double error : d_.ceiling.error) rows.back().push_back(fmt::format("{:.4g}", error));
    page_.Table(header, rows,
                {"Error [" + unit_ + "] on the logs left out, after refitting on the others."});
  }

  void TheExtension() {
    page_.Heading("The extension");
    const CandidateResult* c = d_.chosen();
    if (c) {
      page_.Paragraph(
          "`extended.xml` runs in plain MuJoCo with the plugin; `extended.yaml` is the experiment "
          "that "
          "belongs to it.");
      AddParameterTable(page_, c->ProblemOf(e_).parameters(), c->fitted.fit.x,
                        c->fitted.uncertainty);
    } else {
      page_.Paragraph("Nothing was added: `extended.xml` is the model with refitted parameters.");
      AddParameterTable(page_, Problem(e_, d_.system).parameters(), d_.before.fit.x,
                        d_.before.uncertainty);
    }
    page_.Code(told_.difference, "diff");
  }

  void TheGain() {
    page_.Heading("The gain");
    const Gain gain = GainOf(d_, told_.after);
    const auto row = [&](const std::string& name, const TwoErrors& e) {
      return std::vector<std::string>{name, fmt::format("{:.4g}", e.train),
                                      fmt::format("{:.4g}", e.validate)};
    };
    page_.Table(
        {"model", "train [" + unit_ + "]", "validate [" + unit_ + "]"},
        {row("before", d_.before.error), row("after", told_.after),
         row(d_.noise_limited ? "noise (floor)" : "ceiling: " + d_.ceiling_by, d_.ceiling_error)},
        {fmt::format(
            "Free simulation of every log. Noise: {}. {:.0f} % of the held-out error "
            "removed, {:.0f} … {:.0f} % (95 %, whole trials resampled); {:.0f} % of what is "
            "explainable above the noise.",
            NoiseInWords(), 100 * gain.removed, 100 * d_.gain_low, 100 * d_.gain_high,
            100 * gain.explainable)});
    if (const std::string between = BetweenInWords(e_, d_); !between.empty())
      page_.Paragraph("Between conditions: " + between + ".");
  }

  std::string NoiseInWords() const {
    return d_.noise.rms > 0 ? fmt::format("{:.3g} {} ({})", d_.noise.rms, unit_, d_.noise.source)
                            : "not known";
  }

  void WhatIsLeft() {
    page_.Heading("What is left");
    const std::string over = d_.noise.rms > 0
                                 ? fmt::format("What remains is {:.1f} times the noise: the data",
                                               told_.after.train / d_.noise.rms)
                                 : "How large the noise is these logs do not tell; they";
    std::string text = fmt::format(
        "{} are {}. ", over, ModelLimited(d_, told_.after) ? "model-limited" : "noise-limited");
    text +=
        NothingHelps(d_)
            ? "Nothing that was tried, forces without a name among it, does better on the "
              "held-out logs."
            : fmt::format("The extension reaches {:.0f} % of what {} on the held-out logs.",
                          100 * ShareReached(d_, told_.after),
                          d_.noise_limited ? "lies above the noise" : d_.ceiling_by + " reaches");
    page_.Paragraph(text);
    if (d_.fallback) {
      page_.Paragraph(
          "There is " + FallbackInWords(d_) + ". `" + kFallbackModel +
          "` has it as a formula: something to simulate with where these logs went, and "
          "no explanation. It remembers nothing.");
    }
    page_.Details("All logs", [&] {
      for (std::size_t l = 0; l < e_.logs.size(); ++l) Overlay(l);
    });
  }

  void Assumptions() {
    page_.Heading("What this rests on");
    std::vector<std::string> items{
        d_.noise_limited
            ? "Noise is all that the best model leaves, so likelihoods are calibrated. A cause is "
              "named when noise alone would let one of the candidates do as well in less than 5 % "
              "of such data, nothing is left that smooth forces or shifts of the channels explain, "
              "and every rival is clearly less likely."
            : "A cause is named when the error falls in at least 80 % of the folds and by at least "
              "10 % in the median, its size agrees over the folds within 30 %, it beats 95 % of "
              "random smooth forces with as many parameters, and it is clearly better than every "
              "other candidate in paired folds: in 80 % of them, by more than one standard error "
              "and "
              "by more than 5 % of the other's error, or what 95 % of those forces take off. Of a "
              "law and one that "
              "contains it the plainer is named, unless it is clearly worse. No probability is "
              "given: on such data none would "
              "be calibrated.",
        fmt::format("The model's own time step moves the trajectories by {:.3g} {} (h against "
                    "h/4); nothing smaller is "
                    "named.",
                    d_.noise.step, unit_),
        d_.noise.source == "replicates"
            ? fmt::format("The noise comes from {} pairs of replicates.", d_.noise.pairs)
            : "There are no replicates: \"unexplained\" cannot be told from noise that is not "
              "white."};
    for (const auto& s : d_.skipped) items.push_back("Not tried: " + s + ".");
    for (const Finding& f : told_.findings) {
      if (f.severity != Finding::Severity::kInfo)
        items.push_back("Log check, " + f.log + ": " + f.text);
    }
    page_.List(items);
  }

  const Experiment& e_;
  const Diagnosis& d_;
  const DiagnosisFiles& told_;
  std::string unit_;
  Page page_;
};

}  // namespace

void WriteDiagnosisReport(const Experiment& e, const Diagnosis& d, const DiagnosisFiles& told,
                          const std::filesystem::path& file) {
  DiagnosisPage(e, d, told).Write(file);
}

}  // namespace continuum
