#include "effects/pcc_kinematics.h"

#include <cmath>
#include <random>
#include <vector>

#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using Dual = ceres::Jet<double, 3>;
using Vector = Vec<double, 3>;
constexpr PccSegment<double> kSegment{0.13, 0.05};
constexpr double kRounding = 4e-15;  // a dozen units of rounding of numbers near one

std::vector<Vector> Shapes() {
  std::vector<Vector> shapes{{0, 0, 0}, {1e-9, 0, 0.01}, {-1e-5, 2e-5, -0.01}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> bend(-0.1, 0.1), stretch(-0.03, 0.05);
  for (int i = 0; i < 40; ++i) shapes.push_back({bend(random), bend(random), stretch(random)});
  return shapes;
}

Vec<Dual, 3> Seed(const Vector& x) { return {Dual(x[0], 0), Dual(x[1], 1), Dual(x[2], 2)}; }

// Extended precision, far from zero where nothing cancels there.
long double Reference(int k, long double theta) {
  long double c[2] = {std::cos(theta), std::sin(theta) / theta};
  long double factorial = 1;
  for (int i = 2; i <= k; ++i) {
    c[i % 2] = (1 / factorial - c[i % 2]) / (theta * theta);
    factorial *= i - 1;
  }
  return c[k % 2];
}

TEST(Stumpff, EqualsSineAndCosineFarFromZero) {
  for (double theta = 1.5; theta < 7; theta += 0.01) {
    const auto c = Stumpff<8>(theta * theta);
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(c[k], double(Reference(k, theta)), kRounding) << k << " at " << theta;
    }
  }
}

TEST(Stumpff, IsOneOverTheFactorialAtZeroAndLinearNearby) {
  const auto c = Stumpff<8>(0.0), near = Stumpff<8>(1e-6);
  double factorial = 1;
  for (int k = 0; k < 8; ++k) {
    EXPECT_DOUBLE_EQ(c[k], 1 / factorial);
    const double next = factorial * (k + 1) * (k + 2);
    EXPECT_NEAR(near[k], 1 / factorial - 1e-6 / next, 1e-12 / factorial);
    factorial *= k + 1;
  }
}

TEST(Stumpff, HasNoJumpWhereTheSeriesEnds) {
  const double below = std::nextafter(10.0, 0.0), above = 10.0;
  const auto a = Stumpff<8>(below), b = Stumpff<8>(above);
  for (int k = 0; k < 8; ++k) EXPECT_NEAR(a[k], b[k], kRounding) << k;
  const auto da = Stumpff<8>(Dual(below, 0)), db = Stumpff<8>(Dual(above, 0));
  for (int k = 0; k < 8; ++k) EXPECT_NEAR(da[k].v[0], db[k].v[0], kRounding) << k;
}

TEST(Stumpff, DualsFollowTheDerivativeRule) {
  for (const double w : {0.0, 1e-8, 0.3, 2.0, 9.0, 11.0, 30.0}) {
    const auto c = Stumpff<10>(Dual(w, 0));
    for (int k = 0; k < 8; ++k) {
      EXPECT_NEAR(c[k].v[0], 0.5 * (k * c[k + 2].a - c[k + 1].a), kRounding) << k << " at " << w;
    }
  }
}

TEST(Pcc, TipEqualsThePrintedEquations) {
  for (const Vector& shape : Shapes()) {
    const double big = std::hypot(shape[0], shape[1]), d = kSegment.d;
    if (big < 1e-3) continue;
    const double s = std::sin(big / d), c = std::cos(big / d);
    const double x = shape[0] / big, y = shape[1] / big;
    const double scale = d * (kSegment.L0 + shape[2]) / big;
    const PccTip<double> tip = PccTipPose(kSegment, shape);
    // A division by Δ ≥ 1 mm amplifies the rounding of the printed form by d/Δ ≤ 50.
    const double tolerance = 50 * kRounding;
    EXPECT_NEAR(tip.position[0], scale * x * (1 - c), tolerance);
    EXPECT_NEAR(tip.position[1], scale * y * (1 - c), tolerance);
    EXPECT_NEAR(tip.position[2], scale * s, tolerance);
    const Mat3<double> printed{{{1 + x * x * (c - 1), x * y * (c - 1), x * s},
                                {x * y * (c - 1), 1 + y * y * (c - 1), y * s},
                                {-x * s, -y * s, c}}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(tip.rotation[i][j], printed[i][j], tolerance);
    }
  }
}

TEST(Pcc, TipIsThePointAtTheEndOfTheCentreLine) {
  for (const Vector& shape : Shapes()) {
    const auto tip = PccTipPose(kSegment, shape).position;
    const auto end = PccCentreLine(kSegment, 1.0, shape, Vector{}).position;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(tip[i], end[i], kRounding);
  }
}

