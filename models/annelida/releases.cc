#include "models/annelida/releases.h"

#include <array>

#include <fmt/format.h>

#include "models/annelida/recording.h"

namespace continuum {
namespace {

constexpr int kRepetitions = 8;

bool Left(int repetition) { return repetition % 2 == 1; }
bool ForFitting(int repetition) {
  return repetition == 1 || repetition == 2 || repetition == 5 || repetition == 8;
}

// Of the pulled cable: no two repetitions alike. A slow pull would not repeat: in one of 2 s the
// joints stick and slip in turns that the least difference changes.
double Tension(int repetition, double time) {
  constexpr double kPulled = 0.2, kReleased = 1.5;  // s
  const double most = 13 + 0.5 * repetition;        // N
  return time >= kPulled && time < kReleased ? most : 0;
}

}  // namespace

std::vector<DemoLog> RecordReleases(const AnnelidaParameters& p, std::uint64_t draw) {
  const PlanarChain chain(p);
  std::vector<DemoLog> logs;
  for (int k = 1; k <= kRepetitions; ++k) {
    const auto tension = [k](double time) {
      const double pull = Tension(k, time);
      return Left(k) ? std::array{pull, 0.0} : std::array{0.0, pull};
    };
    const Recorded recorded{.trial = fmt::format("repetition {}", k),
                            .rows = 351,
                            .tension = tension,
                            .rate_noise = 0.05,
                            .rates = true};
    const std::uint64_t seed = 100 * draw + static_cast<std::uint64_t>(k);
    logs.push_back(
        {fmt::format("repetition{}.csv", k), Record(chain, p.Stop(), recorded, {seed}).front()});
  }
  return logs;
}

std::string ReleasesExperiment(const std::filesystem::path& model) {
  std::string text = fmt::format("format: 1\nmodel: {}\nlogs:\n", model.string());
  for (int k = 1; k <= kRepetitions; ++k) {
    text += fmt::format("  - {{file: repetition{}.csv, trial: repetition{}, use: {}}}\n", k, k,
                        ForFitting(k) ? "train" : "validate");
  }
  text += "time: {column: time, unit: s}\nstart: rest\ninputs:\n";
  for (int k = 1; k <= 4; ++k)
    text += fmt::format("  - {{column: cable{}, unit: N, actuator: cable{}}}\n", k, k);
  text += "outputs:\n";
  for (int k = 1; k <= kAnnelidaLinks; ++k) {
    text +=
        fmt::format("  - {{column: bend{}_y, unit: rad, sensor: bend{}_y, sigma: 0.003}}\n", k, k);
  }
  for (int k = 1; k <= kAnnelidaLinks; ++k) {
    text += fmt::format("  - {{column: rate{}, unit: rad/s, sensor: bend{}_y_rate, sigma: 0.05}}\n",
                        k, k);
  }
  return text + R"(parameters:
  - {name: K, target: "joint:bend*", attribute: stiffness, initial: 1.8, lower: 0.3, upper: 5}
  - {name: tau_mu, target: "plugin:joint_friction", attribute: tau_mu, initial: 0.05, lower: 0, upper: 0.3}
  - {name: tau_c, target: "plugin:joint_friction", attribute: tau_c, initial: 0.02, lower: 0.001, upper: 0.3}
  - {name: S, target: "plugin:joint_friction", attribute: S, initial: 0.4, lower: 0, upper: 5}
  - {name: v_d, target: "plugin:joint_friction", attribute: v_d, initial: 0.5, lower: 0.02, upper: 5}
  - {name: mu, target: "plugin:cable_friction", attribute: mu, initial: 0.08, lower: 0, upper: 1}
)";
}

}  // namespace continuum
