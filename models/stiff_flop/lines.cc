#include "models/stiff_flop/lines.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/solver.h"

namespace continuum::stiff_flop {
namespace {

constexpr double kDeadUnit = 1e4;  // Pa

// The fitted numbers, each about 1.
std::vector<double> Unknowns(const Lines& lines, const LineEffects& effects) {
  std::vector<double> x;
  if (effects.gain) x.assign(lines.gain.begin(), lines.gain.end());
  if (effects.dead) x.push_back(lines.dead / kDeadUnit);
  if (effects.creep) x.insert(x.end(), {10 * lines.creep, lines.lag});
  return x;
}

Lines WithUnknowns(Lines lines, const LineEffects& effects, const double* x) {
  if (effects.gain) {
    for (double& gain : lines.gain) gain = *x++;
  }
  if (effects.dead) lines.dead = kDeadUnit * *x++;
  if (effects.creep) {
    lines.creep = *x++ / 10;
    lines.lag = *x++;
  }
  return lines;
}

bool Possible(const Lines& lines) {
  return lines.gain.minCoeff() > 0 && lines.dead >= 0 && lines.creep >= 0 && lines.creep < 1 &&
         lines.lag > 0;
}

/// Marker residuals [mm] after the best registration.
struct Residuals {
  const Robot& robot;
  const Method& method;
  const Log& log;  ///< train rows only
  const LineEffects& effects;
  const Lines& start;

  bool operator()(const double* x, double* f) const {
    const Lines lines = WithUnknowns(start, effects, x);
    return Possible(lines) && MarkerResiduals(robot, method, lines.Acting(log), f);
  }

  template <class X, class F, class J>
  bool Jacobian(const X& x, F& f, J& jacobian) const {
    return numerics::Differences(*this, x, 1e-4, f, jacobian);
  }
};

}  // namespace

Log Lines::Acting(const Log& log) const {
  Log acting = log;
  Eigen::Vector3d late = Eigen::Vector3d::Zero(), before = late;
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const Eigen::Vector3d q =
        gain.cwiseProduct((log.pressure[i].array() - dead).cwiseMax(0).matrix());
    if (i > 0) {
      const double h = log.time[i] - log.time[i - 1], left = std::exp(-h / lag);
      const Eigen::Vector3d slope = (q - before) / h;
      late = q - lag * slope + left * (late - before + lag * slope);
    }
    before = q;
    acting.pressure[i] = (1 - creep) * q + creep * late;
  }
  return acting;
}

numerics::Outcome FitLines(const Robot& robot, const Method& method, const Log& log,
                           const LineEffects& effects, Lines& lines) {
  const Log train = log.First(TrainRows(log));
  const std::vector<double> start = Unknowns(lines, effects);
  Eigen::VectorXd x =
      Eigen::Map<const Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
  numerics::Options options;
  options.max_iterations = 20;
  options.gradient = 1e-4;
  options.step = 1e-5;
  const Lines given = lines;
  const auto outcome = numerics::LevenbergMarquardt<Eigen::VectorXd>(
      Residuals{robot, method, train, effects, given}, x,
      static_cast<Eigen::Index>(3 * train.time.size()), options);
  lines = WithUnknowns(given, effects, x.data());
  return outcome;
}

}  // namespace continuum::stiff_flop
