#include "identification/inverse_dynamics/measured_motion.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "sim/experiment/measurement_model.h"

namespace continuum {
namespace {

constexpr std::size_t kTerms = 5;

double Square(double x) { return x * x; }

// Whether the rows around one are as far apart as those around the row before it.
bool IsSpacedAsBefore(const std::vector<double>& t, std::size_t k) {
  constexpr double kEqual = 1e-9;  // of a spacing
  const double first = t[k - kHalfRows] - t[k - kHalfRows - 1],
               last = t[k + kHalfRows] - t[k + kHalfRows - 1];
  for (std::size_t i = k - kHalfRows; i < k + kHalfRows; ++i) {
    if (std::abs(t[i + 1] - t[i] - first) > kEqual * last) return false;
  }
  return true;
}

}  // namespace

Quartic::Quartic(const std::vector<double>& t, std::size_t k)
    : begin(k - kHalfRows), mean(kQuarticRows - 1) {
  Eigen::MatrixXd A(kQuarticRows, kTerms);
  for (std::size_t i = 0; i < kQuarticRows; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    A(row, 0) = 1;
    for (Eigen::Index n = 1; n < A.cols(); ++n)
      A(row, n) = A(row, n - 1) * (t[begin + i] - t[k]) / static_cast<double>(n);
  }
  const Eigen::MatrixXd weights =
      A.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(kQuarticRows, kQuarticRows));
  value = weights.row(0), slope = weights.row(1), curvature = weights.row(2);
  const auto after = [&](std::size_t i, std::size_t j) {
    return Square(std::max(0.0, t[begin + i] - t[begin + j])) / 2;
  };
  for (std::size_t j = 0; j + 1 < kQuarticRows; ++j) {
    double& integral = mean[static_cast<Eigen::Index>(j)];
    integral = 0;
    for (std::size_t i = 0; i < kQuarticRows; ++i)
      integral += curvature[static_cast<Eigen::Index>(i)] * (after(i, j) - after(i, j + 1));
  }
}

Quartic Quartic::At(std::size_t row) const {
  Quartic other = *this;
  other.begin = row - kHalfRows;
  return other;
}

double Quartic::Of(const std::vector<double>& y, const Eigen::VectorXd& weights) const {
  return Eigen::Map<const Eigen::VectorXd>(y.data() + begin, weights.size()).dot(weights);
}

std::vector<Quartic> QuarticsOf(const std::vector<double>& time) {
  std::vector<Quartic> all;
  for (std::size_t k = kHalfRows; k + kHalfRows < time.size(); ++k) {
    if (!all.empty() && IsSpacedAsBefore(time, k)) {
      all.push_back(all.back().At(k));
    } else {
      all.emplace_back(time, k);
    }
  }
  return all;
}

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

std::map<int, JointMotion> MotionsOf(const Experiment& e, const mjModel& m, const Log& log,
                                     const std::vector<Quartic>& quartics) {
  std::map<int, JointMotion> motions;
  for (const auto& [joint, channel] : JointChannels(e, m)) {
    const std::vector<double> y = SignalsOf(e, log, channel);
    JointMotion& motion = motions[joint];
    for (const Quartic& q : quartics) {
      motion.angle.push_back(q.Of(y, q.value));
      motion.velocity.push_back(q.Of(y, q.slope));
      motion.acceleration.push_back(q.Of(y, q.curvature));
    }
  }
  return motions;
}

}  // namespace continuum
