#include "models/stiff_flop/log.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "error.h"
#include "models/stiff_flop/forward.h"
#include "sim/io/mat_file.h"
#include "sim/numerics/levenberg_marquardt.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/solver.h"

namespace continuum::stiff_flop {
namespace {

constexpr double kStart = 7;          // s
constexpr double kEndOfTrain = 37.8;  // s
constexpr double kBar = 1e5;

const std::vector<double>& Column(const Columns& table, int index) {
  return table.values[static_cast<std::size_t>(index)];
}

Registration Align(const std::vector<Solution>& shapes, const Log& log, std::size_t rows,
                   const Eigen::Vector3d& offset) {
  const auto columns = static_cast<Eigen::Index>(rows);
  Eigen::Matrix3Xd from(3, columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    from.col(i) = Registration::Carried(shapes[static_cast<std::size_t>(i)], offset);
  }
  const Eigen::Map<const Eigen::Matrix3Xd> to(log.marker.data()->data(), 3, columns);
  const Eigen::Matrix4d rigid = Eigen::umeyama(from, to, false);
  return {rigid.topLeftCorner<3, 3>(), rigid.topRightCorner<3, 1>(), offset};
}

Eigen::VectorXd Distances(const Registration& registration, const std::vector<Solution>& shapes,
                          const Log& log, std::size_t rows) {
  Eigen::VectorXd left(3 * static_cast<Eigen::Index>(rows));
  for (std::size_t i = 0; i < rows; ++i) {
    Eigen::Vector3d::Map(left.data() + 3 * i) = registration.Marker(shapes[i]) - log.marker[i];
  }
  return left;
}

/// Marker residuals [mm] after the best registration, as a function of (E/E_0, gamma).
struct Residuals {
  const Robot& robot;
  const Method& method;
  const Log& log;

  bool operator()(const double* x, double* f) const {
    Robot changed = robot;
    changed.module().E *= x[0];
    changed.module().gamma = x[1];
    return MarkerResiduals(changed, method, log, f);
  }

  template <class X, class F, class J>
  bool Jacobian(const X& x, F& f, J& jacobian) const {
    return numerics::Differences(*this, x, 1e-4, f, jacobian);
  }
};

// Distances of the markers by the offset, for LevenbergMarquardt.
struct MarkerDistances {
  const std::vector<Solution>& shapes;
  const Log& log;
  std::size_t rows;

  bool operator()(const double* offset, double* f) const {
    const Eigen::Vector3d at(offset);
    const Eigen::VectorXd distances = Distances(Align(shapes, log, rows, at), shapes, log, rows);
    Eigen::Map<Eigen::VectorXd>(f, distances.size()) = distances;
    return true;
  }
  bool Jacobian(const Eigen::Vector3d& x, Eigen::VectorXd& f, Eigen::MatrixX3d& slope) const {
    constexpr double kProbe = 1e-4;  // m
    return numerics::Differences(*this, x, kProbe, f, slope);
  }
};

}  // namespace

Log Log::Read(const std::filesystem::path& file, int stride) {
  const Columns table = ReadMat(file, "NoLoad");
  if (table.values.size() != 18) {
    throw Error::Input(file.string(), "18 columns", std::to_string(table.values.size()));
  }
  const std::vector<double>& time = Column(table, 0);
  const auto start = std::lower_bound(time.begin(), time.end(), kStart) - time.begin();
  constexpr std::array<int, 3> kOrder = {1, 3, 2};
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int row = 0; row < start; ++row) {
      rest[i] += Column(table, kOrder[i])[row] / static_cast<double>(start);
    }
  }
  Log log;
  for (auto row = static_cast<std::size_t>(start); row < time.size(); row += stride) {
    Eigen::Vector3d pressure, marker;
    for (int i = 0; i < 3; ++i) {
      pressure[i] = kBar * (Column(table, kOrder[i])[row] - rest[i]);
      marker[i] = 1e-3 * Column(table, 11 + i)[row];
    }
    log.time.push_back(time[row]);
    log.pressure.push_back(pressure);
    log.marker.push_back(marker);
  }
  return log;
}

Log Log::First(std::size_t rows) const {
  Log first = *this;
  first.time.resize(rows);
  first.pressure.resize(rows);
  first.marker.resize(rows);
  return first;
}

std::size_t TrainRows(const Log& log) {
  return std::lower_bound(log.time.begin(), log.time.end(), kEndOfTrain) - log.time.begin();
}

Registration Registration::Fit(const std::vector<Solution>& shapes, const Log& log,
                               std::size_t rows) {
  numerics::Options options;
  options.step = 1e-7;  // of an offset of centimetres: 1 nm
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  numerics::LevenbergMarquardt<Eigen::VectorXd>(MarkerDistances{shapes, log, rows}, offset,
                                                3 * static_cast<Eigen::Index>(rows), options);
  return Align(shapes, log, rows, offset);
}

Eigen::Vector3d Registration::Carried(const Solution& solution, const Eigen::Vector3d& offset) {
  const auto tilt = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), solution.tangent);
  return solution.tip + tilt * offset;
}

TipError ErrorOf(const Registration& registration, const std::vector<Solution>& shapes,
                 const Log& log, std::size_t first, std::size_t last) {
  TipError error;
  const auto count = static_cast<double>(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const double distance = (registration.Marker(shapes[i]) - log.marker[i]).norm();
    error.mean += distance / count;
    error.rms += distance * distance / count;
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

std::vector<Solution> Replay(const Robot& robot, const Method& method, const Log& log) {
  std::vector<Solution> shapes;
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const Case row{"", log.pressure[i], {Eigen::Vector3d::Zero(), robot.gravity}};
    shapes.push_back(SolveForward(robot.series, method, row, false));
    if (shapes.back().status != Status::kOk) {
      throw Error::Job("at " + std::to_string(log.time[i]) + " s: " + Name(shapes.back().status) +
                       ", " + shapes.back().outcome.why);
    }
  }
  return shapes;
}

bool MarkerResiduals(const Robot& robot, const Method& method, const Log& log, double* f) {
  std::vector<Solution> shapes;
  try {
    shapes = Replay(robot, method, log);
  } catch (const Error&) {
    return false;
  }
  const std::size_t rows = log.time.size();
  const Registration registration = Registration::Fit(shapes, log, rows);
  for (std::size_t i = 0; i < rows; ++i) {
    Eigen::Vector3d::Map(f + 3 * i) = 1e3 * (registration.Marker(shapes[i]) - log.marker[i]);
  }
  return true;
}

numerics::Outcome FitBraid(const Method& method, const Log& log, Robot& robot) {
  const Log train = log.First(TrainRows(log));
  Eigen::Vector2d x(1, robot.module().gamma);
  numerics::Bounds<2> bounds;
  bounds.lower = {0.2, std::numbers::pi / 4};
  bounds.upper = {5, std::numbers::pi / 2};
  numerics::Options options;
  options.max_iterations = 12;
  options.gradient = 1e-4;
  options.step = 1e-5;
  const numerics::Outcome outcome = numerics::LevenbergMarquardt<Eigen::VectorXd>(
      Residuals{robot, method, train}, x, static_cast<Eigen::Index>(3 * train.time.size()), options,
      bounds);
  robot.module().E *= x[0];
  robot.module().gamma = x[1];
  return outcome;
}

}  // namespace continuum::stiff_flop
