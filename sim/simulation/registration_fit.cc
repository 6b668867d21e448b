#include "sim/simulation/registration_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/experiment/registration.h"
#include "sim/simulation/score.h"
#include "sim/simulation/simulate.h"
#include "sim/simulation/trace_measurement.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd, Eigen::Vector3d, Eigen::Matrix3d;
using Part = Registration::Part;
using Geometry = Wiring::Source::Geometry;

constexpr char kAxis[] = "xyz";
constexpr const char* kTarget = "registration";

std::string Where(const Experiment& e, const std::string& key = "") {
  return e.file.string() + ": registration" + (key.empty() ? "" : "." + key);
}

double MedianPeriod(const Experiment& e) {
  std::vector<double> periods;
  for (const Log& log : e.logs) {
    for (std::size_t k = 1; k < log.rows(); ++k) periods.push_back(log.time[k] - log.time[k - 1]);
  }
  if (periods.empty()) return 1;
  std::nth_element(periods.begin(), periods.begin() + periods.size() / 2, periods.end());
  return periods[periods.size() / 2];
}

// Positions with all three components among the outputs: the first of their channels each.
struct Point {
  std::size_t output[3], channel[3];
};
std::vector<Point> PointsOf(const Experiment& e, const Wiring& wiring) {
  std::map<int, std::map<int, std::size_t>> found;  // sensor, component → channel
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& source = wiring.output[e.channels[c].output];
    if (source.geometry == Geometry::kPoint) found[source.sensor].emplace(source.component, c);
  }
  std::vector<Point> points;
  for (const auto& [sensor, channels] : found) {
    if (channels.size() != 3) continue;
    Point p{};
    for (const auto& [component, c] : channels) {
      p.channel[component] = c;
      p.output[component] = e.channels[c].output;
    }
    points.push_back(p);
  }
  return points;
}

// What was simulated without a frame and what was measured, one column a point.
struct Cloud {
  Eigen::Matrix3Xd from, to;
};
Cloud CloudOf(const Experiment& e, const Wiring& wiring, const std::vector<Trace>& traces) {
  Experiment bare = WithoutLogs(e);
  bare.registration.rotation = bare.registration.translation = {};
  for (Output& out : bare.outputs) out.measurement = {};
  std::vector<Vector3d> from, to;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    const Log& log = e.logs[l];
    if (!log.train || traces[l].diverged) continue;
    Trace trace = traces[l];
    MeasureTrace(bare, wiring, log, trace);
    for (const Point& p : PointsOf(e, wiring)) {
      for (std::size_t k = 0; k < log.rows(); ++k) {
        Vector3d a, b;
        for (int i = 0; i < 3; ++i) {
          const auto& how = e.outputs[p.output[i]].measurement;
          const auto& channel = e.channels[p.channel[i]];
          a[i] = trace.channel[p.channel[i]][k];
          b[i] = (log.measured[p.channel[i]][k] - channel.factor * how.bias) / how.scale;
        }
        if (a.allFinite() && b.allFinite()) from.push_back(a), to.push_back(b);
      }
    }
  }
  Cloud cloud{Eigen::Matrix3Xd(3, from.size()), Eigen::Matrix3Xd(3, to.size())};
  for (std::size_t k = 0; k < from.size(); ++k) {
    cloud.from.col(static_cast<Eigen::Index>(k)) = from[k];
    cloud.to.col(static_cast<Eigen::Index>(k)) = to[k];
  }
  return cloud;
}

// Three points that are not on a line determine a frame.
void RequireSpread(const Experiment& e, const Eigen::Matrix3Xd& points) {
  if (points.cols() < 3) {
    throw Error::Input(Where(e, "frame"),
                       "at least three train rows of a position measured in x, y and z",
                       std::to_string(points.cols()));
  }
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Vector3d spread = Eigen::SelfAdjointEigenSolver<MatrixXd>(centred * centred.transpose())
                              .eigenvalues()
                              .cwiseMax(0)
                              .cwiseSqrt() /
                          std::sqrt(static_cast<double>(points.cols()));
  if (spread[1] < 1e-3 * spread[2] || spread[2] == 0) {
    throw Error::Input(
        Where(e, "frame"), "simulated positions off one line",
        fmt::format("a spread of {:.3g} m along and {:.3g} m across it", spread[2], spread[1]));
  }
}

