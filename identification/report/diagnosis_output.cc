#include "identification/report/diagnosis_output.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/diagnosis/condition_contrast.h"
#include "identification/diagnosis/next_experiment.h"
#include "identification/problem/extended_model.h"
#include "identification/report/apply_extension.h"
#include "identification/report/fit_json.h"
#include "identification/report/line_diff.h"
#include "sim/io/file.h"
#include "sim/replay/replay.h"
#include "sim/replay/replay_report.h"

namespace continuum {
namespace {

// A problem for the hypothesis that was chosen, or the null one.
Problem ChosenProblem(const Experiment& e, const Diagnosis& d) {
  const CandidateResult* chosen = d.chosen();
  return chosen ? chosen->ProblemOf(e) : Problem(e, d.system);
}

std::vector<Added> AddedBy(const Diagnosis& d) {
  std::vector<Added> added;
  const auto add = [&](const Hypothesis& h) { added.push_back({h.instance, h.replaces}); };
  if (d.chosen() && d.partner) add(d.partner->hypothesis);
  if (d.chosen()) add(d.chosen()->hypothesis);
  return added;
}

double FoldsWon(const Diagnosis& d, const CandidateResult& c) {
  std::size_t won = 0;
  for (std::size_t f = 0; f < c.record.after.size(); ++f) {
    won += std::all_of(d.candidates.begin(), d.candidates.end(), [&](const CandidateResult& other) {
      return other.record.after.empty() || other.record.after[f] >= c.record.after[f];
    });
  }
  return static_cast<double>(won) /
         static_cast<double>(std::max<std::size_t>(c.record.after.size(), 1));
}

// The parameters of one cause, whose values begin somewhere in a fit's.
nlohmann::json ParametersOf(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin) {
  nlohmann::json parameters = nlohmann::json::object();
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    const Eigen::Index at = begin + static_cast<Eigen::Index>(i);
    std::string unit = h.extra[i].unit.empty() ? "1" : h.extra[i].unit;
    for (const Param& p : EffectNamed(h.Card()).params) {
      if (p.name == h.extra[i].name) unit = p.unit;
    }
    const Uncertainty& u = fitted.uncertainty;
    parameters[h.extra[i].name] = {
        {"value", fitted.fit.x[at]}, {"unit", unit}, {"ci95", {u.lower[at], u.upper[at]}}};
  }
  return parameters;
}

nlohmann::json ValuesOf(const CandidateResult& c) {
  nlohmann::json values = nlohmann::json::object();
  for (std::size_t i = 0; i < c.hypothesis.extra.size(); ++i)
    values[c.hypothesis.extra[i].name] = c.fitted.fit.x[c.own() + static_cast<Eigen::Index>(i)];
  return values;
}

// The cause that acts beside the chosen one.
nlohmann::json PartnerJson(const Diagnosis& d) {
  const Hypothesis& h = d.partner->hypothesis;
  return {{"effect", h.effect},
          {"variant", h.variant},
          {"equivalent", d.partner->equivalent},
          {"probability", d.chosen()->probability},
          {"probability_is", "of both causes together"},
          {"parameters", ParametersOf(h, d.chosen()->fitted, d.before.fit.x.size())},
          {"where", h.where},
          {"evidence", "consistent with the data: " + d.verdict.reason}};
}

// Of one fit; null where no trial was run under two conditions.
nlohmann::json BetweenJson(const Experiment& e, const Diagnosis& d, const Fitted& fitted) {
  const double between = BetweenConditions(Problem(e, d.system), fitted.residuals);
  return std::isnan(between) ? nlohmann::json(nullptr) : nlohmann::json(between);
}

nlohmann::json FallbackJson(const Diagnosis& d) {
  if (!d.fallback) return nullptr;
  const CandidateResult& c = *d.fallback;
  return {{"label", "no cause: a smooth force that was fitted to what is left"},
          {"where", c.hypothesis.where},
          {"model", kFallbackModel},
          {"experiment", kFallbackExperiment},
          {"folds", c.record.after},
          {"error", {{"train", c.fitted.error.train}, {"validate", c.fitted.error.validate}}}};
}

nlohmann::json CauseJson(const Diagnosis& d, const CandidateResult& c,
                         const std::vector<std::string>& equivalent) {
  const auto falls = std::count_if(
      c.record.after.begin(), c.record.after.end(),
      [&](const double& a) { return a < c.record.before[&a - c.record.after.data()]; });
  std::string evidence =
      d.noise_limited ? fmt::format(
                            "consistent with the data: twice the log-likelihood rises by {:.1f} "
                            "(family-wise p = {:.2g}); {}",
                            c.likelihood, c.p, d.verdict.reason)
                      : fmt::format("consistent with the data: {}", d.verdict.reason);
  if (!c.record.after.empty()) {
    evidence += fmt::format(
        "; leaving out one group at a time, the error falls in {} of {} folds, by {:.0f} % in the "
        "median",
        falls, c.record.after.size(), 100 * Median(Gains(c.record)));
  }
  return {{"effect", c.hypothesis.effect},
          {"variant", c.hypothesis.variant},
          {"equivalent", equivalent},
          {"probability", d.noise_limited ? c.probability : FoldsWon(d, c)},
          {"probability_is", d.noise_limited
                                 ? "posterior among the candidates tried, each as likely before"
                                 : "share of the folds in which it is the best candidate; not "
                                   "calibrated"},
          {"parameters", ParametersOf(c.hypothesis, c.fitted, c.own())},
          {"where", c.hypothesis.where},
          {"evidence", evidence}};
}

}  // namespace

