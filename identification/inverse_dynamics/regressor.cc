#include "identification/inverse_dynamics/regressor.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "engine.h"
#include "error.h"
#include "identification/inverse_dynamics/stationary_rows.h"
#include "identification/inverse_dynamics/zero_phase_lowpass.h"
#include "identification/statistics/uncertainty.h"
#include "sim/experiment/measurement_model.h"
#include "sim/model/joint_equalities.h"
#include "sim/numerics/decompositions.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kFilter = 50;        // Hz
constexpr double kOfTheRate = 0.2;    // of the sampling rate, at most
constexpr double kSpeedNoise = 4e-3;  // of a joint's fastest, at least: filters ring after stops
constexpr double kLinear = 0.01;      // of a column: dry friction near rest bends it by less

std::string JointName(const mjModel& m, int j) {
  const char* const name = mj_id2name(&m, mjOBJ_JOINT, j);
  return name ? name : std::to_string(j);
}

void RequireMeasurable(const mjModel& m, const mjData& d) {
  const auto refuse = [](const std::string& what) {
    throw Error::Input("--method regressor", "a model whose states are its joints", what);
  };
  if (m.na > 0) refuse("activations of actuators");
  if (const JointEqualities ties(m); !ties.obstacle().empty()) refuse(ties.obstacle());
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_type[j] == mjJNT_FREE || m.jnt_type[j] == mjJNT_BALL)
      refuse("joint '" + JointName(m, j) + "', neither hinge nor slide");
  }
  for (int i = 0; i < m.nplugin; ++i) {
    const BoundLaw& law = BoundOf(m, d, i);
    if (law.NeedsAllForces() || (m.plugin_statenum[i] > 0 && !law.IsRow()))
      refuse(std::string(mjp_getPluginAtSlot(m.plugin[i])->name));
  }
}

double EvenStep(const Log& log) {
  const double step = (log.time.back() - log.time.front()) / static_cast<double>(log.rows() - 1);
  for (std::size_t k = 1; k < log.rows(); ++k) {
    if (std::abs(log.time[k] - log.time[k - 1] - step) > 0.01 * step) {
      throw Error::Input("--method regressor", log.label + " sampled evenly",
                         fmt::format("{:g} s after {:g} s, {:g} s on average",
                                     log.time[k] - log.time[k - 1], log.time[k - 1], step));
    }
  }
  return step;
}

// What one log says about every joint, filtered once.
struct Motion {
  std::size_t log;
  double step, cutoff;                       // cutoff: share of the sampling rate
  std::vector<std::vector<double>> q, v, a;  // [free dof][row]
  std::vector<double> noise;                 // [free dof], of v
  std::vector<std::pair<int, std::vector<double>>> actuator_force;  // actuator, its measured force
};

Motion MotionOf(const Experiment& e, const mjModel& m, std::size_t index, double cutoff) {
  const Log& log = e.logs[index];
  Motion motion{index, EvenStep(log), 0, {}, {}, {}, {}, {}};
  const double rate = 1 / motion.step;
  motion.cutoff = std::min(cutoff > 0 ? cutoff : kFilter, kOfTheRate * rate) / rate;
  const std::vector<int> dofs = JointEqualities(m).dofs();
  motion.q.resize(dofs.size()), motion.noise.resize(dofs.size());
  const Wiring wiring(e, m);
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& source = wiring.output[e.channels[c].output];
    const bool force = source.kind == Output::Kind::kForce;
    const auto joint =
        source.kind == Output::Kind::kSensor && m.sensor_type[source.sensor] == mjSENS_JOINTPOS
            ? std::find(dofs.begin(), dofs.end(), m.jnt_dofadr[m.sensor_objid[source.sensor]])
            : dofs.end();
    if (!force && joint == dofs.end()) continue;
    std::vector<double> y = log.measured[c];
    for (std::size_t k = 0; k < y.size(); ++k) {
      y[k] = SignalOf(e, c, y[k]);
      if (std::isnan(y[k])) {
        throw Error::Input("--method regressor",
                           "channel '" + e.channels[c].name + "' measured at every row",
                           fmt::format("a gap at {:g} s of {}", log.time[k], log.label));
      }
    }
    if (force) {
      motion.actuator_force.emplace_back(source.address, std::move(y));
    } else {
      const auto i = joint - dofs.begin();
      motion.q[i] = LowPass(y, motion.cutoff);
      motion.noise[i] = SpeedNoise(y, motion.q[i], motion.cutoff, motion.step);
    }
  }
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (motion.q[i].empty()) {
      throw Error::Input("--method regressor", "every joint measured",
                         "no output of joint '" + JointName(m, m.dof_jntid[dofs[i]]) + "'");
    }
    motion.v.push_back(Derivative(motion.q[i], motion.step));
    motion.a.push_back(Derivative(motion.v[i], motion.step));
    const double fastest = Vector::Map(motion.v[i].data(), log.rows()).cwiseAbs().maxCoeff();
    motion.noise[i] = std::max(motion.noise[i], kSpeedNoise * fastest);
  }
  return motion;
}

