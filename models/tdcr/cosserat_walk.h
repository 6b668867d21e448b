#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <type_traits>

#include "models/statics/dual_value.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/rubbing.h"

/// RodBalance's walk along the rod, for its two sources.
namespace continuum::tdcr {
namespace internal {

struct NoTensions {};
struct NoLengths {};

inline constexpr double kRoundsOff = 1e-24;  // the kink of a norm at zero
// Sizes of states: larger ones cost time to copy.
inline constexpr int kFewTendons = 4, kSomeTendons = 12;

template <class Matrix>
auto Values(const Matrix& m) {
  return m.unaryExpr([](const auto& x) { return statics::Value(x); }).eval();
}

// R^T m of a vector of the base frame.
template <class T>
Eigen::Matrix<T, 3, 1> ToSection(const Eigen::Matrix<T, 4, 1>& q, const Eigen::Vector3d& m) {
  const Eigen::Matrix<T, 3, 1> axis = -q.template tail<3>(), vector = m.cast<T>();
  const Eigen::Matrix<T, 3, 1> turned = 2.0 * axis.cross(vector);
  return vector + q[0] * turned + axis.cross(turned);
}

}  // namespace internal

// Rotation as a quaternion (w first), curvature, position and, with friction, tensions; of contacts
// that remember, the tendons' lengths so far.
template <class T, int kRubbing, bool kSlides>
struct RodBalance::State {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  using Tensions =
      std::conditional_t<kRubbing != 0, Eigen::Matrix<T, Eigen::Dynamic, 1, 0, kRubbing, 1>,
                         internal::NoTensions>;
  static constexpr bool kPosition = std::is_same_v<T, double>;  // the residual needs none

  Eigen::Matrix<T, 4, 1> q;
  Vector3 u, p;
  [[no_unique_address]] Tensions tension;
  [[no_unique_address]] std::conditional_t<kSlides, Tensions, internal::NoLengths> way;

  static State Of(const State<double, kRubbing, kSlides>& plain) {
    State y;
    y.q = plain.q.template cast<T>();
    y.u = plain.u.template cast<T>();
    y.p = plain.p.template cast<T>();
    if constexpr (kRubbing > 0) y.tension = plain.tension.template cast<T>();
    if constexpr (kSlides) y.way = plain.way.template cast<T>();
    return y;
  }

  void Add(double h, const State& slope) {
    q += T(h) * slope.q;
    u += T(h) * slope.u;
    if constexpr (kPosition) p += T(h) * slope.p;
    if constexpr (kRubbing > 0) tension += T(h) * slope.tension;
    if constexpr (kSlides) way += T(h) * slope.way;
  }
};

// The tendons that run through an arc, and, with dy, their lengths per unit of rod.
template <class T, int kRubbing, bool kSlides>
bool RodBalance::AddTendons(const Place& at, const State<T, kRubbing, kSlides>& y,
                            SectionMoment<T>& sum, State<T, kRubbing, kSlides>* dy) const {
  for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    T along(0);
    if (rod_.Runs(k, at.arc)) {
      T pull = T(rod_.pull[k]);
      if constexpr (kRubbing > 0) pull = y.tension[i];
      const Channel& channel = rod_.ChannelOf(k, at.arc);
      const bool inside = channel.parallel ? sum.AddParallel(channel.hole, pull, y.u, along)
                                           : sum.AddSlanted(channel.At(at.s), pull, y.u, along);
      if (!inside) return false;
    }
    if constexpr (kSlides) {
      if (dy != nullptr) dy->way[i] = along;
    }
  }
  return true;
}