TEST(Pcc, CentroidIsTheMeanOfTheCentreLine) {
  // Composite Simpson, 200 intervals: error below (θ h)⁴/180 ~ 1e-11.
  for (const Vector& shape : Shapes()) {
    Vector mean{};
    for (int i = 0; i <= 200; ++i) {
      const auto point = PccCentreLine(kSegment, i / 200.0, shape, Vector{}).position;
      const double weight = (i == 0 || i == 200 ? 1 : i % 2 ? 4 : 2) / 600.0;
      for (int j = 0; j < 3; ++j) mean[j] += weight * point[j];
    }
    const auto centroid = PccCentroid(kSegment, shape, Vector{}).position;
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(centroid[j], mean[j], 1e-11);
  }
}

TEST(Pcc, StraightLimitsAreExact) {
  const auto tip = PccTipPose(kSegment, Vector{0, 0, 0.01});
  EXPECT_EQ(tip.position, (Vector{0, 0, 0.14}));
  EXPECT_EQ(tip.rotation, (Mat3<double>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}));
  const auto centroid = PccCentroid(kSegment, Vector{0, 0, 0.01}, Vector{});
  EXPECT_EQ(centroid.position, (Vector{0, 0, 0.07}));
  EXPECT_DOUBLE_EQ(centroid.jacobian[0][0], 0.14 / (6 * 0.05));  // x_CoG = L² κ / 6
  EXPECT_DOUBLE_EQ(centroid.jacobian[2][2], 0.5);
  const auto end = PccCentreLine(kSegment, 1.0, Vector{0, 0, 0.01}, Vector{});
  EXPECT_DOUBLE_EQ(end.jacobian[1][1], 0.14 / (2 * 0.05));  // y_tip = L² κ / 2
  EXPECT_DOUBLE_EQ(end.jacobian[2][2], 1);
}

TEST(Pcc, JacobiansEqualDuals) {
  for (const Vector& shape : Shapes()) {
    for (const double xi : {-1.0, 0.0, 0.3, 1.0}) {
      const auto at = [&](const auto& s, const auto& delta, const auto& rate) {
        return xi < 0 ? PccCentroid(s, delta, rate) : PccCentreLine(s, xi, delta, rate);
      };
      const auto point = at(kSegment, shape, Vector{});
      const auto dual =
          at(PccSegment<Dual>{Dual(kSegment.L0), Dual(kSegment.d)}, Seed(shape), Vec<Dual, 3>{});
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          EXPECT_NEAR(point.jacobian[i][j], dual.position[i].v[j], kRounding);
        }
      }
    }
  }
}

TEST(Pcc, JacobiansAndTheirRatesEqualFiniteDifferences) {
  const double h = 1e-6;  // central: error h² f'''/6 ~ 1e-9 (1/d² = 400), rounding 1e-17/h
  const Vector rate{0.3, -0.7, 0.4};
  for (const Vector& shape : Shapes()) {
    Vector ahead, behind;
    for (int i = 0; i < 3; ++i) {
      ahead[i] = shape[i] + h * rate[i];
      behind[i] = shape[i] - h * rate[i];
    }
    for (const double xi : {-1.0, 0.3, 1.0}) {
      const auto at = [&](const Vector& delta) {
        return xi < 0 ? PccCentroid(kSegment, delta, rate)
                      : PccCentreLine(kSegment, xi, delta, rate);
      };
      const auto a = at(ahead), b = at(behind), now = at(shape);
      for (int i = 0; i < 3; ++i) {
        double speed = 0;
        for (int j = 0; j < 3; ++j) {
          speed += now.jacobian[i][j] * rate[j];
          EXPECT_NEAR(now.jacobian_rate[i][j], (a.jacobian[i][j] - b.jacobian[i][j]) / (2 * h),
                      1e-7);
        }
        EXPECT_NEAR(speed, (a.position[i] - b.position[i]) / (2 * h), 1e-9);
      }
    }
  }
}

// Rᵀ Ṙ is the cross matrix of ω_tip.
TEST(Pcc, TurningIsTheRateOfTheRotation) {
  for (const Vector& shape : Shapes()) {
    const auto tip = PccTipPose(kSegment, shape);
    const auto dual =
        PccTipPose(PccSegment<Dual>{Dual(kSegment.L0), Dual(kSegment.d)}, Seed(shape));
    for (int k = 0; k < 3; ++k) {
      const auto spin = [&](int i, int j) {
        double sum = 0;
        for (int n = 0; n < 3; ++n) sum += tip.rotation[n][i] * dual.rotation[n][j].v[k];
        return sum;
      };
      const double tolerance = kRounding / kSegment.d;
      EXPECT_NEAR(tip.turning[0][k], spin(2, 1), tolerance);
      EXPECT_NEAR(tip.turning[1][k], spin(0, 2), tolerance);
      EXPECT_NEAR(tip.turning[2][k], spin(1, 0), tolerance);
    }
  }
}

