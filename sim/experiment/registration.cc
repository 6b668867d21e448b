#include "sim/experiment/registration.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

// "rotation[1]" → rotation, 1.
std::pair<std::string, int> Split(const std::string& attribute) {
  const std::size_t open = attribute.rfind('[');
  int index = -1;
  if (open != attribute.npos && attribute.ends_with(']'))
    std::from_chars(attribute.data() + open + 1, attribute.data() + attribute.size() - 1, index);
  return {attribute.substr(0, open), index};
}

}  // namespace

Registration::Vector OffsetOf(const Registration& r, const std::string& source) {
  auto found = r.offset.find(source.substr(0, source.find('[')));
  if (found == r.offset.end()) found = r.offset.find("");
  return found == r.offset.end() ? Registration::Vector{} : found->second;
}

bool IsRegistration(const std::string& attribute) {
  if (attribute == "clock_shift") return true;
  const auto [name, index] = Split(attribute);
  return index >= 0 && index < 3 &&
         (name == "rotation" || name == "translation" || name.starts_with("marker:"));
}

double& RegistrationValue(Registration& r, const std::string& attribute) {
  if (!IsRegistration(attribute)) {
    throw Error::Input("registration",
                       "rotation[i], translation[i], marker:SENSOR[i] (i = 0, 1, 2) or clock_shift",
                       "'" + attribute + "'");
  }
  if (attribute == "clock_shift") return r.clock_shift;
  const auto [name, index] = Split(attribute);
  if (name == "rotation") return r.rotation[index];
  if (name == "translation") return r.translation[index];
  const std::string sensor = name.substr(name.find(':') + 1);
  return r.offset.try_emplace(sensor, OffsetOf(r, sensor)).first->second[index];
}

nlohmann::json RegistrationJson(const Registration& r) {
  nlohmann::json json;
  const char* const how[] = {"a parameter", "known", "estimated from the train logs"};
  const auto quantity = [](const auto& value, const char* unit) {
    return nlohmann::json{{"value", value}, {"unit", unit}};
  };
  if (r.has_frame()) {
    json["frame"] = {{"rotation", quantity(r.rotation, "rad")},
                     {"translation", quantity(r.translation, "m")},
                     {"source", how[static_cast<int>(r.frame)]}};
  }
  if (r.has_marker()) {
    for (const auto& [sensor, offset] : r.offset)
      json["marker"]["offset"][sensor.empty() ? "*" : sensor] = quantity(offset, "m");
    json["marker"]["source"] = how[static_cast<int>(r.marker)];
  }
  if (r.has_clock()) {
    json["clock_shift"] = quantity(r.clock_shift, "s");
    json["clock_shift"]["source"] = how[static_cast<int>(r.clock)];
  }
  return json;
}

std::vector<std::string> RegistrationLines(const Registration& r) {
  const char* const how[] = {"a parameter", "known", "estimated from the train logs"};
  const auto list = [](const Registration::Vector& v) {
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v[0], v[1], v[2]);
  };
  std::vector<std::string> lines;
  if (r.has_frame()) {
    lines.push_back(fmt::format("frame: rotation {} rad, translation {} m ({})", list(r.rotation),
                                list(r.translation), how[static_cast<int>(r.frame)]));
  }
  for (const auto& [sensor, offset] : r.offset) {
    lines.push_back(fmt::format("marker{}: offset {} m ({})", sensor.empty() ? "" : " of " + sensor,
                                list(offset), how[static_cast<int>(r.marker)]));
  }
  if (r.has_clock()) {
    lines.push_back(
        fmt::format("clock shift: {:.6g} s ({})", r.clock_shift, how[static_cast<int>(r.clock)]));
  }
  return lines;
}

std::string RegistrationYaml(const Registration& r) {
  const auto list = [](const Registration::Vector& v) {
    return "[" + Decimal(v[0]) + ", " + Decimal(v[1]) + ", " + Decimal(v[2]) + "]";
  };
  std::string parts;
  const auto add = [&](const std::string& part) { parts += (parts.empty() ? "" : ", ") + part; };
  if (r.has_frame()) {
    add("frame: {rotation: " + list(r.rotation) + ", translation: " + list(r.translation) + "}");
  }
  if (r.has_marker()) {
    std::string offsets;
    for (const auto& [sensor, offset] : r.offset) {
      if (!sensor.empty())
        offsets +=
            (offsets.empty() ? "" : ", ") + std::string("\"") + sensor + "\": " + list(offset);
    }
    const bool all = r.offset.size() == 1 && offsets.empty();
    add("marker: " + (all ? list(r.offset.begin()->second) : "{" + offsets + "}"));
  }
  if (r.has_clock()) add("clock_shift: " + Decimal(r.clock_shift));
  return parts.empty() ? "" : "registration: {" + parts + "}\n";
}

}  // namespace continuum
