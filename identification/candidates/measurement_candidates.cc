#include "identification/candidates/measurement_candidates.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "binding/config.h"
#include "error.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/parameter_size.h"
#include "identification/candidates/shared_value.h"
#include "sim/experiment/measurement_model.h"

namespace continuum {
namespace {

const std::string kSensor = "sensor:";

// How far the measured values of some outputs reach [their unit].
double OutputSize(const Experiment& e, const std::vector<std::string>& columns) {
  const auto [lower, upper] = ReadingRange(e, columns);
  return upper > lower ? upper - lower : 1;
}

// How large an error of the measurement may be, from the unit on its card.
ParameterSize SizeOfError(const Param& card, const std::vector<std::string>& names,
                          const Experiment& e, const Sizes& sizes) {
  if (card.unit == "1" || card.unit == "rad") return {1, 1, 0.02};
  if (card.unit == "s") return {4 * sizes.period, 25, 0.125};
  const double range = OutputSize(e, names);
  if (card.unit == "output") return {range, 1, 0.02};
  const std::vector<double>& time = e.logs.front().time;
  if (card.unit == "output/s") return {range / std::max(1e-9, time.back() - time[0]), 1, 0.02};
  throw Error::Input("parameter " + std::string(card.name) + " of the measurement",
                     "one of the units 1, rad, s, output, output/s",
                     "'" + std::string(card.unit) + "'");
}

// Of a sensor that is called "s[0]", or of a component that is named like this.
std::string SensorOf(const Output& out, const mjModel& m) {
  const bool whole = mj_name2id(&m, mjOBJ_SENSOR, out.source.c_str()) >= 0;
  return whole ? out.source : out.source.substr(0, out.source.rfind('['));
}

// What a parameter of the measurement is for each of some outputs, or for the clock.
std::vector<double> PresentValues(const Param& card, const std::vector<std::string>& names,
                                  const Experiment& e) {
  const std::string attribute(card.name);
  if (names.empty()) return {MeasurementValue(e, "time", attribute)};
  std::vector<double> values;
  for (const std::string& name : names)
    values.push_back(MeasurementValue(e, kSensor + Escaped(name), attribute));
  return values;
}

// Whether it is one of angles: it has a parameter per angle.
bool IsOfAngles(const EffectInfo& effect) {
  return std::any_of(effect.params.begin(), effect.params.end(),
                     [](const Param& p) { return p.unit == "1/output"; });
}

// Whether it turns sensors of three components.
bool Turns(const EffectInfo& effect) { return effect.params.front().name == "angle"; }

// An output on which an effect may act.
struct UsableOutput {
  std::string name, sensor, unit;
};

std::vector<UsableOutput> Usable(const EffectInfo& effect, const std::string& globs,
                                 const Experiment& e, const mjModel& m) {
  std::vector<UsableOutput> all;
  for (const Output& out : e.outputs) {
    if (out.kind != Output::Kind::kSensor || out.weight == 0 || out.quaternion()) continue;
    const std::string sensor = SensorOf(out, m);
    if (!AnyGlobMatches(globs, sensor) && !AnyGlobMatches(globs, out.name())) continue;
    const int id = mj_name2id(&m, mjOBJ_SENSOR, sensor.c_str());
    if (Turns(effect) && (id < 0 || m.sensor_dim[id] != 3)) continue;
    if (IsOfAngles(effect) && (out.unit != "rad" || id < 0 || m.sensor_type[id] != mjSENS_JOINTPOS))
      continue;
    const std::string& name = Turns(effect) ? sensor : out.name();
    const auto same = [&](const UsableOutput& other) { return other.name == name; };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back({name, sensor, out.unit});
  }
  return all;
}

// A bias of millimetres is none of degrees.
void RequireOneUnit(const Param& card, const std::vector<std::string>& names, const Experiment& e) {
  if (!card.unit.starts_with("output")) return;
  const Output* first = nullptr;
  for (const Output& out : e.outputs) {
    if (std::find(names.begin(), names.end(), out.name()) == names.end()) continue;
    if (!first) first = &out;
    if (out.unit != first->unit)
      throw Error::Input("outputs '" + first->name() + "' and '" + out.name() + "'", "one unit",
                         first->unit + " and " + out.unit);
  }
}

// The parameter of a card, as a free one of a hypothesis.
void AddParameter(const Param& card, const std::vector<std::string>& names, const Experiment& e,
                  const Sizes& sizes, Hypothesis& h) {
  RequireOneUnit(card, names, e);
  const SharedValue shared = SharedValueOf(PresentValues(card, names, e));
  const bool factor = card.null == 1 || shared.operation == Change::Operation::kScale;
  const double null = shared.null;
  Parameter p;
  p.name = card.name, p.attribute = card.name;
  p.name += shared.suffix;
  p.target = names.empty() ? "time" : kSensor + GlobsOf(names);
  p.operation = shared.operation;
  p.has_initial = true;
  p.where = "candidate";
  const auto [size, reach, typical] = SizeOfError(card, names, e, sizes);
  p.initial = factor ? null * (1 + typical) : null + typical * size;
  p.lower = factor ? std::min(0.1 * null, 10 * null) : card.unit == "s" ? 0 : null - size;
  p.upper = factor ? std::max(0.1 * null, 10 * null) : null + reach * size;
  if (card.unit == "1" && !factor) {  // of a clock, whose card has its bounds
    p.lower = std::max(p.lower, card.lower), p.upper = std::min(p.upper, card.upper);
  }
  h.extra.push_back(p);
  h.null.push_back(null);
}

}  // namespace

bool IsOfClock(const EffectInfo& effect) { return effect.params.front().name == "skew"; }

Hypothesis MeasurementCandidate(const EffectInfo& effect, const std::vector<std::string>& names,
                                const Experiment& e, const ModelSpec& system, const Sizes& sizes) {
  const std::string where = names.empty() ? "clock" : PlaceText(Place::kSensor, names);
  Hypothesis h{std::string(effect.name), "", where, system, {}, {}, "", {}};
  for (const Param& card : effect.params) {
    if (!std::isnan(card.null)) AddParameter(card, names, e, sizes, h);
  }
  return h;
}

std::vector<std::string> OutputsFor(const EffectInfo& effect, const std::string& globs,
                                    const Experiment& e, const mjModel& m) {
  std::vector<std::string> names;
  for (const UsableOutput& out : Usable(effect, globs, e, m)) names.push_back(out.name);
  return names;
}

std::vector<std::vector<std::string>> OutputsTogether(const EffectInfo& effect,
                                                      const std::string& globs, const Experiment& e,
                                                      const mjModel& m) {
  std::map<std::string, std::vector<std::string>> units, sensors;
  std::vector<std::string> every;
  for (const UsableOutput& out : Usable(effect, globs, e, m)) {
    every.push_back(out.name);
    units[out.unit].push_back(out.name), sensors[out.sensor].push_back(out.name);
  }
  std::vector<std::vector<std::string>> all;
  const auto add = [&](const std::vector<std::string>& names) {
    if (!names.empty() && std::find(all.begin(), all.end(), names) == all.end())
      all.push_back(names);
  };
  if (effect.params.front().name == "delay") add(every);
  for (const auto& [unit, names] : units) add(names);
  for (const auto& [sensor, names] : sensors) add(names);
  for (const auto& name : every) add({name});
  return all;
}

}  // namespace continuum