std::vector<double> At(std::size_t row, const std::vector<std::vector<double>>& all) {
  std::vector<double> values;
  for (const auto& y : all) values.push_back(y[row]);
  return values;
}

// Puts a machine at one row of a motion; joints that are tied to others follow.
void SetState(const Motion& motion, std::size_t row, const JointEqualities& ties, const mjModel& m,
              mjData& d) {
  const auto q = At(row, motion.q), v = At(row, motion.v), a = At(row, motion.a);
  ties.Spread(m, q.data(), a.data(), d);
  mju_copy(d.qacc, d.qvel, static_cast<int>(m.nv));
  ties.Spread(m, q.data(), v.data(), d);
}

// Held inputs act half a period after their rows on the average.
void SetInputs(const Experiment& e, const Log& log, const Wiring& wiring, std::size_t row,
               Inputs& inputs, mjData& d) {
  inputs.AtRow(d, row);
  for (std::size_t i = 0; row > 0 && i < e.inputs.size(); ++i) {
    if (!e.inputs[i].linear)
      d.ctrl[wiring.control[i]] = (log.input[i][row - 1] + log.input[i][row]) / 2;
  }
}

// Forces of one machine along a motion [row, free dof]: what is missing, what the actuators give;
// and 1 where dry friction may hold.
struct Forces {
  Matrix missing, actuated, stationary;
};

void Replace(const mjData& d, int actuator, double measured, Vector& force) {
  const double change = measured - d.actuator_force[actuator];
  const int adr = d.moment_rowadr[actuator];
  for (int k = adr; k < adr + d.moment_rownnz[actuator]; ++k)
    force[d.moment_colind[k]] += change * d.actuator_moment[k];
}

Forces ForcesOf(const Problem& problem, const Motion& motion, const Vector& x) {
  const Experiment& e = problem.experiment();
  const Log& log = e.logs[motion.log];
  ModelAndData machine = problem.system().Build(problem.ChangesFor(x, motion.log));
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  const Wiring wiring(e, m);
  Inputs inputs(m, e, log, wiring);
  const JointEqualities ties(m);
  m.opt.disableflags |= mjDSBL_EQUALITY;
  const auto rows = static_cast<Eigen::Index>(log.rows());
  const auto free = static_cast<Eigen::Index>(ties.velocities());
  Forces forces{Matrix(rows, free), Matrix(rows, free), Matrix::Zero(rows, free)};
  Matrix friction(rows, free);
  mj_resetData(&m, &d);
  Vector on_free(free);
  const auto freely = [&](const Vector& force) {
    ties.Project(force.data(), on_free.data());
    return on_free.transpose();
  };
  for (Eigen::Index k = 0; k < rows; ++k) {
    SetInputs(e, log, wiring, k, inputs, d);
    SetState(motion, k, ties, m, d);
    mj_inverse(&m, &d);
    Eigen::RowVectorXd stationary = Eigen::RowVectorXd::Zero(free);
    MarkStationary(ties, m, d, At(k, motion.v), motion.noise, stationary);
    forces.stationary.row(k) = stationary;
    mj_fwdActuation(&m, &d);
    Vector actuated = Vector::Map(d.qfrc_actuator, m.nv);
    for (const auto& [actuator, force] : motion.actuator_force)
      Replace(d, actuator, force[k], actuated);
    forces.actuated.row(k) = freely(actuated);
    const auto held = Vector::Map(d.qfrc_constraint, m.nv);
    friction.row(k) = freely(held);
    forces.missing.row(k) = freely(Vector::Map(d.qfrc_inverse, m.nv) + held - actuated);
  }
  // Dry friction jumps where filtered motion does not: it is filtered like the positions first.
  for (Eigen::Index i = 0; i < free; ++i) {
    const auto smooth = LowPass({friction.col(i).begin(), friction.col(i).end()}, motion.cutoff);
    forces.missing.col(i) -= Vector::Map(smooth.data(), rows);
  }
  for (Matrix* const forces_of : {&forces.missing, &forces.actuated}) {
    for (auto column : forces_of->colwise()) {
      const auto smooth = LowPass({column.begin(), column.end()}, motion.cutoff);
      column = Vector::Map(smooth.data(), rows);
    }
  }
  return forces;
}

