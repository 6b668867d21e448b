#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <type_traits>

namespace continuum::statics {

/// Where a contact turns back in a step t = 0..1 of the load.
struct Turn {
  double at = 1;      ///< 1: it does not
  double unseen = 0;  ///< how far it slides to and fro, which friction that looks at ends misses
};

/// Of a contact that slides by d in the step, at its end with the rate v, taken as a parabola:
///
///   x(t) = d - v (1 - t) + (v - d) (1 - t)^2,   x' = 0 where 1 - t = v/(2 (v - d))           (1)
inline Turn TurnBefore(double d, double v) {
  if (!(v * (2 * d - v) < 0)) return {};  // rates at end and beginning
  const double back = v / (2 * (v - d));
  return {1 - back, std::min(std::abs(v * back / 2), std::abs(d - v * back / 2))};
}

/// The share of a step at which the first contact turns back by more than `unseen`; 1 when none
/// does. way: of every contact in the step; begin, end: rates per step there, `begin` empty where
/// it is not known.
inline double FirstTurn(const Eigen::VectorXd& begin, const Eigen::VectorXd& way,
                        const Eigen::VectorXd& end, double unseen) {
  double first = 1;
  for (Eigen::Index i = 0; i < way.size(); ++i) {
    const Turn last = TurnBefore(way[i], end[i]);
    if (last.unseen > unseen) first = std::min(first, last.at);
    if (begin.size() == 0 || (begin[i] * way[i] > 0 && begin[i] * end[i] > 0)) continue;
    const Turn mirrored = TurnBefore(-way[i], -begin[i]);  // the step from its end
    if (mirrored.unseen > unseen) first = std::min(first, 1 - mirrored.at);
  }
  return first;
}

/// What FollowRisingLoad asks of a system whose contacts remember: `Slid(x)` in units of the way
/// within which a contact turns, empty where none remembers; `SomeRest(x)`, whether some neither
/// slide on nor have turned; `Rate(load, x, exact)`, dx/dload at a root by the last tangent or by
/// its own; and `GoOnFrom(x)`: they slide from there now.
template <class System, class Vector>
concept Remembering = requires(System& system, const Vector& x) {
  system.Slid(x);
  system.SomeRest(x);
  system.Rate(0.0, x, true);
  system.GoOnFrom(x);
};

/// df/dload at x; the balance is at `load` then.
template <class Balance, class Vector>
Vector SlopeByLoad(Balance& balance, double load, const Vector& x) {
  constexpr double kStep = 1e-5;
  Vector before = x, now = x;
  balance.SetLoad(load - kStep);
  const bool valid = balance(x.data(), before.data());
  balance.SetLoad(load);
  if (!valid || !balance(x.data(), now.data())) return Vector::Zero(x.size());
  return (now - before) / kStep;
}

/// Cuts the way of a rising load where contacts turn back, so that each slides one way in a step.
template <class System, class Vector>
class TurningContacts {
 public:
  explicit TurningContacts(System& system) : system_(system) {}

  /// The share of the step from the root x to the root `next` that may be taken: 1, or where the
  /// first contact turns back.
  double Share(double load, const Vector& x, double next_load, const Vector& next) {
    const double step = next_load - load;
    const Eigen::VectorXd begin = system_.Slid(x), way = system_.Slid(next) - begin;
    if (way.size() == 0) return 1;
    end_ = RateAt(next_load, next, false);
    if (rate_.size() == 0 && system_.SomeRest(next)) rate_ = RateFrom(load, x);
    if (FirstTurn(step * rate_, way, step * end_, kUnseen) == 1) return 1;
    end_ = RateAt(next_load, next, true);
    return FirstTurn(step * rate_, way, step * end_, kUnseen);
  }
  /// After a step that was taken; contacts slide from its end.
  void GoOnFrom(const Vector& x) {
    system_.GoOnFrom(x);
    rate_ = end_;
  }
  /// After a fall no rate is known. What the contacts slide from stays: so they have moved from it
  /// where the next step begins, and a tangent there knows which of them rest.
  void Fallen() { rate_.resize(0); }

 private:
  static constexpr double kUnseen = 0.1;
  static constexpr double kLittle = 1e-3;  // of the load

  Eigen::VectorXd RateAt(double load, const Vector& x, bool exact) {
    const Vector rate = system_.Rate(load, x, exact);
    const double h = 1e-4 / (1 + rate.norm());
    return (system_.Slid(x) - system_.Slid(x - h * rate)) / h;
  }
  // Of contacts at rest whether they will slide is known by a small step alone.
  Eigen::VectorXd RateFrom(double load, const Vector& x) {
    Vector next = x;
    if (!system_.Correct(load + kLittle, next).ok()) return {};
    return (system_.Slid(next) - system_.Slid(x)) / kLittle;
  }

  System& system_;
  Eigen::VectorXd rate_, end_;  // per load, where the next step begins; where the last one ended
};

/// The same of a system that is not Remembering.
struct NothingTurns {
  template <class System>
  explicit NothingTurns(const System& /*system*/) {}
  template <class Vector>
  double Share(double /*load*/, const Vector& /*x*/, double /*to*/, const Vector& /*next*/) const {
    return 1;
  }
  template <class Vector>
  void GoOnFrom(const Vector& /*x*/) const {}
  void Fallen() const {}
};

template <class System, class Vector>
using Turning =
    std::conditional_t<Remembering<System, Vector>, TurningContacts<System, Vector>, NothingTurns>;

}  // namespace continuum::statics
