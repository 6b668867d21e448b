#include <cstdio>
#include <exception>
#include <string>

#include <fmt/format.h>

#include "error.h"
#include "models/spa/chain_error.h"

namespace continuum {
namespace {

void PrintRow(const std::string& name, const SpaFile& file, const SpaTrial& trial) {
  const SpaGap gap = ChainError(file, trial);
  fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n", name, 100 * gap.delta, 100 * gap.tip,
             100 * gap.force, 100 * gap.torque);
  std::fflush(stdout);
}

void Print(const SpaFile& file) {
  const Eigen::Vector3d one(75e3, 0, 0), two(40e3, 40e3, 0), three(40e3, 40e3, 40e3);
  fmt::print(
      "| % of range, N = 10, RK4 0.2 ms | δ | tip | force | torque |\n|---|---|---|---|---|\n");
  for (const bool moving : {false, true}) {
    const char* const base = moving ? "moving" : "fixed";
    PrintRow(fmt::format("one chamber, 75 kPa, base {}", base), file, {one, moving});
    PrintRow(fmt::format("two chambers, 40 kPa, base {}", base), file, {two, moving});
    PrintRow(fmt::format("three chambers, 40 kPa, base {}", base), file, {three, moving});
  }
  fmt::print("\n| two chambers, base fixed | δ | tip | force | torque |\n|---|---|---|---|---|\n");
  for (const int links : {2, 4, 6, 8, 10, 16}) {
    PrintRow(fmt::format("N = {}, RK4 0.2 ms", links), file, {two, false, links});
  }
  for (const double step : {2e-3, 1e-3, 5e-4, 2e-4}) {
    PrintRow(fmt::format("N = 10, implicitfast {:g} ms", 1e3 * step), file,
             {two, false, 10, step, false});
  }
}

}  // namespace
}  // namespace continuum

int main(int argc, char** argv) {
  try {
    if (argc == 1) return continuum::Print(continuum::ReadSpa(CONTINUUM_SPA_FILE)), 0;
    fmt::print(stderr, "usage: {}\n", argv[0]);
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
