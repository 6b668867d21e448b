#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>

#include "error.h"
#include "models/stiff_flop/lines.h"

/// Replays the public log NoLoad.mat in the forward models and prints tip errors beside published
/// ones.
namespace continuum::stiff_flop {
namespace {

constexpr int kStride = 5, kStrideOfLines = 20;

void PrintLine(const std::string& name, const Robot& robot, const Method& method, const Log& log) {
  const std::vector<Solution> shapes = Replay(robot, method, log);
  const std::size_t train = TrainRows(log);
  const Registration registration = Registration::Fit(shapes, log, train);
  const TipError fitted = ErrorOf(registration, shapes, log, 0, train);
  const TipError fresh = ErrorOf(registration, shapes, log, train, log.time.size());
  const Registration all = Registration::Fit(shapes, log, log.time.size());
  const TipError whole = ErrorOf(all, shapes, log, 0, log.time.size());
  fmt::print(
      "| {} | {:.1f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} ({:.2f} %) | {:.1f}, {:.1f}, {:.1f} |\n",
      name, robot.module().E / 1e3, robot.module().gamma * 180 / std::numbers::pi,
      1e3 * fitted.mean, 1e3 * fresh.mean, 1e3 * whole.mean,
      100 * whole.mean / (robot.module().l + robot.module().l_fs), 1e3 * registration.offset.x(),
      1e3 * registration.offset.y(), 1e3 * registration.offset.z());
  std::fflush(stdout);
}

/// The default model with effects of its lines fitted on the train rows.
Lines PrintWithLines(const std::string& name, const Robot& robot, const Log& log,
                     const LineEffects& effects, Lines lines) {
  FitLines(robot, {}, log, effects, lines);
  PrintLine(name, robot, {}, lines.Acting(log));
  fmt::print(stderr, "{}: gain {:.3f} {:.3f} {:.3f}, dead {:.2f} kPa, creep {:.3f}, lag {:.2f} s\n",
             name, lines.gain[0], lines.gain[1], lines.gain[2], lines.dead / 1e3, lines.creep,
             lines.lag);
  return lines;
}

void PrintLines(const Robot& robot, const Log& log) {
  const Lines ideal;
  Lines stepped;
  stepped.dead = 8e3;
  PrintWithLines("gain of each line fitted", robot, log, {true, false, false}, ideal);
  PrintWithLines("dead pressure fitted", robot, log, {false, true, false}, stepped);
  Lines fitted = PrintWithLines("both", robot, log, {true, true, false}, stepped);
  fitted.creep = 0.05;
  PrintWithLines("both and creep", robot, log, {true, true, true}, fitted);
}

int Main(const std::filesystem::path& file, const std::filesystem::path& data) {
  const Robot robot = Robot::Read(file);
  const Log log = Log::Read(data, kStride);
  fmt::print(
      "| model | E [kPa] | gamma [deg] | train [mm] | validate [mm] | whole log [mm] |"
      " marker from the tip [mm] |\n|---|---|---|---|---|---|---|\n"
      "| published physical models | | | | | 2.57, 2.80, 3.06 (4.40, 4.79, 5.22 %) | |\n"
      "| published regression | | | | | 0.72 | |\n");
  for (const Method& method : Method::All()) {
    PrintLine(method.Name(Direction::kForward), robot, method, log);
  }
  Robot standing = robot;
  standing.gravity = -robot.gravity;
  PrintLine(Method{}.Name(Direction::kForward) + ", standing", standing, {}, log);
  for (const Method& method : {Method{BodyLaw::kFixed, ChamberLaw::kFixed}, Method{}}) {
    Robot fitted = robot;
    FitBraid(method, log, fitted);
    PrintLine(method.Name(Direction::kForward) + ", fitted", fitted, method, log);
  }
  PrintLines(robot, Log::Read(data, kStrideOfLines));
  return 0;
}

}  // namespace
}  // namespace continuum::stiff_flop

int main(int argc, char** argv) {
  try {
    if (argc == 3) return continuum::stiff_flop::Main(argv[1], argv[2]);
    fmt::print(stderr, "usage: continuum_stiff_flop_replay ROBOT.yaml NoLoad.mat\n");
    return 2;
  } catch (const continuum::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.exit_code();
  }
}
