#include "binding/island_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace continuum {
namespace {

constexpr double kRelativeError = 1e-12;

}  // namespace

double IslandRows::Base::At(std::span<const double> x) const {
  return constant - std::inner_product(slope.begin(), slope.end(), x.begin(), 0.0);
}

void IslandRows::Begin(const mjModel& m, const mjData& d, const StepInertia& inertia,
                       std::span<SolvedRow> all, std::span<const int> which,
                       std::span<const double> native) {
  n_ = inertia.size(), step_ = m.opt.timestep, native_ = native;
  rows_.clear(), J_.assign(which.size() * n_, 0);
  for (const int r : which) {
    double* const J = J_.data() + rows_.size() * n_;
    for (std::size_t k = 0; k < all[r].dof.size(); ++k)
      J[inertia.index(all[r].dof[k])] = all[r].J[k];
    rows_.push_back(&all[r]);
  }
  damped_ = inertia.matrix();
  FindResponses(m, d, inertia);
  Build();
}

// R of (1), which is J where nothing is damped.
void IslandRows::FindResponses(const mjModel& m, const mjData& d, const StepInertia& inertia) {
  R_ = J_;
  inertia.Mass(m, d, mass_);
  if (mass_ == inertia.matrix()) return;
  solver_.Begin(mass_, n_);
  solver_.Block(n_);
  std::vector<double> y(n_);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    std::copy_n(J_.data() + r * n_, n_, y.begin());
    solver_.Solve(y);
    for (int i = 0; i < n_; ++i)
      R_[r * n_ + i] = std::inner_product(y.begin(), y.end(), damped_.data() + i * n_, 0.0);
  }
}

void IslandRows::Build() {
  matrix_ = damped_, push_.assign(n_, 0);
  bases_.resize(native_.size());
  for (std::size_t c = 0; c < bases_.size(); ++c) {
    Base& base = bases_[c];
    base.rows = std::any_of(rows_.begin(), rows_.end(),
                            [&](const SolvedRow* row) { return row->On(c) != 0; });
    base.constant = native_[c];
    if (base.rows) base.slope.assign(n_, 0);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const SolvedRow& row = *rows_[r];
    if (!row.acts) continue;
    const double *const J = J_.data() + r * n_, *const R = R_.data() + r * n_;
    for (int i = 0; i < n_; ++i) {
      if (J[i] == 0) continue;
      const double f = J[i] * row.stiffness;
      push_[i] += f * row.reference;
      for (int j = 0; j < n_; ++j) matrix_[i * n_ + j] += f * R[j];
    }
    if (!row.on.empty()) AddBase(row, R);
  }
}

void IslandRows::AddBase(const SolvedRow& row, const double* R) {
  for (std::size_t c = 0; c < bases_.size(); ++c) {
    const double tension = row.on[c] * row.stiffness;
    if (tension == 0) continue;
    bases_[c].constant += tension * row.reference;
    for (int i = 0; i < n_; ++i) bases_[c].slope[i] += tension / step_ * R[i];
  }
}

int IslandRows::Judge(std::span<const double> x) {
  int wrong = 0;
  wrong_.assign(rows_.size(), false);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const SolvedRow& row = *rows_[r];
    if (!row.limit) continue;
    double pushed = row.reference * step_, size = std::abs(pushed);
    for (int i = 0; i < n_; ++i) {
      const double part = R_[r * n_ + i] * x[i];
      pushed -= part, size += std::abs(part);
    }
    wrong_[r] = row.acts ? pushed < -kRelativeError * size : pushed > kRelativeError * size;
    wrong += wrong_[r];
  }
  return wrong;
}

bool IslandRows::Change(bool one) {
  bool some = false;
  for (std::size_t r = rows_.size(); r-- > 0 && !(some && one);) {
    if (!wrong_[r]) continue;
    rows_[r]->acts = !rows_[r]->acts;
    some = true;
  }
  if (some) Build();
  return some;
}

std::vector<bool> IslandRows::Acting() const {
  std::vector<bool> acting;
  for (const SolvedRow* row : rows_) acting.push_back(row->acts);
  return acting;
}

void IslandRows::Act(const std::vector<bool>& acting) {
  for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r]->acts = acting[r];
  if (!rows_.empty()) Build();
}

}  // namespace continuum
