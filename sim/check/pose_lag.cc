#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <Eigen/Core>

#include "sim/check/against_model.h"
#include "sim/check/series_statistics.h"
#include "sim/experiment/measurement_model.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A column of the log and where MuJoCo has its number: in qpos or in sensordata.
struct ColumnAddress {
  std::size_t channel;
  int address;
};

// What a log measures of the pose: joints, and sensors that all joints determine.
struct Pose {
  std::vector<ColumnAddress> joints, others;
  bool whole;  // every joint; else the rest is taken to stand still
};

std::optional<Pose> PoseOf(const Experiment& e, const mjModel& m) {
  const Wiring wiring(e, m);
  Pose pose{};
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const Output& out = e.outputs[e.channels[c].output];
    const Wiring::Source& source = wiring.output[e.channels[c].output];
    const bool as_is = out.measurement.angle == 0 && out.measurement.delay == 0;
    if (source.sensor < 0 || out.quaternion() || !as_is) continue;
    if (m.sensor_type[source.sensor] == mjSENS_JOINTPOS)
      pose.joints.push_back({c, m.jnt_qposadr[m.sensor_objid[source.sensor]]});
    else if (m.sensor_needstage[source.sensor] == mjSTAGE_POS)
      pose.others.push_back({c, source.address + source.component});
  }
  pose.whole = std::cmp_equal(pose.joints.size(), m.njnt);
  const bool known = m.nq == m.nv && !pose.joints.empty() && !pose.others.empty();
  return known ? std::optional(pose) : std::nullopt;
}

constexpr std::size_t kReach = 3;  // rows on either side of a secant: noise is not speed

// Rows at which everything is measured, before and after too: some two thousand at most, in one
// piece.
std::vector<std::size_t> RowsOf(const Log& log, const Pose& pose) {
  std::vector<std::size_t> rows;
  for (std::size_t k = kReach; k + kReach < log.rows() && rows.size() < 2000; ++k) {
    const auto missing = [&](const ColumnAddress& p) {
      const auto& x = log.measured[p.channel];
      return !std::isfinite(x[k - kReach]) || !std::isfinite(x[k]) || !std::isfinite(x[k + kReach]);
    };
    if (std::none_of(pose.joints.begin(), pose.joints.end(), missing) &&
        std::none_of(pose.others.begin(), pose.others.end(), missing))
      rows.push_back(k);
  }
  return rows;
}

// Per other column: what is measured beside what the measured joints make of it, and how fast each
// joint moves it, [row](joint); offsets are taken away.
struct Motion {
  std::vector<VectorXd> rest, own;
  std::vector<MatrixXd> by_joint;
};

class PoseKinematics {
 public:
  PoseKinematics(const Experiment& e, const Log& log, const Pose& pose, ModelAndData& machine)
      : e_(e), log_(log), pose_(pose), m_(*machine.model), d_(*machine.data) {}

  Motion Of(const std::vector<std::size_t>& rows) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    const auto joints = static_cast<Eigen::Index>(pose_.joints.size());
    Motion motion;
    motion.rest.assign(pose_.others.size(), VectorXd(n));
    motion.by_joint.assign(pose_.others.size(), MatrixXd(n, joints));
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t k = rows[i];
      for (const ColumnAddress& j : pose_.joints) d_.qpos[j.address] = Measured(j, k);
      const VectorXd here = EvaluateSensors();
      for (Eigen::Index j = 0; j < joints; ++j) {
        const VectorXd speed = Speed(pose_.joints[j], k);
        for (std::size_t o = 0; o < pose_.others.size(); ++o)
          motion.by_joint[o](i, j) = speed[static_cast<Eigen::Index>(o)];
      }
      for (std::size_t o = 0; o < pose_.others.size(); ++o)
        motion.rest[o][i] = Measured(pose_.others[o], k) - here[static_cast<Eigen::Index>(o)];
    }
    for (std::size_t o = 0; o < pose_.others.size(); ++o) {
      motion.rest[o].array() -= motion.rest[o].mean();
      motion.by_joint[o].rowwise() -= motion.by_joint[o].colwise().mean().eval();
      motion.own.push_back(motion.by_joint[o].rowwise().sum());
    }
    return motion;
  }

 private:
  double Measured(const ColumnAddress& p, std::size_t row) const {
    return SignalOf(e_, log_, p.channel, row);
  }
  VectorXd EvaluateSensors() {
    mj_fwdPosition(&m_, &d_);
    mj_sensorPos(&m_, &d_);
    VectorXd seen(static_cast<Eigen::Index>(pose_.others.size()));
    for (std::size_t o = 0; o < pose_.others.size(); ++o)
      seen[static_cast<Eigen::Index>(o)] = d_.sensordata[pose_.others[o].address];
    return seen;
  }
  // Of the others, as one joint moves.
  VectorXd Speed(const ColumnAddress& joint, std::size_t row) {
    double& q = d_.qpos[joint.address];
    const double here = q;
    q = Measured(joint, row + kReach);
    const VectorXd after = EvaluateSensors();
    q = Measured(joint, row - kReach);
    const VectorXd before = EvaluateSensors();
    q = here;
    return (after - before) / (log_.time[row + kReach] - log_.time[row - kReach]);
  }

  const Experiment& e_;
  const Log& log_;
  const Pose& pose_;
  mjModel& m_;
  mjData& d_;
};

// How late a column would be [s] if it alone were, and what of the rest that explains.
struct Delay {
  double seconds = 0, sd = 0, explained = 0, share = 0;
};