// The proper rotation of least squared distance: its quaternion is the eigenvector of the largest
// eigenvalue of a matrix made of the covariance S (Horn, J. Opt. Soc. Am. A 4(4), 1987, p. 629).
Eigen::Quaterniond Turn(const Matrix3d& S) {
  const Vector3d skew(S(1, 2) - S(2, 1), S(2, 0) - S(0, 2), S(0, 1) - S(1, 0));
  MatrixXd N(4, 4);
  N(0, 0) = S.trace();
  N.block<3, 1>(1, 0) = skew;
  N.block<1, 3>(0, 1) = skew.transpose();
  N.block<3, 3>(1, 1) = S + S.transpose() - S.trace() * Matrix3d::Identity();
  const VectorXd q = Eigen::SelfAdjointEigenSolver<MatrixXd>(N).eigenvectors().col(3);
  return {q[0], q[1], q[2], q[3]};
}

// The rotation and the translation of least squared distance.
void StartFrame(const Cloud& cloud, Registration& r) {
  const Vector3d from = cloud.from.rowwise().mean(), to = cloud.to.rowwise().mean();
  const Eigen::Quaterniond turn =
      Turn((cloud.from.colwise() - from) * (cloud.to.colwise() - to).transpose());
  const Eigen::AngleAxisd rotation(turn);
  const Vector3d shift = to - turn * from;
  for (int i = 0; i < 3; ++i) {
    r.rotation[i] = rotation.angle() * rotation.axis()[i];
    r.translation[i] = shift[i];
  }
}

// Gauss-Newton over some of a registration's numbers.
class Search {
 public:
  Search(const Experiment& e, const Wiring& wiring, const std::vector<Parameter>& free,
         const std::vector<Trace>& traces)
      : e_(e), wiring_(wiring), free_(free), traces_(traces), pool_(e), moved_(WithoutLogs(e)) {
    period_ = MedianPeriod(e);
  }

  Registration From(Registration r) {
    const auto n = static_cast<Eigen::Index>(free_.size());
    double cost = CostOf(r);
    for (int iteration = 0; iteration < 50; ++iteration) {
      MatrixXd H;
      VectorXd g;
      Linearise(r, H, g);
      const VectorXd size = H.diagonal().cwiseSqrt();
      if (iteration == 0) RequireSize(size);
      const VectorXd unit = size.cwiseMax(1e-300).cwiseInverse();
      const MatrixXd scaled = unit.asDiagonal() * H * unit.asDiagonal();
      const Eigen::SelfAdjointEigenSolver<MatrixXd> modes(scaled);
      RequireRank(modes);
      const VectorXd step = -(unit.asDiagonal() * modes.operatorInverseSqrt() *
                              modes.operatorInverseSqrt() * unit.asDiagonal() * g);
      Registration next = r;
      double lower = cost;
      for (double share = 1; share > 1e-3; share /= 2) {
        next = r;
        for (Eigen::Index i = 0; i < n; ++i)
          RegistrationValue(next, free_[i].attribute) += share * step[i];
        lower = CostOf(next);
        if (lower < cost) break;
      }
      if (!(lower < cost)) break;
      const bool done = cost - lower < 1e-12 * cost;
      r = next, cost = lower;
      if (done) break;
    }
    return r;
  }

 private:
  // Residuals of one train log, one column; what was not measured is zero.
  VectorXd ResidualOf(const Registration& r, std::size_t l) {
    moved_.registration = r;
    Trace trace;
    trace.raw = traces_[l].raw;
    trace.axes = traces_[l].axes;
    MeasureTrace(moved_, wiring_, e_.logs[l], trace);
    const auto residuals = Residuals(e_, e_.logs[l], trace);
    std::vector<double> all;
    for (std::size_t c = 0; c < residuals.size(); ++c) {
      if (!pool_.counts(c)) continue;
      const double weight = std::sqrt(e_.outputs[e_.channels[c].output].weight) / pool_.scale(c);
      for (const double v : residuals[c]) all.push_back(std::isfinite(v) ? weight * v : 0);
    }
    return VectorXd::Map(all.data(), static_cast<Eigen::Index>(all.size()));
  }
  double CostOf(const Registration& r) {
    double sum = 0;
    for (const std::size_t l : Logs()) sum += ResidualOf(r, l).squaredNorm();
    return sum;
  }
  std::vector<std::size_t> Logs() const {
    std::vector<std::size_t> logs;
    for (std::size_t l = 0; l < traces_.size(); ++l) {
      if (e_.logs[l].train && !traces_[l].diverged) logs.push_back(l);
    }
    return logs;
  }
  void Linearise(const Registration& r, MatrixXd& H, VectorXd& g) {
    const auto n = static_cast<Eigen::Index>(free_.size());
    H = MatrixXd::Zero(n, n);
    g = VectorXd::Zero(n);
    for (const std::size_t l : Logs()) {
      const VectorXd present = ResidualOf(r, l);
      MatrixXd J(present.size(), n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const std::string& attribute = free_[i].attribute;
        // A clock's step is wide: numbers between rows lie on straight lines.
        const double step = attribute == "clock_shift" ? 0.1 * period_ : 1e-6;
        Registration up = r, down = r;
        RegistrationValue(up, attribute) += step;
        RegistrationValue(down, attribute) -= step;
        J.col(i) = (ResidualOf(up, l) - ResidualOf(down, l)) / (2 * step);
      }
      H += J.transpose() * J;
      g += J.transpose() * present;
    }
  }

