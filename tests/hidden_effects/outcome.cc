#include "hidden_effects/outcome.h"

#include <limits>

#include <nlohmann/json.hpp>

namespace continuum::hidden {
namespace {

// An interval without an end is written as null.
double NumberOr(const nlohmann::json& json, double other) {
  return json.is_number() ? json.get<double>() : other;
}

std::string SuiteOf(const Case& c) {
  if (c.background) return "background";
  if (RobotNamed(c.robot).outside) return "outside";
  return c.spoilt.empty() ? "robots" : "spoilt";
}

}  // namespace

nlohmann::json LineOf(const Case& c, const Answer& a) {
  nlohmann::json line{{"case", c.Name()},
                      {"robot", c.robot},
                      {"suite", SuiteOf(c)},
                      {"spoilt", c.spoilt},
                      {"effects", c.effects},
                      {"listed", c.listed},
                      {"factor", c.factor},
                      {"noise", kNoiseNames[static_cast<int>(c.noise)]},
                      {"verdict", a.verdict},
                      {"named", a.named},
                      {"relatives", a.relatives},
                      {"partner", a.partner},
                      {"right", InSet(c, a)},
                      {"exact", InSetExactly(c, a)},
                      {"sibling", !c.effects.empty() && Sibling(c, a)},
                      {"unique", Unique(a)},
                      {"truth", a.truth},
                      {"value", a.value},
                      {"low", a.low},
                      {"high", a.high},
                      {"by_numbers", a.by_numbers},
                      {"removed", a.removed},
                      {"p", a.p},
                      {"lack", a.lack},
                      {"next", a.next},
                      {"closest", a.closest},
                      {"stated", a.stated},
                      {"seconds", a.seconds},
                      {"cpu", a.cpu},
                      {"screened", a.screened},
                      {"leading", a.leading}};
  if (a.complete) line["complete"] = *a.complete;
  if (a.explained) line["explained"] = *a.explained;
  if (a.followed) {
    const Followed& f = *a.followed;
    line["followed"] = {{"input", f.input},
                        {"separation", f.separation},
                        {"named", f.named},
                        {"right", f.right},
                        {"unique", f.unique}};
  }
  return line;
}

namespace {

// What lines of older files lack.
void ReadMore(const nlohmann::json& line, Outcome& o) {
  o.robot = line.value("robot", ""), o.suite = line.value("suite", "robots");
  o.spoilt = line.value("spoilt", "");
  o.exact = line.value("exact", o.right), o.sibling = line.value("sibling", false);
  o.cpu = line.value("cpu", o.seconds), o.p = line.value("p", 1.0);
  if (line.contains("explained")) o.explained = line["explained"].get<double>();
  o.by_numbers = line.value("by_numbers", 0.0);
  o.removed = line.value("removed", o.explained.value_or(0));
  o.screened = line.value("screened", ""), o.leading = line.value("leading", "");
  if (line.contains("complete")) o.complete = line["complete"].get<bool>();
}

}  // namespace

std::vector<Outcome> OutcomesOf(const std::vector<nlohmann::json>& lines) {
  std::vector<Outcome> outcomes;
  for (const auto& line : lines) {
    if (!line.contains("effects")) continue;
    Outcome o;
    o.name = line.at("case"), o.noise = line.at("noise"), o.verdict = line.at("verdict");
    o.effects = line.at("effects"), o.named = line.at("named"), o.partner = line.at("partner");
    o.listed = line.at("listed"), o.factor = line.at("factor");
    o.right = line.at("right"), o.unique = line.at("unique");
    o.truth = line.at("truth"), o.value = line.at("value");
    o.low = NumberOr(line.at("low"), -std::numeric_limits<double>::infinity());
    o.high = NumberOr(line.at("high"), std::numeric_limits<double>::infinity());
    if (line.contains("stated")) o.stated = line.at("stated");
    o.seconds = line.at("seconds"), o.closest = line.value("closest", 0.0);
    ReadMore(line, o);
    if (line.contains("followed")) {
      const auto& f = line["followed"];
      o.followed = {f.at("right").get<bool>(), f.at("unique").get<bool>()};
    }
    outcomes.push_back(std::move(o));
  }
  return outcomes;
}

}  // namespace continuum::hidden
