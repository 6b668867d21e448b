#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "error.h"
#include "hidden_effects/case_lists.h"
#include "hidden_effects/outside/cases.h"
#include "hidden_effects/pictures.h"
#include "hidden_effects/report.h"
#include "hidden_effects/study_cases.h"
#include "identification/diagnosis/effort.h"
#include "support/child.h"
#include "support/json_lines.h"

namespace continuum::hidden {
namespace {

nlohmann::json Line(const Case& c, const std::filesystem::path& folder, bool follow, bool verbose) {
  try {
    const Answer a = follow ? SolveAndFollow(c, folder) : Solve(c, folder);
    if (verbose) fmt::print("{}\n", a.detail), std::fflush(stdout);
    return LineOf(c, a);
  } catch (const std::exception& e) {
    return NoAnswer(c, e.what());
  }
}

// In a process of its own: a crash or a case without an end costs no other.
nlohmann::json LineApart(const Case& c, const std::filesystem::path& folder, bool follow,
                         bool verbose, double limit) {
  constexpr unsigned kWaits = 20;  // times the processor time, on a machine that does other things
  const auto child = testing::InChild([&] { return Line(c, folder, follow, verbose).dump(); },
                                      static_cast<unsigned>(std::ceil(limit)), kWaits);
  if (child.exit_code == 0) return nlohmann::json::parse(child.text);
  return NoAnswer(
      c, child.too_long ? fmt::format("more than {:g} s of processor time", limit) : "crash");
}

// Prints what the lines of files say, and draws it into a folder, if one is named.
int Show(const std::vector<std::string>& files, const std::string& pictures) {
  std::vector<nlohmann::json> lines;
  for (const auto& file : files) {
    for (auto& line : testing::ReadJsonLines(file)) lines.push_back(std::move(line));
  }
  const auto outcomes = OutcomesOf(lines);
  fmt::print("{}", Report(outcomes));
  if (!pictures.empty()) WritePictures(outcomes, pictures);
  return 0;
}

// One line per case of what a study has found, and how many it lacks.
void TakeResults(const std::vector<Case>& cases, const std::string& study,
                 const std::string& results, const std::string& out) {
  if (std::filesystem::exists(out)) throw Error::Input("--out", "a file that is not there", out);
  const auto lines = LinesOfStudy(cases, study, results);
  for (const auto& line : lines) testing::AppendJsonLine(out, line);
  if (lines.size() < cases.size())
    fmt::print(stderr, "{} of {} cases have not run\n", cases.size() - lines.size(), cases.size());
}

// What the command line asks for.
struct Options {
  std::string out, only, keep, pictures, study, results, robot = "arm", effort = "thorough";
  std::vector<std::string> tables;
  int repeats = 1;
  double limit = 1200;  // s of processor time
  bool write = false, verbose = false, told = false, quick = false, background = false,
       spoilt = false, outside = false, every = false, follow = false;

