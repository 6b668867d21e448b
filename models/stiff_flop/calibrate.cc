#include "models/stiff_flop/calibrate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "error.h"
#include "models/stiff_flop/forward.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/linearize.h"

namespace continuum::stiff_flop {
namespace {

struct Pair {
  const Case* row;
  Eigen::Vector3d tip;  ///< measured
};

// Tips less those measured, over l, by the unknowns.
struct Tips {
  const Robot& robot;
  const Method& method;
  const std::vector<std::string>& names;
  std::vector<Pair> pairs;
  mutable std::string failure;

  Eigen::Index equations() const { return static_cast<Eigen::Index>(3 * pairs.size()); }

  Robot At(const double* x) const {
    Robot changed = robot;
    for (const std::string& name : names) {
      const double value = *x++;
      if (name == "E") {
        changed.module().E *= value;
      } else {
        changed.module().gamma = value;
      }
    }
    return changed;
  }
  bool operator()(const double* x, double* f) const {
    const Robot changed = At(x);
    for (const Pair& pair : pairs) {
      const Solution s = SolveForward(changed.series, method, *pair.row, false);
      if (s.status != Status::kOk) {
        failure = "case '" + pair.row->label + "': " + s.outcome.why;
        return false;
      }
      Eigen::Vector3d::Map(f) = (s.tip - pair.tip) / robot.module().l;
      f += 3;
    }
    return true;
  }
  // At a right angle gamma has no room above it.
  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const {
    constexpr double kStep = 1e-4;
    if (!(*this)(x.data(), f.data())) return false;
    Eigen::VectorXd up = f, down = f;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const bool gamma = names[static_cast<std::size_t>(i)] == "gamma";
      const bool beside = gamma && x[i] > std::numbers::pi / 2 - kStep;
      Eigen::VectorXd at = x;
      at[i] = x[i] - (beside ? 2 : 1) * kStep;
      if (!(*this)(at.data(), down.data())) return false;
      at[i] = x[i] + (beside ? -1 : 1) * kStep;
      if (!(*this)(at.data(), up.data())) return false;
      // One-sided of the same order: (3 f - 4 f_1 + f_2)/2h.
      jacobian.col(i) = beside ? Eigen::VectorXd((3 * f - 4 * up + down) / (2 * kStep))
                               : Eigen::VectorXd((up - down) / (2 * kStep));
    }
    return true;
  }
};

std::vector<Pair> PairsOf(const std::vector<Case>& cases,
                          const std::vector<statics::MeasuredPoints>& measured,
                          const std::string& file) {
  std::vector<Pair> pairs;
  for (const Case& row : cases) {
    const auto* const m = statics::Find(measured, row.label);
    if (m != nullptr && !m->test) pairs.push_back({&row, m->disks.col(0)});
  }
  if (pairs.empty()) throw Error::Input(file, "a measured case with 'use' train", "none");
  return pairs;
}

void RequireNames(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name == "E" || name == "gamma") continue;
    throw Error::Input("--parameters", "E, gamma", "'" + name + "'");
  }
  if (names.empty() || std::count(names.begin(), names.end(), names.front()) > 1) {
    throw Error::Input("--parameters", "each of E, gamma at most once", "others");
  }
}

numerics::Bounds<Eigen::Dynamic> Limits(const std::vector<std::string>& names) {
  numerics::Bounds<Eigen::Dynamic> bounds;
  const auto n = static_cast<Eigen::Index>(names.size());
  bounds.lower.resize(n);
  bounds.upper.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool E = names[static_cast<std::size_t>(i)] == "E";
    bounds.lower[i] = E ? 0.01 : std::numbers::pi / 4;
    bounds.upper[i] = E ? 100 : std::numbers::pi / 2;
  }
  return bounds;
}

void RequireEffects(const std::vector<std::string>& names, const Eigen::MatrixXd& J,
                    const std::string& file) {
  constexpr double kNoise = 1e-8;  // of l
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (J.col(static_cast<Eigen::Index>(i)).lpNorm<Eigen::Infinity>() > kNoise) continue;
    throw Error::Input(file, "tips that depend on the parameter " + names[i], "none");
  }
}