// The equations of one log, without the ends that the filter has to guess.
struct Equations {
  bool train;
  Vector e, f;         // missing and actuator force, dof after dof
  Vector informative;  // 0 where dry friction may hold, else 1
  Matrix Y;            // ∂e/∂p
};

Vector Inner(const Matrix& forces, const Vector& weight, double cutoff) {
  const auto ends = std::min<Eigen::Index>(std::lround(1 / cutoff), forces.rows() / 4);
  const Matrix inner = forces.middleRows(ends, forces.rows() - 2 * ends) * weight.asDiagonal();
  return inner.reshaped();
}

// Rows that say something, whatever friction there is: at the start, or with other parameters.
Vector InformativeRows(const Problem& problem, const Motion& motion, const Vector& x,
                       const Matrix& stationary) {
  Vector there = x;
  for (Eigen::Index k = 0; k < x.size(); ++k) there[k] += problem.StepOf(x, k, 0.2);
  const Matrix all = WidenedByFilter(
      stationary.cwiseMax(ForcesOf(problem, motion, there).stationary), motion.cutoff);
  return 1 - Inner(all, Vector::Ones(all.cols()), motion.cutoff).array();
}

Vector Weights(const std::vector<Forces>& forces) {
  Vector power = Vector::Zero(forces.front().actuated.cols());
  double rows = 0;
  for (const Forces& f : forces) {
    power += f.actuated.colwise().squaredNorm().transpose();
    rows += static_cast<double>(f.actuated.rows());
  }
  const double least = 1e-12 * power.maxCoeff();
  return (rows / power.array().max(least)).sqrt();
}

Matrix Columns(const Problem& problem, const Motion& motion, const Vector& x, const Matrix& missing,
               const Vector& weight, const Vector& informative) {
  const Vector base = Inner(missing, weight, motion.cutoff);
  Matrix Y(base.size(), x.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const FreeParameter& p = problem.parameters()[k];
    if (!p.log[motion.log]) {
      Y.col(k).setZero();
      continue;
    }
    const double step = problem.StepOf(x, k, 0.2) / 2;
    const auto moved = [&](double by) -> Vector {
      Vector there = x;
      there[k] += by;
      return (Inner(ForcesOf(problem, motion, there).missing, weight, motion.cutoff) - base) / by;
    };
    Y.col(k) = moved(step);
    const double bend = informative.cwiseProduct(moved(2 * step) - Y.col(k)).norm();
    const double size = informative.cwiseProduct(Y.col(k)).norm();
    if (bend > kLinear * size) {
      throw Error::Input("--method regressor", "parameters that enter the forces linearly",
                         fmt::format("'{}', whose effect changes by {:.2g} % over {:g} {}", p.name,
                                     100 * bend / size, step, p.unit));
    }
  }
  return Y;
}

double Relative(const std::vector<Equations>& equations, const Vector& change, bool train) {
  double missing = 0, actuated = 0;
  for (const Equations& q : equations) {
    if (q.train != train) continue;
    missing += (q.e + q.Y * change).squaredNorm();
    actuated += q.f.squaredNorm();
  }
  return actuated > 0 ? 100 * std::sqrt(missing / actuated) : 0;
}

