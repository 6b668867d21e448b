#include <fmt/format.h>
#include <fmt/ranges.h>

#include <exception>
#include <filesystem>
#include <string>

#include "models/statics/results.h"
#include "models/tdcr/calibrate.h"
#include "models/tdcr/fit.h"
#include "models/tdcr/hybrid.h"
#include "models/tdcr/synthetic.h"
#include "sim/io/file.h"

namespace continuum::tdcr {
namespace {

constexpr unsigned kSeed = 2020;

std::string Text(const Spread& s) { return fmt::format("{:.2f} +- {:.2f}", s.mean, s.std); }

std::vector<double> Together(const TipErrors& tips) {
  std::vector<double> all = tips.train;
  all.insert(all.end(), tips.test.begin(), tips.test.end());
  return all;
}

Spread FitErrors(const Experiment& experiment, double lambda) {
  const Robot truth = Truth(experiment.nominal);
  TipErrors tips;
  for (const Measured& m : experiment.measured) {
    const Solution fit = FitShape(truth, truth.MeasuringToBase() * m.disks, lambda);
    tips.Add(truth, m, fit.disks);
  }
  return *Statistics(Together(tips));
}

void PrintCalibration(const char* name, const Calibration& c, const char* published) {
  const Eigen::Vector3d& angles = c.robot.base_rotation;
  fmt::print(
      "  {:5} {:14} paper {:12}  E {:.1f} GPa, mu {:.3f}, base ({:.3f}, {:.3f}, {:.3f}) rad\n",
      name, Text(*Statistics(Together(c.tips))), published, c.robot.E / 1e9, c.robot.mu, angles.x(),
      angles.y(), angles.z());
}

void PrintSpread(const char* name, const Spread& s, const char* published) {
  fmt::print("  {:10} mean {:.2f}  std {:.2f}  min {:.2f}  max {:.2f}   paper {}\n", name, s.mean,
             s.std, s.min, s.max, published);
}

void PrintHybrid(const char* name, const Hybrid& hybrid, const char* published) {
  PrintSpread(name, *Statistics(hybrid.tips.test), published);
  const auto left_out = hybrid.left_out ? Statistics(hybrid.left_out->tips) : std::nullopt;
  if (left_out) PrintSpread("  left out", *left_out, "-");
  fmt::print("    penalty {:.1e}\n", hybrid.penalty);
}

void Print(const Robot& robot, int set, unsigned seed) {
  const char* const published[2][3] = {{"3.59 +- 3.36", "3.68 +- 3.08", "5.46 +- 4.02"},
                                       {"2.75 +- 1.64", "2.15 +- 1.02", "3.27 +- 2.14"}};
  const char* const hybrids[2][2] = {{"3.37 2.64 0.05 8.60", "2.72 1.63 0.34 5.10"},
                                     {"2.44 2.05 0.61 6.65", "1.59 1.10 0.96 4.8"}};
  const auto experiment = Synthesize(robot, set, seed + static_cast<unsigned>(set));
  const auto pairs = Match(experiment.cases, experiment.measured, "synthetic");
  fmt::print("Set {}: {} cases, tip errors in % of L\n", set, pairs.size());
  fmt::print("  fit (8)  lambda 1e-7: {}   lambda 0: {}   paper 0.43 +- 0.21 (1e-7, both sets)\n",
             Text(FitErrors(experiment, 1e-7)), Text(FitErrors(experiment, 0)));
  const Method methods[] = {Method::kEas, Method::kPcca, Method::kCrt};
  const char* const names[] = {"eas", "pcca", "crt"};
  Calibration eas{};
  for (int i = 0; i < 3; ++i) {
    const Calibration c = Calibrate(experiment.nominal, methods[i], pairs, "synthetic");
    PrintCalibration(names[i], c, published[set - 1][i]);
    if (i == 0) eas = c;
  }
  std::vector<Case> cases = experiment.cases;
  for (Case& c : cases) c.loads.mu = eas.robot.mu;
  const auto trained = Match(cases, experiment.measured, "synthetic");
  PrintSpread("calibrated", *Statistics(eas.tips.test), hybrids[set - 1][0]);
  PrintHybrid("as printed", Train(eas.robot, Method::kEas, trained, "synthetic", 0),
              hybrids[set - 1][1]);
  PrintHybrid("hybrid", Train(eas.robot, Method::kEas, trained, "synthetic", std::nullopt),
              hybrids[set - 1][1]);
}

// How often an interval holds the truth, and a prediction the measured tip.
struct Coverage {
  int seeds = 0, standard = 0, shapes = 0, model = 0;  ///< of E
  int shapes_mu = 0, model_mu = 0;
  int tips = 0, within = 0;
};

void See(const Experiment& experiment, const std::vector<Pair>& pairs, Method method,
         const Calibration& c, Coverage& coverage) {
  const Robot& nominal = experiment.nominal;
  const Robot truth = Truth(nominal);
  const double E = truth.E / nominal.E;
  const auto holds = [](const Eigen::MatrixX2d& interval, Eigen::Index i, double value) {
    return interval(i, 0) <= value && value <= interval(i, 1);
  };
  ++coverage.seeds;
  coverage.standard += std::abs(c.x[0] - E) <= 1.96 * c.spread.standard[0];
  coverage.shapes += holds(c.spread.shapes, 0, E);
  coverage.model += holds(c.spread.model, 0, E);
  if (c.x.size() > 4) {
    coverage.shapes_mu += holds(c.spread.shapes, 4, truth.mu);
    coverage.model_mu += holds(c.spread.model, 4, truth.mu);
  }
  for (const Pair& pair : pairs) {
    if (!pair.measured->test) continue;
    Loads loads = pair.loads->loads;
    loads.mu = c.robot.mu;
    const Solution s = SolveCase(c.robot, loads, method);
    ++coverage.tips;
    coverage.within +=
        Errors(c.robot, *pair.measured, s.disks)[nominal.disks - 1] <= c.prediction.within.back();
  }
}

// Calibrations of shapes of another model (crt_friction with natural curvature), over seeds.
void PrintCoverage(const Robot& robot, unsigned seeds) {
  const char* const names[] = {"eas", "pcca", "crt", "crt_friction"};
  fmt::print(
      "| set, method | E: 1.96 standard errors | E: shapes | E: with model error | mu: shapes | "
      "mu: "
      "with model error | tips of test cases within |\n|---|---|---|---|---|---|---|\n");
  for (const int set : {1, 2}) {
    for (const auto method : {Method::kEas, Method::kPcca, Method::kCrt, Method::kCrtFriction}) {
      Coverage coverage;
      for (unsigned seed = 1; seed <= seeds; ++seed) {
        const auto experiment = Synthesize(robot, set, 100 * seed + static_cast<unsigned>(set));
        const auto pairs = Match(experiment.cases, experiment.measured, "synthetic");
        See(experiment, pairs, method, Calibrate(experiment.nominal, method, pairs, "synthetic"),
            coverage);
      }
      const bool mu = method != Method::kCrt;
      fmt::print("| {}, {} | {} | {} | {} | {} | {} | {} of {} |\n", set,
                 names[static_cast<int>(method)], coverage.standard, coverage.shapes,
                 coverage.model, mu ? std::to_string(coverage.shapes_mu) : "",
                 mu ? std::to_string(coverage.model_mu) : "", coverage.within, coverage.tips);
    }
  }
  fmt::print("of {} seeds\n", seeds);
}

// Set 1 as the files that `continuum solve` reads, tensions and forces to 0.1 mN, points to 1 um.
void WriteSample(const Robot& robot, const std::filesystem::path& folder) {
  Experiment experiment = Synthesize(robot, 1, kSeed + 1);
  std::string cases = "case,T1,T2,T3,fx,fy,fz\n", measured = "case,use";
  for (int i = 1; i <= robot.disks; ++i) measured += fmt::format(",x_{0},y_{0},z_{0}", i);
  measured += '\n';
  for (std::size_t i = 0; i < experiment.cases.size(); ++i) {
    const Case& c = experiment.cases[i];
    const Measured& m = experiment.measured[i];
    const auto& f = c.loads.tip_force;
    cases += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f}\n", c.name,
                         fmt::join(c.loads.tension, ","), f.x(), f.y(), f.z());
    measured += fmt::format("{},{}", m.name, m.test ? "test" : "train");
    for (const double x : m.disks.reshaped()) measured += fmt::format(",{:.6f}", x);
    measured += '\n';
  }
  WriteFile(folder / "cases.csv", cases);
  WriteFile(folder / "measured.csv", measured);
}

}  // namespace
}  // namespace continuum::tdcr

int main(int count, char** arguments) {
  using namespace continuum;
  const bool sample = count == 4 && std::string(arguments[2]) == "--sample";
  const bool coverage = count == 4 && std::string(arguments[2]) == "--coverage";
  if (count != 2 && count != 3 && !sample && !coverage) {
    fmt::print(stderr,
               "usage: tdcr_tables models/tdcr/tdcr.yaml [SEED | --sample FOLDER | --coverage "
               "SEEDS]\n");
    return 2;
  }
  try {
    const tdcr::Robot robot = tdcr::ReadRobot(Yaml::Read(arguments[1]));
    if (sample) {
      tdcr::WriteSample(robot, arguments[3]);
      return 0;
    }
    if (coverage) {
      tdcr::PrintCoverage(robot, static_cast<unsigned>(std::stoul(arguments[3])));
      return 0;
    }
    const unsigned seed =
        count == 3 ? static_cast<unsigned>(std::stoul(arguments[2])) : tdcr::kSeed;
    for (const int set : {1, 2}) tdcr::Print(robot, set, seed);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
