#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// The rod with tendons that rub in their channels, by other means than RodBalance: the curvature
/// on a fixed grid is corrected until it balances the moment that the shape has in space. Tendons
/// are polygons through the turned holes; what they lose follows from the angles of the polygon.
class Polygon {
 public:
  /// share: of the largest friction of contacts along the rod, contacts x tendons; empty: the
  /// directions of the loads.
  Polygon(const Robot& robot, const Loads& loads, int per_arc, Eigen::MatrixXd share = {})
      : robot_(robot),
        loads_(loads),
        share_(std::move(share)),
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
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    node_.assign(1, p);
    frame_.assign(1, R);
    middle_.clear();
    turned_.clear();
    for (int i = 0; i < count_; ++i) {
      const Eigen::Vector3d half = h_ / 2 * u_.col(i);
      const Eigen::Matrix3d step =
          half.norm() > 0 ? Eigen::AngleAxisd(half.norm(), half.normalized()).toRotationMatrix()
                          : Eigen::Matrix3d::Identity();
      turned_.push_back(R * step);
      middle_.push_back(p + h_ / 2 * turned_.back().col(2));
      p += h_ * turned_.back().col(2);
      R = turned_.back() * step;
      node_.push_back(p);
      frame_.push_back(R);
    }
  }

  // Pull of tendon k on the part beyond the middle of every piece.
  std::vector<Eigen::Vector3d> Pulls(int k) const {
    const Eigen::Vector3d hole(robot_.Hole(k).x(), robot_.Hole(k).y(), 0);
    std::vector<Eigen::Vector3d> chord;
    for (int i = 0; i < count_; ++i) {
      chord.push_back(
          (node_[i + 1] + frame_[i + 1] * hole - node_[i] - frame_[i] * hole).normalized());
    }
    const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return std::asin(a.cross(b).norm());
    };
    std::vector<Eigen::Vector3d> pulls;
    double turned = Share(0, k) * angle(chord[0], chord[1]) / 2;
    for (int i = 0; i < count_; ++i) {
      if (i > 0) turned += Share(i, k) * angle(chord[i - 1], chord[i]);
      const double left = std::exp(-loads_.mu * turned);
      pulls.push_back(loads_.tension[k] * left * chord[i]);
    }
    return pulls;
  }

  // Moment of the dead forces beyond the middle of every piece, about that middle, base frame.
  std::vector<Eigen::Vector3d> DeadMoments() const {
    std::vector<Eigen::Vector3d> moments(count_);
    const Eigen::Vector3d piece = robot_.density * robot_.area() * h_ * loads_.gravity;
    Eigen::Vector3d force = loads_.tip_force, first = node_.back().cross(loads_.tip_force);
    for (int i = count_ - 1; i >= 0; --i) {
      if ((i + 1) % per_arc_ == 0) {
        const Eigen::Vector3d disk = robot_.disk_mass * loads_.gravity;
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
    std::vector<Eigen::Vector3d> moments = DeadMoments();
    for (int k = 0; k < robot_.tendons; ++k) {
      const Eigen::Vector3d hole(robot_.Hole(k).x(), robot_.Hole(k).y(), 0);
      const std::vector<Eigen::Vector3d> pulls = Pulls(k);
      for (int i = 0; i < count_; ++i) moments[i] -= (turned_[i] * hole).cross(pulls[i]);
    }
    const Eigen::Vector3d compliance(1 / robot_.EI(), 1 / robot_.EI(), 1 / robot_.GJ());
    double largest = 0;
    for (int i = 0; i < count_; ++i) {
      const Eigen::Vector3d wanted = compliance.cwiseProduct(turned_[i].transpose() * moments[i]);
      largest = std::max(largest, (wanted - u_.col(i)).norm());
      u_.col(i) += (wanted - u_.col(i)) / 2;
    }
    return largest;
  }

  // Of the node between pieces i - 1 and i, where the tendon turns as much in one as in the other.
  double Share(int i, int k) const {
    if (share_.size() == 0) return loads_.direction[static_cast<std::size_t>(k)];
    const Eigen::Index before = std::max(i - 1, 0) * share_.rows() / count_;
    return 0.5 * (share_(before, k) + share_(i * share_.rows() / count_, k));
  }

  const Robot& robot_;
  const Loads& loads_;
  Eigen::MatrixXd share_;
  int count_, per_arc_;
  double h_;
  Eigen::Matrix3Xd u_;                          // rotation per length, in the middle of every piece
  std::vector<Eigen::Vector3d> node_, middle_;  // base frame
  std::vector<Eigen::Matrix3d> frame_, turned_;  // at the nodes and in the middles
};

}  // namespace continuum::tdcr
