#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "models/tdcr/model.h"

namespace continuum::tdcr {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The rod with tendons that rub in their channels, by other means than RodBalance: the curvature
/// on a fixed grid is corrected until it balances the moment that the shape has in space. Tendons
/// are polygons through the turned holes; what they lose follows from the angles of the polygon.
class Polygon {
 public:
  Polygon(const Robot& robot, const Loads& loads, int per_arc)
      : robot_(robot),
        loads_(loads),
        count_(robot.disks * per_arc),
        per_arc_(per_arc),
        h_(robot.length / count_),
        u_(Eigen::Matrix3Xd::Zero(3, count_)) {}

  Eigen::Matrix3Xd Disks() {
    double change = 1;
    for (int i = 0; i < 2000 && change > 1e-12; ++i) {
      Walk();
      change = Correct() * robot_.length;
    }
    EXPECT_LE(change, 1e-12);
    Eigen::Matrix3Xd disks(3, robot_.disks);
    for (int i = 0; i < robot_.disks; ++i) disks.col(i) = node_[(i + 1) * per_arc_];
    return disks;
  }

 private:
  void Walk() {
    Matrix3d R = Matrix3d::Identity();
    Vector3d p = Vector3d::Zero();
    node_.assign(1, p);
    frame_.assign(1, R);
    middle_.clear();
    turned_.clear();
    for (int i = 0; i < count_; ++i) {
      const Vector3d half = h_ / 2 * u_.col(i);
      const Matrix3d step =
          half.norm() > 0 ? Eigen::AngleAxisd(half.norm(), half.normalized()).toRotationMatrix()
                          : Matrix3d::Identity();
      turned_.push_back(R * step);
      middle_.push_back(p + h_ / 2 * turned_.back().col(2));
      p += h_ * turned_.back().col(2);
      R = turned_.back() * step;
      node_.push_back(p);
      frame_.push_back(R);
    }
  }

  // Pull of tendon k on the part beyond the middle of every piece.
  std::vector<Vector3d> Pulls(int k) const {
    const Vector3d hole(robot_.Hole(k).x(), robot_.Hole(k).y(), 0);
    std::vector<Vector3d> chord;
    for (int i = 0; i < count_; ++i) {
      chord.push_back(
          (node_[i + 1] + frame_[i + 1] * hole - node_[i] - frame_[i] * hole).normalized());
    }
    const auto angle = [](const Vector3d& a, const Vector3d& b) {
      return std::asin(a.cross(b).norm());
    };
    std::vector<Vector3d> pulls;
    double turned = angle(chord[0], chord[1]) / 2;
    for (int i = 0; i < count_; ++i) {
      if (i > 0) turned += angle(chord[i - 1], chord[i]);
      const double left = std::exp(-loads_.direction[k] * loads_.mu * turned);
      pulls.push_back(loads_.tension[k] * left * chord[i]);
    }
    return pulls;
  }

  // Moment of the dead forces beyond the middle of every piece, about that middle, base frame.
  std::vector<Vector3d> DeadMoments() const {
    std::vector<Vector3d> moments(count_);
    const Vector3d piece = robot_.density * robot_.area() * h_ * loads_.gravity;
    Vector3d force = loads_.tip_force, first = node_.back().cross(loads_.tip_force);
    for (int i = count_ - 1; i >= 0; --i) {
      if ((i + 1) % per_arc_ == 0) {
        const Vector3d disk = robot_.disk_mass * loads_.gravity;
        force += disk;
        first += node_[i + 1].cross(disk);
      }
      force += piece / 2;
      first += middle_[i].cross(piece / 2);
      moments[i] = first - middle_[i].cross(force);
      force += piece / 2;
      first += middle_[i].cross(piece / 2);
    }
    return moments;
  }

  // Half of the way to the curvature that the moments ask for; the largest change.
  double Correct() {
    std::vector<Vector3d> moments = DeadMoments();
    for (int k = 0; k < robot_.tendons; ++k) {
      const Vector3d hole(robot_.Hole(k).x(), robot_.Hole(k).y(), 0);
      const std::vector<Vector3d> pulls = Pulls(k);
      for (int i = 0; i < count_; ++i) moments[i] -= (turned_[i] * hole).cross(pulls[i]);
    }
    const Vector3d compliance(1 / robot_.EI(), 1 / robot_.EI(), 1 / robot_.GJ());
    double largest = 0;
    for (int i = 0; i < count_; ++i) {
      const Vector3d wanted = compliance.cwiseProduct(turned_[i].transpose() * moments[i]);
      largest = std::max(largest, (wanted - u_.col(i)).norm());
      u_.col(i) += (wanted - u_.col(i)) / 2;
    }
    return largest;
  }

  const Robot& robot_;
  const Loads& loads_;
  int count_, per_arc_;
  double h_;
  Eigen::Matrix3Xd u_;                    // rotation per length, in the middle of every piece
  std::vector<Vector3d> node_, middle_;   // base frame
  std::vector<Matrix3d> frame_, turned_;  // at the nodes and in the middles
};

Loads Random(const Robot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> share(-1, 1);
  Loads loads = NoLoads(robot);
  for (double& t : loads.tension) t = 2.5 * (1 + share(random));
  loads.tip_force = 0.15 * Vector3d(share(random), share(random), share(random));
  loads.gravity = 9.81 * Vector3d(share(random), share(random), share(random)).normalized();
  loads.mu = 0.25 * (1 + share(random));
  loads.direction = {1, -1, 0};
  return loads;
}

TEST(TdcrFriction, TheRodIsThatOfAnIndependentPolygon) {
  Robot robot = ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml"));
  std::mt19937 random(17);
  for (int i = 0; i < 5; ++i) {
    Loads loads = Random(robot, random);
    if (i % 2 == 0) loads.direction = {1, 1, 1};
    const Solution s = SolveCase(robot, loads, Method::kCrtFriction);
    ASSERT_TRUE(s.outcome.ok());
    // The polygon's error falls with the square of its pieces: two of them give the limit.
    const Eigen::Matrix3Xd coarse = Polygon(robot, loads, 40).Disks();
    const Eigen::Matrix3Xd fine = Polygon(robot, loads, 80).Disks();
    const double last = (coarse - s.disks).norm(), now = (fine - s.disks).norm();
    EXPECT_NEAR(last / now, 4, 0.1);
    const Eigen::Matrix3Xd limit = (4 * fine - coarse) / 3;
    EXPECT_LT((limit - s.disks).colwise().norm().maxCoeff(), 1e-7 * robot.length);
    // What it is about: friction moves the tip by far more than that.
    Loads without = loads;
    without.mu = 0;
    const Solution smooth = SolveCase(robot, without, Method::kCrtFriction);
    EXPECT_GT((smooth.disks - s.disks).norm(), 1e-4 * robot.length);
  }
}

}  // namespace
}  // namespace continuum::tdcr
