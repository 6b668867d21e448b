#include "identification/inverse_dynamics/missing_force.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Dense>

#include "sim/experiment/measurement_model.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

constexpr double kStill = 1e-2;  // of the largest motion: less is none
constexpr std::size_t kHalf = 5, kRows = 2 * kHalf + 1, kTerms = 5;

double Square(double x) { return x * x; }

// The quartic through the rows around one row: weights of their values.
struct Quartic {
  std::size_t begin;
  Eigen::VectorXd value, slope, curvature;
  Eigen::VectorXd mean;  // (2): of mean accelerations from each of these rows to the next

  Quartic(const std::vector<double>& t, std::size_t k) : begin(k - kHalf), mean(kRows - 1) {
    Eigen::MatrixXd A(kRows, kTerms);
    for (std::size_t i = 0; i < kRows; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      A(row, 0) = 1;
      for (Eigen::Index n = 1; n < A.cols(); ++n)
        A(row, n) = A(row, n - 1) * (t[begin + i] - t[k]) / static_cast<double>(n);
    }
    const Eigen::MatrixXd weights =
        A.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(kRows, kRows));
    value = weights.row(0), slope = weights.row(1), curvature = weights.row(2);
    const auto after = [&](std::size_t i, std::size_t j) {
      return Square(std::max(0.0, t[begin + i] - t[begin + j])) / 2;
    };
    for (std::size_t j = 0; j + 1 < kRows; ++j) {
      double& integral = mean[static_cast<Eigen::Index>(j)];
      integral = 0;
      for (std::size_t i = 0; i < kRows; ++i)
        integral += curvature[static_cast<Eigen::Index>(i)] * (after(i, j) - after(i, j + 1));
    }
  }

  // The same around another row of evenly spaced ones.
  Quartic At(std::size_t k) const {
    Quartic other = *this;
    other.begin = k - kHalf;
    return other;
  }

  double Of(const std::vector<double>& y, const Eigen::VectorXd& weights) const {
    return Eigen::Map<const Eigen::VectorXd>(y.data() + begin, weights.size()).dot(weights);
  }
};

// Whether the rows around one are as far apart as those around the row before it.
bool IsSpacedAsBefore(const std::vector<double>& t, std::size_t k) {
  constexpr double kEqual = 1e-9;  // of a spacing
  const double first = t[k - kHalf] - t[k - kHalf - 1], last = t[k + kHalf] - t[k + kHalf - 1];
  for (std::size_t i = k - kHalf; i < k + kHalf; ++i) {
    if (std::abs(t[i + 1] - t[i] - first) > kEqual * last) return false;
  }
  return true;
}

// The channel that measures each joint, of those that are measured.
std::map<int, std::size_t> JointChannels(const Experiment& e, const mjModel& m) {
  std::map<int, std::size_t> channels;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const Output& out = e.outputs[e.channels[c].output];
    if (out.kind != Output::Kind::kSensor) continue;
    const int id = mj_name2id(&m, mjOBJ_SENSOR, out.source.c_str());
    if (id >= 0 && m.sensor_type[id] == mjSENS_JOINTPOS) channels[m.sensor_objid[id]] = c;
  }
  return channels;
}

// Joints without a channel; none that could only be at rest in several directions.
std::optional<std::vector<int>> OtherJoints(const mjModel& m,
                                            const std::map<int, std::size_t>& measured) {
  std::vector<int> others;
  for (int joint = 0; joint < m.njnt; ++joint) {
    if (measured.contains(joint)) continue;
    if (m.jnt_type[joint] != mjJNT_HINGE && m.jnt_type[joint] != mjJNT_SLIDE) return {};
    others.push_back(joint);
  }
  return others;
}

struct Motion {
  std::vector<double> angle, velocity, acceleration;
};