std::vector<std::string> ChannelNames(const Experiment& e) {
  std::vector<std::string> names;
  for (const auto& channel : e.channels) names.push_back(channel.name);
  return names;
}

std::string BetweenInWords(const Experiment& e, const Diagnosis& d) {
  const Problem problem(e, d.system);
  const double before = BetweenConditions(problem, d.before.residuals);
  if (std::isnan(before)) return "";
  const auto after = [&](const CandidateResult& c) {
    return BetweenConditions(problem, c.fitted.residuals);
  };
  std::string text = fmt::format("the conditions' runs are {:.4g} {} apart beyond the model",
                                 before, d.pool.unit());
  const auto best =
      std::min_element(d.candidates.begin(), d.candidates.end(),
                       [&](const auto& a, const auto& b) { return after(a) < after(b); });
  if (best != d.candidates.end()) {
    text += fmt::format(", {:.4g} with {}", after(*best), best->hypothesis.NameAtPlace());
  }
  return text + "; what it gets wrong in both cancels";
}

std::string FallbackInWords(const Diagnosis& d) {
  const CandidateResult& c = *d.fallback;
  return fmt::format(
      "no cause, but a smooth force at {} takes {:.0f} % off the error in the median of the folds",
      c.hypothesis.where, 100 * Median(Gains(c.record)));
}

Gain GainOf(const Diagnosis& d, const TwoErrors& after) {
  const double before2 = d.before.error.validate * d.before.error.validate;
  const double after2 = after.validate * after.validate;
  const double noise2 = d.noise.rms * d.noise.rms;
  Gain gain;
  gain.removed = before2 > 0 ? 1 - std::sqrt(after2 / before2) : 0;
  gain.explainable = before2 > noise2 ? (before2 - after2) / (before2 - noise2) : 0;
  return gain;
}

bool NothingHelps(const Diagnosis& d) {
  return !d.chosen() && d.verdict.text != "adequate" &&
         !(d.ceiling_error.validate < d.before.error.validate);
}

double ShareReached(const Diagnosis& d, const TwoErrors& after) {
  if (NothingHelps(d)) return 0;
  const double possible =
      d.before.error.validate - std::min(d.ceiling_error.validate, after.validate);
  return possible > 0 ? std::clamp((d.before.error.validate - after.validate) / possible, 0.0, 1.0)
                      : 1;
}

double Share(const Diagnosis& d, const CandidateResult& c) {
  if (!d.noise_limited) return Median(Gains(c.record));
  const double explainable = std::max(d.before.cost - d.before.freedom, 1.0);
  return std::clamp(c.likelihood / explainable, 0.0, 1.0);  // a fit cut short may be below the null
}

bool ModelLimited(const Diagnosis& d, const TwoErrors& after) {
  return !d.noise_limited && after.train > 3 * d.noise.rms;
}

double Separation(const Diagnosis& d) {
  if (d.candidates.size() < 2) return 0;
  if (d.noise_limited) return std::abs(d.candidates[0].likelihood - d.candidates[1].likelihood);
  const auto& a = d.candidates[0].record;
  const auto& b = d.candidates[1].record;
  if (b.after.empty()) return 0;
  const double n = static_cast<double>(a.after.size());
  double mean = 0, squares = 0;
  for (std::size_t f = 0; f < a.after.size(); ++f) mean += (b.after[f] - a.after[f]) / n;
  for (std::size_t f = 0; f < a.after.size(); ++f) {
    squares += std::pow(b.after[f] - a.after[f] - mean, 2);
  }
  return squares > 0 ? std::abs(mean) / std::sqrt(squares / (n - 1) / n) : 0;
}

