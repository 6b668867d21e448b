#include <cstdint>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

#include "models/annelida/releases.h"
#include "models/tool_main.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

void WriteLogs(const std::vector<DemoLog>& logs, const std::filesystem::path& folder) {
  MakeFolder(folder);
  for (const DemoLog& log : logs) WriteFile(folder / log.file, log.csv);
}

int Main(int argc, char** argv) {
  const std::filesystem::path folder = CONTINUUM_ANNELIDA_FOLDER;
  std::filesystem::path parameters = folder / "annelida.yaml", out = folder / "demo", releases;
  std::uint64_t draw = 1;
  CLI::App app{"Writes the logs of the snake arm's demo, or of its identification"};
  app.add_option("--parameters", parameters, "annelida.yaml")->capture_default_str();
  app.add_option("--out", out, "folder for the logs")->capture_default_str();
  app.add_option("--releases", releases,
                 "folder for logs and experiment of the paper's identification instead");
  app.add_option("--draw", draw, "of the noise of these")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  return RunTool(app, argc, argv, [&] {
    const AnnelidaParameters p = ReadAnnelida(parameters);
    if (releases.empty()) {
      WriteLogs(RecordDemo(p), out);
      return;
    }
    WriteLogs(RecordReleases(p, draw), releases);
    WriteFile(releases / "experiment.yaml", ReleasesExperiment(folder / "annelida.xml"));
  });
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) { return continuum::Main(argc, argv); }
