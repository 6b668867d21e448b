#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/core.h>
#include <Eigen/Core>

#include "sim/check_model.h"
#include "sim/check_series.h"

namespace continuum {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A column of the log and where MuJoCo has its number: in qpos or in sensordata.
struct Place {
  std::size_t channel;
  int address;
};

// What a log measures of the pose: every joint, and sensors that the joints determine.
struct Pose {
  std::vector<Place> joints, others;
};

std::optional<Pose> PoseOf(const Experiment& e, const mjModel& m) {
  const Wiring wiring(e, m);
  Pose pose;
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
  const bool whole = std::cmp_equal(pose.joints.size(), m.njnt) && m.nq == m.nv;
  return whole && !pose.others.empty() ? std::optional(pose) : std::nullopt;
}

// Rows at which everything is measured, before and after too: at most a thousand.
std::vector<std::size_t> RowsOf(const Log& log, const Pose& pose) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 1; k + 1 < log.rows(); ++k) {
    const auto missing = [&](const Place& p) {
      const auto& x = log.measured[p.channel];
      return !std::isfinite(x[k - 1]) || !std::isfinite(x[k]) || !std::isfinite(x[k + 1]);
    };
    if (std::none_of(pose.joints.begin(), pose.joints.end(), missing) &&
        std::none_of(pose.others.begin(), pose.others.end(), missing))
      rows.push_back(k);
  }
  const std::size_t every = rows.size() / 1000 + 1;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < rows.size(); i += every) some.push_back(rows[i]);
  return some;
}

// Per other column: what is measured beside what the measured joints make of it, and how fast each
// joint moves it, [row](joint); offsets are taken away.
struct Motion {
  std::vector<VectorXd> rest, own;
  std::vector<MatrixXd> by_joint;
};

class Poses {
 public:
  Poses(const Experiment& e, const Log& log, const Pose& pose, Machine& machine)
      : e_(e), log_(log), pose_(pose), m_(*machine.model), d_(*machine.data) {}

  Motion Of(const std::vector<std::size_t>& rows) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    const auto joints = static_cast<Eigen::Index>(pose_.joints.size());
    Motion motion;
    motion.rest.assign(pose_.others.size(), VectorXd(n));
    motion.by_joint.assign(pose_.others.size(), MatrixXd(n, joints));
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t k = rows[i];
      for (const Place& j : pose_.joints) d_.qpos[j.address] = Measured(j, k);
      const VectorXd here = Look();
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
  double Measured(const Place& p, std::size_t row) const {
    const auto& channel = e_.channels[p.channel];
    const Measurement& how = e_.outputs[channel.output].measurement;
    return (log_.measured[p.channel][row] - channel.factor * how.bias) / how.scale;
  }
  VectorXd Look() {
    mj_fwdPosition(&m_, &d_);
    mj_sensorPos(&m_, &d_);
    VectorXd seen(static_cast<Eigen::Index>(pose_.others.size()));
    for (std::size_t o = 0; o < pose_.others.size(); ++o)
      seen[static_cast<Eigen::Index>(o)] = d_.sensordata[pose_.others[o].address];
    return seen;
  }
  // Of the others, as one joint moves.
  VectorXd Speed(const Place& joint, std::size_t row) {
    double& q = d_.qpos[joint.address];
    const double here = q;
    q = Measured(joint, row + 1);
    const VectorXd after = Look();
    q = Measured(joint, row - 1);
    const VectorXd before = Look();
    q = here;
    return (after - before) / (log_.time[row + 1] - log_.time[row - 1]);
  }

  const Experiment& e_;
  const Log& log_;
  const Pose& pose_;
  mjModel& m_;
  mjData& d_;
};

// How late a column would be [s] if it alone were, and what of the rest that explains.
struct Late {
  double seconds = 0, sd = 0, explained = 0, share = 0;
};

// rest ≈ late · pattern, in units of the channel's own motion; sd for noise that lasts ten rows.
Late FitLate(const std::vector<VectorXd>& rest, const std::vector<VectorXd>& pattern,
             const std::vector<double>& unit) {
  double rr = 0, rp = 0, pp = 0;
  for (std::size_t o = 0; o < rest.size(); ++o) {
    const double weight = unit[o] > 0 ? 1 / (unit[o] * unit[o]) : 0;
    rr += weight * rest[o].squaredNorm();
    rp += weight * rest[o].dot(pattern[o]);
    pp += weight * pattern[o].squaredNorm();
  }
  if (!(pp > 0) || !(rr > 0)) return {};
  const auto n = static_cast<double>(rest.size()) * static_cast<double>(rest.front().size());
  const double explained = rp * rp / pp;
  return {rp / pp, std::sqrt(10 * (rr - explained) / n / pp), explained, explained / rr};
}

void Tell(const std::string& column, const Late& late, double period, const std::string& against,
          Findings& out) {
  const double rows = std::abs(late.seconds) / period;
  out.Add(Finding::Severity::kWarning, column, "lag",
          fmt::format("is {} {} by {} ({:.1f} rows) by the kinematics of the model alone: the "
                      "column is shifted",
                      late.seconds > 0 ? "late against" : "ahead of", against,
                      Amount(1e3 * std::abs(late.seconds), "ms"), rows));
}

// Columns that are late on their own, those of the joints behind the others.
std::vector<Late> LateColumns(const Motion& motion, const std::vector<double>& unit) {
  std::vector<Late> late;
  for (std::size_t o = 0; o < motion.rest.size(); ++o)
    late.push_back(FitLate({motion.rest[o]}, {-motion.own[o]}, {unit[o]}));
  for (Eigen::Index j = 0; j < motion.by_joint.front().cols(); ++j) {
    std::vector<VectorXd> pattern;
    for (const MatrixXd& by : motion.by_joint) pattern.emplace_back(by.col(j));
    late.push_back(FitLate(motion.rest, pattern, unit));
  }
  return late;
}

}  // namespace

void CheckPose(const Experiment& e, const Log& log, const System& system, Findings& out) {
  const Registration& r = e.registration;
  if (e.quasi_static || r.has_frame() || r.has_marker()) return;
  Machine machine = system.Build(log.set);
  const auto pose = PoseOf(e, *machine.model);
  const std::vector<std::size_t> rows = pose ? RowsOf(log, *pose) : std::vector<std::size_t>();
  if (rows.size() < 100) return;
  std::vector<double> unit;
  for (const Place& o : pose->others) unit.push_back(Deviation(log.measured[o.channel]));
  const double period = Median(Differences(log.time));
  std::vector<Late> late = LateColumns(Poses(e, log, *pose, machine).Of(rows), unit);
  for (Late& l : late) {
    if (std::abs(l.seconds) < std::max(0.7 * period, 4 * l.sd) || l.share < 0.5) l = {};
  }
  // Either some of the others, or the one joint that says more than they do.
  const auto first_joint = late.begin() + static_cast<std::ptrdiff_t>(pose->others.size());
  double by_others = 0;
  for (auto l = late.begin(); l != first_joint; ++l) by_others += l->explained;
  const auto joint = std::max_element(first_joint, late.end(),
                                      [](auto& a, auto& b) { return a.explained < b.explained; });
  const auto tell = [&](const Place& place, const Late& l, const char* against) {
    const std::string& column = e.channels[place.channel].name;
    if (l.explained > 0) Tell(column, l, period, against, out);
  };
  if (joint->explained > by_others)
    return tell(pose->joints[joint - first_joint], *joint, "the other outputs");
  for (std::size_t o = 0; o < pose->others.size(); ++o)
    tell(pose->others[o], late[o], "the measured joints");
}

}  // namespace continuum