// One log, as the model sees it, but for the rows at its ends.
class LogForces {
 public:
  LogForces(const Problem& problem, const Problem::Vector& x, std::size_t log, std::size_t thread)
      : e_(problem.MeasuredBy(x, log)),
        log_(problem.experiment().logs[log]),
        index_(log),
        machine_(problem.system(thread).Build(problem.ChangesFor(x, log))) {
    for (std::size_t k = kHalf; k + kHalf < log_.rows(); ++k) {
      if (!fits_.empty() && IsSpacedAsBefore(log_.time, k)) {
        fits_.push_back(fits_.back().At(k));
      } else {
        fits_.emplace_back(log_.time, k);
      }
    }
    const auto channels = JointChannels(e_, *machine_.model);
    others_ = OtherJoints(*machine_.model, channels).value();
    for (const auto& [joint, channel] : channels) {
      std::vector<double> y = log_.measured[channel];
      for (double& value : y) value = SignalOf(e_, channel, value);
      Motion& motion = measured_[joint];
      for (const Quartic& fit : fits_) {
        motion.angle.push_back(fit.Of(y, fit.value));
        motion.velocity.push_back(fit.Of(y, fit.slope));
        motion.acceleration.push_back(fit.Of(y, fit.curvature));
        reach_ = std::max(reach_, std::abs(motion.angle.back() - motion.angle.front()));
      }
      model_[joint].resize(log_.rows(), 0);
      load_[joint].resize(log_.rows(), 0);
    }
  }

  // Appended to those of other logs, joint by joint. Nothing where a joint moves that is not
  // measured: returns false.
  bool AddTo(std::vector<MissingForce>& all) {
    Drive();
    if (moved_) return false;
    mjModel& m = *machine_.model;
    mjData& d = *machine_.data;
    all.resize(measured_.size());
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      Place(m, d, k);
      mj_fwdPosition(&m, &d);
      const Eigen::VectorXd lack = Lack(k);
      Eigen::VectorXd force(m.nv);
      mj_mulM(&m, &d, force.data(), lack.data());
      std::size_t i = 0;
      for (const auto& [joint, motion] : measured_) {
        MissingForce& out = all[i++];
        out.joint = mj_id2name(&m, mjOBJ_JOINT, joint);
        out.slides = m.jnt_type[joint] == mjJNT_SLIDE;
        out.log.push_back(index_);
        out.time.push_back(log_.time[k + kHalf]);
        out.angle.push_back(motion.angle[k]);
        out.velocity.push_back(motion.velocity[k]);
        out.load.push_back(load_.at(joint)[k + kHalf]);
        out.force.push_back(force[m.jnt_dofadr[joint]]);
        out.acceleration.push_back(lack[m.jnt_dofadr[joint]]);
      }
    }
    for (MissingForce& one : all) one.at_rest = Names(m, others_);
    return true;
  }

 private:
  static std::vector<std::string> Names(const mjModel& m, const std::vector<int>& joints) {
    std::vector<std::string> names;
    for (const int joint : joints) {
      const char* const name = mj_id2name(&m, mjOBJ_JOINT, joint);
      names.push_back(name ? name : "joint " + std::to_string(joint));
    }
    return names;
  }

  // Whether joints without a channel leave where they begin.
  void Watch(const mjModel& m, const mjData& d) {
    if (start_.empty())
      for (const int joint : others_) start_.push_back(d.qpos[m.jnt_qposadr[joint]]);
    for (std::size_t i = 0; i < others_.size(); ++i)
      moved_ = moved_ || std::abs(d.qpos[m.jnt_qposadr[others_[i]]] - start_[i]) > kStill * reach_;
  }

  Eigen::VectorXd Lack(std::size_t k) const {
    const mjModel& m = *machine_.model;
    Eigen::VectorXd lack = Eigen::VectorXd::Zero(m.nv);
    for (const auto& [joint, motion] : measured_) {
      lack[m.jnt_dofadr[joint]] =
          motion.acceleration[k] - fits_[k].Of(model_.at(joint), fits_[k].mean);
    }
    return lack;
  }

  void Place(const mjModel& m, mjData& d, std::size_t k) const {
    for (const auto& [joint, motion] : measured_) {
      d.qpos[m.jnt_qposadr[joint]] = motion.angle[k];
      d.qvel[m.jnt_dofadr[joint]] = motion.velocity[k];
    }
  }

  // Every row begins at the measured state; from there to the next the model moves by itself, so
  // that lags and hysteresis remember, and what its speed gains is its mean acceleration.
  void Drive() {
    std::size_t next = 0;
    std::map<int, double> speed;  // at the row before
    const auto arrive = [&](const mjModel& m, const mjData& d, std::size_t row) {
      for (auto& [joint, mean] : model_) {
        if (row == 0) break;
        mean[row - 1] =
            (d.qvel[m.jnt_dofadr[joint]] - speed[joint]) / (log_.time[row] - log_.time[row - 1]);
      }
    };
    Hooks hooks;
    hooks.step = [&](const mjModel& m, mjData& d) {
      if (next >= log_.rows() || d.time < log_.time[next] - log_.time[0] - 1e-9) return;
      arrive(m, d, next);
      Watch(m, d);
      const bool seen = next >= kHalf && next + kHalf < log_.rows();
      if (seen) Place(m, d, next - kHalf);
      for (const auto& [joint, motion] : measured_) speed[joint] = d.qvel[m.jnt_dofadr[joint]];
    };
    hooks.row = [&](const mjModel& m, mjData& d, std::size_t row) {
      next = row + 1;
      if (next == log_.rows()) arrive(m, d, row);
      for (auto& [joint, load] : load_) load[row] = d.qfrc_actuator[m.jnt_dofadr[joint]];
    };
    Simulate(machine_, e_, log_, {}, hooks);
  }

  Experiment e_;
  const Log& log_;
  std::size_t index_;
  ModelAndData machine_;
  std::vector<Quartic> fits_;
  std::vector<int> others_;    // joints that are not measured
  std::vector<double> start_;  // of them
  double reach_ = 0;           // of the measured ones, from where they begin
  bool moved_ = false;
  std::map<int, Motion> measured_;
  std::map<int, std::vector<double>> model_, load_;
};