  void RequireSize(const VectorXd& size) const {
    for (Eigen::Index i = 0; i < size.size(); ++i) {
      if (size[i] > 0) continue;
      throw Error::Input(Where(e_), "outputs that '" + free_[i].name + "' changes", "none");
    }
  }
  void RequireRank(const Eigen::SelfAdjointEigenSolver<MatrixXd>& modes) const {
    constexpr double kLeast = 1e-8;  // square of what a direction changes over what others do
    if (modes.eigenvalues()[0] > kLeast * modes.eigenvalues().maxCoeff()) return;
    std::string confused;
    const VectorXd v = modes.eigenvectors().col(0);
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (std::abs(v[i]) > 0.2) confused += (confused.empty() ? "" : ", ") + free_[i].name;
    }
    throw Error::Input(Where(e_), "train logs that distinguish its parts",
                       confused + " do the same to all outputs");
  }

  const Experiment& e_;
  const Wiring& wiring_;
  const std::vector<Parameter>& free_;
  const std::vector<Trace>& traces_;
  Pool pool_;
  Experiment moved_;  // without logs
  double period_;
};

}  // namespace

std::vector<Parameter> RegistrationParameters(const Experiment& e, const Wiring& wiring,
                                              const mjModel& m) {
  std::vector<Parameter> free;
  const auto add = [&](const std::string& name, const std::string& attribute, double reach) {
    Parameter p;
    p.name = name, p.target = kTarget, p.attribute = attribute, p.where = Where(e);
    Registration present = e.registration;
    p.initial = RegistrationValue(present, attribute);
    p.lower = p.initial - reach, p.upper = p.initial + reach;
    p.has_initial = true;
    free.push_back(p);
  };
  const auto three = [&](const std::string& name, const std::string& attribute, double reach) {
    for (int i = 0; i < 3; ++i)
      add(name + "_" + kAxis[i], attribute + "[" + std::to_string(i) + "]", reach);
  };
  if (e.registration.frame == Part::kEstimate) {
    three("frame_rotation", "rotation", 1.5);
    three("frame_translation", "translation", 1);
  }
  if (e.registration.marker == Part::kEstimate) {
    std::set<int> seen;
    for (const auto& source : wiring.output) {
      if (source.geometry != Geometry::kPoint || !seen.insert(source.sensor).second) continue;
      const std::string sensor = mj_id2name(&m, mjOBJ_SENSOR, source.sensor);
      three("marker_" + sensor, "marker:" + sensor, 1);
    }
  }
  if (e.registration.clock == Part::kEstimate)
    add("clock_shift", "clock_shift", 100 * MedianPeriod(e));
  return free;
}

Registration Registered(const Experiment& e, const Wiring& wiring, const mjModel& m,
                        const std::vector<Trace>& traces) {
  const auto free = RegistrationParameters(e, wiring, m);
  Registration start = e.registration;
  if (free.empty()) return start;
  if (std::none_of(e.logs.begin(), e.logs.end(), [](const Log& log) { return log.train; }))
    throw Error::Input(Where(e), "a train log to estimate it from", "none");
  if (start.frame == Part::kEstimate) {
    const Cloud cloud = CloudOf(e, wiring, traces);
    const bool turns =
        std::any_of(wiring.output.begin(), wiring.output.end(),
                    [](const auto& source) { return source.geometry == Geometry::kRotation; });
    if (!turns) RequireSpread(e, cloud.from);
    if (cloud.from.cols() >= 3) StartFrame(cloud, start);
  }
  return Search(e, wiring, free, traces).From(start);
}

Experiment Registered(const Experiment& e, const ModelSpec& system) {
  Experiment out = e;
  if (!e.registration.estimates()) return out;
  const Wiring wiring(e, system.model());
  std::vector<Trace> traces;
  for (const Log& log : e.logs) {
    traces.emplace_back();
    traces.back().diverged = true;
    if (!log.train) continue;
    ModelAndData machine = system.Build(SettingsOfModel(log));
    traces.back() = Simulate(machine, e, log, {}, Hooks::Stoppable());
  }
  out.registration = Registered(e, wiring, system.model(), traces);
  return out;
}

}  // namespace continuum
