#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "error.h"
#include "models/annelida/releases.h"
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
  CLI::App app{"Writes the logs of the snake arm's demo, or of its identification"};
  app.add_option("--parameters", parameters, "annelida.yaml")->capture_default_str();
  app.add_option("--out", out, "folder for the logs")->capture_default_str();
  app.add_option("--releases", releases,
                 "folder for logs and experiment of the paper's identification instead");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const AnnelidaParameters p = ReadAnnelida(parameters);
  if (releases.empty()) {
    WriteLogs(RecordDemo(p), out);
    return 0;
  }
  WriteLogs(RecordReleases(p), releases);
  WriteFile(releases / "experiment.yaml", ReleasesExperiment(folder / "annelida.xml"));
  return 0;
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) {
  try {
    return continuum::Main(argc, argv);
  } catch (const continuum::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
