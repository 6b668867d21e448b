#include "sim/io/unit_names.h"

#include <array>
#include <map>
#include <numbers>
#include <string>

namespace continuum {
namespace {

constexpr double kPi = std::numbers::pi;

struct Prefix {
  std::string_view symbol, name;
  double factor;
};
// µ is written with either of two characters.
constexpr std::array<Prefix, 15> kPrefixes{{{"da", "deca", 1e1},
                                            {"f", "femto", 1e-15},
                                            {"p", "pico", 1e-12},
                                            {"n", "nano", 1e-9},
                                            {"u", "micro", 1e-6},
                                            {"\u00B5", "micro", 1e-6},
                                            {"\u03BC", "micro", 1e-6},
                                            {"m", "milli", 1e-3},
                                            {"c", "centi", 1e-2},
                                            {"d", "deci", 1e-1},
                                            {"h", "hecto", 1e2},
                                            {"k", "kilo", 1e3},
                                            {"M", "mega", 1e6},
                                            {"G", "giga", 1e9},
                                            {"T", "tera", 1e12}}};

using Dimension = std::array<int, 4>;
using Names = std::map<std::string, Unit, std::less<>>;

constexpr Dimension kLength{1, 0, 0, 0}, kMass{0, 1, 0, 0}, kTime{0, 0, 1, 0}, kRate{0, 0, -1, 0},
    kForce{1, 1, -2, 0}, kEnergy{2, 1, -2, 0}, kPower{2, 1, -3, 0}, kPressure{-1, 1, -2, 0},
    kVoltage{2, 1, -3, -1}, kCurrent{0, 0, 0, 1}, kResistance{2, 1, -3, -2}, kAngle{},
    kSpeed{1, 0, -1, 0}, kAcceleration{1, 0, -2, 0};

void Add(Names& all, const Dimension& d, const std::map<std::string, double>& factors) {
  for (const auto& [name, factor] : factors) all[name] = {factor, d, false};
}

// Symbols that take a prefix's symbol.
const Names& Symbols() {
  static const Names symbols = [] {
    Names all;
    Add(all, kAngle, {{"rad", 1}});
    Add(all, kLength, {{"m", 1}});
    Add(all, kMass, {{"g", 1e-3}});
    Add(all, kTime, {{"s", 1}});
    Add(all, kRate, {{"Hz", 1}});
    Add(all, kForce, {{"N", 1}});
    Add(all, kEnergy, {{"J", 1}, {"Nm", 1}, {"Nmm", 1e-3}, {"Ncm", 1e-2}});
    Add(all, kPower, {{"W", 1}});
    Add(all, kPressure, {{"Pa", 1}, {"bar", 1e5}});
    Add(all, kVoltage, {{"V", 1}});
    Add(all, kCurrent, {{"A", 1}});
    Add(all, kResistance, {{"ohm", 1}, {"\u03A9", 1}, {"\u2126", 1}});
    return all;
  }();
  return symbols;
}

// Names that take a prefix's name, and an s at their end.
const Names& Words() {
  static const Names words = [] {
    Names all;
    Add(all, kAngle, {{"radian", 1}});
    Add(all, kLength, {{"meter", 1}, {"metre", 1}});
    Add(all, kMass, {{"gram", 1e-3}});
    Add(all, kTime, {{"second", 1}});
    Add(all, kRate, {{"hertz", 1}});
    Add(all, kForce, {{"newton", 1}});
    Add(all, kEnergy, {{"joule", 1}});
    Add(all, kPower, {{"watt", 1}});
    Add(all, kPressure, {{"pascal", 1}});
    Add(all, kVoltage, {{"volt", 1}});
    Add(all, kCurrent, {{"ampere", 1}, {"amp", 1}});
    return all;
  }();
  return words;
}

// What takes no prefix.
const Names& Others() {
  static const Names others = [] {
    Names all{{"1", {1}},     {"%", {0.01}},  {"percent", {0.01}}, {"step", {1}},
              {"steps", {1}}, {"count", {1}}, {"counts", {1}},     {"ppm", {1e-6}}};
    const double degree = kPi / 180, pound_force = 4.4482216152605, gravity = 9.80665;
    for (const char* name : {"deg", "degree", "degrees", "arc_degree", "arcdeg", "\u00B0"})
      all[name] = {degree, kAngle, false};
    for (const char* name :
         {"rev", "revolution", "revolutions", "turn", "turns", "cycle", "cycles"})
      all[name] = {2 * kPi, kAngle, false};
    Add(all, kAngle,
        {{"arcmin", degree / 60},
         {"arc_minute", degree / 60},
         {"arcsec", degree / 3600},
         {"arc_second", degree / 3600},
         {"gon", 0.9 * degree},
         {"grad", 0.9 * degree},
         {"grade", 0.9 * degree}});
    Add(all, kRate, {{"rpm", kPi / 30}, {"dps", degree}, {"mdps", 1e-3 * degree}});
    Add(all, kLength,
        {{"in", 0.0254},
         {"inch", 0.0254},
         {"inches", 0.0254},
         {"ft", 0.3048},
         {"foot", 0.3048},
         {"feet", 0.3048},
         {"micron", 1e-6},
         {"microns", 1e-6}});
    Add(all, kMass,
        {{"lb", 0.45359237},
         {"lbs", 0.45359237},
         {"pound", 0.45359237},
         {"pounds", 0.45359237},
         {"oz", 0.028349523125},
         {"tonne", 1e3}});
    Add(all, kTime,
        {{"sec", 1},
         {"secs", 1},
         {"msec", 1e-3},
         {"usec", 1e-6},
         {"nsec", 1e-9},
         {"min", 60},
         {"minute", 60},
         {"minutes", 60},
         {"h", 3600},
         {"hr", 3600},
         {"hour", 3600},
         {"hours", 3600},
         {"day", 86400},
         {"days", 86400}});
    Add(all, kSpeed, {{"kph", 1 / 3.6}, {"kmh", 1 / 3.6}});
    Add(all, kAcceleration, {{"g0", gravity}, {"gravity", gravity}, {"standard_gravity", gravity}});
    Add(all, kForce,
        {{"kgf", gravity},
         {"gf", 1e-3 * gravity},
         {"kilogram_force", gravity},
         {"lbf", pound_force},
         {"pound_force", pound_force},
         {"ozf", pound_force / 16},
         {"dyn", 1e-5},
         {"dyne", 1e-5}});
    Add(all, kPressure,
        {{"psi", 6894.757293168361},
         {"atm", 101325},
         {"torr", 101325.0 / 760},
         {"mmHg", 133.322387415},
         {"inHg", 3386.38864034},
         {"mmH2O", gravity},
         {"cmH2O", 10 * gravity}});
    return all;
  }();
  return others;
}

// The unit of a name that ends with one of these units and begins with a prefix or nothing before.
std::optional<Unit> WithPrefix(std::string_view name, const Names& units,
                               std::string_view Prefix::*spelling) {
  if (const auto plain = units.find(name); plain != units.end()) return plain->second;
  for (const Prefix& prefix : kPrefixes) {
    const std::string_view begin = prefix.*spelling;
    if (!name.starts_with(begin)) continue;
    const auto found = units.find(name.substr(begin.size()));
    if (found == units.end()) continue;
    Unit unit = found->second;
    unit.factor *= prefix.factor;
    return unit;
  }
  return {};
}

}  // namespace

std::optional<Unit> UnitNamed(std::string_view name) {
  if (const auto found = Others().find(name); found != Others().end()) return found->second;
  if (const auto unit = WithPrefix(name, Symbols(), &Prefix::symbol)) return unit;
  if (const auto unit = WithPrefix(name, Words(), &Prefix::name)) return unit;
  if (!name.ends_with('s')) return {};
  return WithPrefix(name.substr(0, name.size() - 1), Words(), &Prefix::name);
}

}  // namespace continuum
