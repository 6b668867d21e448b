#include <unistd.h>

#include <array>
#include <filesystem>
#include <map>
#include <set>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "benchmark/stick_slip/experiment.h"
#include "error.h"
#include "identification/fit/intervals.h"
#include "identification/fit/multi_start.h"
#include "identification/problem/path_choice.h"
#include "identification/statistics/noise_model.h"
#include "identification/statistics/uncertainty.h"
#include "sim/io/file.h"
#include "support/json_lines.h"

namespace continuum::stick_slip {
namespace {

struct Case {
  double rho;    ///< of the noise, from row to row
  double sigma;  ///< of the noise [m]
  double step;   ///< of the model [s]
  int seed;

  std::string Group() const {
    return fmt::format("{} {} mm, {} ms", rho > 0 ? fmt::format("AR({})", rho) : "white",
                       1e3 * sigma, 1e3 * step);
  }
};

std::vector<double> Values(const Problem::Vector& x) { return {x.begin(), x.end()}; }

nlohmann::json Solve(const Case& c, Experiment e, const ModelSpec& system, int starts,
                     double share) {
  Random64 rng(static_cast<std::uint64_t>(c.seed));
  const ChannelNoise noise{{c.rho}, c.sigma * std::sqrt(1 - c.rho * c.rho), 0, c.sigma};
  for (Log& log : e.logs) {
    const auto errors = NoiseDraw(noise, kRows, rng);
    for (std::size_t k = 0; k < kRows; ++k) log.measured[0][k] += errors[k];
  }
  Problem problem(e, system);
  problem.DifferBy(share);
  const auto use = problem.AllLogs();
  const Fit fit = FitParameters(problem, problem.Start(), use, {.iterations = 50});
  const auto r = problem.Residuals(fit.x, use);
  const Uncertainty u = IntervalsOf(problem, fit.x, r);
  const Uncertainty plain = UncertaintyOf(problem, fit.x, r, problem.Jacobian(fit.x, r, use));
  nlohmann::json line{{"group", c.Group()},
                      {"seed", c.seed},
                      {"x", Values(fit.x)},
                      {"fine", Values(fit.x + u.step)},
                      {"lower", Values(u.lower)},
                      {"upper", Values(u.upper)},
                      {"plain_lower", Values(plain.lower)},
                      {"plain_upper", Values(plain.upper)},
                      {"cost", 2 * fit.cost / static_cast<double>(kLogs * kRows)},
                      {"seconds", fit.seconds},
                      {"starts", starts},
                      {"reached", 0}};
  if (starts > 0) {
    const auto many = FitFromMany(problem, fit.x, use, starts + 1,
                                  static_cast<std::uint64_t>(c.seed), {.iterations = 50});
    line["reached"] = many.Reached() - (many.starts[0].cost <= 1.001 * many.best.cost);
    line["best"] = 2 * many.best.cost / static_cast<double>(kLogs * kRows);
  }
  return line;
}

struct Mean {
  double sum = 0, squares = 0;
  int n = 0;
  void Add(double v) { sum += v, squares += v * v, ++n; }
  double Value() const { return sum / n; }
  double Deviation() const { return std::sqrt(std::max(0.0, squares / n - Value() * Value())); }
};

void Report(const std::vector<nlohmann::json>& lines) {
  std::map<std::string, std::vector<nlohmann::json>> groups;
  for (const auto& line : lines) groups[line.at("group")].push_back(line);
  for (const auto& [group, fits] : groups) {
    Mean cost, seconds, reached;
    for (const auto& f : fits) {
      cost.Add(f.at("cost")), seconds.Add(f.at("seconds"));
      for (int k = 0; k < f.at("starts"); ++k) reached.Add(k < f.at("reached"));
    }
    fmt::print("{}: {} fits, cost {:.4f}, {:.2f} s each, {:.0f} of {} random starts reach it\n",
               group, fits.size(), cost.Value(), seconds.Value(), reached.sum, reached.n);
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      Mean off, fine, stated, plain;
      for (const auto& f : fits) {
        const auto at = [&](const char* key) { return f.at(key).at(i).get<double>() / kTrue[i]; };
        off.Add(100 * (at("x") - 1)), fine.Add(100 * (at("fine") - 1));
        stated.Add(100 * (at("lower") <= 1 && 1 <= at("upper")));
        plain.Add(100 * (at("plain_lower") <= 1 && 1 <= at("plain_upper")));
      }
      fmt::print(
          "  {:<10} bias {:+6.2f} %, at a fine step {:+6.2f} %, scatter {:5.2f} %, covered {:5.1f} "
          "%, without the step {:5.1f} %\n",
          kNames[i], off.Value(), fine.Value(), off.Deviation(), stated.Value(), plain.Value());
    }
  }
}

int Main(int argc, char** argv) {
  CLI::App app{"Fits a slider that sticks and slips; goes on where an earlier run stopped"};
  std::string out, only;
  int first = 1, seeds = 100, starts = 0;
  double sigma = 2e-4, share = 1e-3;
  app.add_option("--out", out, "one JSON line per fit")->required();
  app.add_option("--first", first, "seed of the noise")->capture_default_str();
  app.add_option("--seeds", seeds, "of each kind")->capture_default_str();
  app.add_option("--starts", starts, "random ones beside each fit")->capture_default_str();
  app.add_option("--sigma", sigma, "of the noise [m]")->capture_default_str();
  app.add_option("--differences", share, "over this share of a parameter's scale")
      ->capture_default_str();
  app.add_option("--only", only, "kinds whose name holds this");
  CLI11_PARSE(app, argc, argv);
  std::set<std::pair<std::string, int>> done;
  for (const auto& line : testing::ReadJsonLines(out))
    done.emplace(line.at("group").get<std::string>(), line.at("seed").get<int>());
  const auto folder =
      std::filesystem::temp_directory_path() / ("stick_slip_" + std::to_string(getpid()));
  MakeFolder(folder);
  for (std::size_t l = 0; l < kLogs; ++l)
    fmt::print("log {}: stuck at {:.0f} % of the rows\n", l + 1,
               100 * kTruth.Run(Command(l), kPeriod).stuck);
  std::fflush(stdout);
  for (const double step : {2e-3, 5e-4}) {
    const Experiment e = Clean(folder, step, sigma);
    const ModelSpec system = ModelSpec::Load(e.model);
    if (step == 2e-3)
      fmt::print("smooth path: {}\n", SmoothObstacle(Problem(e, system))), std::fflush(stdout);
    for (int seed = first; seed < first + seeds; ++seed) {
      for (const double rho : {0.0, 0.9}) {
        const Case c{rho, sigma, step, seed};
        if (done.contains({c.Group(), seed}) || c.Group().find(only) == std::string::npos) continue;
        testing::AppendJsonLine(out, Solve(c, e, system, starts, share));
      }
    }
  }
  std::filesystem::remove_all(folder);
  Report(testing::ReadJsonLines(out));
  return 0;
}

}  // namespace
}  // namespace continuum::stick_slip

int main(int argc, char** argv) { return continuum::stick_slip::Main(argc, argv); }
