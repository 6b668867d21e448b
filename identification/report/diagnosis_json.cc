#include "identification/report/diagnosis_json.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "identification/diagnosis/gain.h"
#include "identification/report/apply_extension.h"
#include "identification/report/diagnosis_words.h"
#include "identification/report/fit_json.h"
#include "identification/report/model_changes.h"
#include "sim/io/rounded.h"

namespace continuum {
namespace {

std::vector<Added> AddedBy(const Diagnosis& d) {
  std::vector<Added> added;
  const auto add = [&](const Hypothesis& h) { added.push_back({h.instance, h.replaces}); };
  if (d.chosen() && d.partner) add(d.partner->hypothesis);
  if (d.chosen()) add(d.chosen()->hypothesis);
  return added;
}

// The parameters of one cause, whose values begin somewhere in a fit's.
nlohmann::json ParametersOf(const Hypothesis& h, const Fitted& fitted, Eigen::Index begin) {
  nlohmann::json parameters = nlohmann::json::object();
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    const Eigen::Index at = begin + static_cast<Eigen::Index>(i);
    const std::string unit = UnitOfExtra(h, i);
    nlohmann::json& json = parameters[h.extra[i].name];
    json = {{"value", fitted.fit.x[at]}, {"unit", unit.empty() ? "1" : unit}, {"ci95", nullptr}};
    if (!fitted.complete()) continue;
    const Uncertainty& u = fitted.sensitivities->uncertainty;
    json["ci95"] = {u.lower[at], u.upper[at]};
    if (u.step.size() > 0) json["fine_step"] = fitted.fit.x[at] + u.step[at];
    if (u.by_numbers.size() > 0) json["if_numbers_are_off"] = u.by_numbers[at];
  }
  return parameters;
}

nlohmann::json ValuesOf(const CandidateResult& c) {
  nlohmann::json values = nlohmann::json::object();
  for (std::size_t i = 0; i < c.hypothesis.extra.size(); ++i)
    values[c.hypothesis.extra[i].name] =
        c.fitted.fit.x[c.first_extra() + static_cast<Eigen::Index>(i)];
  return values;
}

// The cause that acts beside the chosen one.
nlohmann::json PartnerJson(const Diagnosis& d) {
  const Hypothesis& h = d.partner->hypothesis;
  std::vector<std::string> equivalent = d.partner->equivalent;
  equivalent.insert(equivalent.end(), d.partner->relatives.begin(), d.partner->relatives.end());
  return {{"effect", h.effect},
          {"variant", h.variant},
          {"equivalent", equivalent},
          {"relatives", d.partner->relatives},
          {"correction", d.partner->Corrects()},
          {"probability", d.chosen()->probability},
          {"probability_is", "of both causes together"},
          {"parameters", ParametersOf(h, d.chosen()->fitted, d.before.fit.x.size())},
          {"where", h.where},
          {"evidence", "consistent with the data: " + d.verdict.reason}};
}

nlohmann::json OrNull(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

// The name of a file that was made.
nlohmann::json NameIf(bool made, const char* name) {
  return made ? nlohmann::json(name) : nlohmann::json(nullptr);
}

nlohmann::json FallbackJson(const Diagnosis& d, const ExtensionRun& run) {
  if (!d.fallback) return nullptr;
  const CandidateResult& c = *d.fallback;
  return {{"label", "no cause: a smooth force that was fitted to the residual"},
          {"where", c.hypothesis.where},
          {"model", NameIf(run.fallback.has_value(), kFallbackModel)},
          {"experiment", NameIf(run.fallback.has_value(), kFallbackExperiment)},
          {"folds", c.record.after},
          {"error", {{"train", c.fitted.error.train}, {"validate", c.fitted.error.validate}}}};
}

nlohmann::json CauseJson(const Diagnosis& d, const CandidateResult& c,
                         const std::vector<std::string>& equivalent) {
  const auto falls = std::count_if(
      c.record.after.begin(), c.record.after.end(),
      [&](const double& a) { return a < c.record.before[&a - c.record.after.data()]; });
  std::string evidence = d.noise_limited
                             ? fmt::format(
                                   "consistent with the data: twice the log-likelihood rises by {} "
                                   "(family-wise p = {:.2g}); {}",
                                   Fixed(c.likelihood, 1), c.p, d.verdict.reason)
                             : fmt::format("consistent with the data: {}", d.verdict.reason);
  if (!c.record.after.empty()) {
    evidence += fmt::format(
        "; leaving out one group at a time, the error falls in {} of {} folds, by {} in the "
        "median",
        falls, c.record.after.size(), Percent(Median(Gains(c.record))));
  }
  return {{"effect", c.hypothesis.effect},
          {"variant", c.hypothesis.variant},
          {"equivalent", equivalent},
          {"probability", d.noise_limited ? c.probability : FoldsWon(d, c)},
          {"probability_is", d.noise_limited
                                 ? "posterior among the candidates tried, each as likely before"
                                 : "share of the folds in which it is the best candidate; not "
                                   "calibrated"},
          {"parameters", ParametersOf(c.hypothesis, c.fitted, c.first_extra())},
          {"where", c.hypothesis.where},
          {"evidence", evidence}};
}

nlohmann::json ErrorJson(const TwoErrors& error) {
  return {{"train", error.train}, {"validate", error.validate}};
}

nlohmann::json NextSettings(const Diagnosis& d) {
  auto json = nlohmann::json::object();
  if (!d.next.log) return json;
  for (const Change& c : d.next.log->set) json[c.target][c.attribute] = c.value;
  return json;
}

nlohmann::json CausesJson(const Diagnosis& d) {
  auto json = nlohmann::json::array();
  if (d.verdict.named.empty()) return json;
  std::vector<std::string> equivalent;
  const auto add = [&](const CandidateResult& c) {
    const std::string& name = c.hypothesis.effect;
    const bool known = name == d.chosen()->hypothesis.effect ||
                       std::find(equivalent.begin(), equivalent.end(), name) != equivalent.end();
    if (!known) equivalent.push_back(name);
  };
  for (std::size_t i = 1; i < d.verdict.named.size(); ++i) add(d.candidates[d.verdict.named[i]]);
  for (const std::size_t i : d.verdict.siblings) add(d.candidates[i]);
  for (const CandidateResult& c : d.unlisted) add(c);
  if (d.partner)
    equivalent.insert(equivalent.end(), d.partner->instead.begin(), d.partner->instead.end());
  json.push_back(CauseJson(d, *d.chosen(), equivalent));
  if (!d.partner) return json;
  json.front()["correction"] = d.partner->OtherCorrects();
  json.insert(d.partner->main ? json.begin() : json.end(), PartnerJson(d));
  return json;
}

nlohmann::json LeadingJson(const Diagnosis& d) {
  if (!d.verdict.leading || *d.verdict.leading >= d.candidates.size()) return nullptr;
  const CandidateResult& c = d.candidates[*d.verdict.leading];
  return {{"effect", c.hypothesis.effect},
          {"where", c.hypothesis.where},
          {"share", d.verdict.leading_share}};
}

nlohmann::json CausesAt(const Diagnosis& d, const std::vector<std::size_t>& candidates) {
  auto json = nlohmann::json::array();
  for (const std::size_t i : candidates) json.push_back(CauseJson(d, d.candidates[i], {}));
  return json;
}

// To first order, as the screen saw it.
nlohmann::json FirstOrderJson(double explained, double p) {
  return {{"explained", explained}, {"p", p}};
}

nlohmann::json GainJson(const Diagnosis& d, const TwoErrors& after) {
  const Gain gain = GainOf(d, after);
  nlohmann::json interval = nullptr;
  if (d.gain_interval) interval = {d.gain_interval->low, d.gain_interval->high};
  return {{"validate_error_removed", gain.removed},
          {"ci95", interval},
          {"explainable_error_removed", OrNull(gain.explainable)}};
}

nlohmann::json DeviationsJson(const std::vector<Deviation>& deviations) {
  auto json = nlohmann::json::array();
  for (const Deviation& d : deviations)
    json.push_back({{"log", d.log}, {"channel", d.channel}, {"when", d.when}, {"what", d.what}});
  return json;
}

nlohmann::json NextJson(const Diagnosis& d, const ExtensionRun& run) {
  auto alternatives = nlohmann::json::array();
  for (const std::size_t i : d.verdict.named)
    alternatives.push_back(d.candidates[i].hypothesis.Name());
  return {{"for", d.verdict.named.size() > 1 ? alternatives : nlohmann::json::array()},
          {"input", d.next.input},
          {"expected_separation", d.next.separation},
          {"file", NameIf(!run.next_inputs.empty(), kNextInputs)},
          {"set", NextSettings(d)}};
}

nlohmann::json AdequacyJson(const Diagnosis& d, const TwoErrors& after) {
  const double over = d.noise.rms > 0 ? after.train / d.noise.rms : 0;
  return {{"regime", ModelLimited(d, after) ? "model_limited" : "noise_limited"},
          {"remaining_over_noise", over},
          {"noise", d.noise.rms},
          {"step_effect", d.noise.step},
          {"noise_source", d.noise.source},
          {"ceiling",
           {{"validate_error", d.ceiling_error.validate},
            {"reached_by", d.ceiling_by},
            {"share_reached", ShareReached(d, after)}}}};
}

nlohmann::json FoldsJson(const Diagnosis& d) {
  auto json = nlohmann::json::array();
  const auto& after = d.chosen() ? d.chosen()->record.after : d.before.folds.error;
  for (std::size_t f = 0; f < after.size(); ++f) {
    const double before = d.before.folds.error[f];
    json.push_back({{"left_out", d.folds[f].name},
                    {"before", before},
                    {"after", after[f]},
                    {"worse", after[f] > before}});
  }
  return json;
}

// The share of random forces, this one among them, that do as well.
double ByPlacebos(const std::vector<double>& placebo_gains, double score) {
  const auto all = static_cast<double>(placebo_gains.size());
  const auto beaten = static_cast<double>(std::count_if(placebo_gains.begin(), placebo_gains.end(),
                                                        [&](double gain) { return gain < score; }));
  return (all - beaten + 1) / (all + 1);
}

nlohmann::json CandidateJson(const Diagnosis& d, std::size_t i) {
  const CandidateResult& c = d.candidates[i];
  const double score = Share(d, c);
  const auto& all = d.verdict.named;
  const bool named = std::find(all.begin(), all.end(), i) != all.end();
  return {{"effect", c.hypothesis.effect},
          {"variant", c.hypothesis.variant},
          {"where", c.hypothesis.where},
          {"score", score},
          {"p", d.noise_limited ? c.p : ByPlacebos(c.record.placebo_gains, score)},
          {"first_order", FirstOrderJson(c.explained, c.p)},
          {"likelihood", c.likelihood},
          {"probability", c.probability},
          {"lambda", c.lambda},
          {"missing_force_explained",
           c.by_equation ? nlohmann::json(c.by_equation->share) : nlohmann::json(nullptr)},
          {"group", named && all.size() > 1 ? "not distinguished" : ""},
          {"folds", c.record.after},
          {"amplitude", c.record.amplitude},
          {"placebos", c.record.placebo_gains},
          {"fails", c.failures},
          {"values", ValuesOf(c)},
          {"between_conditions", OrNull(c.contrast)},
          {"error", ErrorJson(c.fitted.error)}};
}

nlohmann::json CandidatesJson(const Diagnosis& d) {
  auto json = nlohmann::json::array();
  for (std::size_t i = 0; i < d.candidates.size(); ++i) json.push_back(CandidateJson(d, i));
  for (const Dismissed& c : d.dismissed) {
    json.push_back({{"effect", c.effect},
                    {"variant", c.variant},
                    {"where", c.where},
                    {"score", 0},
                    {"p", c.p},
                    {"first_order", FirstOrderJson(c.explained, c.p)},
                    {"group", "not fitted: " + WhyNotFitted(c)}});
  }
  return json;
}

nlohmann::json PairsJson(const Diagnosis& d) {
  auto json = nlohmann::json::array();
  for (const PairTried& pair : d.pairs)
    json.push_back({{"effects", {pair.first, pair.second}}, {"likelihood", pair.likelihood}});
  return json;
}

nlohmann::json LengthsJson(const Diagnosis& d) {
  if (!d.lengths_as_given) return nullptr;
  return {{"verdict", d.lengths_as_given->verdict},
          {"error", ErrorJson(d.lengths_as_given->error)}};
}

}  // namespace

std::vector<std::string> ChannelNames(const Experiment& e) {
  std::vector<std::string> names;
  for (const auto& channel : e.channels) names.push_back(channel.name);
  return names;
}

nlohmann::json DiagnosisJson(const Experiment& e, const Diagnosis& d, const ExtensionRun& run,
                             std::vector<MissingPart>& missing) {
  nlohmann::json json;
  json["model"] = e.model.filename().string();
  json["channels"] = ChannelNames(e);
  json["verdict"] = d.verdict.word();
  json["reason"] = d.verdict.reason;
  json["certainty"] = InWords(CertaintyOf(d));
  json["complete"] = d.verdict.complete;
  json["remaining"] = {{"over_noise", d.remaining.over_noise},
                       {"where", d.remaining.where},
                       {"would_take", d.remaining.would_take}};
  json["leading"] = LeadingJson(d);
  json["offered"] = NameIf(run.offered, kExtendedModel);
  json["error"] = {{"unit", d.pool.unit()},
                   {"before", ErrorJson(d.before.error)},
                   {"after", ErrorJson(run.after)}};
  json["extended_model"] = NameIf(!run.extended.xml.empty(), kExtendedModel);
  json["extended_experiment"] = NameIf(!run.extended.yaml.empty(), kExtendedExperiment);
  json["lengths_as_given"] = LengthsJson(d);
  json["skipped"] = d.skipped;
  json["left_out"] = d.left_out;
  json["interrupted"] = d.interrupted;
  json["seconds"] = d.seconds;
  json["lack_of_fit"] = {{"force", d.lack_of_fit.force}, {"channel", d.lack_of_fit.channel}};
  const auto part = [&](const char* key, const std::function<nlohmann::json()>& make) {
    json[key] = nullptr;
    MakePart(key, missing, [&] { json[key] = make(); });
  };
  part("causes", [&] { return CausesJson(d); });
  part("alternatives", [&] { return CausesAt(d, d.verdict.named); });
  part("relatives", [&] { return CausesAt(d, d.verdict.siblings); });
  part("gain", [&] { return GainJson(d, run.after); });
  part("between_conditions", [&] {
    const CandidateResult* const chosen = d.chosen();
    return nlohmann::json{{"before", OrNull(d.contrast)},
                          {"after", OrNull(chosen ? chosen->contrast : d.contrast)}};
  });
  part("wrong", [&] { return DeviationsJson(run.deviations); });
  part("next_experiment", [&] { return NextJson(d, run); });
  part("adequacy", [&] { return AdequacyJson(d, run.after); });
  part("folds", [&] { return FoldsJson(d); });
  part("candidates", [&] { return CandidatesJson(d); });
  part("pairs", [&] { return PairsJson(d); });
  part("parameters", [&] {
    return ParametersJson(d.parameters, d.last().fit.x, d.last().sensitivities.value().uncertainty);
  });
  part("extension", [&] {
    const bool all = run.offered || !d.chosen();
    return all ? ChangesJson(d.changes, AddedBy(d)) : ChangesJson({}, {});
  });
  part("fallback", [&] { return FallbackJson(d, run); });
  return json;
}

}  // namespace continuum
