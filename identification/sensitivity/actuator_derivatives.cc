#include "identification/sensitivity/actuator_derivatives.h"

#include <algorithm>
#include <cmath>

#include "identification/sensitivity/native_forces.h"

namespace continuum {
namespace {

using Kind = Number::Kind;

// Entries i, i + step, … of an array as [number, perturbed model].
Tangents Strided(const Tangents& all, Eigen::Index first, Eigen::Index step, Eigen::Index count) {
  Tangents some(count, all.cols());
  for (Eigen::Index i = 0; i < count; ++i) some.row(i) = all.row(first + i * step);
  return some;
}

int OutputOf(const mjModel& m, int a) { return m.actuator_outadr[a]; }

}  // namespace

ActuatorDerivatives::ActuatorDerivatives(const ModelAndData& machine,
                                         std::span<const ModelAndData* const> perturbed,
                                         double move)
    : perturbed_(perturbed.begin(), perturbed.end()), move_(move) {
  const mjModel& m = *machine.model;
  const Eigen::Index n = m.nactuator;
  const auto all = [&](double* mjModel::*array, Eigen::Index size) {
    return ArrayTangents(m, perturbed, move, array, n * size);
  };
  gain_ = Strided(all(&mjModel::actuator_gainprm, mjNGAIN), 0, mjNGAIN, n);
  gear_ = Strided(all(&mjModel::actuator_gear, 6), 0, 6, n);
  range_ = all(&mjModel::actuator_forcerange, 2);
  const Tangents bias = all(&mjModel::actuator_biasprm, mjNBIAS);
  bias_.resize(3 * n, bias.cols());
  for (Eigen::Index i = 0; i < 3 * n; ++i) bias_.row(i) = bias.row(i / 3 * mjNBIAS + i % 3);
}

void ActuatorDerivatives::WriteConstants(NumberTangents& numbers) const {
  numbers[Kind::kGain] = gain_, numbers[Kind::kBias] = bias_, numbers[Kind::kGear] = gear_;
  numbers[Kind::kRange] = range_;
}

void ActuatorDerivatives::Begin(const mjModel& m, const mjData& d, NumberTangents& numbers) {
  control_.resize(m.nactuator);
  for (int a = 0; a < m.nactuator; ++a) control_[a] = ControlWithin(m, d, a);
  input_ = control_;
  was_.assign(d.ctrl, d.ctrl + m.nu);
  numbers[Kind::kControl].setZero(), numbers[Kind::kInput].setZero();
}

double ActuatorDerivatives::Rate(const mjModel& m, const mjData& d, int a) const {
  const int id = m.actuator_trnid[2 * a];
  return m.actuator_trntype[a] == mjTRN_TENDON ? d.ten_velocity[id] : d.qvel[m.jnt_dofadr[id]];
}

Eigen::RowVectorXd ActuatorDerivatives::RateTangent(const mjModel& m, int a,
                                                    const NumberTangents& numbers) const {
  const int id = m.actuator_trnid[2 * a];
  return m.actuator_trntype[a] == mjTRN_TENDON ? numbers[Kind::kRate].row(id)
                                               : numbers[Kind::kSpeed].row(m.jnt_dofadr[id]);
}

bool ActuatorDerivatives::SetInputs(const mjModel& m, mjData& d, const Tangents& activation,
                                    NumberTangents& numbers) {
  force_.resize(m.nactuator);
  for (int a = 0; a < m.nactuator; ++a) {
    if (input_[a] == control_[a]) continue;
    d.ctrl[a] = input_[a];
    if (ControlWithin(m, d, a) != input_[a]) return false;
  }
  for (int a = 0; a < m.nactuator; ++a) {
    const double rate = Rate(m, d, a), h = m.opt.timestep;
    const ActuatorOutput out = UnlimitedOutput(m, d, a, rate, h);
    force_[a] = out.f;
    const int id = m.actuator_trnid[2 * a];
    const auto rate_tangent = RateTangent(m, a, numbers);
    auto row = numbers[Kind::kActuator].row(a);
    row = out.by_rate * rate_tangent + out.by_input * numbers[Kind::kInput].row(a) +
          out.by_length * (m.actuator_trntype[a] == mjTRN_TENDON
                               ? numbers[Kind::kLength].row(id)
                               : numbers[Kind::kPosition].row(m.jnt_dofadr[id]));
    if (m.actuator_actadr[a] >= 0) row += out.by_activation * activation.row(m.actuator_actadr[a]);
    for (std::size_t c = 0; c < perturbed_.size(); ++c) {
      const double there = UnlimitedOutput(*perturbed_[c]->model, d, a, rate, h).f;
      row[static_cast<Eigen::Index>(c)] += (there - out.f) / move_;
    }
    numbers[Kind::kActuatorRate].row(a) =
        m.actuator_gear[6 * OutputOf(m, a)] * rate_tangent + rate * numbers[Kind::kGear].row(a);
  }
  return true;
}

void ActuatorDerivatives::Limit(const mjModel& m, NumberTangents& numbers) {
  for (int a = 0; a < m.nactuator; ++a) {
    const double* const range = m.actuator_forcerange + 2 * a;
    if (!m.actuator_forcelimited[a] || (force_[a] >= range[0] && force_[a] <= range[1])) continue;
    const bool low = force_[a] < range[0];
    force_[a] = low ? range[0] : range[1];
    numbers[Kind::kActuator].row(a) = range_.row(2 * a + !low);
  }
}

void ActuatorDerivatives::PutControlsBack(mjData& d) const {
  std::copy(was_.begin(), was_.end(), d.ctrl);
}

void ActuatorDerivatives::AddForces(const mjModel& m, const mjData& d,
                                    std::span<const double> given, double factor,
                                    const NumberTangents& numbers, Tangents& force) const {
  for (int a = 0; a < m.nactuator; ++a) {
    if (std::isnan(given[a])) continue;
    const double gear = m.actuator_gear[6 * OutputOf(m, a)];
    const double* const range = m.actuator_forcerange + 2 * a;
    const bool limited =
        m.actuator_forcelimited[a] && (given[a] <= range[0] || given[a] >= range[1]);
    Eigen::RowVectorXd along = gear * numbers[Kind::kActuator].row(a);
    if (!limited) {
      along -= gear * UnlimitedOutput(m, d, a, Rate(m, d, a), m.opt.timestep).by_rate *
               RateTangent(m, a, numbers);
    }
    const int id = m.actuator_trnid[2 * a];
    if (m.actuator_trntype[a] != mjTRN_TENDON) {
      force.row(m.jnt_dofadr[id]) += factor * along;
      continue;
    }
    const int adr = m.ten_J_rowadr[id];
    for (int k = adr; k < adr + m.ten_J_rownnz[id]; ++k)
      force.row(m.ten_J_colind[k]) += factor * d.ten_J[k] * along;
  }
}

}  // namespace continuum
