#include <filesystem>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "models/annelida/annelida.h"
#include "models/mjcf/tendon_arm.h"
#include "models/spa/chain.h"
#include "models/spa/parameters.h"
#include "models/stiff_flop/mjcf.h"
#include "models/tdcr/mjcf.h"
#include "models/tool_main.h"
#include "models/twin_pivot/mjcf.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

using Generator = std::function<std::string(const std::filesystem::path&)>;

std::string Segment(const std::filesystem::path& file, tdcr::Guides guides) {
  constexpr int kLinksPerDisk = 5;
  const tdcr::Robot robot = tdcr::ReadRobot(Yaml::Read(file));
  return tdcr::SegmentMjcf(robot, kLinksPerDisk * robot.disks, guides);
}

int Main(int argc, char** argv) {
  const Generator tendon_arm = [](const auto& file) { return TendonArmMjcf(ReadTendonArm(file)); };
  const std::map<std::string, Generator> robots{
      {"annelida", [](const auto& file) { return AnnelidaMjcf(ReadAnnelida(file)); }},
      {"trunk", tendon_arm},
      {"tdcr_three_segment", tendon_arm},
      {"tdcr", [](const auto& file) { return Segment(file, tdcr::Guides::kLinks); }},
      {"tdcr_disks", [](const auto& file) { return Segment(file, tdcr::Guides::kDisks); }},
      {"twin_pivot",
       [](const auto& file) { return twin_pivot::RobotMjcf(twin_pivot::Robot::Read(file)); }},
      {"stiff_flop",
       [](const auto& file) { return stiff_flop::ModuleMjcf(stiff_flop::Robot::Read(file)); }},
      {"stiff_flop_braid",
       [](const auto& file) {
         return stiff_flop::ModuleMjcf(stiff_flop::Robot::Read(file), stiff_flop::Threads::kBraid);
       }},
      {"spa", [](const auto& file) { return SpaMjcf(ReadSpa(file)); }},
      {"spa_free", [](const auto& file) { return SpaMjcf(ReadSpa(file), {.evenness = 1}); }},
      {"spa_series", [](const auto& file) { return SpaMjcf(ReadSpa(file), {.series = 2}); }}};

  CLI::App app{"Writes the MJCF of a robot from its parameters"};
  std::string robot, parameters, out;
  app.add_option("robot", robot, "which robot")->required()->check(CLI::IsMember(robots));
  app.add_option("parameters", parameters, "its parameters (YAML)")->required();
  app.add_option("--out", out, "the MJCF file")->required();
  return RunTool(app, argc, argv, [&] { WriteFile(out, robots.at(robot)(parameters)); });
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) { return continuum::Main(argc, argv); }
