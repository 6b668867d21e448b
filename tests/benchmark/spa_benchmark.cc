#include <benchmark/benchmark.h>

#include "models/spa/response.h"

namespace continuum {
namespace {

constexpr SpaParameters<double> kTable{.L0 = 0.13,
                                       .d = 0.05,
                                       .r_ch = 0.03,
                                       .x_m = -0.4e-3,
                                       .y_m = -1.5e-3,
                                       .T_PT1 = 7e-3,
                                       .A = 31e-6,
                                       .m = 0.1806,
                                       .d_theta = 0.2301,
                                       .d_dL = 1.8384,
                                       .k_theta = 183.5195,
                                       .k_theta3 = 0,
                                       .k_dL1 = 251.7274,
                                       .k_dL3 = -4.2e4};

const SpaState<double> kState{{0.02, -0.01, 0.01}, {0.3, 0.2, -0.1}};
const Eigen::Vector3d kPressure{4e4, 1e4, 0};

SpaMass MassOf(const benchmark::State& state) {
  return state.range(0) == 0 ? SpaMass::kCentroid : SpaMass::kArc;
}

void SpaAcceleration(benchmark::State& state) {
  const Spa<double> spa(kTable, {MassOf(state)});
  const auto base = SpaBase<double>::Hanging();
  for (auto _ : state) benchmark::DoNotOptimize(spa.Acceleration(kState, base, kPressure));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(SpaAcceleration)->Arg(0)->Arg(1)->ArgName("arc");

void SpaHybridDynamics(benchmark::State& state) {
  const Spa<double> spa(kTable, {MassOf(state)});
  const auto base = SpaBase<double>::Hanging();
  for (auto _ : state) {
    const Eigen::Vector3d acceleration = spa.Acceleration(kState, base, kPressure);
    benchmark::DoNotOptimize(spa.BaseWrench(kState, acceleration, base));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(SpaHybridDynamics)->Arg(0)->Arg(1)->ArgName("arc");

// One second of a step at 1 kHz, error per step 1e-10.
void SpaOneSecond(benchmark::State& state) {
  const Spa<double> spa(kTable, {MassOf(state)});
  const auto base = SpaBase<double>::Hanging();
  const auto start = SpaAtRest(spa, Eigen::Vector3d::Zero(), base);
  const std::vector<Eigen::Vector3d> input(1001, kPressure);
  for (auto _ : state) {
    benchmark::DoNotOptimize(SpaRespond(spa, start, input, 1e-3, [&](double) { return base; }));
  }
}
BENCHMARK(SpaOneSecond)->Arg(0)->Arg(1)->ArgName("arc")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace continuum
