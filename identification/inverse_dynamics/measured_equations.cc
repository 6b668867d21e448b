#include "identification/inverse_dynamics/measured_equations.h"

#include <algorithm>
#include <cmath>

#include "engine.h"
#include "error.h"
#include "identification/inverse_dynamics/filtered_activations.h"
#include "identification/inverse_dynamics/stationary_rows.h"
#include "identification/inverse_dynamics/zero_phase_lowpass.h"
#include "sim/model/joint_equalities.h"
#include "sim/model/mujoco_handles.h"
#include "sim/numerics/parallel.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

void RequireMeasurable(const mjModel& m, const mjData& d) {
  const auto refuse = [](const std::string& what) {
    throw Error::Input("--method regressor", "a model whose states follow from its joints", what);
  };
  if (const std::string why = ActivationObstacle(m); !why.empty()) refuse(why);
  if (const JointEqualities ties(m); !ties.obstacle().empty()) refuse(ties.obstacle());
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_type[j] == mjJNT_FREE || m.jnt_type[j] == mjJNT_BALL)
      refuse("joint " + Called(m, mjOBJ_JOINT, j) + ", neither hinge nor slide");
  }
  for (int i = 0; i < m.nplugin; ++i) {
    const BoundLaw& law = BoundOf(m, d, i);
    if (law.NeedsAllForces() || (m.plugin_statenum[i] > 0 && !law.IsRow()))
      refuse(std::string(mjp_getPluginAtSlot(m.plugin[i])->name));
  }
}

// Places of bodies and sites in the pose at rest.
Vector PlacesOf(const ModelAndData& machine) {
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  mj_resetData(&m, &d);
  mj_kinematics(&m, &d);
  Vector places(3 * (m.nbody + m.nsite));
  places << Vector::Map(d.xpos, 3 * m.nbody), Vector::Map(d.site_xpos, 3 * m.nsite);
  return places;
}

// Positions that come from places hold for the geometry at the start.
void RequireGeometry(const Problem& problem) {
  const Vector x = problem.Start();
  const Vector here = PlacesOf(problem.system().Build(problem.ChangesFor(x, 0)));
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    Vector there = x;
    there[k] += problem.StepOf(x, k, 0.2);
    if (PlacesOf(problem.system().Build(problem.ChangesFor(there, 0))) == here) continue;
    throw Error::Input("--method regressor",
                       "parameters that move no place, as joints that are not measured follow them",
                       "'" + problem.parameters()[k].name + "'");
  }
}

std::vector<double> At(std::size_t row, const std::vector<std::vector<double>>& all) {
  std::vector<double> values;
  for (const auto& y : all) values.push_back(y[row]);
  return values;
}

Matrix Smooth(const Matrix& columns, double cutoff) {
  Matrix smooth(columns.rows(), columns.cols());
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    const auto y = LowPass({columns.col(i).begin(), columns.col(i).end()}, cutoff);
    smooth.col(i) = Vector::Map(y.data(), columns.rows());
  }
  return smooth;
}

// A machine that is put at the rows of a measured motion; joints that are tied to others follow.
class MeasuredState {
 public:
  MeasuredState(const Experiment& e, const LogMotion& motion, ModelAndData& machine)
      : m(*machine.model),
        d(*machine.data),
        ties(m),
        e_(e),
        log_(e.logs[motion.log]),
        motion_(motion),
        wiring_(e, m),
        inputs_(m, e, log_, wiring_),
        activations_(FilteredActivations(e, m, log_, wiring_, motion.cutoff)) {
    m.opt.disableflags |= mjDSBL_EQUALITY;
    mj_resetData(&m, &d);
  }

  // With all forces of the actuators, and those that the motion takes (qfrc_inverse); sensors too.
  void Take(std::size_t row, bool sensors) {
    SetInputs(row);
    const auto q = At(row, motion_.q), v = At(row, motion_.v), a = At(row, motion_.a);
    ties.Spread(m, q.data(), a.data(), d);
    mju_copy(d.qacc, d.qvel, static_cast<int>(m.nv));
    ties.Spread(m, q.data(), v.data(), d);
    mj_fwdPosition(&m, &d);
    mj_fwdVelocity(&m, &d);
    mj_fwdActuation(&m, &d);  // laws may read what actuators give
    mj_inverseSkip(&m, &d, mjSTAGE_VEL, !sensors);
  }

