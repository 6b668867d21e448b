#include "models/make.h"

#include <algorithm>
#include <functional>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "error.h"
#include "models/annelida/annelida.h"
#include "models/annelida/pipe.h"
#include "models/mjcf/tendon_arm.h"
#include "models/spa/chain.h"
#include "models/spa/parameters.h"
#include "models/stiff_flop/mjcf.h"
#include "models/tdcr/mjcf.h"
#include "models/twin_pivot/mjcf.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using Variants =
    std::map<std::string, std::function<std::string(const fs::path&, const MakeLayout&)>>;

std::string Rod(const fs::path& file, tdcr::Guides guides,
                tdcr::Loaded loaded = tdcr::Loaded::kTip) {
  constexpr int kLinksPerDisk = 5, kLinks = 45;  // at least
  const tdcr::Robot robot = tdcr::ReadRobot(Yaml::Read(file));
  const int per_disk = std::max(kLinksPerDisk, (kLinks + robot.disks - 1) / robot.disks);
  return tdcr::RobotMjcf(robot, per_disk * robot.disks, guides,
                         robot.has_sections() ? file.filename().string() : "tdcr.yaml", loaded);
}

std::string Module(const fs::path& file, stiff_flop::Threads threads) {
  return stiff_flop::ModuleMjcf(stiff_flop::Robot::Read(file), threads);
}

std::string Spa(const fs::path& file, SpaLayout layout, const MakeLayout& asked) {
  layout.series = asked.series.value_or(layout.series);
  layout.row = asked.rows.value_or(layout.row);
  layout.links = asked.links.value_or(layout.links);
  layout.standing = asked.standing;
  return SpaMjcf(ReadSpa(file), layout);
}

void RefuseLayout(const std::string& file, const MakeLayout& layout) {
  for (const auto& [option, given] :
       {std::pair("--series", layout.series.has_value()),
        std::pair("--rows", layout.rows.has_value()),
        std::pair("--links", layout.links.has_value()), std::pair("--standing", layout.standing)}) {
    if (given) throw Error::Input(option, "a description with robot: spa", "'" + file + "'");
  }
}

const std::map<std::string, Variants>& Robots() {
  using stiff_flop::Threads, tdcr::Guides;
  static const std::map<std::string, Variants> robots{
      {"annelida",
       {{"", [](const auto& file, const auto&) { return AnnelidaMjcf(ReadAnnelida(file)); }},
        {"pipe",
         [](const auto& file, const auto&) { return AnnelidaInPipeMjcf(ReadAnnelida(file)); }}}},
      {"tdcr",
       {{"", [](const auto& file, const auto&) { return Rod(file, Guides::kLinks); }},
        {"disks", [](const auto& file, const auto&) { return Rod(file, Guides::kDisks); }},
        {"loads", [](const auto& file,
                     const auto&) { return Rod(file, Guides::kLinks, tdcr::Loaded::kDisks); }}}},
      {"twin_pivot",
       {{"", [](const auto& file,
                const auto&) { return twin_pivot::RobotMjcf(twin_pivot::Robot::Read(file)); }}}},
      {"stiff_flop",
       {{"", [](const auto& file, const auto&) { return Module(file, Threads::kRings); }},
        {"braid", [](const auto& file, const auto&) { return Module(file, Threads::kBraid); }}}},
      {"spa",
       {{"", [](const auto& file, const auto& asked) { return Spa(file, {}, asked); }},
        {"free",
         [](const auto& file, const auto& asked) { return Spa(file, {.evenness = 1}, asked); }},
        {"series",
         [](const auto& file, const auto& asked) { return Spa(file, {.series = 2}, asked); }}}}};
  return robots;
}

template <class Map>
std::string Names(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name.empty() ? "none" : name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const Variants& VariantsOf(const Yaml& robot) {
  static const Variants arm{
      {"", [](const auto& file, const auto&) { return TendonArmMjcf(ReadTendonArm(file)); }}};
  if (robot.Has("segments")) return arm;
  const Yaml kind =
      robot.Has("robot") || !robot.Has("model") ? robot.At("robot") : robot.At("model");
  const auto found = Robots().find(kind.Text());
  if (found != Robots().end()) return found->second;
  throw Error::Input(kind.Where(), Names(Robots()) + ", or an arm with the key 'segments'",
                     "'" + kind.Text() + "'");
}

}  // namespace

std::string MakeMjcf(const fs::path& robot, const std::string& variant, const MakeLayout& layout) {
  const Yaml description = Yaml::Read(robot);
  const Variants& variants = VariantsOf(description);
  if (&variants != &Robots().at("spa")) RefuseLayout(robot.string(), layout);
  const auto found = variants.find(variant);
  if (found != variants.end()) return found->second(robot, layout);
  throw Error::Input("variant", Names(variants), "'" + variant + "'");
}

}  // namespace continuum
