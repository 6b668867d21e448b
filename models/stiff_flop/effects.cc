#include <fmt/core.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <random>
#include <vector>

#include "error.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"

/// Prints how far the eight models of Table 2 are apart, beside the errors that the paper published
/// for them. Its measurements are not public: here the forward model `hooke+general+constant`
/// stands for the robot.
namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;

/// Table 2, mean errors: inverse [kPa], [% of E]; forward [mm], [% of the length].
struct Published {
  double kpa, per_E, mm, per_length;
};
constexpr std::array<Published, 8> kTable2 = {{{60, 60, 7.6, 12},
                                               {111, 113, 9, 14},
                                               {61, 61, 13, 20},
                                               {95, 95, 9, 14},
                                               {40, 40, 10, 16},
                                               {53, 53, 14, 22},
                                               {38, 38, 7, 11},
                                               {38, 38, 6.6, 10}}};
constexpr Method kRobot = {BodyLaw::kGeneral, ChamberLaw::kConstant};

/// The shape of constant curvature with the given tip: kappa, phi, lambda_l.
Vector3d ShapeOf(const Vector3d& tip, double l) {
  const double aside = std::hypot(tip.x(), tip.z());
  const double half = std::atan2(aside, tip.y());
  const double arc = tip.norm() * (half > 0 ? half / std::sin(half) : 1);
  return {2 * half / arc, std::atan2(-tip.z(), tip.x()), arc / l};
}

Solution Require(const Solution& solution) {
  if (solution.status == Status::kOk) return solution;
  throw Error::Job(Name(solution.status) + ": " + solution.outcome.why);
}

/// Random pressures [0, 60 kPa] of all lines under the module's own weight, as many as the paper
/// had; their tips of the forward model, and each inverse model on them.
class Random {
 public:
  static constexpr int kCases = 43;

  explicit Random(const Robot& robot) : robot_(robot) {
    std::mt19937 source(4);
    std::uniform_real_distribution<double> pressure(0, 60e3);
    for (int i = 0; i < kCases; ++i) {
      Case row{"", {}, {Vector3d::Zero(), robot.gravity}};
      for (double& p : row.given) p = pressure(source);
      const Solution solution = Require(SolveForward(robot.module, kRobot, row, false));
      applied_.push_back(row.given);
      row.given = ShapeOf(solution.tip, robot.module.l);
      shapes_.push_back(row);
    }
  }

  /// Mean norm of the error of the three pressures [Pa].
  double Error(const Method& method) const {
    double sum = 0;
    for (int i = 0; i < kCases; ++i) {
      const Solution solution = Require(SolveInverse(robot_.module, method, shapes_[i], false));
      sum += (solution.answer - applied_[i]).norm();
    }
    return sum / kCases;
  }

  double MeanPressure() const {
    double sum = 0;
    for (const Vector3d& p : applied_) sum += p.norm();
    return sum / kCases;
  }

 private:
  const Robot& robot_;
  std::vector<Vector3d> applied_;
  std::vector<Case> shapes_;
};

/// Two steps of pressure against lateral and axial tip forces, 33 cases; distances [m] of tips from
/// those of the best pair.
class Loaded {
 public:
  explicit Loaded(const Robot& robot) : robot_(robot) {
    for (int i = 0; i < 33; ++i) {
      const double share = i / 32.0;
      const Vector3d force(0.3 * std::sin(7 * share), 0.2 * share - 0.1, 0);
      rows_.push_back({"", {i % 2 ? 100e3 : 50e3, 0, 0}, {force, robot.gravity}});
    }
  }

  double Distance(const Method& method) const {
    double sum = 0;
    for (const Case& row : rows_) {
      sum += (Require(SolveForward(robot_.module, method, row, false)).tip -
              Require(SolveForward(robot_.module, kRobot, row, false)).tip)
                 .norm();
    }
    return sum / static_cast<double>(rows_.size());
  }

  double Deflection() const {
    double sum = 0;
    for (const Case& row : rows_) {
      const Vector3d tip = Require(SolveForward(robot_.module, kRobot, row, false)).tip;
      sum += (tip - Vector3d(0, robot_.module.l, 0)).norm();
    }
    return sum / static_cast<double>(rows_.size());
  }

 private:
  const Robot& robot_;
  std::vector<Case> rows_;
};

void Print(const Robot& a, const Robot& b) {
  const Random random(a);
  const Loaded loaded(b);
  const double length = b.module.l + 2 * b.module.l_fs;
  const double best = random.Error(kRobot);
  fmt::print(
      "| body + chamber | CC published | above best | here | above best | VC published |"
      " above best | here, from best |\n|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < kTable2.size(); ++i) {
    const Method& method = Method::All()[i];
    const Published& paper = kTable2[i];
    const double error = random.Error(method);
    const double distance = loaded.Distance(method);
    fmt::print(
        "| {} | {:.0f} kPa, {:.0f} % E | {:+.0f} | {:.1f} kPa | {:+.1f} | {:.1f} mm, {:.0f}"
        " % | {:+.1f} | {:.2f} mm, {:.1f} % |\n",
        method.Name(Direction::kInverse), paper.kpa, paper.per_E, paper.kpa - 38, error / 1e3,
        (error - best) / 1e3, paper.mm, paper.per_length, paper.mm - 6.6, distance * 1e3,
        100 * distance / length);
  }
  fmt::print(
      "\nMean |p| of the inverse cases {:.0f} kPa, mean deflection of the forward cases "
      "{:.1f} mm.\n\n",
      random.MeanPressure() / 1e3, loaded.Deflection() * 1e3);
}

void PrintRatio() {
  fmt::print("| lambda | 1.2 | 1.5 | 2.0 |\n|---|---|---|---|\n| Hooke over neo-Hookean energy");
  for (const double lambda : {1.2, 1.5, 2.0}) {
    const Bend<double> bend{lambda, 0};
    fmt::print(" | {:.3f}", Body<double>(BodyLaw::kFixed, bend).Energy(1) /
                                Body<double>(BodyLaw::kElongation, bend).Energy(1));
  }
  fmt::print(" |\n");
}

int Main(const std::filesystem::path& file) {
  Robot a = Robot::Read(file, "a");
  Robot b = Robot::Read(file, "b");
  // The pairs of the real module: with one tube per line it would move by a tenth of its length.
  a.module.n_c = b.module.n_c = 2;
  Print(a, b);
  PrintRatio();
  return 0;
}

}  // namespace
}  // namespace continuum::stiff_flop

int main(int argc, char** argv) {
  try {
    if (argc == 2) return continuum::stiff_flop::Main(argv[1]);
    fmt::print(stderr, "usage: continuum_stiff_flop_effects ROBOT.yaml\n");
    return 2;
  } catch (const continuum::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.exit_code();
  }
}
