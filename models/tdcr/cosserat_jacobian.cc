#include <algorithm>
#include <array>
#include <vector>

#include "models/tdcr/cosserat.h"
#include "models/tdcr/cosserat_walk.h"

namespace continuum::tdcr {

namespace {

constexpr int kBlock = 4;
using Dual = ceres::Jet<double, kBlock>;

// Numbers of a state: q, u and the tensions.
Eigen::Index Numbers(Eigen::Index tendons) { return 7 + tendons; }

template <class State>
auto& NumberOf(State& y, Eigen::Index i) {
  return i < 4 ? y.q[i] : i < 7 ? y.u[i - 4] : y.tension[i - 7];
}

}  // namespace

template <int kRubbing>
bool RodBalance::JacobianOf(const Eigen::VectorXd& x, Eigen::VectorXd& f,
                            Eigen::MatrixXd& jacobian) const {
  using Plain = State<double, kRubbing, true>;
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  std::vector<Plain> at{Base<double, kRubbing, true>(x.data())};
  const auto keep = [&](int step, const Plain& y) {
    if (static_cast<int>(at.size()) == step) at.push_back(y);  // where u jumps: before it
  };
  if (!WalkAll<double, kRubbing, true>(x.data(), f.data(), keep)) return false;
  const std::vector<Eigen::Index> coupled = Coupled(x);
  jacobian.setZero();
  jacobian.diagonal().setConstant(-1);
  // A walk takes its unknowns along half the rod, as they act all along it; steps take all of it.
  const auto columns = static_cast<Eigen::Index>(coupled.size());
  const bool many = columns > 2 * (Numbers(tendons) + tendons);
  const bool valid = many ? BySteps<kRubbing>(x, at, coupled, jacobian)
                          : ByWalks<kRubbing>(x, at, coupled, jacobian);
  return valid && f.allFinite() && jacobian.allFinite();
}

// A contact moves nothing before its step: walks with duals begin there.
template <int kRubbing>
bool RodBalance::ByWalks(const Eigen::VectorXd& x,
                         const std::vector<State<double, kRubbing, true>>& at,
                         const std::vector<Eigen::Index>& coupled,
                         Eigen::MatrixXd& jacobian) const {
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  const auto nothing = [](int, const auto&) {};
  std::vector<Dual> dual_x(x.begin(), x.end()), dual_f(static_cast<std::size_t>(x.size()));
  for (std::size_t first = 0; first < coupled.size(); first += kBlock) {
    const auto count = static_cast<int>(std::min<std::size_t>(kBlock, coupled.size() - first));
    const auto column = [&](int i) { return coupled[first + static_cast<std::size_t>(i)]; };
    const auto step = static_cast<int>(std::max<Eigen::Index>(0, (column(0) - 3) / tendons));
    std::fill(dual_f.begin(), dual_f.end(), Dual(0));
    for (int i = 0; i < count; ++i) dual_x[static_cast<std::size_t>(column(i))].v[i] = 1;
    const State<Dual, kRubbing, true> begin =
        step > 0 ? State<Dual, kRubbing, true>::Of(at[static_cast<std::size_t>(step)])
                 : Base<Dual, kRubbing, true>(dual_x.data());
    if (!Walk<Dual, kRubbing, true>(dual_x.data(), dual_f.data(), step, begin, nothing)) {
      return false;
    }
    for (int i = 0; i < count; ++i) {
      for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
        jacobian(row, column(i)) = dual_f[static_cast<std::size_t>(row)].v[i];
      }
      dual_x[static_cast<std::size_t>(column(i))].v[i] = 0;
    }
  }
  return true;
}

// Of the state after a step, with the tendons' lengths, by the state before it and the shares.
template <int kRubbing>
bool RodBalance::StepSlopes(const Eigen::VectorXd& x, int step,
                            const State<double, kRubbing, true>& y, Eigen::MatrixXd& slopes) const {
  using S = State<Dual, kRubbing, true>;
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  const Eigen::Index numbers = Numbers(tendons), all = numbers + tendons;
  const auto nothing = [](int, const auto&) {};
  std::array<Dual, kRubbing> share;
  slopes.setZero(all, all);
  for (Eigen::Index first = 0; first < all; first += kBlock) {
    S dual = S::Of(y);
    dual.way.setZero(tendons);
    for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
      share[k] = step < contacts_ ? Dual(Share(step, k, Beyond(x.data(), step, k)))
                                  : Dual(rod_.direction[k]);
    }
    const auto count = static_cast<int>(std::min<Eigen::Index>(kBlock, all - first));
    for (int i = 0; i < count; ++i) {
      const Eigen::Index at = first + i;
      (at < numbers ? NumberOf(dual, at) : share[static_cast<std::size_t>(at - numbers)]).v[i] = 1;
    }
    if (!Advance<Dual, kRubbing, true>(step, share.data(), dual, nothing)) return false;
    for (Eigen::Index row = 0; row < all; ++row) {
      const Dual& number = row < numbers ? NumberOf(dual, row) : dual.way[row - numbers];
      for (int i = 0; i < count; ++i) slopes(row, first + i) = number.v[i];
    }
  }
  return true;
}