// Flattened, as Rub is: dual numbers are so short that calls would cost as much as the work.
template <class T, int kRubbing, bool kSlides>
[[gnu::flatten]] bool RodBalance::Slope(const Place& at, const State<T, kRubbing, kSlides>& y,
                                        const T* share, State<T, kRubbing, kSlides>& dy) const {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  const Vector3& u = y.u;
  if constexpr (kSlides) dy.way.resize(y.way.size());
  SectionMoment<T> sum = Elastic(at.arc, u);
  if (!AddTendons(at, y, sum, &dy)) return false;
  const Vector3& moment = sum.moment;
  const Eigen::Vector3d force = rod_.Force(at.arc, at.s);
  const T &q0 = y.q[0], &q1 = y.q[1], &q2 = y.q[2], &q3 = y.q[3];
  const Vector3 tangent(2.0 * (q1 * q3 + q0 * q2), 2.0 * (q2 * q3 - q0 * q1),
                        q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3);
  const T nx = (q0 * q0 + q1 * q1 - q2 * q2 - q3 * q3) * force.x() +
               2.0 * ((q1 * q2 + q0 * q3) * force.y() + (q1 * q3 - q0 * q2) * force.z());
  const T ny = (q0 * q0 - q1 * q1 + q2 * q2 - q3 * q3) * force.y() +
               2.0 * ((q1 * q2 - q0 * q3) * force.x() + (q2 * q3 + q0 * q1) * force.z());
  Vector3 right(moment.y() * u.z() - moment.z() * u.y() + ny,
                moment.z() * u.x() - moment.x() * u.z() - nx,
                moment.x() * u.y() - moment.y() * u.x());

  if (sum.slanted) right -= sum.drift;
  dy.u = sum.Solve(right);
  if constexpr (kRubbing > 0) {
    Rub(at, y, sum.Hessian(), right, share, dy);
  }
  if constexpr (State<T, kRubbing, kSlides>::kPosition) dy.p = tangent;
  dy.q = 0.5 * Eigen::Matrix<T, 4, 1>(
                   -q1 * u.x() - q2 * u.y() - q3 * u.z(), q0 * u.x() + q2 * u.z() - q3 * u.y(),
                   q0 * u.y() + q3 * u.x() - q1 * u.z(), q0 * u.z() + q1 * u.y() - q2 * u.x());
  return true;
}

// u' with friction: H u' + sum_k T_k'(u') a_k x t_k = right, from the u' without it. Steps along
// the first tangent, off by a thousandth, in plain numbers; one more in T has the derivatives too.
template <class T, int kRubbing, bool kSlides>
[[gnu::flatten]] void RodBalance::Rub(const Place& at, const State<T, kRubbing, kSlides>& y,
                                      const Eigen::Matrix<T, 3, 3>& hessian,
                                      const Eigen::Matrix<T, 3, 1>& right, const T* share,
                                      State<T, kRubbing, kSlides>& dy) const {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  constexpr int kMostRounds = 12;
  constexpr double kLastStep = 1e-7;
  using Vector = Eigen::Vector3d;
  const auto count = static_cast<std::size_t>(y.tension.size());
  std::array<Rubbing<double>, kRubbing> plain;
  const Eigen::Matrix3d elastic = internal::Values(hessian);
  const Vector known = internal::Values(right);
  Vector du = internal::Values(dy.u);
  Eigen::Matrix3d tangent = elastic;
  for (std::size_t k = 0; k < count; ++k) {
    const double tension = statics::Value(y.tension[static_cast<Eigen::Index>(k)]);
    const double direction = kSlides ? statics::Value(share[k]) : rod_.direction[k];
    const Channel& channel = rod_.ChannelOf(k, at.arc);
    if (!rod_.Runs(k, at.arc)) continue;
    plain[k] = Rubbing<double>(channel.At(at.s), channel.parallel, internal::Values(y.u),
                               direction * rod_.mu * tension);
    tangent += plain[k].Lever() * plain[k].Gradient(du).transpose();
  }
  const Eigen::Matrix3d inverse = tangent.inverse();
  for (int round = 0; round < kMostRounds; ++round) {
    Vector rest = known - elastic * du;
    for (std::size_t k = 0; k < count; ++k) {
      if (rod_.Runs(k, at.arc)) rest -= plain[k].Slope(du) * plain[k].Lever();
    }
    const Vector step = inverse * rest;
    du += step;
    if (step.squaredNorm() <= kLastStep * kLastStep * (1 + du.squaredNorm())) break;
  }
  const Vector3 near = du.cast<T>();
  Vector3 rest = right - hessian * near;
  dy.tension.resize(y.tension.size());
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    dy.tension[i] = T(0);
    if (!rod_.Runs(k, at.arc)) continue;
    const T loss = kSlides ? T(rod_.mu * share[k]) : T(rod_.direction[k] * rod_.mu);
    const Channel& channel = rod_.ChannelOf(k, at.arc);
    const Rubbing<T> rubbing(channel.At(at.s), channel.parallel, y.u, loss * y.tension[i]);
    dy.tension[i] = rubbing.Slope(near);
    rest -= dy.tension[i] * rubbing.Lever();
  }
  const Vector3 step = inverse.cast<T>() * rest;
  dy.u = near + step;
  for (std::size_t k = 0; k < count; ++k) {
    if (!rod_.Runs(k, at.arc)) continue;
    const Vector gradient = plain[k].Gradient(du);
    for (int i = 0; i < 3; ++i) dy.tension[static_cast<Eigen::Index>(k)] += gradient[i] * step[i];
  }
}

