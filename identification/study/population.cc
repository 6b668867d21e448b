#include "identification/study/population.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>
#include <utility>

namespace continuum {
namespace {

constexpr std::size_t kFewest = 3;  // units: with two, neither is the odd one
constexpr double kHalf = 1.96;      // half a 95 % interval, over the standard error

std::optional<UnitValue> ValueOf(const RowParameter& p) {
  const double error = (p.high - p.low) / (2 * kHalf);
  if (p.at_bound || !std::isfinite(p.value) || !std::isfinite(error) || error <= 0)
    return std::nullopt;
  return UnitValue{p.value, error};
}

// Without the spread.
std::vector<Population> Gathered(const std::vector<StudyLine>& lines) {
  std::vector<Population> all;
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> place;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    if (!lines[l].status.record) continue;
    const std::filesystem::path file = lines[l].status.record->inputs.model;
    const std::string model = file.filename();
    for (const RowParameter& p : lines[l].result.parameters) {
      if (p.name.starts_with("start:")) continue;
      const auto [at, is_new] = place.try_emplace({model, p.name, p.unit}, all.size());
      if (is_new) all.push_back({model, p.name, p.unit, {}, {}, {}});
      Population& one = all[at->second];
      if (ValueOf(p)) one.units.push_back({l, p, {}});
      if (!ValueOf(p)) one.left_out.push_back(l);
    }
  }
  return all;
}

}  // namespace

std::vector<Population> PopulationsOf(const std::vector<StudyLine>& lines) {
  std::vector<Population> all = Gathered(lines);
  std::erase_if(all, [](const Population& p) { return p.units.size() < kFewest; });
  for (Population& p : all) {
    std::vector<UnitValue> values;
    for (const PopulationUnit& unit : p.units) values.push_back(*ValueOf(unit.parameter));
    p.spread = FitRandomEffects(values);
    const auto deviations = DeviationsOf(values);
    for (std::size_t i = 0; i < p.units.size(); ++i) p.units[i].deviation = deviations[i];
  }
  return all;
}

std::vector<std::string> OddUnits(const Population& population,
                                  const std::vector<StudyLine>& lines) {
  std::vector<std::string> names;
  for (const PopulationUnit& unit : population.units) {
    if (unit.deviation.odd) names.push_back(lines[unit.line].row->name);
  }
  return names;
}

}  // namespace continuum
