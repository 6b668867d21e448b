#include "sim/io/units.h"

#include <cmath>
#include <map>
#include <numbers>

#include "error.h"

namespace continuum {
namespace {

constexpr double kPi = std::numbers::pi;

const std::map<std::string, Unit>& Units() {
  static const std::map<std::string, Unit> units = [] {
    using Dimension = std::array<int, 4>;
    const Dimension length{1, 0, 0, 0}, mass{0, 1, 0, 0}, time{0, 0, 1, 0}, rate{0, 0, -1, 0},
        force{1, 1, -2, 0}, energy{2, 1, -2, 0}, power{2, 1, -3, 0}, pressure{-1, 1, -2, 0},
        voltage{2, 1, -3, -1}, current{0, 0, 0, 1};
    std::map<std::string, Unit> all{{"1", {1}}, {"%", {0.01}}, {"step", {1}}};
    const auto add = [&](const Dimension& d, const std::map<std::string, double>& factors) {
      for (const auto& [name, factor] : factors) all[name] = {factor, d, false};
    };
    add({}, {{"rad", 1}, {"mrad", 1e-3}, {"deg", kPi / 180}});
    add(length, {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}});
    add(mass, {{"kg", 1}, {"g", 1e-3}});
    add(time, {{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"min", 60}});
    add(rate, {{"Hz", 1}, {"rpm", kPi / 30}});
    add(force, {{"N", 1}, {"mN", 1e-3}, {"kN", 1e3}});
    add(energy, {{"Nm", 1}, {"mNm", 1e-3}, {"Nmm", 1e-3}, {"J", 1}});
    add(power, {{"W", 1}});
    add(pressure,
        {{"Pa", 1}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}, {"mbar", 100}, {"bar", 1e5}});
    add(voltage, {{"V", 1}, {"mV", 1e-3}});
    add(current, {{"A", 1}, {"mA", 1e-3}});
    return all;
  }();
  return units;
}

const Unit& Simple(const std::string& name, const std::string& unit, const std::string& where) {
  const auto found = Units().find(name);
  if (found != Units().end()) return found->second;
  std::string all;
  for (const auto& [known, value] : Units()) all += (all.empty() ? "" : " ") + known;
  throw Error::Input(where, "a unit made of " + all, "'" + unit + "'");
}

}  // namespace

std::vector<UnitFactorPower> FactorsOf(const std::string& unit) {
  std::vector<UnitFactorPower> all;
  int sign = 1;
  for (std::size_t i = 0; i <= unit.size();) {
    const std::size_t end = std::min(unit.find_first_of("*/", i), unit.size());
    std::string name = unit.substr(i, end - i);
    int power = sign;
    const std::size_t caret = name.find('^');
    if (caret != name.npos && caret + 2 == name.size() && name[caret + 1] >= '1' &&
        name[caret + 1] <= '9') {
      power *= name[caret + 1] - '0';
      name.resize(caret);
    }
    all.push_back({std::move(name), power});
    if (end < unit.size()) sign = unit[end] == '/' ? -1 : 1;
    i = end + 1;
  }
  return all;
}

Unit ParseUnit(const std::string& unit, const std::string& where) {
  Unit product;
  for (const auto& [name, power] : FactorsOf(unit)) {
    const Unit& part = Simple(name, unit, where);
    product.factor *= std::pow(part.factor, power);
    for (std::size_t d = 0; d < product.dimension.size(); ++d)
      product.dimension[d] += power * part.dimension[d];
    product.any &= part.any;
  }
  return product;
}

double UnitFactor(const std::string& unit, const std::string& where) {
  return ParseUnit(unit, where).factor;
}

void RequireUnitLike(const std::string& expected, const std::string& unit,
                     const std::string& where) {
  const Unit found = ParseUnit(unit, where);
  if (found.any || found.dimension == ParseUnit(expected, "").dimension) return;
  throw Error::Input(where, "a unit like '" + expected + "'", "'" + unit + "'");
}

}  // namespace continuum
