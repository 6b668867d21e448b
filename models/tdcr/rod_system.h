#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "models/statics/relax.h"
#include "models/statics/turning.h"
#include "models/tdcr/corrector.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/rod_law.h"
#include "sim/numerics/last_tangent.h"

namespace continuum::tdcr {

/// The Cosserat rod: roots by shooting, stability and falls by a chain of rigid pieces. Contacts
/// that remember stay as they are while the rod falls.
template <class Vector>
class RodSystem {
 public:
  using Chain = statics::RodChain<RodLaw>;

  /// winches: as RodLaw::SetWinches.
  RodSystem(const Robot& robot, RodBalance& balance, Eigen::VectorXd winches = {})
      : robot_(robot), balance_(balance), winches_(std::move(winches)) {}

  numerics::Outcome Correct(double load, Vector& x) {
    balance_.SetLoad(load);
    if (!balance_.remembers()) return numerics::Newton(balance_, x, Corrector(load));
    Vector trial = x;
    numerics::Outcome outcome = tangent_.Newton(balance_, trial, Corrector(load));
    if (!outcome.ok()) {
      const int spent = outcome.iterations;
      trial = x;
      outcome = Sharpened(load, trial);
      outcome.iterations += spent;
    }
    if (outcome.ok()) x = trial;
    return outcome;
  }

  // The count of a coarse chain is that of the rod unless an eigenvalue is near zero: then of finer
  // ones. Friction adds at most mu sum T r/2 of the unloaded stiffness.
  int Unstable(double load, const Vector& x) {
    constexpr double kSpare = 0.05, kNear = 0.01;  // chains of 9 and 36 pieces: 0.01, 0.001
    balance_.SetLoad(load);
    const bool friction = balance_.rod().friction;
    int unstable = Count(x, kPieces, kSpare + (friction ? FrictionShare() : 0));
    if (unstable == 0) return 0;
    const bool held = friction || winches_.size() > 0;
    unstable = Count(x, kFallingPieces, held ? 0 : kNear);
    return unstable == kNearZero ? Count(x, kManyPieces, 0) : unstable;
  }

  statics::Fall Fall(double from, double load, Vector& x) {
    balance_.SetLoad(from);
    Chain::Shape shape = Frames(x, kFallingPieces);
    if (shape.empty()) return {};
    const Eigen::MatrixXd share = Shares(x);
    balance_.SetLoad(load);
    RodLaw law(balance_.rod(), Pieces(shape), share);
    Chain chain(law, law.lengths());
    statics::Fall fall = statics::FallToRest(chain, shape);
    if (!fall.ok) return fall;
    const Eigen::Matrix3Xd zeta = chain.zeta();
    const Eigen::Vector3d u = BaseCurvature(law, zeta);
    x = balance_.remembers() ? balance_.Unknowns(u, law.Beyond(zeta)) : Eigen::VectorXd(u);
    fall.ok = numerics::Newton(balance_, x, Limits()).ok() && Near(x, shape.back()) &&
              Unstable(load, x) == 0;
    return fall;
  }

  numerics::Outcome Solve(Vector& x) {
    balance_.SetLoad(1);
    return tangent_.Newton(balance_, x, Limits());
  }

  /// For statics::TurningContacts.
  Eigen::VectorXd Slid(const Vector& x) const {
    return balance_.remembers() ? balance_.SlidAt(x) : Eigen::VectorXd();
  }
  bool SomeRest(const Vector& x) const { return balance_.SomeRest(x); }
  void GoOnFrom(const Vector& x) {
    if (balance_.remembers()) balance_.GoOnFrom(x);
  }
  Vector Rate(double load, const Vector& x, bool exact) {
    return tangent_.Rate(balance_, x, statics::SlopeByLoad(balance_, load, x), exact);
  }

 private:
  static constexpr int N = Vector::RowsAtCompileTime;

  // By contacts that turn widely, then more and more sharply.
  numerics::Outcome Sharpened(double load, Vector& x) {
    numerics::Outcome outcome;
    int spent = 0;
    for (const double width : {1e-4, 1e-5, kGivesWay}) {
      balance_.SetWidth(width);
      numerics::Options options = Corrector(load);
      options.damped = true;
      options.max_iterations = 20;
      outcome = tangent_.Newton(balance_, x, options);
      spent += outcome.iterations;
      if (!outcome.ok()) break;
    }
    balance_.SetWidth(kGivesWay);
    outcome.iterations = spent;
    return outcome;
  }

  static constexpr int kPieces = 9, kFallingPieces = 36, kManyPieces = 144;
  static constexpr int kNearZero = 98, kUnknown = 99;

  // Unstable directions, or kNearZero when they are not the same within `spare` of the stiffness.
  int Count(const Vector& x, int pieces, double spare) {
    const Chain::Shape shape = Frames(x, pieces);
    if (shape.empty()) return kUnknown;
    RodLaw law(balance_.rod(), Pieces(shape), Shares(x));
    law.SetWinches(winches_);
    Chain chain(law, law.lengths());
    if (spare > 0 && chain.DefiniteAt(shape, -spare)) return 0;
    if (!chain.Linearize(shape)) return kUnknown;
    if (spare == 0) return UnstableDirections(chain, law, shape);
    return chain.Definite(spare) ? kNearZero : chain.UnstableDirections();
  }

  double FrictionShare() const {
    const UnitRod& rod = balance_.rod();
    double share = 0;
    for (const double pull : rod.pull) share += 0.75 * rod.mu * pull;
    return share * robot_.tendon_radius / robot_.length;
  }

  static int Pieces(const Chain::Shape& shape) { return static_cast<int>(shape.size()) - 1; }

  // Of contacts that remember.
  Eigen::MatrixXd Shares(const Vector& x) const {
    return balance_.remembers() ? balance_.ContactsAt(x).share : Eigen::MatrixXd();
  }

  // Frames of the root x, at least so many pieces. Contacts that remember are tied to the steps, so
  // that frames are left out instead.
  Chain::Shape Frames(const Vector& x, int pieces) {
    const int steps = balance_.steps();
    const int arcs = balance_.rod().arcs();
    const int wanted = std::max(1, (pieces + arcs - 1) / arcs);
    if (!balance_.remembers()) balance_.SetSteps(wanted);
    const RodBalance::Shape& shape = balance_.Integrate(x);
    balance_.SetSteps(steps);
    if (!shape.valid) return {};
    if (!balance_.remembers()) return shape.frames;
    int stride = std::max(1, steps / wanted);
    while (steps % stride != 0) --stride;
    Chain::Shape some;
    for (std::size_t i = 0; i < shape.frames.size(); i += static_cast<std::size_t>(stride)) {
      some.push_back(shape.frames[i]);
    }
    return some;
  }

  // From the middles of the first two pieces, where they are of one arc.
  static Eigen::Vector3d BaseCurvature(const RodLaw& law, const Eigen::Matrix3Xd& zeta) {
    if (!law.OneArc(0, 1)) return zeta.col(0);
    return 1.5 * zeta.col(0) - 0.5 * zeta.col(1);
  }

  bool Near(const Vector& x, const Eigen::Quaterniond& end) const {
    const auto& shape = balance_.Integrate(x);
    return shape.valid && shape.frames.back().angularDistance(end) < 0.2;
  }

  const Robot& robot_;
  RodBalance& balance_;
  Eigen::VectorXd winches_;
  numerics::LastTangentOf<RodBalance, N> tangent_{3};
};

}  // namespace continuum::tdcr
