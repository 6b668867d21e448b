#include "identification/problem.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "effects/all.h"
#include "error.h"
#include "identification/parallel.h"

namespace continuum {
namespace {

double TypicalSize(double initial, double lower, double upper) {
  const double range = upper - lower;
  const double size = std::max(std::abs(initial), 1e-3 * range);
  return std::isfinite(size) && size > 0 ? std::min(size, range) : 1;
}

std::string UnitOf(const System& system, const Parameter& p) {
  if (p.operation == Change::Operation::kScale) return "1";
  const mjModel& m = system.model();
  if (p.target.starts_with("plugin:")) {
    const int id = mj_name2id(&m, mjOBJ_PLUGIN, p.target.substr(7).c_str());
    const std::string plugin = id < 0 ? "" : mjp_getPluginAtSlot(m.plugin[id])->name;
    std::string unit = "1";
    All::ForEach([&]<class E>() {
      for (const Param& param : E::kParams) {
        if (plugin == "continuum." + std::string(E::kName) && param.name == p.attribute) {
          unit = param.unit;
        }
      }
    });
    return unit;
  }
  const std::string name = p.attribute.substr(0, p.attribute.find('['));
  const std::string kind = p.target.substr(0, p.target.find(':'));
  if (name == "mass" || name == "point_mass") return "kg";
  if (name == "inertia" || name == "fullinertia" || name == "armature") return "kg*m^2";
  if (name == "ref" || name == "springref") return "rad";
  if (name == "pos" || name == "springlength") return "m";
  if (name == "delay" || name == "lag" || name == "timestep") return "s";
  if (name == "gravity") return "m/s^2";
  if (name == "stiffness") return kind == "tendon" ? "N/m" : "N*m/rad";
  if (name == "damping") return kind == "tendon" ? "N*s/m" : "N*m*s/rad";
  if (name == "frictionloss") return kind == "tendon" ? "N" : "N*m";
  return "1";
}

}  // namespace

double SumOfSquares(const std::vector<Eigen::VectorXd>& residuals) {
  double sum = 0;
  for (const auto& r : residuals) sum += r.squaredNorm();
  return sum;
}

Problem::Problem(const Experiment& experiment, const System& system, std::vector<Parameter> extra,
                 ForceTerms terms)
    : experiment_(&experiment), terms_(std::move(terms)) {
  for (std::size_t t = 0; t < ThreadCount(); ++t) {
    systems_.push_back(system);
    systems_.back().DropVisuals();
  }
  for (const Parameter& p : experiment.parameters) Expand(p);
  for (const Parameter& p : extra) Expand(p);
  for (std::size_t k = 0; k < terms_.count; ++k) {
    parameters_.push_back({"force term " + std::to_string(k + 1),
                           "N*m",
                           0,
                           -100 * terms_.size,
                           100 * terms_.size,
                           10 * terms_.size,
                           {},
                           AllLogs()});
  }
  const Pool pool(experiment);
  bool sigma = true;
  for (const Output& out : experiment.outputs) sigma &= out.sigma > 0 || out.weight == 0;
  for (std::size_t c = 0; c < experiment.channels.size(); ++c) {
    const auto& channel = experiment.channels[c];
    const Output& out = experiment.outputs[channel.output];
    if (!pool.counts(c)) continue;
    channels_.push_back(c);
    const double unit = sigma ? out.sigma * channel.factor : pool.scale(c);
    scale_.push_back(unit / std::sqrt(out.weight));
    pooled_.push_back(scale_.back() / pool.scale(c));
  }
}

void Problem::Expand(const Parameter& p) {
  const auto& logs = experiment_->logs;
  const auto at = [&](const std::function<double()>& read) {
    try {
      return read();
    } catch (const Error& e) {
      throw Error::Input(p.where, e.what());
    }
  };
  FreeParameter free{p.name, UnitOf(system(), p), p.initial, p.lower, p.upper, 1, {}, {}};
  const double present = at([&] { return system().Value(p.target, p.attribute); });
  if (!p.has_initial) {
    free.initial = p.operation == Change::Operation::kScale ? 1
                   : p.operation == Change::Operation::kAdd ? 0
                                                            : present;
  }
  free.change = {p.target, p.attribute, 0, p.operation};
  if (p.frozen) {
    free.change.value = free.initial;
    frozen_.push_back(free.change);
    return;
  }
  if (free.initial < free.lower || free.initial > free.upper) {
    throw Error::Input(
        p.where,
        "a start within [" + std::to_string(free.lower) + ", " + std::to_string(free.upper) + "]",
        std::to_string(free.initial) + " (what the model has)");
  }
  free.scale = TypicalSize(free.initial, free.lower, free.upper);
  if (p.per == Parameter::Per::kAll) {
    free.log.assign(logs.size(), true);
    parameters_.push_back(free);
    return;
  }
  const auto group = [&](const Log& log) {
    return p.per == Parameter::Per::kLog ? log.label : log.condition;
  };
  std::set<std::string> trained, all;
  for (const Log& log : logs) {
    all.insert(group(log));
    if (log.train) trained.insert(group(log));
  }
  for (const std::string& name : all) {
    if (!trained.contains(name)) {
      throw Error::Input(p.where,
                         "a train log of every " +
                             std::string(p.per == Parameter::Per::kLog ? "log" : "condition"),
                         "none of '" + name + "'");
    }
    FreeParameter one = free;
    one.name = p.name + "[" + name + "]";
    for (const Log& log : logs) one.log.push_back(group(log) == name);
    parameters_.push_back(std::move(one));
  }
}

Problem::Vector Problem::Start() const {
  Vector x(static_cast<Eigen::Index>(parameters_.size()));
  for (std::size_t i = 0; i < parameters_.size(); ++i) x[i] = parameters_[i].initial;
  return x;
}

Problem::Vector Problem::Clamp(const Vector& x) const {
  Vector out = x;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    out[i] = std::clamp(x[i], parameters_[i].lower, parameters_[i].upper);
  }
  return out;
}