template <class T, int kRubbing, bool kSlides>
RodBalance::State<T, kRubbing, kSlides> RodBalance::Base(const T* x) const {
  State<T, kRubbing, kSlides> y;
  y.q << T(1), T(0), T(0), T(0);
  y.u << x[0], x[1], x[2];
  y.p.setZero();
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  if constexpr (kRubbing > 0) {
    y.tension.resize(tendons);
    for (Eigen::Index k = 0; k < tendons; ++k) {
      y.tension[k] = T(rod_.pull[static_cast<std::size_t>(k)]);
    }
  }
  if constexpr (kSlides) y.way.setZero(tendons);
  return y;
}

// Shares of the contacts of a step, and their (5).
template <class T, int kRubbing>
void RodBalance::Slide(int step, const T* x, const State<T, kRubbing, true>& y, T* share,
                       T* end) const {
  const std::size_t tendons = rod_.pull.size();
  for (std::size_t k = 0; k < tendons; ++k) {
    share[k] = step < contacts_ ? Share(step, k, Beyond(x, step, k)) : T(rod_.direction[k]);
    if (step == 0 || step >= contacts_) continue;
    const T& way = y.way[static_cast<Eigen::Index>(k)];
    end[3 + static_cast<std::size_t>(step) * tendons + k] =
        Beyond(x, 0, k) - way - Beyond(x, step, k);
  }
}

// Of tendons that turn at the disk where an arc begins: T exp(-s mu b), b the angle.
template <class T, int kRubbing, bool kSlides>
void RodBalance::LoseAtDisk(int arc, const T* share, const State<T, kRubbing, kSlides>& before,
                            State<T, kRubbing, kSlides>& y) const {
  using std::asin;
  using std::exp;
  using std::sqrt;
  const double s = rod_.Arc(arc).start();
  for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
    if (!rod_.Runs(k, arc)) continue;
    const auto from = Along(rod_.ChannelOf(k, arc - 1).At(s), before.u).normalized();
    const auto to = Along(rod_.ChannelOf(k, arc).At(s), y.u).normalized();
    const T angle = 2.0 * asin(0.5 * sqrt((to - from).squaredNorm() + internal::kRoundsOff));
    const T sliding = kSlides ? share[k] : T(rod_.direction[k]);
    const auto i = static_cast<Eigen::Index>(k);
    y.tension[i] = before.tension[i] * exp(-rod_.mu * sliding * angle);
  }
}

// The curvature just after a disk, where the section or the tendons are others, by (2). Rounds
// after the last one that counts give duals their derivatives.
template <class T, int kRubbing, bool kSlides>
bool RodBalance::Jump(int arc, const T* share, State<T, kRubbing, kSlides>& y) const {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  constexpr int kMostRounds = 40, kMore = kRubbing > 0 ? 8 : 1;
  constexpr double kLastStep = 1e-13;
  const State<T, kRubbing, kSlides> before = y;
  const Place from{arc - 1, rod_.Arc(arc).start()}, to{arc, from.s};
  SectionMoment<T> sum = Elastic(arc - 1, y.u);
  if (!AddTendons(from, y, sum, static_cast<State<T, kRubbing, kSlides>*>(nullptr))) return false;
  const Vector3 moment = sum.moment - internal::ToSection(y.q, rod_.MomentAfter(arc - 1));
  for (int round = 0, more = 0; round < kMostRounds && more < kMore; ++round) {
    if constexpr (kRubbing > 0) LoseAtDisk(arc, share, before, y);
    sum = Elastic(arc, y.u);
    if (!AddTendons(to, y, sum, static_cast<State<T, kRubbing, kSlides>*>(nullptr))) return false;
    const Vector3 step = sum.Solve(moment - sum.moment);
    y.u += step;
    if (internal::Values(step).norm() <= kLastStep * (1 + internal::Values(y.u).norm())) ++more;
  }
  return true;
}

