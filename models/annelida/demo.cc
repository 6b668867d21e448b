#include "models/annelida/demo.h"

#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "models/annelida/recording.h"

namespace continuum {
namespace {

constexpr int kRows = 301;

// From this time on [s] these tensions of cables 1 and 3 [N].
struct Pull {
  double time, left, right;
};
struct Trial {
  std::string name;
  std::vector<Pull> pulls;
};

const std::vector<Trial>& Trials() {
  static const std::vector<Trial> trials{
      {"left_right", {{0.2, 16, 0}, {1.1, 0, 0}, {1.7, 0, 12}, {2.4, 0, 0}}},
      {"right_twice", {{0.2, 0, 14}, {0.9, 0, 5}, {1.5, 0, 17}, {2.3, 0, 0}}},
      {"left_stairs", {{0.2, 6, 0}, {0.8, 12, 0}, {1.4, 17, 0}, {2.0, 8, 0}, {2.5, 0, 0}}},
      {"right_left", {{0.2, 0, 15}, {0.8, 0, 0}, {1.3, 13, 0}, {1.9, 4, 0}, {2.4, 0, 10}}}};
  return trials;
}

std::array<double, 2> TensionAt(const Trial& trial, double time) {
  std::array<double, 2> tension{0, 0};
  for (const Pull& pull : trial.pulls) {
    if (time > pull.time - 1e-9) tension = {pull.left, pull.right};
  }
  return tension;
}

}  // namespace

std::vector<DemoLog> RecordDemo(const AnnelidaParameters& p, const DemoTruth& truth) {
  const PlanarChain chain(p, truth.payload);
  std::vector<DemoLog> logs;
  std::uint64_t seed = 1;
  for (const Trial& trial : Trials()) {
    const Recorded recorded{.trial = trial.name,
                            .rows = kRows,
                            .tension = [&](double time) { return TensionAt(trial, time); },
                            .angle_noise = truth.angle_noise,
                            .tip_noise = truth.tip_noise,
                            .step = truth.step};
    int repeat = 0;
    for (std::string& csv : Record(chain, p.Stop(), recorded, {seed, seed + 1}))
      logs.push_back({fmt::format("{}_{}.csv", trial.name, ++repeat), std::move(csv)});
    seed += 2;
  }
  return logs;
}

}  // namespace continuum
