#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "hidden_effects/suite.h"
#include "sim/io/file.h"

namespace continuum::hidden {
namespace {

constexpr int kWindows = 6;         // of one log; the last is to validate
constexpr double kGeometry = 0.03;  // of every length
constexpr std::array kLengths{"long upper link", "long lower link"};

// The joints' angles alone: of the tip a wrong length would be most of what is wrong.
constexpr std::size_t kOutputs = 2;
constexpr const char* kExperiment = R"(inputs:
  - {column: u1, unit: N*m, actuator: u1}
  - {column: u2, unit: N*m, actuator: u2}
outputs:
  - {column: q1, unit: rad, sensor: q1}
  - {column: q2, unit: rad, sensor: q2}
parameters:
  - {name: stiffness, target: "joint:*", attribute: stiffness, initial: 1.9, lower: 0.2, upper: 20}
  - {name: damping, target: "joint:*", attribute: damping, initial: 0.06, lower: 0, upper: 1}
)";

// What no candidate is.
std::vector<std::string> Unnamed() {
  return {"cogging", "drag", "coupling", "crosstalk", "wander", "one-sided spring"};
}

double Mean(const std::vector<double>& y) {
  double sum = 0;
  for (const double v : y) sum += v;
  return sum / static_cast<double>(y.size());
}

// How far two motions are apart, in standard deviations of the first's channels.
double Apart(const Columns& a, const Columns& b) {
  double sum = 0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    const double mean = Mean(a[c]);
    double difference = 0, size = 0;
    for (std::size_t k = 0; k < a[c].size(); ++k) {
      difference += std::pow(a[c][k] - b[c][k], 2);
      size += std::pow(a[c][k] - mean, 2);
    }
    sum += difference / size;
  }
  return std::sqrt(sum / static_cast<double>(a.size()));
}

class Background {
 public:
  explicit Background(const Case& c) : c_(c), robot_(RobotNamed("arm")), rng_(c.seed) {
    robot_.outputs.resize(kOutputs);
  }

  std::filesystem::path Write(const std::filesystem::path& folder) {
    Drive();
    plain_ = Move({});
    for (const char* const length : kLengths) hidden_.emplace_back(length, kGeometry * Sign());
    const double geometry = Apart(plain_, Move(hidden_));
    const double size = geometry * Between(2, 4);
    auto unnamed = Unnamed();
    std::shuffle(unnamed.begin(), unnamed.end(), rng_);
    for (int k = 0; k < 3; ++k) AddOfSize(unnamed[k], size * Between(0.1, 0.2));
    const Columns background = Move(hidden_);
    for (const auto& effect : c_.effects) AddOfSize(effect, size);
    Columns y = Move(hidden_);
    const double over = Apart(plain_, background) / std::pow(10, Between(1, 2));
    for (auto& column : y) column = WithNoise(column, c_.noise, over * SizeOf(column), rng_);
    MakeFolder(folder);
    WriteFile(folder / "robot.xml", robot_.model);
    WriteFile(folder / "log.csv", Csv(robot_, u_, y));
    WriteFile(folder / "experiment.yaml", Experiment());
    return folder / "experiment.yaml";
  }

 private:
  double Between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng_);
  }
  double Sign() { return Between(-1, 1) < 0 ? -1 : 1; }

  static double SizeOf(const std::vector<double>& y) {
    const double mean = Mean(y);
    double squares = 0;
    for (const double v : y) squares += (v - mean) * (v - mean);
    return std::sqrt(squares / static_cast<double>(y.size()));
  }

  void Drive() {
    for (int w = 0; w < kWindows; ++w) {
      const Columns window = robot_.drive(w % robot_.trials, rng_);
      u_.resize(window.size());
      for (std::size_t i = 0; i < u_.size(); ++i)
        u_[i].insert(u_[i].end(), window[i].begin(), window[i].end());
    }
  }

  Columns Move(const Amounts& amounts) const {
    Columns y = robot_.run(amounts, 0, u_);
    y.resize(kOutputs);
    return y;
  }

  // An effect that moves the robot that far from what it does without.
  void AddOfSize(const std::string& effect, double size) {
    Amounts one{{effect, robot_.Named(effect).size}};
    for (int iteration = 0; iteration < 4; ++iteration)
      one[0].second *= size / Apart(plain_, Move(one));
    hidden_.push_back(one[0]);
  }

  std::string Experiment() const {
    std::string logs;
    const double span = robot_.period * static_cast<double>(robot_.rows);
    for (int w = 0; w < kWindows; ++w) {
      logs += fmt::format(
          "  - {{file: log.csv, trial: window{}, use: {}, window: [{:.3f}, {:.3f}]}}\n", w,
          w + 1 < kWindows ? "train" : "validate", span * w, span * (w + 1) - 2 * robot_.period);
    }
    return std::string("format: 1\nmodel: robot.xml\nstart: estimate\n") + kExperiment + "logs:\n" +
           logs + "candidates: [" + CandidatesOf(c_) + "]\n";
  }

  const Case& c_;
  Robot robot_;
  std::mt19937_64 rng_;
  Columns u_, plain_;
  Amounts hidden_;
};

}  // namespace

std::filesystem::path WriteBackground(const Case& c, const std::filesystem::path& folder) {
  return Background(c).Write(folder);
}

}  // namespace continuum::hidden
