#include "identification/report/derivative_table.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace continuum {
namespace {

using Way = Derivative::Way;

const char* InWords(Way way) {
  switch (way) {
    case Way::kClosedForm:
      return "closed form";
    case Way::kSingleSteps:
      return "single steps";
    case Way::kSingleRates:
      return "single rates";
    case Way::kMeasurement:
      return "same motion";
    case Way::kDifferences:
      return "by differences";
  }
  return "";
}

// What differs of a model reads as its name in mjModel.
std::string WhyInWords(const Derivative& made) {
  return made.way == Way::kSingleSteps ? made.why + " differs" : made.why;
}

// Each kind once, with the logs that have it.
std::vector<std::pair<Derivative, std::vector<std::string>>> KindsOf(
    const std::vector<Derivative>& made, const std::vector<std::string>& logs) {
  std::vector<std::pair<Derivative, std::vector<std::string>>> kinds;
  for (std::size_t l = 0; l < made.size(); ++l) {
    auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == made[l]; });
    if (kind == kinds.end()) kind = kinds.insert(kinds.end(), {made[l], {}});
    kind->second.push_back(logs[l]);
  }
  return kinds;
}

}  // namespace

std::string DerivativesInWords(const Derivatives& all) {
  std::size_t width = std::string("parameter").size();
  for (const std::string& name : all.parameters) width = std::max(width, name.size());
  const auto line = [&](const std::string& name, const std::string& way, const std::string& why) {
    std::string text = fmt::format("{:<{}}  {:<14}  {}", name, width, way, why);
    return text.erase(text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string table = all.path + "\n" + line("parameter", "derivative", "why");
  for (std::size_t k = 0; k < all.parameters.size(); ++k) {
    const auto kinds = KindsOf(all.made[k], all.logs);
    for (const auto& [made, logs] : kinds) {
      const std::string of = kinds.size() == 1 ? "" : fmt::format(" [{}]", fmt::join(logs, ", "));
      table += line(all.parameters[k], InWords(made.way), WhyInWords(made) + of);
    }
  }
  return table;
}

}  // namespace continuum
