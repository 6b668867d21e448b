#include "identification/candidates/measurement_candidates.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "binding/config.h"
#include "error.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/parameter_size.h"
#include "sim/experiment/measurement_model.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

// How far the measured values of some outputs reach [their unit].
double OutputSize(const Experiment& e, const std::vector<std::string>& columns) {
  double lower = kInfinity, upper = -kInfinity;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const bool wanted =
        std::find(columns.begin(), columns.end(), e.channels[c].name) != columns.end();
    for (const Log& log : e.logs) {
      for (const double y : log.measured[c]) {
        if (!wanted || std::isnan(y)) continue;
        lower = std::min(lower, y / e.channels[c].factor);
        upper = std::max(upper, y / e.channels[c].factor);
      }
    }
  }
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

// An effect of the measurement on some outputs (or on the clock): nothing of the model changes.
Hypothesis MeasureCandidate(const EffectInfo& effect, const std::string& target,
                            const std::vector<std::string>& names, const Experiment& e,
                            const ModelSpec& system, const Sizes& sizes) {
  const std::string where = names.empty() ? "clock" : PlaceText(Place::kSensor, names);
  Hypothesis h{std::string(effect.name), "", where, system, {}, {}, "", {}};
  const Param& card = effect.params.front();
  const std::string name(card.name);
  const auto [size, reach, typical] = SizeOfError(card, names, e, sizes);
  Parameter p;
  p.name = name;
  p.target = target, p.attribute = name;
  p.has_initial = true;
  p.where = "candidate";
  const double null = MeasurementValue(e, target, name);
  const bool factor = card.null == 1, late = card.unit == "s";
  p.initial = null + typical * size;
  p.upper = null + (factor ? 9 * std::abs(null) : reach * size);
  p.lower = factor ? 0.1 * null : late ? 0 : null - size;
  h.extra.push_back(p);
  h.null.push_back(null);
  return h;
}

// Outputs that one cause may act on alike: all of a unit, those of each sensor among them, each
// alone; late ones also all of any unit, as the input is. turned: those of sensors with three
// components.
std::vector<std::vector<std::string>> OutputsTogether(const Experiment& e, const mjModel& m,
                                                      const std::string& glob, bool turned,
                                                      bool late) {
  std::map<std::string, std::vector<std::string>> units, sensors;
  std::vector<std::string> every;
  for (const Output& out : e.outputs) {
    if (out.kind != Output::Kind::kSensor || out.weight == 0 || out.quaternion()) continue;
    const std::string sensor = out.source.substr(0, out.source.find('['));
    if (!GlobMatches(glob, sensor) && !GlobMatches(glob, out.name())) continue;
    const int id = mj_name2id(&m, mjOBJ_SENSOR, sensor.c_str());
    if (turned && (id < 0 || m.sensor_dim[id] != 3)) continue;
    const std::string& name = turned ? sensor : out.name();
    if (std::find(every.begin(), every.end(), name) != every.end()) continue;
    every.push_back(name), units[out.unit].push_back(name), sensors[sensor].push_back(name);
  }
  std::vector<std::vector<std::string>> all;
  const auto add = [&](const std::vector<std::string>& names) {
    if (!names.empty() && std::find(all.begin(), all.end(), names) == all.end())
      all.push_back(names);
  };
  if (late) add(every);
  for (const auto& [unit, names] : units) add(names);
  for (const auto& [sensor, names] : sensors) add(names);
  for (const auto& name : every) add({name});
  return all;
}

}  // namespace

std::vector<Hypothesis> MeasurementCandidates(const EffectInfo& effect, const Candidate& wanted,
                                              const Experiment& e, const ModelSpec& system,
                                              const Sizes& sizes) {
  const std::string_view name = effect.params.front().name;
  if (name == "skew") return {MeasureCandidate(effect, "time", {}, e, system, sizes)};
  const std::string glob =
      wanted.where.empty() ? "*" : wanted.where.substr(wanted.where.find(':') + 1);
  std::vector<Hypothesis> all;
  for (const auto& names :
       OutputsTogether(e, system.model(), glob, name == "angle", name == "delay"))
    all.push_back(MeasureCandidate(effect, "sensor:" + GlobsOf(names), names, e, system, sizes));
  return all;
}

}  // namespace continuum
