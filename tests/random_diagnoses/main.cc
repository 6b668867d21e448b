// Diagnoses many random models and logs, and prints what must not be.
#include <cstdio>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "random_diagnoses/run_case.h"
#include "support/json_lines.h"

namespace continuum::random_diagnoses {
namespace {

struct Options {
  std::uint64_t first = 1, cases = 300;
  unsigned limit = 120;
  std::string out = "random_diagnoses.jsonl", keep;
};

int Run(const Options& o) {
  std::set<std::uint64_t> done;
  for (const auto& line : testing::ReadJsonLines(o.out))
    done.insert(line.at("seed").get<std::uint64_t>());
  std::size_t bad = 0;
  for (std::uint64_t seed = o.first; seed < o.first + o.cases; ++seed) {
    if (done.contains(seed)) continue;
    const Outcome outcome = RunCase(
        seed, o.limit, o.keep.empty() ? "" : std::filesystem::path(o.keep) / std::to_string(seed));
    testing::AppendJsonLine(o.out, OutcomeJson(outcome));
    bad += !outcome.problems.empty();
    std::fputs(fmt::format("{:5} {:6.1f} s  rc {}  {}\n", seed, outcome.seconds, outcome.exit_code,
                           outcome.problems.empty() ? outcome.verdict : outcome.problems[0])
                   .c_str(),
               stdout);
    std::fflush(stdout);
  }
  return bad ? 1 : 0;
}

}  // namespace
}  // namespace continuum::random_diagnoses

int main(int argc, char** argv) {
  continuum::random_diagnoses::Options o;
  CLI::App app(
      "Diagnoses random models and logs; goes on where it stopped. Exits with 1 when "
      "something is wrong.");
  app.add_option("--first", o.first, "the first seed")->capture_default_str();
  app.add_option("--cases", o.cases, "how many seeds from there")->capture_default_str();
  app.add_option("--limit", o.limit, "seconds of processor time for each")->capture_default_str();
  app.add_option("--out", o.out, "file to which one JSON line per case is added")
      ->capture_default_str();
  app.add_option("--keep", o.keep, "folder in which the cases stay, one folder per seed");
  CLI11_PARSE(app, argc, argv);
  return continuum::random_diagnoses::Run(o);
}