  // What actuators give [dof], measured where it is.
  Vector Actuated(std::size_t row) const {
    Vector force = Vector::Map(d.qfrc_actuator, m.nv);
    for (const auto& [actuator, measured] : motion_.actuator_force) {
      const double change = measured[row] - d.actuator_force[actuator];
      const int adr = d.moment_rowadr[actuator];
      for (int k = adr; k < adr + d.moment_rownnz[actuator]; ++k)
        force[d.moment_colind[k]] += change * d.actuator_moment[k];
    }
    return force;
  }

  mjModel& m;
  mjData& d;
  const JointEqualities ties;

 private:
  // Held inputs act half a period after their rows on the average; lags know it.
  void SetInputs(std::size_t row) {
    inputs_.AtRow(d, row);
    for (std::size_t i = 0; row > 0 && i < e_.inputs.size(); ++i) {
      if (!e_.inputs[i].linear)
        d.ctrl[wiring_.control[i]] = (log_.input[i][row - 1] + log_.input[i][row]) / 2;
    }
    for (int w = 0; w < m.na; ++w) d.act[w] = activations_[w][row];
  }

  const Experiment& e_;
  const Log& log_;
  const LogMotion& motion_;
  Wiring wiring_;
  Inputs inputs_;
  std::vector<std::vector<double>> activations_;
};

}  // namespace

// Along a motion [row, free joint or number of a wrench].
struct MeasuredEquations::Forces {
  Matrix missing, actuated;
  Matrix taken;       // by motion and weight
  Matrix stationary;  // 1 where dry friction may hold
};

MeasuredEquations::Forces MeasuredEquations::ForcesOf(const Vector& x, std::size_t log, Part part,
                                                      std::size_t thread) const {
  const LogMotion& motion = motions_[log];
  ModelAndData machine = problem_.system(thread).Build(problem_.ChangesFor(x, log));
  MeasuredState state(problem_.experiment(), motion, machine);
  const auto rows = static_cast<Eigen::Index>(motion.rows());
  const bool wrench = part == Part::kWrench;
  const auto count = static_cast<Eigen::Index>(wrench ? motion.wrench.size() : motion.q.size());
  const Matrix none = Matrix::Zero(rows, count);
  Forces forces{none, none, none, none};
  Matrix friction = none;
  Vector on_free(count);
  const auto freely = [&](const Vector& force) {
    state.ties.Project(force.data(), on_free.data());
    return on_free.transpose();
  };
  for (Eigen::Index k = 0; k < rows; ++k) {
    state.Take(k, wrench);
    for (Eigen::Index i = 0; wrench && i < count; ++i) {
      const MeasuredWrench& w = motion.wrench[i];
      forces.missing(k, i) = (state.d.sensordata[w.address] - w.value[k]) / w.unit;
    }
    if (wrench) continue;
    Eigen::RowVectorXd stationary = Eigen::RowVectorXd::Zero(count);
    MarkStationary(state.ties, state.m, state.d, At(k, motion.v), motion.noise, stationary);
    forces.stationary.row(k) = stationary;
    const Vector actuated = state.Actuated(k);
    const auto held = Vector::Map(state.d.qfrc_constraint, state.m.nv);
    const Vector moving = Vector::Map(state.d.qfrc_inverse, state.m.nv) + held;
    forces.actuated.row(k) = freely(actuated);
    forces.taken.row(k) = freely(moving + Vector::Map(state.d.qfrc_passive, state.m.nv));
    friction.row(k) = freely(held);
    forces.missing.row(k) = freely(moving - actuated);
  }
  for (Matrix* const of : {&forces.missing, &forces.actuated, &forces.taken, &friction}) {
    for (Eigen::Index i = 0; !wrench && i < count; ++i)
      if (motion.prescribed[i]) of->col(i).setZero();
  }
  // Dry friction jumps where filtered motion does not: it is filtered like the positions first.
  if (!wrench) forces.missing -= Smooth(friction, motion.cutoff);
  forces.missing = Smooth(forces.missing, motion.cutoff);
  if (!wrench) forces.actuated = Smooth(forces.actuated, motion.cutoff);
  return forces;
}

