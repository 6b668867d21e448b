#include "sim/experiment/measurement_model.h"

#include <map>

#include "binding/config.h"
#include "error.h"
#include "sim/experiment/registration.h"

namespace continuum {
namespace {

constexpr std::string_view kSensor = "sensor:";

// Corrections of a reading for its eccentricity; each makes the error less than a tenth, as an
// encoder is off its axis by less than that.
constexpr int kEccentric = 12;

using Member = double Measurement::*;
const std::map<std::string, Member, std::less<>>& Members() {
  static const std::map<std::string, Member, std::less<>> members{
      {"bias", &Measurement::bias},   {"scale", &Measurement::scale},
      {"delay", &Measurement::delay}, {"rate", &Measurement::rate},
      {"angle", &Measurement::angle}, {"cosine", &Measurement::cosine},
      {"sine", &Measurement::sine},   {"harmonic", &Measurement::harmonic}};
  return members;
}

// globs: one or several, separated by spaces; or the name of one, spaces and all.
bool Matches(const Output& out, const std::string& globs) {
  if (globs == out.name() || globs == out.source) return true;
  const std::string sensor = out.source.substr(0, out.source.find('['));
  return AnyGlobMatches(globs, out.source) || AnyGlobMatches(globs, sensor) ||
         AnyGlobMatches(globs, out.name());
}

std::vector<std::size_t> OutputsOf(const Experiment& e, const std::string& target) {
  const std::string glob = target.substr(kSensor.size());
  std::vector<std::size_t> found;
  std::string all;
  for (std::size_t o = 0; o < e.outputs.size(); ++o) {
    if (Matches(e.outputs[o], glob)) found.push_back(o);
    all += (o ? ", " : "") + e.outputs[o].name();
  }
  if (found.empty()) throw Error::Input(target, "one of the outputs " + all, "no match");
  return found;
}

double& ValueOf(Experiment& e, std::size_t output, const std::string& attribute) {
  return e.outputs[output].measurement.*Members().find(attribute)->second;
}

}  // namespace

bool IsMeasurement(const std::string& target, const std::string& attribute) {
  if (target == "time") return attribute == "skew";
  if (target == "registration") return IsRegistration(attribute);
  return target.starts_with(kSensor) && Members().contains(attribute);
}

double MeasurementValue(const Experiment& e, const std::string& target,
                        const std::string& attribute) {
  if (target == "time") return e.skew;
  if (target == "registration") {
    Registration present = e.registration;
    return RegistrationValue(present, attribute);
  }
  return e.outputs[OutputsOf(e, target).front()].measurement.*Members().find(attribute)->second;
}

void ApplyMeasurement(Experiment& e, const Change& change) {
  if (change.target == "time") {
    e.skew = Changed(e.skew, change);
    return;
  }
  if (change.target == "registration") {
    double& value = RegistrationValue(e.registration, change.attribute);
    value = Changed(value, change);
    return;
  }
  for (const std::size_t o : OutputsOf(e, change.target)) {
    double& value = ValueOf(e, o, change.attribute);
    value = Changed(value, change);
  }
}

std::vector<Change> SettingsOfModel(const Log& log) {
  std::vector<Change> settings;
  for (const Change& c : log.set)
    if (!IsMeasurement(c.target, c.attribute)) settings.push_back(c);
  return settings;
}

Experiment WithoutLogs(const Experiment& e) {
  Experiment setup = e;
  setup.logs.clear();
  return setup;
}

Experiment MeasuredIn(const Experiment& e, const Log& log) {
  Experiment measured = e;
  for (const Change& c : log.set)
    if (IsMeasurement(c.target, c.attribute)) ApplyMeasurement(measured, c);
  return measured;
}

std::string MeasurementUnit(const Experiment& e, const std::string& target,
                            const std::string& attribute) {
  if (target == "registration")
    return attribute == "clock_shift" ? "s" : attribute.starts_with("rotation") ? "rad" : "m";
  if (attribute == "scale" || attribute == "skew") return "1";
  if (attribute == "delay") return "s";
  if (attribute == "angle") return "rad";
  std::string unit;
  for (const std::size_t o : OutputsOf(e, target)) {
    if (!unit.empty() && unit != e.outputs[o].unit) return "1";
    unit = e.outputs[o].unit;
  }
  if (attribute == "harmonic") return "1/" + unit;
  return attribute == "rate" ? unit + "/s" : unit;
}

double SignalOf(const Experiment& e, const Log& log, std::size_t channel, std::size_t row) {
  const Experiment::Channel& c = e.channels[channel];
  const Measurement& how = e.outputs[c.output].measurement;
  const double drift = how.rate * (log.time[row] - log.Begin());
  const double reading = (log.measured[channel][row] / c.factor - how.bias - drift) / how.scale;
  double y = reading;
  for (int k = 0; k < kEccentric && (how.cosine != 0 || how.sine != 0); ++k)
    y = reading - how.Eccentricity(y);
  return c.factor * y;
}

std::vector<double> SignalsOf(const Experiment& e, const Log& log, std::size_t channel) {
  std::vector<double> signals;
  for (std::size_t row = 0; row < log.rows(); ++row)
    signals.push_back(SignalOf(e, log, channel, row));
  return signals;
}

}  // namespace continuum
