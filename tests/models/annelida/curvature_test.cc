#include "models/annelida/constant_curvature.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace continuum {
namespace {

using Eigen::Vector3d;
constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-14;

TEST(ConstantCurvature, AQuarterCircleEndsAtItsRadiusAndPointsSideways) {
  const double s = 0.26, r = s / (kPi / 2);
  for (const double azimuth : {0.0, 0.7, kPi / 2, -2.1}) {
    const Eigen::Isometry3d pose = ArcPose(Arc::Of(azimuth, kPi / 2, s));
    const Vector3d toward(std::cos(azimuth), std::sin(azimuth), 0);
    EXPECT_LT((pose.translation() - (r * toward + Vector3d(0, 0, r))).norm(), kRounding);
    EXPECT_LT((pose.linear() * Vector3d::UnitZ() - toward).norm(), kRounding);
  }
}

TEST(ConstantCurvature, TheOrientationIsTheRotationByTheTwistVector) {
  for (const auto& [u, v] : {std::pair{0.3, -0.8}, {1e-5, 2e-5}, {-2.0, 1.5}, {0.0, 0.0}}) {
    const Vector3d w(u, v, 0);
    const Eigen::Matrix3d R =
        Eigen::AngleAxisd(w.norm(), w.norm() > 0 ? Vector3d(w.normalized()) : Vector3d::UnitX())
            .toRotationMatrix();
    EXPECT_LT((ArcPose({u, v, 0.1}).linear() - R).norm(), kRounding) << u << ", " << v;
  }
}

TEST(ConstantCurvature, IsSmoothThroughTheStraightShape) {
  const double s = 0.2;
  EXPECT_EQ(ArcPose({0, 0, s}).translation(), Vector3d(0, 0, s));
  for (const double e : {1e-9, 1e-6, 0.9e-3, 1.1e-3}) {
    const Vector3d p = ArcPose({0, e, s}).translation();
    EXPECT_NEAR(p.x(), s * (e / 2 - e * e * e / 24), s * kRounding) << e;
    EXPECT_NEAR(p.z(), s * (1 - e * e / 6), s * (e * e * e * e / 120 + kRounding)) << e;
  }
}

TEST(ConstantCurvature, ATipGivesBackItsArc) {
  for (const double angle : {0.0, 1e-7, 0.4, kPi / 2, 3.0, 5.0}) {
    for (const double azimuth : {0.0, 1.2, -2.5}) {
      const Arc arc = Arc::Of(azimuth, angle, 0.26);
      const Arc back = ArcTo(ArcPose(arc).translation());
      EXPECT_NEAR(back.u, arc.u, 1e-13) << angle;
      EXPECT_NEAR(back.v, arc.v, 1e-13) << angle;
      EXPECT_NEAR(back.s, arc.s, 1e-13) << angle;
    }
  }
}

TEST(ConstantCurvature, CableLengthsAreDistancesBetweenTheHoles) {
  const Module module{0.032, 0.0135};
  const double azimuth = 0.6, angle = 0.5;
  const Eigen::AngleAxisd turn(angle, Vector3d(-std::sin(azimuth), std::cos(azimuth), 0));
  const CableLengths lengths = module.Lengths(azimuth, angle);
  for (int j = 0; j < 4; ++j) {
    const Vector3d hole(module.a * std::cos(j * kPi / 2), module.a * std::sin(j * kPi / 2), 0);
    const Vector3d to_plane(0, 0, module.b);
    EXPECT_NEAR(lengths[j], (turn * (hole + to_plane) - (hole - to_plane)).norm(), kRounding);
  }
}

TEST(ConstantCurvature, CableLengthsOfAnArcAreChordsBetweenItsEnds) {
  const double angle = 0.5, s = 0.03, azimuth = -1.1;
  const Eigen::Isometry3d pose = ArcPose(Arc::Of(azimuth, angle, s));
  // The arc's end tangents meet at b = (s/θ) tan(θ/2) from either end.
  const CableLengths lengths =
      Module{0.032, s / angle * std::tan(angle / 2)}.Lengths(azimuth, angle);
  for (int j = 0; j < 4; ++j) {
    const Vector3d hole(0.032 * std::cos(j * kPi / 2), 0.032 * std::sin(j * kPi / 2), 0);
    EXPECT_NEAR(lengths[j], (pose * hole - hole).norm(), kRounding);
  }
}

TEST(ConstantCurvature, CableLengthsGiveBackTheBend) {
  for (const int n : {1, 5}) {
    const Module section{0.032, 0.0135, n};
    for (const double angle : {1e-6, 0.3, kPi / 2}) {
      // 0 is where the printed formula divides by zero.
      for (const double azimuth : {0.0, kPi / 2, 2.2, -0.4}) {
        const auto bend = section.FromLengths(section.Lengths(azimuth, angle));
        EXPECT_NEAR(bend.angle, angle, 1e-13);
        EXPECT_NEAR(std::remainder(bend.azimuth - azimuth, 2 * kPi), 0, 1e-9);
        EXPECT_NEAR(bend.curvature, std::tan(angle / (2 * n)) / section.b, 1e-11);
      }
    }
  }
  EXPECT_EQ((Module{0.032, 0.0135}.FromLengths({0.027, 0.027, 0.027, 0.027}).angle), 0);
}

}  // namespace
}  // namespace continuum
