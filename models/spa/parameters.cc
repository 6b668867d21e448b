#include "models/spa/parameters.h"

#include <limits>

#include "error.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();
constexpr double kSmallest = std::numeric_limits<double>::min();

template <class Choice>
struct Option {
  const char* name;
  Choice choice;
};

template <class Choice>
Choice Choose(const Yaml& node, const Option<Choice>& first, const Option<Choice>& second) {
  const std::string text = node.Text();
  if (text == first.name) return first.choice;
  if (text == second.name) return second.choice;
  throw Error::Input(node.Where(), std::string(first.name) + " or " + second.name,
                     "'" + text + "'");
}

SpaParameters<double> Parameters(const Yaml& node) {
  node.Only({"L0", "d", "r_ch", "x_m", "y_m", "T_PT1", "A", "m", "d_theta", "d_dL", "k_theta",
             "k_theta3", "k_dL1", "k_dL3"});
  for (const auto& key : node.Keys()) {
    const Yaml entry = node.At(key);
    if (entry.IsMap()) entry.Only({"value", "unit", "uncertainty", "source"});
  }
  const auto positive = [&](const char* key) {
    return node.At(key).Parameter(kSmallest, kLargest);
  };
  const auto magnitude = [&](const char* key) { return node.At(key).Parameter(0, kLargest); };
  const auto any = [&](const char* key) { return node.At(key).Parameter(); };
  return {.L0 = positive("L0"),
          .d = positive("d"),
          .r_ch = positive("r_ch"),
          .x_m = any("x_m"),
          .y_m = any("y_m"),
          .T_PT1 = magnitude("T_PT1"),
          .A = positive("A"),
          .m = positive("m"),
          .d_theta = magnitude("d_theta"),
          .d_dL = magnitude("d_dL"),
          .k_theta = magnitude("k_theta"),
          .k_theta3 = any("k_theta3"),
          .k_dL1 = magnitude("k_dL1"),
          .k_dL3 = any("k_dL3")};
}

}  // namespace

SpaFile ReadSpa(const std::filesystem::path& file) {
  const Yaml root = Yaml::Read(file);
  root.Only({"robot", "mass", "actuation", "gravity", "parameters"});
  SpaFile spa;
  spa.options.mass =
      Choose<SpaMass>(root.At("mass"), {"centroid", SpaMass::kCentroid}, {"arc", SpaMass::kArc});
  spa.options.actuation = Choose<SpaActuation>(root.At("actuation"), {"tip", SpaActuation::kTip},
                                               {"volume", SpaActuation::kVolume});
  spa.options.gravity = {0, 0, -root.At("gravity").Parameter()};
  spa.parameters = Parameters(root.At("parameters"));
  return spa;
}

}  // namespace continuum
