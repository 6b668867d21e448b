#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>

#include "error.h"
#include "models/mjcf/slow_pull.h"
#include "models/tdcr/mjcf.h"
#include "models/tdcr/model.h"
#include "sim/io/csv.h"
#include "sim/io/yaml.h"

/// Prints the distances between the tips of the MJCF, pulled slowly, and of the Cosserat rod with
/// friction, as Markdown.
namespace continuum::tdcr {
namespace {

constexpr int kLinksPerDisk[] = {1, 2, 3, 5, 6};

void Print(const std::filesystem::path& file, const std::filesystem::path& table) {
  const Robot robot = ReadRobot(Yaml::Read(file));
  const auto cases = ReadCases(CsvTable::Read(table), robot);
  const auto at_disks = [](const Case& c) {
    return c.loads.disk_force.size() > 0 || c.loads.disk_moment.size() > 0;
  };
  const Loaded loaded =
      std::any_of(cases.begin(), cases.end(), at_disks) ? Loaded::kDisks : Loaded::kTip;
  const std::string name = file.filename().string();
  std::vector<ModelSpec> models;
  fmt::print("| tip off by [% L] |");
  for (const int per_disk : kLinksPerDisk) {
    const int links = per_disk * robot.disks;
    models.push_back(ModelSpec::Parse(RobotMjcf(robot, links, Guides::kLinks, name, loaded)));
    fmt::print(" {} links |", links);
  }
  const int fine = kLinksPerDisk[3] * robot.disks;
  models.push_back(ModelSpec::Parse(RobotMjcf(robot, fine, Guides::kDisks, name, loaded)));
  fmt::print(" {} links, tendons through the disks only |\n|---|", fine);
  for (std::size_t i = 0; i < models.size(); ++i) fmt::print("---|");
  fmt::print("\n");
  for (const Case& c : cases) {
    const Solution rod = SolveCase(robot, c.loads, Method::kCrtFriction);
    if (!rod.outcome.ok()) throw Error::Job(c.name + ": " + rod.outcome.why);
    fmt::print("| {} |", c.name);
    for (const ModelSpec& model : models) {
      const Eigen::Vector3d off = PulledTip(model, c.loads) - rod.disks.col(robot.disks - 1);
      fmt::print(" {:.3f} |", 100 * off.norm() / robot.length);
    }
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace continuum::tdcr

int main(int count, char** arguments) {
  try {
    if (count != 3) throw continuum::Error::Input("continuum_tdcr_pulls", "ROBOT.yaml CASES.csv");
    continuum::tdcr::Print(arguments[1], arguments[2]);
    return 0;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
