#include "identification/inverse_dynamics/pose_positions.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/QR>

#include "error.h"
#include "sim/model/mujoco_handles.h"
#include "sim/model/object_frame.h"

namespace continuum {
namespace {

using Vector = Eigen::VectorXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int kIterations = 100;
constexpr double kStill = 1e-11;   // rad or m: the last step
constexpr double kFarthest = 0.5;  // rad or m: a step
constexpr double kAlike = 1e-6;    // columns of joints that no place distinguishes

// From a measured orientation to the frame's, as a rotation vector in the world.
void TurnBetween(const double* axes, const std::array<double, 4>& measured, double* turn) {
  std::array<double, 4> to{}, back{}, between{};
  mju_mat2Quat(to.data(), axes);
  std::array<double, 4> unit = measured;
  mju_normalize4(unit.data());
  mju_negQuat(back.data(), unit.data());
  mju_mulQuat(between.data(), to.data(), back.data());
  mju_quat2Vel(turn, between.data(), 1);
}

// The places of a model at one row, and how they follow its free joints.
class Places {
 public:
  Places(const std::vector<MeasuredPlace>& places, const JointEqualities& ties,
         ModelAndData& machine)
      : places_(places), ties_(ties), m_(*machine.model), d_(*machine.data) {
    Eigen::Index rows = 0;
    for (const MeasuredPlace& place : places)
      rows += place.kind == MeasuredPlace::Kind::kTurn ? 3 : 1;
    residual.resize(rows);
    jacobian.setZero(rows, static_cast<Eigen::Index>(ties.velocities()));
  }

  void At(std::size_t row, const Vector& q) {
    const Vector still = Vector::Zero(q.size());
    ties_.Spread(m_, q.data(), still.data(), d_);
    mj_kinematics(&m_, &d_);
    mj_comPos(&m_, &d_);
    Eigen::Index at = 0;
    for (const MeasuredPlace& place : places_) at = Write(place, row, q, at);
  }

  Vector residual;
  RowMatrix jacobian;

 private:
  Eigen::Index Write(const MeasuredPlace& place, std::size_t row, const Vector& q,
                     Eigen::Index at) {
    if (place.kind == MeasuredPlace::Kind::kJoint) {
      residual[at] = (q[place.at] - place.value[0][row]) / place.unit;
      jacobian(at, place.at) = 1 / place.unit;
      return at + 1;
    }
    const int type = m_.sensor_objtype[place.at], id = m_.sensor_objid[place.at];
    const ObjectFrame frame = FrameOf(d_, type, id);
    const bool turn = place.kind == MeasuredPlace::Kind::kTurn;
    RowMatrix along(3, m_.nv);
    mj_jac(&m_, &d_, turn ? nullptr : along.data(), turn ? along.data() : nullptr, frame.position,
           BodyOf(m_, type, id));
    std::array<double, 3> away{};
    if (turn) {
      TurnBetween(
          frame.axes,
          {place.value[0][row], place.value[1][row], place.value[2][row], place.value[3][row]},
          away.data());
    } else {
      away[place.component] = frame.position[place.component] - place.value[0][row];
    }
    const int first = turn ? 0 : place.component, last = turn ? 3 : place.component + 1;
    for (int i = first; i < last; ++i, ++at) {
      residual[at] = away[i] / place.unit;
      ties_.Project(along.row(i).data(), jacobian.row(at).data());
      jacobian.row(at) /= place.unit;
    }
    return at;
  }

  const std::vector<MeasuredPlace>& places_;
  const JointEqualities& ties_;
  const mjModel& m_;
  mjData& d_;
};

// A Gauss-Newton step; empty: the places do not determine it.
Vector StepOf(const Places& places) {
  const Vector size = places.jacobian.colwise().norm();
  if (places.jacobian.rows() < places.jacobian.cols() || !(size.minCoeff() > 0)) return {};
  const RowMatrix unit = places.jacobian * size.cwiseInverse().asDiagonal();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(unit);
  const auto diagonal = qr.matrixR().diagonal().head(unit.cols()).cwiseAbs();
  if (diagonal.minCoeff() < kAlike * diagonal.maxCoeff()) return {};
  Vector step = -qr.solve(places.residual).cwiseQuotient(size);
  const double farthest = step.cwiseAbs().maxCoeff();
  if (farthest > kFarthest) step *= kFarthest / farthest;
  return step;
}

void RequireMoved(const Places& places, const JointEqualities& ties, const mjModel& m) {
  for (Eigen::Index i = 0; i < places.jacobian.cols(); ++i) {
    if (places.jacobian.col(i).norm() > 0) continue;
    throw Error::Input("--method regressor", "every joint measured",
                       "no output of joint " + Called(m, mjOBJ_JOINT, m.dof_jntid[ties.dofs()[i]]));
  }
}

}  // namespace

std::vector<std::vector<double>> PositionsFromPlaces(const std::vector<MeasuredPlace>& given,
                                                     const JointEqualities& ties,
                                                     ModelAndData& machine,
                                                     const std::string& log) {
  mj_resetData(machine.model.get(), machine.data.get());
  Places places(given, ties, machine);
  Vector q(static_cast<Eigen::Index>(ties.positions()));
  ties.FreePositions(machine.data->qpos, q.data());
  const std::size_t rows = given.front().value[0].size();
  std::vector<std::vector<double>> all(q.size());
  for (std::size_t row = 0; row < rows; ++row) {
    bool still = false;
    for (int i = 0; i < kIterations && !still; ++i) {
      places.At(row, q);
      const Vector step = StepOf(places);
      if (step.size() == 0) {
        RequireMoved(places, ties, *machine.model);
        throw Error::Input(
            "--method regressor", "places that determine every joint",
            fmt::format("joints that move them alike, at row {} of {}", row + 1, log));
      }
      q += step;
      still = step.cwiseAbs().maxCoeff() < kStill;
    }
    if (!still)
      throw Error::Job(
          fmt::format("--method regressor: no pose of the model fits row {} of {}", row + 1, log));
    for (Eigen::Index i = 0; i < q.size(); ++i) all[i].push_back(q[i]);
  }
  return all;
}

}  // namespace continuum