TEST(Pcc, TheTipPositionDeterminesTheShape) {
  for (Vector shape : Shapes()) {
    const auto found = PccFromTip(kSegment, PccTipPose(kSegment, shape).position);
    // Near a half circle the tip's height, which is divided by, is small.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], shape[i], 1e-14);
  }
}

TEST(Pcc, TheShapeFromTheTipHasTheInverseJacobian) {
  for (const Vector& shape : Shapes()) {
    const auto end = PccCentreLine(kSegment, 1.0, shape, Vector{});
    const auto found =
        PccFromTip(PccSegment<Dual>{Dual(kSegment.L0), Dual(kSegment.d)}, Seed(end.position));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        double product = 0;
        for (int k = 0; k < 3; ++k) product += found[i].v[k] * end.jacobian[k][j];
        EXPECT_NEAR(product, i == j, 1e-11);
      }
    }
  }
}

TEST(PccPressure, ChamberOneBendsTowardPlusX) {
  const PccChambers<double> chambers{0.03, 0, 0, 31e-6};
  const auto load = PccPressureLoad(chambers, Vector{4e4, 0, 0});
  EXPECT_DOUBLE_EQ(load.f_z, 1.24);
  EXPECT_DOUBLE_EQ(load.m_y, 0.03 * 1.24);
  EXPECT_EQ(load.m_x, 0);
  EXPECT_GT(PccTipForces(kSegment, Vector{}, load)[0], 0);
}

TEST(PccPressure, LoadIsTheMomentOfTheChamberForces) {
  const PccChambers<double> chambers{0.03, -0.4e-3, -1.5e-3, 31e-6};
  const Vector pressure{2e4, 3e4, 5e4};
  double x = 0, y = 0;
  for (int i = 0; i < 3; ++i) {
    const double angle = M_PI * (1 + 2.0 * i / 3);
    x += (0.03 * std::cos(angle) + 0.4e-3) * 31e-6 * pressure[i];
    y += (0.03 * std::sin(angle) + 1.5e-3) * 31e-6 * pressure[i];
  }
  const auto load = PccPressureLoad(chambers, pressure);
  EXPECT_NEAR(load.m_x, y, 1e-16);  // rounding of terms of 0.05 N m
  EXPECT_NEAR(load.m_y, -x, 1e-16);
}

// ΔJ of (26): the tip's geometric Jacobian less the base's, which has no columns in δ.
TEST(PccPressure, TipForcesDoTheWorkOfTheTipLoad) {
  const PccLoad<double> load{3.1, -0.07, 0.05};
  for (const Vector& shape : Shapes()) {
    const auto tip = PccTipPose(kSegment, shape);
    const auto end = PccCentreLine(kSegment, 1.0, shape, Vector{});
    const auto force = PccTipForces(kSegment, shape, load);
    for (int j = 0; j < 3; ++j) {
      double work = load.m_x * tip.turning[0][j] + load.m_y * tip.turning[1][j];
      for (int i = 0; i < 3; ++i) work += tip.rotation[i][2] * load.f_z * end.jacobian[i][j];
      EXPECT_NEAR(force[j], work, 5 * kRounding);
    }
  }
}

TEST(PccPressure, VolumeForcesAreTheGradientOfTheChamberVolumes) {
  const PccChambers<double> chambers{0.03, -0.4e-3, -1.5e-3, 31e-6};
  const Vector pressure{2e4, 3e4, 5e4}, shape{0.03, -0.05, 0.01};
  // Length of the line at r_i, by summing chords of the shifted centre line.
  const auto volume_work = [&](const Vector& delta) {
    const int n = 10000;
    double work = 0;
    for (int i = 0; i < 3; ++i) {
      const auto r = PccChamber(chambers, i);
      Vector last{};
      double length = 0;
      for (int k = 0; k <= n; ++k) {
        const double xi = double(k) / n;
        const Vector part{xi * delta[0], xi * delta[1], 0};
        const auto centre = PccCentreLine(kSegment, xi, delta, Vector{}).position;
        const auto section = PccTipPose(kSegment, part).rotation;
        Vector place;
        for (int j = 0; j < 3; ++j) {
          place[j] = centre[j] + section[j][0] * r[0] + section[j][1] * r[1];
        }
        if (k > 0) {
          length += std::hypot(place[0] - last[0], place[1] - last[1], place[2] - last[2]);
        }
        last = place;
      }
      work += pressure[i] * chambers.A * length;
    }
    return work;
  };
  const auto force = PccVolumeForces(kSegment, PccPressureLoad(chambers, pressure));
  for (int j = 0; j < 3; ++j) {
    const double h = 1e-4;
    Vector ahead = shape, behind = shape;
    ahead[j] += h;
    behind[j] -= h;
    // Chords are short by L (θ/n)²/24; its derivative by δ is 3e-9, times 3 N.
    EXPECT_NEAR(force[j], (volume_work(ahead) - volume_work(behind)) / (2 * h), 1e-7);
  }
}

}  // namespace
}  // namespace continuum
