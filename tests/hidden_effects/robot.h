#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace continuum::hidden {

using Columns = std::vector<std::vector<double>>;  ///< [column][row]

/// One effect that the logs may have and the model has not.
struct Hidden {
  std::string name;       ///< of the effect as the diagnosis calls it
  std::string parameter;  ///< whose value is the truth; empty: the law has no such number
  double size;            ///< a moderate one
  double null = 0;
  std::vector<std::string> siblings = {};  ///< names that mean the same on these logs
};
using Amounts = std::vector<std::pair<std::string, double>>;  ///< of effects, beyond their null

/// A machine that moves by equations of its own, and the model that is to explain its logs.
struct Robot {
  std::string name;
  std::string model;                         ///< MJCF that has nothing of what is hidden
  std::string experiment;                    ///< inputs, outputs and parameters as YAML
  std::vector<std::string> inputs, outputs;  ///< columns of the logs
  std::vector<double> sigma;                 ///< of the noise of each output
  double period = 0.01;                      ///< s
  std::size_t rows = 400;
  int trials = 3;
  int held_out = 1;      ///< trials that validate, the last ones
  bool outside = false;  ///< of the outside suite: it has other masses than its model
  std::vector<std::string> conditions = {};  ///< [trial] YAML of what its logs set, if anything
  std::vector<Hidden> effects = {};
  std::function<Columns(int trial, std::mt19937_64&)> drive = {};
  std::function<Columns(const Amounts&, int trial, const Columns& u)> run = {};

  const Hidden& Named(const std::string& effect) const;  ///< throws std::out_of_range
};

/// The robots by name; throws std::out_of_range.
const Robot& RobotNamed(const std::string& name);

/// An effect and how a plant gets it.
template <class Plant>
struct Part {
  Hidden effect;
  void (*add)(Plant&, double amount);
};

/// Lets a robot move as a plant with parts does.
template <class Plant>
void Equip(Robot& robot, const std::vector<Part<Plant>>& parts) {
  for (const auto& part : parts) robot.effects.push_back(part.effect);
  robot.run = [parts](const Amounts& hidden, int trial, const Columns& u) {
    Plant plant;
    for (const auto& [name, amount] : hidden) {
      for (const auto& part : parts) {
        if (part.effect.name == name) part.add(plant, amount);
      }
    }
    return plant.Run(u, trial);
  };
}

/// A column that is held from row to row, at a time that many steps into the log, when the input
/// comes late by some; before the first row it is the first.
inline double Held(const std::vector<double>& column, long step, long late, long steps_per_row) {
  return column[static_cast<std::size_t>(std::max(0L, step - late) / steps_per_row)];
}

/// Steps of random height, and in later trials sines on them; at rest at the end.
inline std::vector<double> StepsAndSines(int trial, double high, std::size_t rows, double period,
                                         std::mt19937_64& rng) {
  std::uniform_real_distribution<double> part;
  std::vector<double> u;
  const double slow = 1 + 2 * part(rng), fast = 5 + 6 * part(rng);
  const std::size_t each = rows / 5, rest = rows * 17 / 20;
  double step = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = period * static_cast<double>(k);
    if (k % each == each / 4) step = high * (2 * part(rng) - 1);
    if (k > rest) step = 0;
    const double sines =
        trial == 0 || k > rest ? 0 : 0.5 * high * (std::sin(slow * t) + 0.4 * std::sin(fast * t));
    u.push_back(step + sines);
  }
  return u;
}

}  // namespace continuum::hidden