double ScatterOf(const std::vector<Pair>& pairs) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs) mean += pair.tip / static_cast<double>(pairs.size());
  double squares = 0;
  for (const Pair& pair : pairs) squares += (pair.tip - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(pairs.size()));
}

void Judge(const Tips& tips, statics::FittedShapes& fit, Calibration& c) {
  std::vector<bool> free;
  for (Eigen::Index i = 0; i < c.x.size(); ++i) {
    free.push_back(c.x[i] > fit.low[i] && c.x[i] < fit.high[i]);
    if (!free.back()) c.at_bound.push_back(c.names[static_cast<std::size_t>(i)]);
  }
  for (std::size_t i = 0; i <= tips.pairs.size(); ++i) {
    fit.begin.push_back(static_cast<Eigen::Index>(3 * i));
  }
  c.spread = statics::SpreadOf(fit, free);
  const double l = tips.robot.module().l;
  c.rmse = l * fit.f.norm() / std::sqrt(static_cast<double>(c.cases));
  std::vector<double> left_out;
  for (Eigen::Index i = 0; i < c.cases; ++i) {
    left_out.push_back(l * c.spread.left_out.segment<3>(3 * i).norm());
  }
  c.within = statics::WithinOf(left_out, c.level);
}

// The best fit from the robot's own gamma and from two more: near a right angle, where threads are
// rings, tips hardly depend on it.
Eigen::VectorXd Fit(const Tips& tips, const numerics::Bounds<Eigen::Dynamic>& bounds) {
  numerics::Options options;
  options.tolerance = 0;
  options.gradient = 1e-7;
  options.step = 1e-8;
  options.max_iterations = 200;
  const bool has_gamma = tips.names.back() == "gamma" || tips.names.front() == "gamma";
  numerics::Outcome best;
  Eigen::VectorXd found;
  for (const double gamma : {tips.robot.module().gamma, 1.4, 1.1}) {
    Eigen::VectorXd x(bounds.lower.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x[i] = tips.names[static_cast<std::size_t>(i)] == "E" ? 1 : gamma;
    }
    const auto outcome =
        numerics::LevenbergMarquardt<Eigen::VectorXd>(tips, x, tips.equations(), options, bounds);
    if (outcome.ok() && outcome.residual < best.residual) {
      best = outcome;
      found = x;
    } else if (found.size() == 0) {
      best.why = outcome.why;
    }
    if (!has_gamma) break;
  }
  if (found.size() > 0) return found;
  throw Error::Job("calibration failed: " + best.why +
                   (tips.failure.empty() ? "" : "; " + tips.failure));
}

}  // namespace

Calibration Calibrate(const Robot& robot, const Method& method,
                      const std::vector<std::string>& names, const std::vector<Case>& cases,
                      const std::vector<statics::MeasuredPoints>& measured,
                      const std::string& file) {
  RequireNames(names);
  const Tips tips{robot, method, names, PairsOf(cases, measured, file), {}};
  const auto n = static_cast<Eigen::Index>(names.size());
  if (tips.equations() <= n) throw Error::Input(file, "at least two measured tips", "one");
  const auto bounds = Limits(names);
  const Eigen::VectorXd x = Fit(tips, bounds);
  Calibration c{tips.At(x.data()), names, x, {}, {}, 0, 0, 0, 0};
  c.cases = static_cast<int>(tips.pairs.size());
  c.scatter = ScatterOf(tips.pairs);
  statics::FittedShapes fit{Eigen::VectorXd(tips.equations()),
                            Eigen::MatrixXd(tips.equations(), n),
                            {},
                            x,
                            bounds.lower,
                            bounds.upper};
  if (!tips.Jacobian(x, fit.f, fit.J)) throw Error::Job(tips.failure);
  RequireEffects(names, fit.J, file);
  Judge(tips, fit, c);
  return c;
}

}  // namespace continuum::stiff_flop
