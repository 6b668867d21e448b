#include "sim/units.h"

#include <cmath>
#include <map>
#include <numbers>

#include "error.h"

namespace continuum {
namespace {

double Simple(const std::string& name, const std::string& unit, const std::string& where) {
  static const std::map<std::string, double> si{{"1", 1},
                                                {"rad", 1},
                                                {"m", 1},
                                                {"s", 1},
                                                {"kg", 1},
                                                {"N", 1},
                                                {"Nm", 1},
                                                {"Pa", 1},
                                                {"V", 1},
                                                {"A", 1},
                                                {"Hz", 1},
                                                {"J", 1},
                                                {"W", 1},
                                                {"deg", std::numbers::pi / 180},
                                                {"mrad", 1e-3},
                                                {"mm", 1e-3},
                                                {"cm", 1e-2},
                                                {"um", 1e-6},
                                                {"ms", 1e-3},
                                                {"us", 1e-6},
                                                {"min", 60},
                                                {"g", 1e-3},
                                                {"mN", 1e-3},
                                                {"kN", 1e3},
                                                {"mNm", 1e-3},
                                                {"Nmm", 1e-3},
                                                {"kPa", 1e3},
                                                {"MPa", 1e6},
                                                {"mbar", 100},
                                                {"bar", 1e5},
                                                {"mV", 1e-3},
                                                {"mA", 1e-3},
                                                {"rpm", std::numbers::pi / 30},
                                                {"%", 0.01},
                                                {"step", 1}};
  const auto found = si.find(name);
  if (found != si.end()) return found->second;
  std::string all;
  for (const auto& [known, factor] : si) all += (all.empty() ? "" : " ") + known;
  throw Error::Input(where, "a unit made of " + all, "'" + unit + "'");
}

}  // namespace

double UnitFactor(const std::string& unit, const std::string& where) {
  double factor = 1, sign = 1;
  for (std::size_t i = 0; i <= unit.size();) {
    const std::size_t end = std::min(unit.find_first_of("*/", i), unit.size());
    std::string name = unit.substr(i, end - i);
    double power = 1;
    if (const std::size_t caret = name.find('^'); caret != name.npos) {
      const std::string digits = name.substr(caret + 1);
      if (digits.size() != 1 || digits[0] < '1' || digits[0] > '9') Simple(name, unit, where);
      power = digits[0] - '0';
      name.resize(caret);
    }
    factor *= std::pow(Simple(name, unit, where), sign * power);
    if (end < unit.size()) sign = unit[end] == '/' ? -1 : 1;
    i = end + 1;
  }
  return factor;
}

}  // namespace continuum
