#include <unistd.h>

#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "error.h"
#include "models/spa/logs.h"
#include "models/spa/recipe.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

void Progress(int done, int of) {
  if (isatty(STDERR_FILENO)) {
    fmt::print(stderr, "\rswarm: iteration {} of {}{}", done, of, done == of ? "\n" : "");
  } else if (done % 10 == 0) {
    fmt::print(stderr, "swarm: iteration {} of {}\n", done, of);
  }
}

int Main(int argc, char** argv) {
  CLI::App app("Identification and validation of the soft pneumatic actuator on simulated steps");
  std::string file = CONTINUUM_SPA_FILE, out, logs;
  SpaRecipe recipe;
  app.add_option("--parameters", file, "parameters of the true model")->capture_default_str();
  app.add_option("--seed", recipe.seed, "seed of noise and swarm")->capture_default_str();
  app.add_option("--cutoff", recipe.filter.cutoff, "of the zero-phase filter [Hz]")
      ->check(CLI::Range(20.0, 400.0))
      ->capture_default_str();
  app.add_option("--filter", recipe.filter.kind, "butterworth, or average as in the paper")
      ->transform(CLI::CheckedTransformer(std::map<std::string, SpaFilter::Kind>{
          {"butterworth", SpaFilter::Kind::kButterworth}, {"average", SpaFilter::Kind::kAverage}}));
  app.add_option("--out", out, "write the tables to this file instead of stdout");
  app.add_option("--logs", logs,
                 "only write steps as logs and an experiment of `continuum identify` here");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const SpaFile truth = ReadSpa(file);
  if (!logs.empty()) {
    WriteSpaLogs(truth, recipe.noise, recipe.seed, logs);
    return 0;
  }
  recipe.progress = Progress;
  const std::string tables = SpaTables(RunSpaRecipe(truth, recipe));
  if (out.empty()) {
    fmt::print("{}", tables);
  } else {
    WriteFile(out, tables);
  }
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
