#include "models/annelida/demo.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "error.h"
#include "models/annelida/planar_chain.h"

namespace continuum {
namespace {

constexpr int kRows = 301;
constexpr double kPeriod = 0.01;  // [s]

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

// Normal numbers that are the same with every standard library.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : random_(seed) {}

  double operator()(double sigma) {
    const double radius = std::sqrt(-2 * std::log(Uniform()));
    return sigma * radius * std::cos(2 * std::numbers::pi * Uniform());
  }

 private:
  double Uniform() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; }

  std::mt19937_64 random_;
};

std::array<double, 2> TensionAt(const Trial& trial, double time) {
  std::array<double, 2> tension{0, 0};
  for (const Pull& pull : trial.pulls) {
    if (time > pull.time - 1e-9) tension = {pull.left, pull.right};
  }
  return tension;
}

std::string Header() {
  std::string header = "time,cable1,cable2,cable3,cable4";
  for (int i = 1; i <= kAnnelidaLinks; ++i) header += fmt::format(",bend{}_y", i);
  return header + ",tip_x,tip_z\n";
}

// Joint angles at the rows of a trial.
std::vector<Joints> Motion(const PlanarChain& chain, const Trial& trial, double stop, double h) {
  const long steps = std::lround(kPeriod / h);
  std::vector<Joints> rows;
  PlanarState state;
  for (int row = 0; row < kRows; ++row) {
    rows.push_back(state.q);
    if (state.q.cwiseAbs().maxCoeff() > stop) {
      throw Error::Job("annelida demo: trial " + trial.name + " reaches a stop");
    }
    const auto tension = TensionAt(trial, row * kPeriod);
    for (long k = 0; k < steps; ++k) chain.Step(state, tension, h);
  }
  return rows;
}

std::string Csv(const PlanarChain& chain, const Trial& trial, const std::vector<Joints>& motion,
                const DemoTruth& truth, std::uint64_t seed) {
  Noise noise(seed);
  std::string csv = Header();
  for (int row = 0; row < kRows; ++row) {
    const auto tension = TensionAt(trial, row * kPeriod);
    csv += fmt::format("{:.2f},{},0,{},0", row * kPeriod, tension[0], tension[1]);
    for (const double q : motion[row]) csv += fmt::format(",{:.5f}", q + noise(truth.angle_noise));
    for (const double x : chain.Tip(motion[row]))
      csv += fmt::format(",{:.5f}", x + noise(truth.tip_noise));
    csv += "\n";
  }
  return csv;
}

}  // namespace

std::vector<DemoLog> RecordDemo(const AnnelidaParameters& p, const DemoTruth& truth) {
  const PlanarChain chain(p, truth.payload);
  std::vector<DemoLog> logs;
  std::uint64_t seed = 1;
  for (const Trial& trial : Trials()) {
    const auto motion = Motion(chain, trial, p.Stop(), truth.step);
    for (int repeat = 1; repeat <= 2; ++repeat) {
      logs.push_back(
          {fmt::format("{}_{}.csv", trial.name, repeat), Csv(chain, trial, motion, truth, seed++)});
    }
  }
  return logs;
}

}  // namespace continuum
