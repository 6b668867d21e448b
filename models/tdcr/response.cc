#include "models/tdcr/response.h"

#include <algorithm>
#include <utility>

#include "models/statics/length_driven.h"
#include "models/tdcr/contacts.h"
#include "models/tdcr/cosserat.h"
#include "models/tdcr/details.h"
#include "models/tdcr/disks.h"
#include "sim/numerics/linearize.h"

namespace continuum::tdcr {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using statics::Shown;

/// What all methods share. Inputs: tip force over EI/L^2, then tensions over EI/(L r_d).
class Tendons : public statics::Responding {
 public:
  Tendons(const Robot& robot, const Loads& loads)
      : robot_(robot), loads_(loads), stretch_(robot.tendon_EA, loads.length) {}

  double force() const { return robot_.moment() / robot_.length; }
  double tension() const { return robot_.tension(); }

 protected:
  Loads At(const VectorXd& w) const {
    Loads loads = loads_;
    loads.tip_force += force() * w.head<3>();
    for (int k = 0; k < robot_.tendons; ++k) {
      loads.tension[static_cast<std::size_t>(k)] += tension() * w[3 + k];
    }
    return loads;
  }
  bool by_length() const { return loads_.length.size() > 0; }

  const Robot& robot_;
  const Loads& loads_;
  statics::CableStretch stretch_;
};

template <int C>
class RespondingDisks : public Tendons {
 public:
  using Vector = typename DiskBalance<C>::Vector;
  using Matrix = typename DiskBalance<C>::Matrix;
  using Tendons::Tendons;

  bool Residual(const VectorXd& z, const VectorXd& w, VectorXd& f) const override {
    const Loads loads = At(w);
    return DiskBalance<C>(robot_, loads)(z.data(), f.data());
  }
  bool Tangent(const VectorXd& z, MatrixXd& k) const override {
    Vector f(z.size());
    Matrix tangent(z.size(), z.size());
    if (!DiskBalance<C>(robot_, loads_).Jacobian(Vector(z), f, tangent)) return false;
    k = tangent;
    return true;
  }
  std::optional<Shown> Show(const VectorXd& z, const VectorXd& w) const override {
    const Loads loads = At(w);
    const DiskBalance<C> balance(robot_, loads);
    const Vector x = z;
    const Chain chain = Forward(EqualArcs(robot_), balance.Curvatures(x));
    const MatrixXd length = balance.LengthsAt(x);
    VectorXd rest = length.colwise().sum().transpose();
    if (by_length()) rest -= stretch_.Of(balance.TensionsAt(x), length);
    VectorXd disks(3 * robot_.disks);
    for (int i = 0; i < robot_.disks; ++i) {
      disks.segment<3>(3 * i) = chain.O[static_cast<std::size_t>(i) + 1];
    }
    return Shown{chain.O.back(), Eigen::Quaterniond(chain.R.back()), rest, disks};
  }
  // Contacts turn within 1 um.
  double Step(Eigen::Index /*unknown*/) const override {
    return std::min(1e-5, 1e-3 * kGivesWay / robot_.tendon_radius);
  }
};

/// The Cosserat rod, also with contacts that remember.
class RespondingRod : public Tendons {
 public:
  RespondingRod(const Robot& robot, const Loads& loads, bool friction, bool remembers)
      : Tendons(robot, loads), friction_(friction), remembers_(remembers) {}

  bool Residual(const VectorXd& z, const VectorXd& w, VectorXd& f) const override {
    const Loads loads = At(w);
    return BalanceOf(loads)(z.data(), f.data());
  }
  bool Tangent(const VectorXd& z, MatrixXd& k) const override {
    const RodBalance balance = BalanceOf(loads_);
    VectorXd f(z.size());
    if (remembers_) return numerics::Linearize(balance, z, f, k);
    const Eigen::Vector3d x = z;
    Eigen::Vector3d residual;
    Eigen::Matrix3d tangent;
    if (!numerics::Linearize(balance, x, residual, tangent)) return false;
    k = tangent;
    return true;
  }
  std::optional<Shown> Show(const VectorXd& z, const VectorXd& w) const override {
    const Loads loads = At(w);
    const RodBalance balance = BalanceOf(loads);
    const RodBalance::Shape& shape = balance.Integrate(z);
    if (!shape.valid) return std::nullopt;
    const Line line = balance.LineOf(shape);
    VectorXd rest = TendonLengths(robot_, line);
    if (by_length()) {
      const Eigen::Index parts = shape.way.rows() - 1;
      const MatrixXd length = shape.way.bottomRows(parts) - shape.way.topRows(parts);
      const MatrixXd twice = shape.tension.topRows(parts) + shape.tension.bottomRows(parts);
      rest -= stretch_.Of(0.5 * force() * twice, robot_.length * length);
    }
    return Shown{line.points.rightCols<1>(), shape.frames.back(), rest, shape.disks.reshaped()};
  }
  // Contacts turn within 1 um.
  double Step(Eigen::Index unknown) const override {
    return unknown < 3 ? 1e-5 : 1e-3 * kGivesWay / robot_.length;
  }

 private:
  RodBalance BalanceOf(const Loads& loads) const {
    const int steps = ContactSteps(CountArcs(robot_));
    return remembers_ ? RodBalance::Remembering(robot_, loads, steps, nullptr)
                      : RodBalance(robot_, loads, friction_, steps);
  }

  bool friction_, remembers_;
};

std::optional<MatrixXd> Slopes(const Robot& robot, const Loads& loads, Method method,
                               const VectorXd& x, double& force, double& tension) {
  const auto of = [&](const auto& responding) {
    force = responding.force();
    tension = responding.tension();
    return statics::Respond(responding, x, 3 + robot.tendons);
  };
  if (method == Method::kEas) return of(RespondingDisks<6>(robot, loads));
  if (method == Method::kPcca) return of(RespondingDisks<Eigen::Dynamic>(robot, loads));
  return of(RespondingRod(robot, loads, method == Method::kCrtFriction, x.size() > 3));
}

}  // namespace

std::optional<statics::TipResponse> Respond(const Robot& robot, const Loads& loads, Method method,
                                            const Solution& solution) {
  Loads at = loads;
  at.from = solution.from;
  if (method == Method::kCrt) at.mu = 0;
  double force = 0, tension = 0;
  auto slopes = Slopes(robot, at, method, solution.x, force, tension);
  if (!slopes) return std::nullopt;
  slopes->leftCols(3) /= force;
  slopes->rightCols(robot.tendons) /= tension;
  statics::TipResponse response{{"fx", "fy", "fz"}, 3, std::move(*slopes)};
  for (const auto& name : statics::Numbered("T", robot.tendons)) response.input.push_back(name);
  if (loads.length.size() == 0) return response;
  return statics::HoldLengths(response, VectorXd::Map(at.tension.data(), robot.tendons));
}

}  // namespace continuum::tdcr