std::vector<bool> Problem::TrainLogs() const {
  std::vector<bool> use;
  for (const Log& log : experiment_->logs) use.push_back(log.train);
  return use;
}

std::vector<Change> Problem::ChangesFor(const Vector& x, std::size_t log) const {
  std::vector<Change> changes = experiment_->logs[log].set;
  changes.insert(changes.end(), frozen_.begin(), frozen_.end());
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (!parameters_[i].log[log] || parameters_[i].change.target.empty()) continue;
    changes.push_back(parameters_[i].change);
    changes.back().value = x[i];
  }
  return changes;
}

std::vector<Change> Problem::CommonChanges(const Vector& x) const {
  std::vector<Change> changes = frozen_;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const auto& acts = parameters_[i].log;
    if (std::find(acts.begin(), acts.end(), false) != acts.end()) continue;
    if (parameters_[i].change.target.empty()) continue;
    changes.push_back(parameters_[i].change);
    changes.back().value = x[i];
  }
  return changes;
}

Trace Problem::Run(std::size_t thread, const Vector& x, std::size_t log) const {
  Machine machine = systems_[thread].Build(ChangesFor(x, log));
  Hooks hooks;
  if (terms_.count > 0) {
    const std::span<const double> theta(x.data() + x.size() - terms_.count, terms_.count);
    hooks.step = [&terms = terms_, theta](const mjModel& m, mjData& d) {
      mju_zero(d.qfrc_applied, static_cast<int>(m.nv));
      terms.add(m, d, theta);
    };
  }
  return Simulate(machine, *experiment_, experiment_->logs[log], {}, hooks);
}

Trace Problem::Predict(const Vector& x, std::size_t log) const { return Run(0, x, log); }

Problem::Vector Problem::ResidualOf(std::size_t index, const Trace& trace) const {
  const Log& log = experiment_->logs[index];
  const auto residuals = continuum::Residuals(*experiment_, log, trace);
  const auto rows = static_cast<Eigen::Index>(log.rows());
  Vector r(rows * static_cast<Eigen::Index>(channels_.size()));
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    for (Eigen::Index k = 0; k < rows; ++k) {
      const double value = residuals[channels_[c]][k];
      const bool missing = std::isnan(log.measured[channels_[c]][k]);
      r[static_cast<Eigen::Index>(c) * rows + k] = missing ? 0 : value / scale_[c];
    }
  }
  if (trace.diverged) r.setConstant(std::numeric_limits<double>::quiet_NaN());
  return r;
}

std::vector<Problem::Vector> Problem::Residuals(const Vector& x,
                                                const std::vector<bool>& use) const {
  std::vector<std::size_t> logs;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (use[l]) logs.push_back(l);
  }
  std::vector<Vector> out(use.size());
  ParallelFor(logs.size(), [&](std::size_t thread, std::size_t i) {
    out[logs[i]] = ResidualOf(logs[i], Run(thread, x, logs[i]));
  });
  evaluations_ += logs.size();
  return out;
}

std::vector<Problem::Matrix> Problem::Jacobian(const Vector& x, const std::vector<Vector>& r,
                                               const std::vector<bool>& use,
                                               const std::vector<Matrix>& known) const {
  std::vector<Matrix> J(use.size());
  std::vector<std::pair<std::size_t, std::size_t>> tasks;  // log, parameter
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    J[l] = Matrix::Zero(r[l].size(), x.size());
    const std::size_t first = known.empty() ? 0 : static_cast<std::size_t>(known[l].cols());
    if (first > 0) J[l].leftCols(known[l].cols()) = known[l];
    for (std::size_t i = first; i < parameters_.size(); ++i) {
      if (parameters_[i].log[l]) tasks.emplace_back(l, i);
    }
  }
  ParallelFor(tasks.size(), [&](std::size_t thread, std::size_t t) {
    const auto [l, i] = tasks[t];
    const FreeParameter& p = parameters_[i];
    double step = 1e-3 * p.scale;  // stick and slip are decided step by step: average over some
    if (x[i] + step > p.upper) step = -step;
    Vector moved = x;
    moved[i] += step;
    const Vector there = ResidualOf(l, Run(thread, moved, l));
    J[l].col(i) = (there - r[l]) / step;
  });
  evaluations_ += tasks.size();
  return J;
}

double Problem::PooledRms(const std::vector<Vector>& r, const std::vector<bool>& use) const {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    const Log& log = experiment_->logs[l];
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      for (std::size_t k = 0; k < log.rows(); ++k) {
        if (std::isnan(log.measured[channels_[c]][k])) continue;
        const double e = pooled_[c] * r[l][static_cast<Eigen::Index>(c * log.rows() + k)];
        squares += e * e;
        ++count;
      }
    }
  }
  return count ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

}  // namespace continuum
