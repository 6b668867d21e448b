#include "identification/inverse_dynamics/missing_force.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Dense>

#include "binding/gear_load.h"
#include "identification/inverse_dynamics/measured_motion.h"
#include "sim/model/elastic_gear.h"
#include "sim/numerics/parallel.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

constexpr double kStill = 1e-2;  // of the largest motion: less is none

// Joints without a channel but motors of elastic gears, whose motion is a memory of the model's;
// none that could only be at rest in several directions.
std::optional<std::vector<int>> OtherJoints(const mjModel& m,
                                            const std::map<int, std::size_t>& measured) {
  std::vector<int> others;
  for (int joint = 0; joint < m.njnt; ++joint) {
    if (measured.contains(joint) || IsGearMotor(m, joint)) continue;
    if (m.jnt_type[joint] != mjJNT_HINGE && m.jnt_type[joint] != mjJNT_SLIDE) return {};
    others.push_back(joint);
  }
  return others;
}

// One log, as the model sees it, but for the rows at its ends.
class LogForces {
 public:
  LogForces(const Problem& problem, const Problem::Vector& x, std::size_t log, std::size_t thread,
            double step)
      : e_(problem.MeasuredBy(x, log)),
        log_(problem.experiment().logs[log]),
        index_(log),
        machine_(problem.system(thread).Build(problem.ChangesFor(x, log))),
        fits_(QuarticsOf(log_.time)) {
    if (step > 0) machine_.model->opt.timestep = step;
    others_ = OtherJoints(*machine_.model, JointChannels(e_, *machine_.model)).value();
    measured_ = MotionsOf(e_, *machine_.model, log_, fits_);
    for (const auto& [joint, motion] : measured_) {
      for (const double angle : motion.angle)
        reach_ = std::max(reach_, std::abs(angle - motion.angle.front()));
      model_[joint].resize(log_.rows(), 0);
      load_[joint].resize(log_.rows(), 0);
    }
  }

  // On each measured joint; none where a joint moves that is not measured.
  std::vector<MissingForce> Joints() {
    Drive();
    if (moved_) return {};
    mjModel& m = *machine_.model;
    mjData& d = *machine_.data;
    std::vector<MissingForce> all(measured_.size());
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
        out.time.push_back(log_.time[k + kHalfRows]);
        out.angle.push_back(motion.angle[k]);
        out.velocity.push_back(motion.velocity[k]);
        out.load.push_back(load_.at(joint)[k + kHalfRows]);
        out.force.push_back(force[m.jnt_dofadr[joint]]);
        out.weight.push_back(WeightTorque(m, d, m.jnt_dofadr[joint]));
        out.acceleration.push_back(lack[m.jnt_dofadr[joint]]);
      }
    }
    for (MissingForce& one : all) one.at_rest = Names(m, others_);
    return all;
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
    for (const auto& [joint, motion] : measured_)
      PlaceJoint(m, d, joint, motion.angle[k], motion.velocity[k]);
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
      const bool seen = next >= kHalfRows && next + kHalfRows < log_.rows();
      if (seen) Place(m, d, next - kHalfRows);
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
  std::map<int, JointMotion> measured_;
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

// To those of other logs, joint by joint.
void Append(const std::vector<MissingForce>& joints, std::vector<MissingForce>& all) {
  all.resize(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const MissingForce& from = joints[j];
    MissingForce& to = all[j];
    to.joint = from.joint, to.slides = from.slides, to.at_rest = from.at_rest;
    to.log.insert(to.log.end(), from.log.begin(), from.log.end());
    for (const auto rows :
         {&MissingForce::time, &MissingForce::angle, &MissingForce::velocity, &MissingForce::load,
          &MissingForce::force, &MissingForce::acceleration, &MissingForce::weight})
      (to.*rows).insert((to.*rows).end(), (from.*rows).begin(), (from.*rows).end());
  }
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
  return !e.quasi_static && rows.rows() >= kQuarticRows &&
         std::ssize(JointChannels(e, m)) + GearMotors(m) == m.njnt && EveryRowIsThere(e, m, rows);
}

std::vector<MissingForce> MissingForces(const Problem& problem, const Problem::Vector& x,
                                        const std::vector<bool>& use, double step) {
  const Experiment& e = problem.experiment();
  std::vector<std::size_t> logs;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l] || e.logs[l].rows() < kQuarticRows) continue;
    if (e.quasi_static || !EveryRowIsThere(e, problem.system().model(), e.logs[l])) return {};
    logs.push_back(l);
  }
  std::vector<std::vector<MissingForce>> of_log(logs.size());
  ParallelFor(logs.size(), [&](std::size_t thread, std::size_t i) {
    of_log[i] = LogForces(problem, x, logs[i], thread, step).Joints();
  });
  std::vector<MissingForce> all;
  for (const auto& joints : of_log) {
    if (joints.empty()) return {};
    Append(joints, all);
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