Vector MeasuredEquations::Inner(const Matrix& forces, std::size_t log) const {
  const auto ends = (forces.rows() - rows_[log]) / 2;
  return forces.middleRows(ends, rows_[log]).reshaped();
}

MeasuredEquations::MeasuredEquations(const Problem& problem, const std::vector<bool>& use,
                                     double cutoff)
    : problem_(problem), use_(use) {
  const Vector x = problem.Start();
  std::vector<Forces> forces;
  for (std::size_t l = 0; l < use.size(); ++l) {
    ModelAndData machine = problem.system().Build(problem.ChangesFor(x, l));
    RequireMeasurable(*machine.model, *machine.data);
    motions_.push_back(MotionOf(problem, machine, l, cutoff));
    const auto rows = static_cast<Eigen::Index>(motions_[l].rows());
    const auto ends = std::min<Eigen::Index>(std::lround(1 / motions_[l].cutoff), rows / 4);
    rows_.push_back(rows - 2 * ends);
    wrench_ |= !motions_[l].wrench.empty();
    forces.push_back(ForcesOf(x, l, Part::kJoints, 0));
  }
  if (motions_.front().from_places) RequireGeometry(problem);
  FindWeights(forces);
  FindInformative(forces);
}

// Of each joint its RMS force: what its actuators give, or where no joint has any what motion and
// weight take.
void MeasuredEquations::FindWeights(const std::vector<Forces>& forces) {
  const auto given = [](const Forces& f) { return f.actuated.squaredNorm() > 0; };
  const bool actuated = std::any_of(forces.begin(), forces.end(), given);
  const auto scale = actuated ? &Forces::actuated : &Forces::taken;
  Vector power = Vector::Zero(forces.front().missing.cols());
  double rows = 0;
  for (std::size_t l = 0; l < forces.size(); ++l) {
    if (!use_[l]) continue;
    power += (forces[l].*scale).colwise().squaredNorm().transpose();
    rows += static_cast<double>(forces[l].missing.rows());
  }
  const double least = 1e-12 * power.maxCoeff();
  weight_ = (rows / power.array().max(least)).sqrt();
  for (std::size_t l = 0; l < forces.size(); ++l)
    forces_.push_back(Inner(forces[l].*scale * weight_.asDiagonal(), l));
}

void MeasuredEquations::FindInformative(const std::vector<Forces>& forces) {
  const Vector x = problem_.Start();
  Vector there = x;
  for (Eigen::Index k = 0; k < x.size(); ++k) there[k] += problem_.StepOf(x, k, 0.2);
  for (std::size_t l = 0; l < forces.size(); ++l) {
    const Matrix both =
        forces[l].stationary.cwiseMax(ForcesOf(there, l, Part::kJoints, 0).stationary);
    informative_.push_back(1 - Inner(WidenedByFilter(both, motions_[l].cutoff), l).array());
  }
}

Vector MeasuredEquations::Weight(std::size_t log, Part part) const {
  if (part == Part::kJoints) return informative_[log];
  return Vector::Ones(rows_[log] * std::ssize(motions_[log].wrench));
}

std::vector<Vector> MeasuredEquations::Residuals(const Vector& x, Part part, bool all) const {
  std::vector<Vector> residuals(motions_.size());
  ParallelFor(motions_.size(), [&](std::size_t thread, std::size_t l) {
    if (!all && !use_[l]) return;
    const Matrix missing = ForcesOf(x, l, part, thread).missing;
    residuals[l] =
        part == Part::kJoints ? Inner(missing * weight_.asDiagonal(), l) : Inner(missing, l);
  });
  return residuals;
}

}  // namespace continuum
