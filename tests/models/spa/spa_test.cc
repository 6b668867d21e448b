#include "models/spa/spa.h"

#include <random>

#include <ceres/jet.h>
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "print_mass.h"

namespace continuum {

namespace {

using Vector3 = Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr SpaParameters<double> kTable{.L0 = 0.13,
                                       .d = 0.05,
                                       .r_ch = 0.03,
                                       .x_m = -0.4e-3,
                                       .y_m = -1.5e-3,
                                       .T_PT1 = 7e-3,
                                       .A = 31e-6,
                                       .m = 0.1806,
                                       .d_theta = 0.2301,
                                       .d_dL = 1.8384,
                                       .k_theta = 183.5195,
                                       .k_theta3 = 2e3,
                                       .k_dL1 = 251.7274,
                                       .k_dL3 = -4.2e4};

struct Draw {
  std::mt19937 random{7};
  Vector3 operator()(double size) {
    std::uniform_real_distribution<double> u(-size, size);
    return {u(random), u(random), u(random)};
  }
  SpaState<double> State() { return {(*this)(0.06), (*this)(1)}; }
  Vector6 Six(double first, double second) {
    Vector6 v;
    v << (*this)(first), (*this)(second);
    return v;
  }
  SpaBase<double> Base() { return SpaCardan<double>::Base(Six(0.5, 1.2), Six(1, 3), Six(10, 30)); }
};

class BothMasses : public ::testing::TestWithParam<SpaMass> {
 protected:
  SpaOptions Options() const { return {GetParam(), SpaActuation::kTip, {1.2, -3.4, -9.1}}; }
};
INSTANTIATE_TEST_SUITE_P(Spa, BothMasses, ::testing::Values(SpaMass::kCentroid, SpaMass::kArc),
                         ::testing::PrintToStringParamName());

using Dual = ceres::Jet<double, 18>;  // by (q, q̇)

struct Gradient {
  Vector9 coordinates, momenta;
};

Gradient LagrangianGradient(const SpaOptions& options, const Vector9& q, const Vector9& rate) {
  Eigen::Matrix<Dual, 9, 1> dq, drate;
  for (int i = 0; i < 9; ++i) {
    dq[i] = Dual(q[i], i);
    drate[i] = Dual(rate[i], 9 + i);
  }
  const Spa<Dual> spa(kTable.Cast<Dual>(), options);
  const Eigen::Matrix<Dual, 6, 1> none = Eigen::Matrix<Dual, 6, 1>::Zero();
  const auto base = SpaCardan<Dual>::Base(dq.head<6>(), drate.head<6>(), none);
  const auto energy = spa.Energy({dq.tail<3>(), drate.tail<3>()}, base);
  const Dual lagrangian = energy.kinetic - energy.gravity - energy.elastic;
  return {lagrangian.v.head<9>(), lagrangian.v.tail<9>()};
}

// Lagrange's equations of the second kind in (x, y, z, α, β, γ, Δx, Δy, δL) from the energies
// alone; the model itself is written as a balance of momentum. The rate of the momenta is a
// five-point difference along the motion: rounding 1e-16/h, error h⁴/30 of the fifth derivative.
Vector9 Lagrange(const SpaOptions& options, const Vector9& q, const Vector9& rate,
                 const Vector9& acceleration) {
  const double h = 2e-4;
  const auto momenta = [&](double t) {
    return LagrangianGradient(options, q + t * rate + 0.5 * t * t * acceleration,
                              rate + t * acceleration)
        .momenta;
  };
  Vector9 force = (momenta(-2 * h) - 8 * momenta(-h) + 8 * momenta(h) - momenta(2 * h)) / (12 * h) -
                  LagrangianGradient(options, q, rate).coordinates;
  force.segment<2>(6) += kTable.d_theta * rate.segment<2>(6);
  force[8] += kTable.d_dL * rate[8];
  return force;
}

TEST_P(BothMasses, LeftSideEqualsLagrangesEquationsInSixBaseCoordinates) {
  Draw draw;
  const Spa<double> spa(kTable, Options());
  for (int k = 0; k < 20; ++k) {
    Vector9 q, rate, acceleration;
    q << draw.Six(0.5, 1.2), (k == 0 ? 0.0 : 1.0) * draw(0.06);
    rate << draw.Six(1, 3), draw(1);
    acceleration << draw.Six(10, 30), draw(50);
    const auto base = SpaCardan<double>::Base(q.head<6>(), rate.head<6>(), acceleration.head<6>());
    Vector9 left = spa.InverseDynamics({q.tail<3>(), rate.tail<3>()}, acceleration.tail<3>(), base);
    left.head<6>() = (SpaCardan<double>::Jacobian(q.head<6>()).transpose() * left.head<6>()).eval();
    const Vector9 truth = Lagrange(Options(), q, rate, acceleration);
    EXPECT_LT((left - truth).norm(), 1e-9 * truth.norm());
  }
}

TEST_P(BothMasses, RegressorTimesParametersIsTheLeftSide) {
  Draw draw;
  const Spa<double> spa(kTable, Options());
  for (int k = 0; k < 100; ++k) {
    const auto state = draw.State();
    const Vector3 acceleration = draw(50);
    const auto base = draw.Base();
    const Vector9 left = spa.InverseDynamics(state, acceleration, base);
    const Vector9 product = spa.Regressor(state, acceleration, base) * spa.LinearParameters();
    EXPECT_LT((left - product).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST_P(BothMasses, HybridDynamicsInvertTheInverseDynamics) {
  Draw draw;
  const Spa<double> spa(kTable, Options());
  for (int k = 0; k < 50; ++k) {
    const auto state = draw.State();
    const auto base = draw.Base();
    const Vector3 pressure = draw(3e4) + Vector3::Constant(3e4);
    const Vector3 acceleration = spa.Acceleration(state, base, pressure);
    const Vector3 force = spa.InverseDynamics(state, acceleration, base).tail<3>();
    EXPECT_LT((force - spa.Actuation(state.delta, pressure)).norm(), 1e-11);
  }
}

TEST_P(BothMasses, MassMatrixIsSymmetricSemidefiniteAndDefiniteInTheShape) {
  Draw draw;
  const Spa<double> spa(kTable, Options());
  for (int k = 0; k < 50; ++k) {
    const Vector3 delta = k == 0 ? Vector3::Zero().eval() : draw(0.08);
    const auto m = spa.MassMatrix(delta);
    EXPECT_LT((m - m.transpose()).cwiseAbs().maxCoeff(), 1e-16);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> all(m);
    EXPECT_GT(all.eigenvalues()[0], -1e-15);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> shape(m.bottomRightCorner<3, 3>());
    EXPECT_GT(shape.eigenvalues()[0], 0.01 * kTable.m);
    const long rank = (all.eigenvalues().array() > 1e-14).count();
    EXPECT_LE(rank, GetParam() == SpaMass::kArc ? 8 : 3);
  }
}

TEST_P(BothMasses, KineticEnergyIsHalfTheMassMatrixTimesTheSquaredVelocity) {
  Draw draw;
  const Spa<double> spa(kTable, Options());
  const auto state = draw.State();
  const auto base = draw.Base();
  Vector9 velocity;
  velocity << base.velocity, base.angular_velocity, state.rate;
  const auto m = spa.MassMatrix(state.delta);
  EXPECT_NEAR(spa.Energy(state, base).kinetic, 0.5 * velocity.dot(m * velocity), 1e-14);
  EXPECT_LT((spa.Momentum(state, base) - m.topRows<6>() * velocity).norm(), 1e-14);
}

TEST(Spa, StraightInertiasAreOneThirtySixthAndOneTwentieth) {
  const double L = kTable.L0 + 0.01, per_theta = kTable.d * kTable.d;
  const Vector3 straight(0, 0, 0.01);
  const auto centroid = Spa<double>(kTable, {SpaMass::kCentroid}).MassMatrix(straight);
  const auto arc = Spa<double>(kTable, {SpaMass::kArc}).MassMatrix(straight);
  EXPECT_NEAR(centroid(6, 6) * per_theta, kTable.m * L * L / 36, 1e-18);
  EXPECT_NEAR(arc(7, 7) * per_theta, kTable.m * L * L / 20, 1e-18);
  EXPECT_NEAR(centroid(8, 8), kTable.m / 4, 1e-16);
  EXPECT_NEAR(arc(8, 8), kTable.m / 3, 1e-16);
}

TEST(Spa, CardanBaseEqualsDerivativesOfThePose) {
  using Dual = ceres::Jet<double, 1>;
  Draw draw;
  const Vector6 q = draw.Six(0.5, 1.2), rate = draw.Six(1, 3), acceleration = draw.Six(10, 30);
  Eigen::Matrix<Dual, 6, 1> dq, drate;
  for (int i = 0; i < 6; ++i) {
    dq[i] = Dual(q[i]);
    drate[i] = Dual(rate[i]);
    dq[i].v[0] = rate[i];
    drate[i].v[0] = acceleration[i];
  }
  const auto base = SpaCardan<double>::Base(q, rate, acceleration);
  const auto rotation = SpaCardan<Dual>::Rotation(dq);
  const auto omega = (SpaCardan<Dual>::Rates(dq) * drate.tail<3>()).eval();
  Eigen::Matrix3d rotation_rate;
  for (int i = 0; i < 9; ++i) rotation_rate.data()[i] = rotation.data()[i].v[0];
  const Eigen::Matrix3d spin = base.R_WB.transpose() * rotation_rate;
  EXPECT_NEAR(spin(2, 1), base.angular_velocity[0], 1e-14);
  EXPECT_NEAR(spin(0, 2), base.angular_velocity[1], 1e-14);
  EXPECT_NEAR(spin(1, 0), base.angular_velocity[2], 1e-14);
  EXPECT_LT((base.R_WB.transpose() * base.R_WB - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_NEAR(base.R_WB.determinant(), 1, 1e-14);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(base.angular_acceleration[i], omega[i].v[0], 1e-13);
    EXPECT_NEAR((base.R_WB * base.acceleration)[i], acceleration[i], 1e-13);
    EXPECT_NEAR((base.R_WB * base.velocity)[i], rate[i], 1e-14);
  }
}

TEST_P(BothMasses, WrenchAtRestCarriesTheWeight) {
  const SpaOptions options{GetParam()};
  const Spa<double> spa(kTable, options);
  const SpaState<double> bent{{0.03, 0, 0.005}, Vector3::Zero()};
  const auto base = SpaBase<double>::Hanging();
  const Vector6 wrench = spa.BaseWrench(bent, Vector3::Zero(), base);
  // Hanging: gravity is +z in base axes, the mount pulls toward −z.
  EXPECT_NEAR(wrench[2], -kTable.m * 9.81, 1e-15);
  EXPECT_NEAR(wrench.head<2>().norm(), 0, 1e-15);
  const double theta = 0.03 / kTable.d, L = kTable.L0 + 0.005;
  const double x = L * (theta - std::sin(theta)) / (theta * theta);
  EXPECT_NEAR(wrench[4], x * kTable.m * 9.81, 1e-15);
}

// The closed chambers' pressure pair cancels: pressure alone, with the motion held, changes
// nothing.
TEST_P(BothMasses, PressureReachesTheBaseOnlyThroughMotion) {
  Draw draw;
  const Spa<double> spa(kTable, Options());
  const auto state = draw.State();
  const auto base = draw.Base();
  const Vector3 a = spa.Acceleration(state, base, Vector3::Zero());
  const Vector3 b = spa.Acceleration(state, base, {4e4, 0, 1e4});
  const Vector6 change = spa.BaseWrench(state, b, base) - spa.BaseWrench(state, a, base);
  const Eigen::Matrix<double, 6, 3> coupling = spa.MassMatrix(state.delta).topRightCorner<6, 3>();
  EXPECT_LT((change - coupling * (b - a)).norm(), 1e-12 * change.norm());
}

TEST_P(BothMasses, CrossingTheStraightShapeIsSmooth) {
  const Spa<double> spa(kTable, Options());
  const auto base = Draw{}.Base();
  const auto at = [&](double x, double y) {
    return spa.Acceleration({{x, y, 0.004}, {0.5, -0.2, 0.1}}, base, {4e4, 1e4, 0});
  };
  const Vector3 straight = at(0, 0);
  // A smooth function's difference shrinks with the distance, in any direction.
  const double slope = (at(1e-5, 0) - straight).norm() / 1e-5;
  for (const double h : {1e-6, 1e-8, 1e-10, 1e-12}) {
    for (const double angle : {0.0, 1.0, 2.5, 4.0}) {
      const double change = (at(h * std::cos(angle), h * std::sin(angle)) - straight).norm();
      EXPECT_LT(change, 5 * slope * h + 1e-12 * straight.norm()) << h;
    }
  }
}

TEST(Spa, TipAndVolumeActuationAgreeWhenStraight) {
  const Vector3 pressure(4e4, 1e4, 2e4), straight(0, 0, 0.01);
  const Vector3 tip =
      Spa<double>(kTable, {.actuation = SpaActuation::kTip}).Actuation(straight, pressure);
  const Vector3 volume =
      Spa<double>(kTable, {.actuation = SpaActuation::kVolume}).Actuation(straight, pressure);
  EXPECT_LT((tip - volume).norm(), 1e-15);
}

TEST(SpaLag, FollowsTheDifferentialEquationExactly) {
  const double lag = 7e-3, u = 4e4;
  EXPECT_DOUBLE_EQ(SpaLag(0.0, u, lag, lag), u * (1 - std::exp(-1)));
  // One step equals any number of smaller ones.
  double p = 1e4;
  for (int i = 0; i < 1000; ++i) p = SpaLag(p, u, 1e-5, lag);
  EXPECT_NEAR(p, SpaLag(1e4, u, 1e-2, lag), 1e-8);
  EXPECT_EQ(SpaLag(1e4, u, 1e-3, 0.0), u);
}

}  // namespace
}  // namespace continuum