// Least squares within the bounds: what leaves them stays at them, the others again.
Vector Solve(const Problem& problem, const Vector& x, const std::vector<Equations>& equations) {
  const Eigen::Index n = x.size();
  Matrix H = Matrix::Zero(n, n);
  Vector g = Vector::Zero(n), scale(n);
  for (Eigen::Index k = 0; k < n; ++k) scale[k] = problem.parameters()[k].scale;
  for (const Equations& q : equations) {
    if (!q.train) continue;
    H += q.Y.transpose() * q.informative.asDiagonal() * q.Y;
    g += q.Y.transpose() * q.informative.cwiseProduct(q.e);
  }
  H = scale.asDiagonal() * H * scale.asDiagonal();
  g = scale.cwiseProduct(g);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (H(k, k) > 0) continue;
    throw Error::Input("parameter '" + problem.parameters()[k].name + "'",
                       "an effect on the forces of a train log where its joints move", "none");
  }
  const Vector size = H.diagonal().cwiseSqrt();
  const Matrix unit = size.cwiseInverse().asDiagonal() * H * size.cwiseInverse().asDiagonal();
  if (unit.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() < 1e-10)
    throw Error::Job("the logs do not distinguish the parameters");
  std::vector<bool> fixed(n, false);
  Vector change = Vector::Zero(n);
  for (bool again = true; again;) {
    again = false;
    Matrix A = H;
    Vector b = -g;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (!fixed[k]) continue;
      b -= A.col(k) * change[k];
      A.row(k).setZero(), A.col(k).setZero();
      A(k, k) = 1, b[k] = change[k];
    }
    change = A.ldlt().solve(b);
    for (Eigen::Index k = 0; k < n; ++k) {
      const FreeParameter& p = problem.parameters()[k];
      const double value = x[k] + change[k] * scale[k];
      if (fixed[k] || (value >= p.lower && value <= p.upper)) continue;
      change[k] = (std::clamp(value, p.lower, p.upper) - x[k]) / scale[k];
      fixed[k] = again = true;
    }
  }
  return problem.Clamp(x + scale.cwiseProduct(change));
}

}  // namespace

Regression FitByRegressor(const Problem& problem, const std::vector<bool>& use,
                          const RegressorOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const Experiment& e = problem.experiment();
  const Vector x = problem.Start();
  const ModelAndData machine = problem.system().Build(problem.ChangesFor(x, 0));
  RequireMeasurable(*machine.model, *machine.data);
  std::vector<Motion> motions;
  std::vector<Forces> forces, seen;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    motions.push_back(MotionOf(e, *machine.model, l, options.cutoff));
    forces.push_back(ForcesOf(problem, motions.back(), x));
    if (use[l]) seen.push_back(forces.back());
  }
  const Vector weight = Weights(seen);
  std::vector<Equations> equations;
  Regression found;
  for (std::size_t l = 0; l < motions.size(); ++l) {
    const double cutoff = motions[l].cutoff;
    const Vector informative = InformativeRows(problem, motions[l], x, forces[l].stationary);
    equations.push_back({use[l], Inner(forces[l].missing, weight, cutoff),
                         Inner(forces[l].actuated, weight, cutoff), informative,
                         Columns(problem, motions[l], x, forces[l].missing, weight, informative)});
    if (use[l]) found.rows += static_cast<std::size_t>(informative.sum());
  }
  found.x = Solve(problem, x, equations);
  const Vector change = found.x - x;
  found.train = Relative(equations, change, true);
  found.validate = Relative(equations, change, false);
  std::vector<std::vector<Scores>> scores;
  for (const Equations& q : equations) {
    if (!q.train) continue;
    scores.push_back({{q.informative.cwiseProduct(q.e + q.Y * change),
                       q.informative.asDiagonal() * q.Y, Vector::Ones(q.e.size())}});
  }
  found.uncertainty = UncertaintyFrom(problem, found.x, scores);
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

}  // namespace continuum
