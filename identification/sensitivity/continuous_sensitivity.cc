#include "identification/sensitivity/continuous_sensitivity.h"

#include <algorithm>

namespace continuum {
namespace {

// What the dynamics have that the closed form does not know; empty: nothing.
std::string Obstacle(const ContinuousDynamics& dynamics) {
  const mjModel& m = dynamics.model();
  if (dynamics.tied()) return "joints are tied";
  if (m.nplugin > 0) return "an effect acts";
  return ForceDerivatives::Obstacle(m);
}

}  // namespace

ContinuousSensitivity::ContinuousSensitivity(
    ContinuousDynamics& dynamics, const std::vector<std::unique_ptr<ContinuousDynamics>>& perturbed,
    double move)
    : dynamics_(dynamics),
      perturbed_(perturbed),
      move_(move),
      why_not_(perturbed.size(), Obstacle(dynamics)),
      derivatives_(dynamics.model()),
      rate_(dynamics.size()) {
  if (perturbed.empty() || !Covers(0)) return;
  const mjModel& m = dynamics.model();
  for (std::size_t k = 0; k < perturbed.size(); ++k) {
    ModelDifference difference(m, perturbed[k]->model());
    if (!difference.field.empty()) {
      why_not_[k] = difference.field + " differs";
      continue;
    }
    difference.AddGated(dynamics.wiring());
    columns_.push_back(k);
    differences_.push_back(std::move(difference));
  }
  const auto count = static_cast<Eigen::Index>(columns_.size());
  const Eigen::Index nv = m.nv, na = m.na;
  if (SensorDerivatives::Cover(m, dynamics.wiring()))
    sensors_ = std::make_unique<SensorDerivatives>(m, dynamics.wiring());
  inertia_.resize(nv, nv), follow_.resize(nv, 2 * nv + na), driven_.resize(nv, count);
  lag_.resize(na, 1 + count);
  in_.resize(2 * nv + na, count), out_.resize(nv, count);
}

void ContinuousSensitivity::At(double t, const double* y) {
  if (columns_.empty()) return;
  if (t == t_ && !y_.empty() && std::equal(y_.begin(), y_.end(), y)) return;
  dynamics_.Rate(t, y, rate_.data());
  t_ = t, y_.assign(y, y + dynamics_.size());
  const mjModel& m = dynamics_.model();
  const mjData& d = dynamics_.data();
  derivatives_.Place(m, d);
  derivatives_.Update(m, d, d.qacc, d.qvel);
  follow_ << derivatives_.by_position(), derivatives_.by_velocity(), derivatives_.by_activation();
  driven_.setZero(), lag_.setZero();
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_actadr[a] >= 0)
      lag_(m.actuator_actadr[a], 0) = RateOfActivation(m, d, a).by_itself;
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const mjModel& other = perturbed_[columns_[c]]->model();
    const auto column = static_cast<Eigen::Index>(c);
    derivatives_.Differ(m, d, other, differences_[c], driven_.col(column).data());
    for (const int a : differences_[c].activations) {
      lag_(m.actuator_actadr[a], 1 + column) =
          (RateOfActivation(other, d, a).value - RateOfActivation(m, d, a).value) / move_;
    }
  }
  driven_ /= move_;
  mj_fullM(&m, &d, inertia_.data());
  factor_.compute(inertia_);
  factor_.solveInPlace(follow_);
  factor_.solveInPlace(driven_);
}

void ContinuousSensitivity::Rates(const std::vector<double*>& s,
                                  const std::vector<double*>& rates) {
  const Eigen::Index nv = dynamics_.model().nv, na = dynamics_.model().na;
  for (std::size_t c = 0; c < columns_.size(); ++c)
    std::copy_n(s[columns_[c]], 2 * nv + na, in_.col(static_cast<Eigen::Index>(c)).data());
  out_ = driven_;
  out_.noalias() += follow_ * in_;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    double* const rate = rates[columns_[c]];
    std::copy_n(in_.col(column).data() + nv, nv, rate);
    std::copy_n(out_.col(column).data(), nv, rate + nv);
    for (Eigen::Index a = 0; a < na; ++a)
      rate[2 * nv + a] = lag_(a, 0) * in_(2 * nv + a, column) + lag_(a, 1 + column);
  }
}

void ContinuousSensitivity::Observe(const std::vector<const double*>& s,
                                    const std::vector<Recorder*>& recorders) {
  if (columns_.empty() || !sensors_) return;
  const mjModel& m = dynamics_.model();
  mjData& d = dynamics_.data();
  mj_comPos(&m, &d);
  sensors_->Update(m, d);
  std::vector<double> dy(2 * m.nv);
  for (const std::size_t k : columns_) {
    for (std::size_t i = 0; i < dy.size(); ++i) dy[i] = move_ * s[k][i];
    sensors_->Move(d, dy.data(), dy.data() + m.nv);
    dynamics_.Record(*recorders[k]);
    sensors_->Back(d);
  }
}

}  // namespace continuum