namespace {

// Or takes away what an earlier diagnosis left there.
void WriteFallback(const Experiment& e, const Diagnosis& d, const std::filesystem::path& folder) {
  if (!d.fallback) {
    std::filesystem::remove(folder / kFallbackModel);
    std::filesystem::remove(folder / kFallbackExperiment);
    return;
  }
  const CandidateResult& c = *d.fallback;
  const ExtendedModel files = Extend(c.ProblemOf(e), c.fitted.fit.x, folder, kFallbackModel);
  WriteFile(folder / kFallbackModel, files.xml);
  WriteFile(folder / kFallbackExperiment, files.yaml);
}

void WriteNext(const Experiment& e, const Diagnosis& d, const std::filesystem::path& folder) {
  if (d.next.log) {
    WriteFile(folder / kNextInputs, NextCsv(e, *d.next.log));
  } else {
    std::filesystem::remove(folder / kNextInputs);
  }
}

// As under `set` of a log.
nlohmann::json NextSettings(const Diagnosis& d) {
  auto json = nlohmann::json::object();
  if (!d.next.log) return json;
  for (const Change& c : d.next.log->set) json[c.target][c.attribute] = c.value;
  return json;
}

}  // namespace

DiagnosisFiles WriteDiagnosis(const Experiment& e, const Diagnosis& d,
                              const std::filesystem::path& folder) {
  MakeFolder(folder);
  DiagnosisFiles told;
  const Problem null(e, d.system);
  const Problem problem = ChosenProblem(e, d);
  const CandidateResult* const chosen = d.chosen();
  const Problem::Vector& x = chosen ? chosen->fitted.fit.x : d.before.fit.x;
  const ExtendedModel extension = Extend(problem, x, folder);
  WriteFile(folder / "extended.xml", extension.xml);
  WriteFile(folder / "extended.yaml", extension.yaml);
  WriteFallback(e, d, folder);
  WriteNext(e, d, folder);
  told.difference = LineDiff(d.system.Xml({}, {}, folder), extension.xml);

  Experiment extended = Experiment::Read(folder / "extended.yaml");
  const auto replayed = Replay(extended, ModelSpec::Load(folder / "extended.xml"));
  const SplitError error = PooledError(extended, replayed);
  told.after = {error.train, error.validate};
  for (const Replayed& r : replayed) told.after_traces.push_back(r.trace);
  for (std::size_t l = 0; l < e.logs.size(); ++l)
    told.before_traces.push_back(null.Predict(d.before.fit.x, l));
  told.wrong = FindWrong(e, told.before_traces);
  told.findings = CheckLogs(e);
  WriteSimulated(e, told.after_traces, folder / "simulated");
  WriteFile(folder / "diagnosis.json", DiagnosisJson(e, d, told).dump(2) + "\n");
  WriteDiagnosisReport(e, d, told, folder / "report.html");
  return told;
}

