#include <unistd.h>

#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include <fmt/format.h>

#include "models/spa/logs.h"
#include "models/spa/recipe.h"
#include "models/tool_main.h"
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
  return RunTool(app, argc, argv, [&] {
    const SpaFile truth = ReadSpa(file);
    if (!logs.empty()) {
      WriteSpaLogs(truth, recipe.noise, recipe.seed, logs);
      return;
    }
    recipe.progress = Progress;
    const std::string tables = SpaTables(RunSpaRecipe(truth, recipe));
    if (out.empty()) {
      fmt::print("{}", tables);
    } else {
      WriteFile(out, tables);
    }
  });
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) { return continuum::Main(argc, argv); }