// R nu(1) less the moment at the tip, and (5) of the first contacts.
template <class T, int kRubbing, bool kSlides>
void RodBalance::End(const T* x, const State<T, kRubbing, kSlides>& y, T* end) const {
  const int last = rod_.arcs() - 1;
  SectionMoment<T> sum = Elastic(last, y.u);
  AddTendons({last, 1}, y, sum, static_cast<State<T, kRubbing, kSlides>*>(nullptr));
  // R nu by the quaternion: nu + 2 q_0 (q x nu) + 2 q x (q x nu).
  const Eigen::Matrix<T, 3, 1> axis = y.q.template tail<3>();
  const Eigen::Matrix<T, 3, 1> turned = 2.0 * axis.cross(sum.moment);
  Eigen::Map<Eigen::Matrix<T, 3, 1>> residual(end, 3);
  residual = sum.moment + y.q[0] * turned + axis.cross(turned);
  if (rod_.has_moments()) residual -= rod_.MomentAfter(last).template cast<T>();
  if constexpr (kSlides) {
    for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
      end[3 + k] = y.way[static_cast<Eigen::Index>(k)] - x[3 + k];
    }
  }
}

// A step of Dormand-Prince's fifth-order formula, `steps_` equal ones per arc, with a jump of u
// where an arc begins. share: of the contacts there.
template <class T, int kRubbing, bool kSlides, class AtNode>
bool RodBalance::Advance(int step, const T* share, State<T, kRubbing, kSlides>& y,
                         AtNode&& at_node) const {
  static constexpr double kNodes[6] = {0, 0.2, 0.3, 0.8, 8. / 9, 1};
  static constexpr double kA[7][6] = {
      {},
      {1. / 5},
      {3. / 40, 9. / 40},
      {44. / 45, -56. / 15, 32. / 9},
      {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
      {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
      {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
  using S = State<T, kRubbing, kSlides>;
  std::array<S, 6> slope;
  const int number = step / steps_;
  const RodArc& arc = rod_.Arc(number);
  const double h = 1.0 / (arc.per_rod * steps_);
  const double from = arc.before * steps_ + (step - number * steps_);  // in steps
  if (step == number * steps_ && rod_.Jumps(number)) {
    if (!Jump(number, share, y)) return false;
    at_node(step, y);
  }
  for (int stage = 0; stage <= 6; ++stage) {
    S at = y;
    for (int j = 0; j < stage; ++j) {
      if (kA[stage][j] != 0) at.Add(h * kA[stage][j], slope[static_cast<std::size_t>(j)]);
    }
    if (stage == 6) {
      y = at;
    } else if (!Slope({number, h * (from + kNodes[stage])}, at, share,
                      slope[static_cast<std::size_t>(stage)])) {
      return false;
    }
  }
  at_node(step + 1, y);
  return true;
}

// end: R nu(1), then (5). at_node(step, y) after every step, and once more where u has jumped. From
// the start of step `first`, where the rod is at y.
template <class T, int kRubbing, bool kSlides, class AtNode>
bool RodBalance::Walk(const T* x, T* end, int first, State<T, kRubbing, kSlides> y,
                      AtNode&& at_node) const {
  std::array<T, kSlides ? kRubbing : 1> share{};
  for (int step = first; step < rod_.arcs() * steps_; ++step) {
    if constexpr (kSlides) Slide(step, x, y, share.data(), end);
    if (!Advance<T, kRubbing, kSlides>(step, share.data(), y, at_node)) return false;
  }
  End(x, y, end);
  return true;
}

template <class T, int kRubbing, bool kSlides, class AtNode>
bool RodBalance::WalkAll(const T* x, T* end, AtNode&& at_node) const {
  return Walk<T, kRubbing, kSlides>(x, end, 0, Base<T, kRubbing, kSlides>(x), at_node);
}

template <class T, bool kSlides, class AtNode>
bool RodBalance::WalkAny(const T* x, T* end, AtNode&& at_node) const {
  const std::size_t tendons = rod_.pull.size();
  if constexpr (kSlides) {
    if (tendons <= internal::kFewTendons)
      return WalkAll<T, internal::kFewTendons, true>(x, end, at_node);
    if (tendons <= internal::kSomeTendons)
      return WalkAll<T, internal::kSomeTendons, true>(x, end, at_node);
    return WalkAll<T, kMaxTendons, true>(x, end, at_node);
  } else {
    if (!rod_.friction) return WalkAll<T, 0, false>(x, end, at_node);
    return tendons <= internal::kFewTendons
               ? WalkAll<T, internal::kFewTendons, false>(x, end, at_node)
               : WalkAll<T, kMaxTendons, false>(x, end, at_node);
  }
}

}  // namespace continuum::tdcr