nlohmann::json DiagnosisJson(const Experiment& e, const Diagnosis& d, const DiagnosisFiles& told) {
  const Gain gain = GainOf(d, told.after);
  nlohmann::json json;
  json["model"] = e.model.filename().string();
  json["channels"] = ChannelNames(e);
  json["verdict"] = d.verdict.text;
  json["reason"] = d.verdict.reason;
  json["causes"] = nlohmann::json::array();
  if (!d.verdict.named.empty()) {
    std::vector<std::string> equivalent;
    const auto add = [&](const CandidateResult& c) {
      const std::string& name = c.hypothesis.effect;
      const bool known = name == d.chosen()->hypothesis.effect ||
                         std::find(equivalent.begin(), equivalent.end(), name) != equivalent.end();
      if (!known) equivalent.push_back(name);
    };
    for (std::size_t i = 1; i < d.verdict.named.size(); ++i) add(d.candidates[d.verdict.named[i]]);
    for (const CandidateResult& c : d.unlisted) add(c);
    json["causes"].push_back(CauseJson(d, *d.chosen(), equivalent));
    if (d.partner) json["causes"].push_back(PartnerJson(d));
  }
  json["alternatives"] = nlohmann::json::array();
  for (const std::size_t i : d.verdict.named)
    json["alternatives"].push_back(CauseJson(d, d.candidates[i], {}));
  json["error"] = {
      {"unit", d.pool.unit()},
      {"before", {{"train", d.before.error.train}, {"validate", d.before.error.validate}}},
      {"after", {{"train", told.after.train}, {"validate", told.after.validate}}}};
  json["gain"] = {{"validate_error_removed", gain.removed},
                  {"ci95", {d.gain_low, d.gain_high}},
                  {"explainable_error_removed", gain.explainable}};
  const Fitted& standing = d.chosen() ? d.chosen()->fitted : d.before;
  json["between_conditions"] = {{"before", BetweenJson(e, d, d.before)},
                                {"after", BetweenJson(e, d, standing)}};
  json["wrong"] = nlohmann::json::array();
  for (const Deviation& w : told.wrong) {
    json["wrong"].push_back(
        {{"log", w.log}, {"channel", w.channel}, {"when", w.when}, {"what", w.what}});
  }
  auto alternatives = nlohmann::json::array();
  for (const std::size_t i : d.verdict.named)
    alternatives.push_back(d.candidates[i].hypothesis.Name());
  json["next_experiment"] = {
      {"for", d.verdict.named.size() > 1 ? alternatives : nlohmann::json::array()},
      {"input", d.next.input},
      {"expected_separation", d.next.separation},
      {"file", d.next.log ? nlohmann::json(kNextInputs) : nlohmann::json(nullptr)},
      {"set", NextSettings(d)}};
  const double over = d.noise.rms > 0 ? told.after.train / d.noise.rms : 0;
  json["adequacy"] = {{"regime", ModelLimited(d, told.after) ? "model_limited" : "noise_limited"},
                      {"remaining_over_noise", over},
                      {"noise", d.noise.rms},
                      {"step_effect", d.noise.step},
                      {"noise_source", d.noise.source},
                      {"ceiling",
                       {{"validate_error", d.ceiling_error.validate},
                        {"reached_by", d.ceiling_by},
                        {"share_reached", ShareReached(d, told.after)}}}};
  json["folds"] = nlohmann::json::array();
  const auto& after = d.chosen() ? d.chosen()->record.after : d.before.folds.error;
  for (std::size_t f = 0; f < after.size(); ++f) {
    json["folds"].push_back(
        {{"left_out", d.folds[f].name}, {"before", d.before.folds.error[f]}, {"after", after[f]}});
  }
  json["candidates"] = nlohmann::json::array();
  for (std::size_t i = 0; i < d.candidates.size(); ++i) {
    const CandidateResult& c = d.candidates[i];
    const auto& p = c.record.placebo_gains;
    const double score = Share(d, c);
    const double beaten =
        static_cast<double>(std::count_if(p.begin(), p.end(), [&](double g) { return g < score; }));
    const double of_placebos =
        (static_cast<double>(p.size()) - beaten + 1) / static_cast<double>(p.size() + 1);
    const bool named =
        std::find(d.verdict.named.begin(), d.verdict.named.end(), i) != d.verdict.named.end();
    json["candidates"].push_back(
        {{"effect", c.hypothesis.effect},
         {"variant", c.hypothesis.variant},
         {"where", c.hypothesis.where},
         {"score", score},
         {"p", d.noise_limited ? c.p : of_placebos},
         {"likelihood", c.likelihood},
         {"probability", c.probability},
         {"lambda", c.apart},
         {"missing_force_explained",
          c.by_equation ? nlohmann::json(c.by_equation->share) : nlohmann::json(nullptr)},
         {"group", named && d.verdict.named.size() > 1 ? "not told apart" : ""},
         {"folds", c.record.after},
         {"amplitude", c.record.amplitude},
         {"placebos", p},
         {"fails", c.failures},
         {"values", ValuesOf(c)},
         {"between_conditions", BetweenJson(e, d, c.fitted)},
         {"error", {{"train", c.fitted.error.train}, {"validate", c.fitted.error.validate}}}});
  }
  for (const Dismissed& c : d.dismissed) {
    json["candidates"].push_back({{"effect", c.effect},
                                  {"variant", c.variant},
                                  {"where", c.where},
                                  {"score", 0},
                                  {"p", c.p},
                                  {"group", "left behind by the first-order screen"}});
  }
  json["pairs"] = nlohmann::json::array();
  for (const PairTried& pair : d.pairs) {
    json["pairs"].push_back(
        {{"effects", {pair.first, pair.second}}, {"likelihood", pair.likelihood}});
  }
  json["lack_of_fit"] = {{"force", d.lack.force}, {"channel", d.lack.channel}};
  json["skipped"] = d.skipped;
  json["parameters"] = nlohmann::json::array();
  const Problem problem = ChosenProblem(e, d);
  const auto& fitted = d.chosen() ? d.chosen()->fitted : d.before;
  json["parameters"] = ParametersJson(problem.parameters(), fitted.fit.x, fitted.uncertainty);
  json["extension"] = ChangesJson(problem.CommonChanges(fitted.fit.x), AddedBy(d));
  json["extended_model"] = "extended.xml";
  json["extended_experiment"] = "extended.yaml";
  json["fallback"] = FallbackJson(d);
  json["seconds"] = d.seconds;
  return json;
}

}  // namespace continuum
