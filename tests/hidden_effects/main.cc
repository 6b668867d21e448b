#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "binding/effect_catalog.h"
#include "error.h"
#include "hidden_effects/outside/cases.h"
#include "hidden_effects/pictures.h"
#include "hidden_effects/report.h"
#include "hidden_effects/study_cases.h"
#include "identification/diagnosis/effort.h"
#include "support/child.h"
#include "support/json_lines.h"

namespace continuum::hidden {
namespace {

constexpr double kFactors[] = {0.125, 0.25, 0.5, 1, 2, 4};

constexpr const char* kPairs[][2] = {
    {"payload", "coulomb"},           {"cubic_stiffness", "sensor_scale"},
    {"input_gain", "coulomb"},        {"gravity_tilt", "armature"},
    {"payload", "sensor_delay"},      {"coulomb", "input_offset"},
    {"dead_time", "cubic_stiffness"}, {"external_force", "armature"}};

bool Known(const std::string& effect) {
  for (const EffectInfo& info : Catalog()) {
    if (info.name == effect) return true;
  }
  return false;
}

void AddNone(const std::string& robot, NoiseKind noise, int times, std::vector<Case>& all) {
  for (int n = 0; n < times; ++n) all.push_back({{}, 1, noise, all.size() + 1, true, false, robot});
}

// The large suite: every effect at six sizes, nothing hidden, effects that are not listed; noise of
// five kinds in turn.
std::vector<Case> Cases(const std::string& robot, int repeats) {
  std::vector<Case> all;
  for (int r = 0; r < repeats; ++r) {
    for (int kind = 0; kind < 5; ++kind) AddNone(robot, static_cast<NoiseKind>(kind), 4, all);
    int turn = r;
    const auto add = [&](std::vector<std::string> effects, double factor, bool listed) {
      const auto noise = static_cast<NoiseKind>(turn++ % 5);
      all.push_back({std::move(effects), factor, noise, all.size() + 1, listed, false, robot});
    };
    if (robot == "arm") {
      for (const auto& pair : kPairs) add({pair[0], pair[1]}, 2, true);
    }
    for (const Hidden& h : RobotNamed(robot).effects) {
      if (!Known(h.name)) continue;
      for (const double factor : kFactors) add({h.name}, factor, true);
      add({h.name}, 2, false);
    }
  }
  return all;
}

// White noise, two sizes of every effect, and nothing hidden twice.
std::vector<Case> QuickCases(const std::string& robot) {
  std::vector<Case> all;
  AddNone(robot, NoiseKind::kWhite, 2, all);
  for (const Hidden& h : RobotNamed(robot).effects) {
    if (!Known(h.name)) continue;
    for (const double factor : {1.0, 2.0})
      all.push_back({{h.name}, factor, NoiseKind::kWhite, all.size() + 1, true, false, robot});
  }
  return all;
}

// The background suite: every effect, and nothing beside the background as often.
std::vector<Case> BackgroundCases(int repeats) {
  std::vector<Case> all;
  for (int r = 0; r < repeats; ++r) {
    for (const Hidden& h : RobotNamed("arm").effects) {
      if (!Known(h.name)) continue;
      for (const bool hidden : {true, false}) {
        Case c{{}, 1, NoiseKind::kWhite, 1000 * all.size() + 17};
        if (hidden) c.effects = {h.name};
        c.background = true;
        all.push_back(std::move(c));
      }
    }
  }
  return all;
}

// Logs that are wrong themselves, with nothing hidden.
std::vector<Case> SpoiltCases(int repeats) {
  std::vector<Case> all;
  for (int r = 0; r < repeats; ++r) {
    for (const char* const how : {"turned", "late", "flipped", "exchanged"}) {
      for (int kind = 0; kind < 5; ++kind) {
        Case c{{}, 1, static_cast<NoiseKind>(kind), 7000 + all.size()};
        c.spoilt = how;
        all.push_back(std::move(c));
      }
    }
  }
  return all;
}

// All suites, of every robot.
std::vector<Case> AllCases(int repeats) {
  std::vector<Case> all;
  const auto add = [&](std::vector<Case> some) {
    all.insert(all.end(), std::make_move_iterator(some.begin()),
               std::make_move_iterator(some.end()));
  };
  for (const char* const robot : {"arm", "servo", "silverbox", "bouc_wen", "spa", "annelida"})
    add(Cases(robot, repeats));
  add(OutsideCases(false));
  add(BackgroundCases(repeats));
  add(SpoiltCases(repeats));
  return all;
}

// Those with one hidden effect, which alone is tried: for its size and interval, at little cost.
std::vector<Case> DescribedCases(std::vector<Case> cases) {
  std::erase_if(cases, [](const Case& c) { return c.effects.size() != 1 || !c.listed; });
  for (Case& c : cases) c.told = true;
  return cases;
}

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

int Main(int argc, char** argv) {
  CLI::App app{"Diagnoses logs with hidden effects; goes on where an earlier run stopped"};
  std::string out, only, keep, pictures, study, results, robot = "arm";
  std::vector<std::string> tables;
  int repeats = 1;
  std::string effort = "thorough";
  double limit = 1200;
  bool write = false, verbose = false, told = false, quick = false, background = false,
       spoilt = false, outside = false, every = false, follow = false;
  app.add_option("--out", out, "one JSON line per case");
  app.add_option("--table", tables, "files of earlier runs: print what they measure together, only")
      ->check(CLI::ExistingFile);
  app.add_option("--robot", robot,
                 "arm, servo, silverbox, bouc_wen, spa or annelida; of --outside all")
      ->capture_default_str();
  app.add_flag("--quick", quick, "white noise, two sizes of every effect, nothing hidden twice");
  app.add_flag("--background", background,
               "one log in windows, in which much else is wrong too, of the arm");
  app.add_flag("--spoilt", spoilt,
               "logs of the arm that are turned, late, of flipped or of other inputs");
  app.add_flag(
      "--outside", outside,
      "machines whose masses and lengths are 1 % off their models (--quick: some of them)");
  app.add_flag("--all", every, "all of these suites, of every robot");
  app.add_option("--study", study,
                 "a folder: write the cases there as one study for `continuum study`");
  app.add_option("--results", results, "what that has found: write it as lines (--out)")
      ->needs("--study");
  app.add_option("--repeats", repeats, "of the whole suite")->capture_default_str();
  app.add_option("--effort", effort, "quick, normal or thorough")
      ->check(CLI::IsMember({"quick", "normal", "thorough"}))
      ->capture_default_str();
  app.add_option("--limit", limit, "processor seconds for a case; later it has no answer")
      ->capture_default_str();
  app.add_option("--only", only, "cases whose name holds this");
  app.add_option("--keep", keep, "a folder that keeps model, logs and experiment of each case");
  app.add_option("--pictures", pictures, "a folder for confusion, power and calibration as SVG");
  app.add_flag("--write", write, "write the cases (--keep), without a diagnosis");
  app.add_flag("--told", told, "only cases of one effect, as the only candidate: for intervals");
  app.add_flag("--follow", follow, "run the experiment that a set proposes, and diagnose again");
  app.add_flag("--verbose", verbose, "print each summary");
  CLI11_PARSE(app, argc, argv);
  if (!tables.empty()) return Show(tables, pictures);
  const bool only_write = !study.empty() && results.empty();
  if (out.empty() && !only_write) return app.exit(CLI::RequiredError("--out"));
  auto cases = every        ? AllCases(repeats)
               : background ? BackgroundCases(repeats)
               : spoilt     ? SpoiltCases(repeats)
               : outside    ? OutsideCases(quick)
               : quick      ? QuickCases(robot)
                            : Cases(robot, repeats);
  for (Case& c : cases) c.effort = EffortNamed(effort);
  if (told) cases = DescribedCases(std::move(cases));
  if (!study.empty())
    std::erase_if(cases, [&](const Case& c) { return c.Name().find(only) == std::string::npos; });
  if (only_write) {
    WriteStudy(cases, effort, study);
    return 0;
  }
  if (!results.empty()) {
    TakeResults(cases, study, results, out);
    return Show({out}, pictures);
  }
  std::set<std::string> done;
  for (const auto& line : testing::ReadJsonLines(out)) done.insert(line.at("case"));
  const auto temporary =
      std::filesystem::temp_directory_path() / ("hidden_effects_" + std::to_string(getpid()));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::string name = cases[i].Name();
    if (done.contains(name) || name.find(only) == name.npos) continue;
    std::filesystem::remove_all(temporary);
    const auto folder =
        keep.empty() ? temporary : std::filesystem::path(keep) / std::to_string(i + 1);
    if (write) {
      WriteCase(cases[i], folder);
      continue;
    }
    const nlohmann::json line = LineApart(cases[i], folder, follow, verbose, limit);
    testing::AppendJsonLine(out, line);
    fmt::print(stderr, "{}/{} {}: {} {} {:.1f} s\n", i + 1, cases.size(), name,
               line.at("verdict").get<std::string>(),
               line.value("named", nlohmann::json::array()).dump(), line.value("seconds", 0.0));
  }
  std::filesystem::remove_all(temporary);
  return Show({out}, pictures);
}

}  // namespace
}  // namespace continuum::hidden

int main(int argc, char** argv) { return continuum::hidden::Main(argc, argv); }
