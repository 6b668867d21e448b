#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "hidden_effects/outside/joints.h"
#include "hidden_effects/robot.h"

namespace continuum::hidden {

inline constexpr double kRowPeriod = 0.01;  // s, of all logs of the outside suite
inline constexpr long kStepsPerRow = 400;   // of 25 us

/// What may be wrong on the way in and on the way out of a machine.
struct Signals {
  double gain = 1, offset = 0, dead_time = 0, lag = 0;  ///< 1, input's, s, s
  double bias = 0, scale = 1, late = 0, drift = 0;      ///< output's, 1, s, output's/s
  std::size_t wrong_outputs = 1000;                     ///< the first so many are wrong

  double Seen(double y, std::size_t output, double t) const {
    return output < wrong_outputs ? scale * y + bias + drift * t : y;
  }
};

/// Logs of a machine at rest before its first row. Machine has Step(input, h) [one value for each
/// column of u, as it arrives] and Outputs(). on: [rows] whether its motors are on; off, nothing
/// arrives at once, however late and wrong the inputs are. Empty: always.
template <class Machine>
Columns Record(const Signals& s, Machine& machine, const Columns& u,
               const std::vector<double>& on = {}) {
  constexpr double h = kRowPeriod / kStepsPerRow;
  const auto rows = static_cast<long>(u[0].size());
  const long behind = std::lround(s.dead_time / h), late = std::lround(s.late / h);
  const auto wanted = [&](std::size_t i, long step) {
    return s.gain * Held(u[i], step, behind, kStepsPerRow) + s.offset;
  };
  std::vector<double> input;
  for (std::size_t i = 0; i < u.size(); ++i) input.push_back(wanted(i, 0));
  Columns out(machine.Outputs().size());
  const auto record = [&] {
    const std::vector<double> y = machine.Outputs();
    const double t = kRowPeriod * static_cast<double>(out[0].size());
    for (std::size_t i = 0; i < y.size(); ++i) out[i].push_back(s.Seen(y[i], i, t));
  };
  for (long step = -late; step < rows * kStepsPerRow; ++step) {
    if ((step + late) % kStepsPerRow == 0 && step + late < rows * kStepsPerRow) record();
    if (step < 0) continue;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double target = wanted(i, step);
      input[i] = s.lag > 0 ? input[i] + (1 - std::exp(-h / s.lag)) * (target - input[i]) : target;
    }
    const bool off = !on.empty() && on[step / kStepsPerRow] < 0.5;
    machine.Step(off ? std::vector<double>(u.size()) : input, h);
  }
  return out;
}

/// What every machine of the outside suite has.
struct Outside {
  Law law = Law::kStick;
  double heavier = 1, longer = 1;  ///< factors on all masses and lengths that the model misses
  Signals signals = {};
};

/// Lets a robot move as a plant with parts does, and as Outside may.
template <class Plant>
void EquipOutside(Robot& robot, std::vector<Part<Plant>> parts) {
  parts.push_back({{"heavier", "", 0.01}, [](Plant& p, double v) { p.heavier += v; }});
  parts.push_back({{"longer", "", 0.01}, [](Plant& p, double v) { p.longer += v; }});
  parts.push_back({{"law", "", 1}, [](Plant& p, double v) { p.law = static_cast<Law>(v); }});
  robot.outside = true;
  Equip(robot, parts);
}

}  // namespace continuum::hidden
