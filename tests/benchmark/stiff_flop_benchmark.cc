#include <benchmark/benchmark.h>

#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"

namespace continuum::stiff_flop {
namespace {

const Module kModule{.r_c1 = 2.5e-3,
                     .r_c2 = 3e-3,
                     .gamma = 1.5599752854,
                     .r_o = 9e-3,
                     .r_1 = 4.5e-3,
                     .r_2 = 12.5e-3,
                     .l = 44e-3,
                     .l_fs = 16.6e-3,
                     .E = 1e5,
                     .m = 24e-3,
                     .m_fs = 1e-3,
                     .n_c = 2};

Case Row(double a, double b, double c) {
  return {"", Eigen::Vector3d(a, b, c), {{0.05, 0, 0.02}, {0, 9.81, 0}}};
}

void Inverse(benchmark::State& state) {
  const Method& method = Method::All()[state.range(0)];
  state.SetLabel(method.Name(Direction::kInverse));
  const Case row = Row(15, 0.4, 1.15);
  for (auto _ : state) {
    benchmark::DoNotOptimize(SolveInverse(kModule, method, row, false));
  }
}
BENCHMARK(Inverse)->DenseRange(0, 7)->Unit(benchmark::kMicrosecond);

void Forward(benchmark::State& state) {
  const Method& method = Method::All()[state.range(0)];
  state.SetLabel(method.Name(Direction::kForward));
  const Case row = Row(4e4, 1e4, 0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(SolveForward(kModule, method, row, false));
  }
}
BENCHMARK(Forward)->DenseRange(0, 7)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace continuum::stiff_flop