// rest ≈ late · pattern, in units of the channel's own motion; sd for noise that lasts ten rows.
// The share is of what is more than white noise.
Delay FitDelay(const std::vector<VectorXd>& rest, const std::vector<VectorXd>& pattern,
               const std::vector<double>& unit) {
  double rr = 0, rp = 0, pp = 0, white = 0;
  const auto rows = static_cast<double>(rest.front().size());
  for (std::size_t o = 0; o < rest.size(); ++o) {
    const double weight = unit[o] > 0 ? 1 / (unit[o] * unit[o]) : 0;
    rr += weight * rest[o].squaredNorm();
    rp += weight * rest[o].dot(pattern[o]);
    pp += weight * pattern[o].squaredNorm();
    white += weight * rows * std::pow(NoiseOf({rest[o].begin(), rest[o].end()}), 2);
  }
  if (!(pp > 0) || !(rr > 0)) return {};
  const double explained = rp * rp / pp, n = static_cast<double>(rest.size()) * rows;
  return {rp / pp, std::sqrt(10 * (rr - explained) / n / pp), explained,
          explained / std::max(rr - white, explained)};
}

void ReportLag(const std::string& column, const Delay& delay, double period,
               const std::string& against, Findings& out) {
  const double rows = std::abs(delay.seconds) / period;
  out.Add(Finding::Severity::kWarning, column, "lag",
          fmt::format("is {} {} by {} ({:.1f} rows) by the kinematics of the model alone: the "
                      "column is shifted",
                      delay.seconds > 0 ? "late against" : "ahead of", against,
                      Amount(1e3 * std::abs(delay.seconds), "ms"), rows));
}

// Whether joints that are not measured move, by the sensors that see them too.
bool Moves(const Motion& motion, const std::vector<double>& unit) {
  constexpr double kStill = 0.2;  // of what is measured: shifts by some rows are less
  for (std::size_t o = 0; o < unit.size(); ++o) {
    const auto rows = static_cast<double>(motion.rest[o].size());
    if (motion.rest[o].norm() > kStill * unit[o] * std::sqrt(rows)) return true;
  }
  return false;
}

// Columns that are late on their own, those of the joints behind the others.
std::vector<Delay> DelaysOfColumns(const Motion& motion, const std::vector<double>& unit) {
  std::vector<Delay> delay;
  for (std::size_t o = 0; o < motion.rest.size(); ++o)
    delay.push_back(FitDelay({motion.rest[o]}, {-motion.own[o]}, {unit[o]}));
  for (Eigen::Index j = 0; j < motion.by_joint.front().cols(); ++j) {
    std::vector<VectorXd> pattern;
    for (const MatrixXd& by : motion.by_joint) pattern.emplace_back(by.col(j));
    delay.push_back(FitDelay(motion.rest, pattern, unit));
  }
  return delay;
}

// A column that is refreshed now and then is late by itself, and makes others look so.
bool Repeats(const std::vector<double>& x) {
  std::size_t repeats = 0;
  for (std::size_t k = 1; k < x.size(); ++k) repeats += x[k] == x[k - 1];
  return 3 * repeats > x.size();
}

// What is believed of them: some of the others, or the one joint that says more than they do.
std::vector<Delay> PlausibleDelays(std::vector<Delay> delay, std::size_t others, double period) {
  constexpr double kShare = 0.4;  // joints that move together look late together
  for (Delay& l : delay) {
    if (std::abs(l.seconds) < std::max(0.7 * period, 4 * l.sd) || l.share < kShare) l = {};
  }
  const auto first_joint = delay.begin() + static_cast<std::ptrdiff_t>(others);
  const auto joint = std::max_element(first_joint, delay.end(),
                                      [](auto& a, auto& b) { return a.explained < b.explained; });
  double by_others = 0;
  for (auto l = delay.begin(); l != first_joint; ++l) by_others += l->explained;
  const bool one_joint = joint->explained > by_others;
  for (auto l = delay.begin(); l != delay.end(); ++l) {
    if (one_joint ? l != joint : l >= first_joint) *l = {};
  }
  return delay;
}

}  // namespace

std::set<std::string> CheckPose(const Experiment& e, const Log& log, const ModelSpec& system,
                                Findings& out) {
  const Registration& r = e.registration;
  if (e.quasi_static || r.has_frame() || r.has_marker()) return {};
  ModelAndData machine = system.Build(SettingsOfModel(log));
  const auto pose = PoseOf(e, *machine.model);
  const std::vector<std::size_t> rows = pose ? RowsOf(log, *pose) : std::vector<std::size_t>();
  if (rows.size() < 100) return {};
  std::vector<double> unit;
  for (const ColumnAddress& o : pose->others) unit.push_back(Deviation(log.measured[o.channel]));
  std::vector<ColumnAddress> columns = pose->others;
  columns.insert(columns.end(), pose->joints.begin(), pose->joints.end());
  const auto repeats = [&](const ColumnAddress& p) { return Repeats(log.measured[p.channel]); };
  if (std::any_of(columns.begin(), columns.end(), repeats)) return {};
  const Motion motion = PoseKinematics(e, log, *pose, machine).Of(rows);
  if (!pose->whole && Moves(motion, unit)) return {};
  const double period = Median(Differences(log.time));
  const std::vector<Delay> delay =
      PlausibleDelays(DelaysOfColumns(motion, unit), pose->others.size(), period);
  std::set<std::string> judged;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& column = e.channels[columns[i].channel].name;
    judged.insert(column);
    const bool joint = i >= pose->others.size();
    if (delay[i].explained > 0)
      ReportLag(column, delay[i], period, joint ? "the other outputs" : "the measured joints", out);
  }
  return judged;
}

}  // namespace continuum
