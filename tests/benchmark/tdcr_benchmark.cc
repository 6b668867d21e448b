#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "models/tdcr/model.h"

namespace continuum::tdcr {
namespace {

// The paper's timing: ten disks, a random tension of tendon 1 and a random tip force along y (out
// of the bending plane) or z (in it), every solve from the straight rod.
std::vector<Loads> PaperCases(const Robot& robot, bool planar) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> tension(0, 5), force(0, 0.5);
  std::vector<Loads> cases(500, NoLoads(robot));
  for (Loads& loads : cases) {
    loads.tension[0] = tension(random);
    loads.tip_force[planar ? 2 : 1] = force(random);
  }
  return cases;
}

// All tendons, friction on every one, weights, 50 g in any direction.
std::vector<Loads> RangeCases(const Robot& robot) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  std::vector<Loads> cases(500, NoLoads(robot));
  for (Loads& loads : cases) {
    for (double& t : loads.tension) t = 5 * share(random);
    const double x = normal(random), y = normal(random), z = normal(random);
    loads.tip_force = 0.5 * share(random) * Eigen::Vector3d(x, y, z).normalized();
    loads.gravity = {0, 0, 9.81};
  }
  return cases;
}

enum Kind { kPlanar, kNonPlanar, kRange };

void Solve(benchmark::State& state, Method method, Kind kind) {
  Robot robot;
  robot.disks = 10;
  robot.mu = 0.2;
  if (kind == kRange) {
    robot.density = 6450;
    robot.disk_mass = 0.6e-3;
  }
  const auto cases = kind == kRange ? RangeCases(robot) : PaperCases(robot, kind == kPlanar);
  std::size_t i = 0;
  for (auto _ : state) {
    const Solution solution = SolveCase(robot, cases[i++ % cases.size()], method);
    if (!solution.outcome.ok()) state.SkipWithError(solution.outcome.why.c_str());
    benchmark::DoNotOptimize(solution.disks.data());
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(Solve, eas_planar, Method::kEas, kPlanar)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, eas_non_planar, Method::kEas, kNonPlanar)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, eas_range, Method::kEas, kRange)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, pcca_non_planar, Method::kPcca, kNonPlanar)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, crt_planar, Method::kCrt, kPlanar)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, crt_non_planar, Method::kCrt, kNonPlanar)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, crt_range, Method::kCrt, kRange)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, crt_friction_planar, Method::kCrtFriction, kPlanar)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, crt_friction_non_planar, Method::kCrtFriction, kNonPlanar)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, crt_friction_range, Method::kCrtFriction, kRange)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Solve, eas_two_cores, Method::kEas, kNonPlanar)
    ->Unit(benchmark::kMicrosecond)
    ->Threads(2)
    ->UseRealTime();
BENCHMARK_CAPTURE(Solve, crt_two_cores, Method::kCrt, kNonPlanar)
    ->Unit(benchmark::kMicrosecond)
    ->Threads(2)
    ->UseRealTime();
BENCHMARK_CAPTURE(Solve, crt_friction_two_cores, Method::kCrtFriction, kNonPlanar)
    ->Unit(benchmark::kMicrosecond)
    ->Threads(2)
    ->UseRealTime();

}  // namespace
}  // namespace continuum::tdcr

BENCHMARK_MAIN();