  bool OnlyWritesStudy() const { return !study.empty() && results.empty(); }
};

void AddSuites(CLI::App& app, Options& o) {
  app.add_option("--robot", o.robot,
                 "arm, servo, silverbox, bouc_wen, spa or annelida; of --outside all")
      ->capture_default_str();
  app.add_flag("--quick", o.quick, "white noise, two sizes of every effect, nothing hidden twice");
  app.add_flag("--background", o.background,
               "one log in windows, in which much else is wrong too, of the arm");
  app.add_flag("--spoilt", o.spoilt,
               "logs of the arm that are turned, late, of flipped or of other inputs");
  app.add_flag(
      "--outside", o.outside,
      "machines whose masses and lengths are 1 % off their models (--quick: some of them)");
  app.add_flag("--all", o.every, "all of these suites, of every robot");
  app.add_option("--repeats", o.repeats, "of the whole suite")->capture_default_str();
  app.add_option("--only", o.only, "cases whose name holds this");
  app.add_flag("--told", o.told, "only cases of one effect, as the only candidate: for intervals");
}

void AddRuns(CLI::App& app, Options& o) {
  app.add_option("--out", o.out, "one JSON line per case");
  app.add_option("--table", o.tables,
                 "files of earlier runs: print what they measure together, only")
      ->check(CLI::ExistingFile);
  app.add_option("--study", o.study,
                 "a folder: write the cases there as one study for `continuum study`");
  app.add_option("--results", o.results, "what that has found: write it as lines (--out)")
      ->needs("--study");
  app.add_option("--effort", o.effort, "quick, normal or thorough")
      ->check(CLI::IsMember({"quick", "normal", "thorough"}))
      ->capture_default_str();
  app.add_option("--limit", o.limit, "processor seconds for a case; later it has no answer")
      ->capture_default_str();
  app.add_option("--keep", o.keep, "a folder that keeps model, logs and experiment of each case");
  app.add_option("--pictures", o.pictures, "a folder for confusion, power and calibration as SVG");
  app.add_flag("--write", o.write, "write the cases (--keep), without a diagnosis");
  app.add_flag("--follow", o.follow, "run the experiment that a set proposes, and diagnose again");
  app.add_flag("--verbose", o.verbose, "print each summary");
}

std::vector<Case> CasesOf(const Options& o) {
  auto cases = o.every        ? AllCases(o.repeats)
               : o.background ? BackgroundCases(o.repeats)
               : o.spoilt     ? SpoiltCases(o.repeats)
               : o.outside    ? OutsideCases(o.quick)
               : o.quick      ? QuickCases(o.robot)
                              : Cases(o.robot, o.repeats);
  for (Case& c : cases) c.effort = EffortNamed(o.effort);
  return o.told ? DescribedCases(std::move(cases)) : cases;
}

bool IsWanted(const Case& c, const Options& o) {
  return c.Name().find(o.only) != std::string::npos;
}

// Each case in its folder, diagnosed if that is wanted; those that an earlier run did are skipped.
void RunCases(const std::vector<Case>& cases, const Options& o) {
  std::set<std::string> done;
  for (const auto& line : testing::ReadJsonLines(o.out)) done.insert(line.at("case"));
  const auto temporary =
      std::filesystem::temp_directory_path() / ("hidden_effects_" + std::to_string(getpid()));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    if (done.contains(c.Name()) || !IsWanted(c, o)) continue;
    std::filesystem::remove_all(temporary);
    const auto folder =
        o.keep.empty() ? temporary : std::filesystem::path(o.keep) / std::to_string(i + 1);
    if (o.write) {
      WriteCase(c, folder);
      continue;
    }
    const nlohmann::json line = LineApart(c, folder, o.follow, o.verbose, o.limit);
    testing::AppendJsonLine(o.out, line);
    fmt::print(stderr, "{}/{} {}: {} {} {:.1f} s\n", i + 1, cases.size(), c.Name(),
               line.at("verdict").get<std::string>(),
               line.value("named", nlohmann::json::array()).dump(), line.value("seconds", 0.0));
  }
  std::filesystem::remove_all(temporary);
}

int Main(int argc, char** argv) {
  CLI::App app{"Diagnoses logs with hidden effects; goes on where an earlier run stopped"};
  Options o;
  AddRuns(app, o);
  AddSuites(app, o);
  CLI11_PARSE(app, argc, argv);
  if (!o.tables.empty()) return Show(o.tables, o.pictures);
  if (o.out.empty() && !o.OnlyWritesStudy()) return app.exit(CLI::RequiredError("--out"));
  std::vector<Case> cases = CasesOf(o);
  if (!o.study.empty()) std::erase_if(cases, [&](const Case& c) { return !IsWanted(c, o); });
  if (o.OnlyWritesStudy()) {
    WriteStudy(cases, o.effort, o.study);
    return 0;
  }
  if (o.results.empty()) {
    RunCases(cases, o);
  } else {
    TakeResults(cases, o.study, o.results, o.out);
  }
  return Show({o.out}, o.pictures);
}

}  // namespace
}  // namespace continuum::hidden

int main(int argc, char** argv) {
  try {
    return continuum::hidden::Main(argc, argv);
  } catch (const continuum::Error& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
  }
}
