#include <filesystem>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "error.h"
#include "models/annelida/demo.h"
#include "sim/file.h"

namespace continuum {
namespace {

int Main(int argc, char** argv) {
  const std::filesystem::path folder = CONTINUUM_ANNELIDA_FOLDER;
  std::filesystem::path parameters = folder / "annelida.yaml", out = folder / "demo";
  CLI::App app{"Writes the logs of the snake arm's demo"};
  app.add_option("--parameters", parameters, "annelida.yaml")->capture_default_str();
  app.add_option("--out", out, "folder for the logs")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  MakeFolder(out);
  for (const DemoLog& log : RecordDemo(ReadAnnelida(parameters)))
    WriteFile(out / log.file, log.csv);
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
