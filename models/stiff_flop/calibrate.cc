#include "models/stiff_flop/calibrate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "models/stiff_flop/details.h"
#include "models/stiff_flop/forward.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/linearize.h"

namespace continuum::stiff_flop {
namespace {

struct Pair {
  const Case* row;
  Eigen::Matrix3Xd ends;  ///< of the modules as measured; a column of NaN: not measured

  bool Has(Eigen::Index module) const { return !std::isnan(ends(0, module)); }
  Eigen::Index points() const { return (ends.row(0).array() == ends.row(0).array()).count(); }
};

// Upper ends of the modules less those measured, over the length, by the unknowns.
struct Ends {
  const Robot& robot;
  const Method& method;
  const std::vector<std::string>& names;
  std::vector<Pair> pairs;
  mutable std::string failure;

  Eigen::Index points() const {
    Eigen::Index count = 0;
    for (const Pair& pair : pairs) count += pair.points();
    return count;
  }
  Eigen::Index equations() const { return 3 * points(); }
  double length() const { return robot.series.length(); }

  Robot At(const double* x) const {
    Robot changed = robot;
    for (const std::string& name : names) {
      const double value = *x++;
      for (const std::size_t at : ModulesOf(robot, name)) {
        Module& module = changed.series.modules[at];
        if (IsGamma(name)) {
          module.gamma = value;
        } else {
          module.E *= value;
        }
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
      Eigen::Matrix3Xd ends = s.tip;
      if (robot.series.size() > 1) ends = EndsOf(changed.series, method, *pair.row, s);
      for (Eigen::Index k = 0; k < ends.cols(); ++k) {
        if (!pair.Has(k)) continue;
        Eigen::Vector3d::Map(f) = (ends.col(k) - pair.ends.col(k)) / length();
        f += 3;
      }
    }
    return true;
  }
  // At a right angle gamma has no room above it.
  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const {
    constexpr double kStep = 1e-4;
    if (!(*this)(x.data(), f.data())) return false;
    Eigen::VectorXd up = f, down = f;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const bool gamma = IsGamma(names[static_cast<std::size_t>(i)]);
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
    if (m != nullptr && !m->test) pairs.push_back({&row, m->disks});
  }
  if (pairs.empty()) throw Error::Input(file, "a measured case with 'use' train", "none");
  return pairs;
}

void RequireNames(const Robot& robot, const std::vector<std::string>& names) {
  const std::string known = robot.series.size() == 1
                                ? "E, gamma"
                                : "E, gamma, or of one module, as E_" + robot.names.front();
  std::set<std::pair<bool, std::size_t>> taken;
  for (const std::string& name : names) {
    const auto modules = ModulesOf(robot, name);
    if (modules.empty()) throw Error::Input("--parameters", known, "'" + name + "'");
    for (const std::size_t module : modules) {
      if (taken.insert({IsGamma(name), module}).second) continue;
      throw Error::Input("--parameters", "each of " + known + " at most once", "'" + name + "'");
    }
  }
  if (names.empty()) throw Error::Input("--parameters", known, "none");
}

numerics::Bounds<Eigen::Dynamic> Limits(const std::vector<std::string>& names) {
  numerics::Bounds<Eigen::Dynamic> bounds;
  const auto n = static_cast<Eigen::Index>(names.size());
  bounds.lower.resize(n);
  bounds.upper.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool gamma = IsGamma(names[static_cast<std::size_t>(i)]);
    bounds.lower[i] = gamma ? std::numbers::pi / 4 : 0.01;
    bounds.upper[i] = gamma ? std::numbers::pi / 2 : 100;
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

// Of every module's end about its mean.
double ScatterOf(const std::vector<Pair>& pairs) {
  double squares = 0;
  Eigen::Index points = 0;
  for (Eigen::Index k = 0; k < pairs.front().ends.cols(); ++k) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    for (const Pair& pair : pairs) {
      if (pair.Has(k)) sum += pair.ends.col(k), ++count;
    }
    for (const Pair& pair : pairs) {
      if (!pair.Has(k)) continue;
      squares += (pair.ends.col(k) - sum / count).squaredNorm();
      ++points;
    }
  }
  return std::sqrt(squares / static_cast<double>(points));
}

void Judge(const Ends& ends, statics::FittedShapes& fit, Calibration& c) {
  std::vector<bool> free;
  for (Eigen::Index i = 0; i < c.x.size(); ++i) {
    free.push_back(c.x[i] > fit.low[i] && c.x[i] < fit.high[i]);
    if (!free.back()) c.at_bound.push_back(c.names[static_cast<std::size_t>(i)]);
  }
  fit.begin.push_back(0);
  for (const Pair& pair : ends.pairs) fit.begin.push_back(fit.begin.back() + 3 * pair.points());
  c.spread = statics::SpreadOf(fit, free);
  const auto points = static_cast<double>(ends.points());
  c.rmse = ends.length() * fit.f.norm() / std::sqrt(points);
  std::vector<double> left_out;
  for (Eigen::Index i = 0; i < ends.points(); ++i) {
    left_out.push_back(ends.length() * c.spread.left_out.segment<3>(3 * i).norm());
  }
  c.within = statics::WithinOf(left_out, c.level);
}

// The best fit from the robot's own gamma and from two more: near a right angle, where threads are
// rings, tips hardly depend on it.
Eigen::VectorXd Fit(const Ends& ends, const numerics::Bounds<Eigen::Dynamic>& bounds) {
  constexpr double kItsOwn = 0;
  numerics::Options options;
  options.tolerance = 0;
  options.gradient = 1e-7;
  options.step = 1e-8;
  options.max_iterations = 200;
  const bool has_gamma = std::any_of(ends.names.begin(), ends.names.end(), IsGamma);
  numerics::Outcome best;
  Eigen::VectorXd found;
  for (const double gamma : {kItsOwn, 1.4, 1.1}) {
    Eigen::VectorXd x(bounds.lower.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const std::string& name = ends.names[static_cast<std::size_t>(i)];
      const double own = ends.robot.series[ModulesOf(ends.robot, name).front()].gamma;
      x[i] = !IsGamma(name) ? 1 : gamma == kItsOwn ? own : gamma;
    }
    const auto outcome =
        numerics::LevenbergMarquardt<Eigen::VectorXd>(ends, x, ends.equations(), options, bounds);
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
                   (ends.failure.empty() ? "" : "; " + ends.failure));
}

}  // namespace

std::vector<std::size_t> ModulesOf(const Robot& robot, const std::string& name) {
  std::vector<std::size_t> modules;
  for (std::size_t i = 0; i < robot.names.size(); ++i) {
    for (const std::string of : {"E", "gamma"}) {
      if (name == of || name == of + "_" + robot.names[i]) modules.push_back(i);
    }
  }
  return modules;
}

bool IsGamma(const std::string& name) { return name.starts_with("gamma"); }

Calibration Calibrate(const Robot& robot, const Method& method,
                      const std::vector<std::string>& names, const std::vector<Case>& cases,
                      const std::vector<statics::MeasuredPoints>& measured,
                      const std::string& file) {
  RequireNames(robot, names);
  const Ends ends{robot, method, names, PairsOf(cases, measured, file), {}};
  const auto n = static_cast<Eigen::Index>(names.size());
  if (ends.equations() <= n) throw Error::Input(file, "at least two measured tips", "one");
  const auto bounds = Limits(names);
  const Eigen::VectorXd x = Fit(ends, bounds);
  Calibration c{ends.At(x.data()), names, x, {}, {}, 0, 0, 0, 0};
  c.cases = static_cast<int>(ends.pairs.size());
  c.scatter = ScatterOf(ends.pairs);
  statics::FittedShapes fit{Eigen::VectorXd(ends.equations()),
                            Eigen::MatrixXd(ends.equations(), n),
                            {},
                            x,
                            bounds.lower,
                            bounds.upper};
  if (!ends.Jacobian(x, fit.f, fit.J)) throw Error::Job(ends.failure);
  RequireEffects(names, fit.J, file);
  Judge(ends, fit, c);
  return c;
}

}  // namespace continuum::stiff_flop