bool EveryRowIsThere(const Experiment& e, const mjModel& m, const Log& log) {
  const auto channels = JointChannels(e, m);
  if (channels.empty() || !OtherJoints(m, channels)) return false;
  return std::all_of(channels.begin(), channels.end(), [&](const auto& one) {
    const std::vector<double>& y = log.measured[one.second];
    return std::none_of(y.begin(), y.end(), [](double v) { return std::isnan(v); });
  });
}

double Squares(const MissingForce& f) {
  double sum = 0;
  for (const double v : f.force) sum += v * v;
  return sum;
}

}  // namespace

StackedForces::StackedForces(const std::vector<MissingForce>& joints, Kind kind) : kind_(kind) {
  for (const MissingForce& joint : joints) {
    const auto all = Problem::Vector::Map((joint.*kind).data(), std::ssize(joint.*kind));
    const double norm = all.norm();
    unit_.push_back(norm > 0 ? norm : 1);
    size_ += all.size();
  }
}

Problem::Vector StackedForces::Of(const std::vector<MissingForce>& joints) const {
  Problem::Vector all(size_);
  Eigen::Index at = 0;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    for (const double f : joints[j].*kind_) all[at++] = f / unit_[j];
  }
  return all;
}

bool MeasuresEveryJoint(const Problem& problem, std::size_t log) {
  const Experiment& e = problem.experiment();
  const Log& rows = e.logs[log];
  const mjModel& m = problem.system().model();
  return !e.quasi_static && rows.rows() >= kRows && std::ssize(JointChannels(e, m)) == m.njnt &&
         EveryRowIsThere(e, m, rows);
}

std::vector<MissingForce> MissingForces(const Problem& problem, const Problem::Vector& x,
                                        const std::vector<bool>& use, std::size_t thread) {
  const Experiment& e = problem.experiment();
  std::vector<MissingForce> all;
  for (std::size_t l = 0; l < use.size(); ++l) {
    const Log& log = e.logs[l];
    if (!use[l] || log.rows() < kRows) continue;
    if (e.quasi_static || !EveryRowIsThere(e, problem.system().model(), log)) return {};
    if (!LogForces(problem, x, l, thread).AddTo(all)) return {};
  }
  return all;
}

MissingForce FindMissingForce(const Problem& problem, const Problem::Vector& x) {
  const auto all = MissingForces(problem, x, problem.AllLogs());
  const auto largest = std::max_element(
      all.begin(), all.end(),
      [](const MissingForce& a, const MissingForce& b) { return Squares(a) < Squares(b); });
  return largest == all.end() ? MissingForce{} : *largest;
}

}  // namespace continuum
