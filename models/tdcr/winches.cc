#include "models/tdcr/winches.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "models/statics/dense_system.h"
#include "models/statics/length_driven.h"
#include "sim/numerics/linearize.h"

namespace continuum::tdcr {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What both plants know of the tendons.
class Tendons {
 public:
  Tendons(const Robot& robot, const VectorXd& given)
      : robot_(robot), given_(given), stretch_(robot.tendon_EA, given) {}

  double unit() const { return robot_.tension(); }
  double reach() const { return robot_.tendon_radius; }
  VectorXd Compliance(const VectorXd& tension) const { return stretch_.Compliance(tension); }

 protected:
  const Robot& robot_;
  const VectorXd& given_;
  statics::CableStretch stretch_;
};

/// Arcs between disks for statics::LengthDriven.
template <int C>
class DiskPlant : public Tendons {
 public:
  using Vector = typename DiskBalance<C>::Vector;
  using Matrix = typename DiskBalance<C>::Matrix;

  DiskPlant(const Robot& robot, const VectorXd& given, DiskBalance<C>& balance)
      : Tendons(robot, given), balance_(balance) {}

  void SetLoad(double load) { balance_.SetLoad(load); }
  void SetTension(const VectorXd& tension) { balance_.SetTension(tension); }
  bool Residual(const VectorXd& x, VectorXd& f) { return balance_(x.data(), f.data()); }
  VectorXd SlidAt(const VectorXd& x) { return balance_.SlidAt(x); }
  bool SomeRest(const VectorXd& x) { return balance_.SomeRest(x); }
  void GoOnFrom(const VectorXd& x) { balance_.GoOnFrom(x); }
  bool Linearize(const VectorXd& x, VectorXd& f, MatrixXd& k) {
    Vector balance(x.size());
    Matrix slope(x.size(), x.size());
    if (!balance_.Jacobian(Vector(x), balance, slope)) return false;
    f = balance;
    k = slope;
    return true;
  }
  VectorXd Lengths(const VectorXd& x) {
    return balance_.LengthsAt(Vector(x)).colwise().sum().transpose();
  }
  MatrixXd LengthSlopes(const VectorXd& x) {
    constexpr double kStep = 1e-5;
    MatrixXd slopes(given_.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const VectorXd step = kStep * VectorXd::Unit(x.size(), i);
      slopes.col(i) = (Lengths(x + step) - Lengths(x - step)) / (2 * kStep);
    }
    return slopes;
  }
  VectorXd Stretch(const VectorXd& x) {
    return stretch_.Of(balance_.TensionsAt(Vector(x)), balance_.LengthsAt(Vector(x)));
  }

  // By generalized forces; moments act at the starts of arcs, so that they are not quite symmetric.
  int Unstable(const VectorXd& x, const VectorXd& held) {
    VectorXd f(x.size());
    MatrixXd slope(x.size(), x.size());
    if (!Linearize(x, f, slope)) return static_cast<int>(x.size());
    const MatrixXd lengths = LengthSlopes(x);
    const Matrix relative = balance_.RelativeToUnloaded(Matrix(slope));
    const MatrixXd k = MatrixXd(balance_.Stiffness(relative)) +
                       lengths.transpose() * (held / robot_.moment()).asDiagonal() * lengths;
    const MatrixXd symmetric = 0.5 * (k + k.transpose());
    if (Eigen::LLT<MatrixXd>(symmetric).info() == Eigen::Success) return 0;
    const Matrix unloaded = balance_.Stiffness(Matrix::Identity(x.size(), x.size()));
    return statics::NegativeRealParts(Eigen::PartialPivLU<MatrixXd>(MatrixXd(unloaded)).solve(k));
  }

 private:
  DiskBalance<C>& balance_;
};

/// The Cosserat rod for statics::LengthDriven; its tendons' lengths are unknowns of its own.
class RodPlant : public Tendons {
 public:
  RodPlant(const Robot& robot, const VectorXd& given, RodBalance& balance)
      : Tendons(robot, given), balance_(balance) {}

  void SetLoad(double load) { balance_.SetLoad(load); }
  void SetTension(const VectorXd& tension) { balance_.SetTension(tension); }
  bool Residual(const VectorXd& x, VectorXd& f) { return balance_(x.data(), f.data()); }
  VectorXd SlidAt(const VectorXd& x) { return balance_.SlidAt(x); }
  bool SomeRest(const VectorXd& x) { return balance_.SomeRest(x); }
  void GoOnFrom(const VectorXd& x) { balance_.GoOnFrom(x); }
  bool Linearize(const VectorXd& x, VectorXd& f, MatrixXd& k) {
    return numerics::Linearize(balance_, x, f, k);
  }
  VectorXd Lengths(const VectorXd& x) { return robot_.length * x.segment(3, given_.size()); }
  MatrixXd LengthSlopes(const VectorXd& x) {
    MatrixXd slopes = MatrixXd::Zero(given_.size(), x.size());
    slopes.middleCols(3, given_.size()).diagonal().setConstant(robot_.length);
    return slopes;
  }
  VectorXd Stretch(const VectorXd& x) {
    const RodBalance::Shape& shape = balance_.Integrate(x);
    const Eigen::Index steps = shape.way.rows() - 1;
    const MatrixXd length = shape.way.bottomRows(steps) - shape.way.topRows(steps);
    const MatrixXd twice = shape.tension.topRows(steps) + shape.tension.bottomRows(steps);
    const double force = robot_.moment() / robot_.length;
    return stretch_.Of(0.5 * force * twice, robot_.length * length);
  }
  int Unstable(const VectorXd& x, const VectorXd& held) {
    const double unit = robot_.moment() / (robot_.length * robot_.length);  // EI/L^3
    return UnstableDirections(robot_, balance_, x, VectorXd(held / unit));
  }

 private:
  RodBalance& balance_;
};

}  // namespace

template <int C>
Found FindByWinches(const Robot& robot, const Loads& loads, const VectorXd& from,
                    DiskBalance<C>& balance, typename DiskBalance<C>::Vector& x,
                    VectorXd& tension) {
  DiskPlant<C> plant(robot, loads.length, balance);
  Found found;
  VectorXd shape = x;
  found.outcome =
      statics::FollowLengths(plant, from, loads.length, shape, tension, found.stability);
  x = shape;
  balance.SetTension(tension);
  return found;
}

template Found FindByWinches(const Robot&, const Loads&, const VectorXd&, DiskBalance<6>&,
                             DiskBalance<6>::Vector&, VectorXd&);
template Found FindByWinches(const Robot&, const Loads&, const VectorXd&,
                             DiskBalance<Eigen::Dynamic>&, DiskBalance<Eigen::Dynamic>::Vector&,
                             VectorXd&);

Found FindByWinches(const Robot& robot, const Loads& loads, const VectorXd& from,
                    RodBalance& balance, VectorXd& x, VectorXd& tension) {
  RodPlant plant(robot, loads.length, balance);
  Found found;
  found.outcome = statics::FollowLengths(plant, from, loads.length, x, tension, found.stability);
  balance.SetTension(tension);
  return found;
}

}  // namespace continuum::tdcr