// Of R nu(1) by the state at the tip.
template <int kRubbing>
void RodBalance::EndSlopes(const Eigen::VectorXd& x, const State<double, kRubbing, true>& y,
                           Eigen::MatrixXd& slopes) const {
  const Eigen::Index numbers = Numbers(static_cast<Eigen::Index>(rod_.pull.size()));
  const std::vector<Dual> dual_x(x.begin(), x.end());
  std::vector<Dual> end(dual_x.size());
  slopes.setZero(3, numbers);
  for (Eigen::Index first = 0; first < numbers; first += kBlock) {
    auto dual = State<Dual, kRubbing, true>::Of(y);
    const auto count = static_cast<int>(std::min<Eigen::Index>(kBlock, numbers - first));
    for (int i = 0; i < count; ++i) NumberOf(dual, first + i).v[i] = 1;
    End(dual_x.data(), dual, end.data());
    for (Eigen::Index row = 0; row < 3; ++row) {
      for (int i = 0; i < count; ++i) {
        slopes(row, first + i) = end[static_cast<std::size_t>(row)].v[i];
      }
    }
  }
}

// Slopes of the state by all unknowns go from step to step.
template <int kRubbing>
bool RodBalance::BySteps(const Eigen::VectorXd& x,
                         const std::vector<State<double, kRubbing, true>>& at,
                         const std::vector<Eigen::Index>& coupled,
                         Eigen::MatrixXd& jacobian) const {
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  const Eigen::Index numbers = Numbers(tendons);
  const auto columns = static_cast<Eigen::Index>(coupled.size());
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(numbers, columns);
  Eigen::MatrixXd way = Eigen::MatrixXd::Zero(tendons, columns);
  Eigen::MatrixXd slopes, rows = Eigen::MatrixXd::Zero(x.size(), columns);
  state.block(4, 0, 3, 3).setIdentity();  // u(0), the first unknowns
  const int steps = rod_.arcs() * steps_;
  Eigen::Index acting = 3;  // columns before it act before this step
  for (int step = 0; step < steps; ++step) {
    const Eigen::Index own = 3 + step * tendons;  // its first unknown
    if (step > 0 && step < contacts_) rows.middleRows(own, tendons) = -way;
    if (!StepSlopes<kRubbing>(x, step, at[static_cast<std::size_t>(step)], slopes)) return false;
    const auto so_far = std::min(columns, acting);
    way.leftCols(so_far) += slopes.bottomLeftCorner(tendons, numbers) * state.leftCols(so_far);
    state.leftCols(so_far) =
        (slopes.topLeftCorner(numbers, numbers) * state.leftCols(so_far)).eval();
    for (; acting < columns && coupled[acting] < own + tendons && step < contacts_; ++acting) {
      const Eigen::Index k = coupled[acting] - own;
      const double turn =
          Share(step, static_cast<std::size_t>(k), Dual(x[coupled[acting]], 0)).v[0];
      state.col(acting) = turn * slopes.col(numbers + k).head(numbers);
      way.col(acting) = turn * slopes.col(numbers + k).tail(tendons);
    }
  }
  EndSlopes<kRubbing>(x, at.back(), slopes);
  rows.topRows(3) = slopes * state;
  rows.middleRows(3, tendons) = way;
  for (Eigen::Index c = 0; c < columns; ++c) {
    const Eigen::Index unknown = coupled[c];
    rows(unknown, c) -= unknown >= 3 ? 1 : 0;     // (5)
    if (unknown >= 3 && unknown < 3 + tendons) {  // the whole length stands in all of (5)
      for (int step = 1; step < contacts_; ++step) rows(unknown + step * tendons, c) += 1;
    }
    jacobian.col(unknown) = rows.col(c);
  }
  return true;
}

bool RodBalance::Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f,
                          Eigen::MatrixXd& jacobian) const {
  const std::size_t tendons = rod_.pull.size();
  if (tendons <= internal::kFewTendons) return JacobianOf<internal::kFewTendons>(x, f, jacobian);
  if (tendons <= internal::kSomeTendons) return JacobianOf<internal::kSomeTendons>(x, f, jacobian);
  return JacobianOf<kMaxTendons>(x, f, jacobian);
}

std::vector<Eigen::Index> RodBalance::Coupled(const Eigen::VectorXd& x) const {
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  std::vector<Eigen::Index> coupled;
  for (Eigen::Index i = 0; i < 3 + tendons; ++i) coupled.push_back(i);
  for (Eigen::Index i = 3 + tendons; i < x.size(); ++i) {
    const auto contact = static_cast<int>((i - 3) / tendons);
    const auto tendon = static_cast<std::size_t>((i - 3) % tendons);
    if (Share(contact, tendon, Dual(x[i], 0)).v[0] != 0) coupled.push_back(i);
  }
  return coupled;
}

}  // namespace continuum::tdcr
