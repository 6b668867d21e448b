#pragma once

#include <array>
#include <span>

#include <mujoco/mujoco.h>

#include <Eigen/Core>

#include "binding/law_slopes.h"
#include "sim/model/model_spec.h"

namespace continuum {

/// A row for each number, a column for each perturbed model.
using Tangents = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of the first numbers of an array of the model; move: what the differences are to be divided by.
inline Tangents ArrayTangents(const mjModel& m, std::span<const ModelAndData* const> perturbed,
                              double move, double* mjModel::*array, Eigen::Index size) {
  Tangents all(size, std::ssize(perturbed));
  for (Eigen::Index c = 0; c < all.cols(); ++c) {
    for (Eigen::Index i = 0; i < size; ++i)
      all(i, c) = ((perturbed[c]->model.get()->*array)[i] - (m.*array)[i]) / move;
  }
  return all;
}

/// What the numbers of a machine (law_slopes.h) change by in perturbed models, to first order.
/// States and parameters of all instances follow each other.
class NumberTangents {
 public:
  using Kind = Number::Kind;

  NumberTangents(const mjModel& m, Eigen::Index parameters, Eigen::Index perturbed) {
    for (const Kind kind :
         {Kind::kPosition, Kind::kSpeed, Kind::kPositionAfter, Kind::kSpeedAfter, Kind::kSpringRest,
          Kind::kTorqueTransmitted, Kind::kTorqueActuator, Kind::kForce})
      (*this)[kind].setZero(m.nv, perturbed);
    for (const Kind kind : {Kind::kLength, Kind::kRate, Kind::kPull})
      (*this)[kind].setZero(m.ntendon, perturbed);
    (*this)[Kind::kTendonRest].setZero(2 * m.ntendon, perturbed);
    for (const Kind kind : {Kind::kState, Kind::kNext})
      (*this)[kind].setZero(m.npluginstate, perturbed);
    for (const Kind kind : {Kind::kControl, Kind::kInput, Kind::kActuator, Kind::kActuatorNext,
                            Kind::kActuatorRate, Kind::kGain, Kind::kGear})
      (*this)[kind].setZero(m.nactuator, perturbed);
    (*this)[Kind::kBias].setZero(3 * m.nactuator, perturbed);
    (*this)[Kind::kRange].setZero(2 * m.nactuator, perturbed);
    (*this)[Kind::kParameter].setZero(parameters, perturbed);
  }

  Tangents& operator[](Kind kind) { return of_[static_cast<std::size_t>(kind)]; }
  const Tangents& operator[](Kind kind) const { return of_[static_cast<std::size_t>(kind)]; }

  Tangents tendon_stiffness, tendon_damping;  ///< [ntendon]

  /// Makes room for the rows of the constraint solver, all zero.
  void SetRows(int rows) {
    const Eigen::Index perturbed = (*this)[Kind::kPosition].cols();
    for (const Kind kind : {Kind::kYield, Kind::kLevel, Kind::kOffset})
      (*this)[kind].setZero(rows, perturbed);
  }
  /// Makes room for the sums of an instance's own, all zero.
  void SetScratch(int count) {
    (*this)[Kind::kScratch].setZero(count, (*this)[Kind::kPosition].cols());
  }

 private:
  std::array<Tangents, static_cast<std::size_t>(Kind::kNext) + 1> of_;
};

}  // namespace continuum
