#include "models/tdcr/rod_law.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/numerics/decompositions.h"

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

constexpr double kZero = -1e-9;  // of the largest eigenvalue

int NegativeEigenvalues(const Eigen::MatrixXd& symmetric) {
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
          .eigenvalues();
  const double largest = values.cwiseAbs().maxCoeff();
  return static_cast<int>((values.array() < kZero * largest).count());
}

}  // namespace

RodLaw::RodLaw(UnitRod rod, int pieces, Eigen::MatrixXd share)
    : rod_(std::move(rod)),
      pieces_(pieces),
      share_(std::move(share)),
      tension_(pulling(), pieces) {}

Vector3d RodLaw::Force(double s) const { return rod_.Force(static_cast<int>(s * rod_.disks), s); }

double RodLaw::Share(int i, int tendon) const {
  if (share_.size() == 0) return rod_.direction[static_cast<std::size_t>(tendon)];
  const Eigen::Index row = i * share_.rows() / pieces_;
  return share_(row, tendon);
}

double RodLaw::Holds(int i, int tendon) const {
  constexpr double kResting = 0.98, kHeld = 1e6;
  const bool rests = share_.size() > 0 && std::abs(Share(i, tendon)) < kResting &&
                     rod_.direction[static_cast<std::size_t>(tendon)] == kAsItSlides;
  if (rests) return kHeld;
  return i == 0 && winches_.size() > 0 ? winches_[tendon] : 0;
}

Eigen::MatrixXd RodLaw::Beyond(const Eigen::Matrix3Xd& zeta) const {
  Eigen::MatrixXd beyond(pieces_, pulling());
  for (int k = 0; k < pulling(); ++k) {
    double length = 0;
    for (int i = pieces_ - 1; i >= 0; --i) {
      length += Along(rod_.holes[static_cast<std::size_t>(k)], zeta.col(i)).norm() / pieces_;
      beyond(i, k) = length;
    }
  }
  return beyond;
}

bool RodLaw::Prepare(const Eigen::Matrix3Xd& zeta) {
  const double h = 1.0 / pieces_;
  for (int k = 0; k < pulling(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    tension_.row(k).setConstant(rod_.pull[at]);
    if (!rod_.friction || rod_.direction[at] == 0) continue;
    Vector3d before = Along(rod_.holes[at], zeta.col(0)).normalized();
    double angle = 0.5 * h * Share(0, k) * zeta.col(0).cross(before).norm();
    for (int i = 0; i < pieces_; ++i) {
      const Vector3d t = Along(rod_.holes[at], zeta.col(i)).normalized();
      if (i > 0) {
        const Vector3d u = 0.5 * (zeta.col(i) + zeta.col(i - 1));
        angle += Share(i, k) * (h * u.cross(Vector3d(0.5 * (t + before))) + t - before).norm();
      }
      before = t;
      tension_(k, i) *= std::exp(-rod_.mu * angle);
    }
  }
  return true;
}

Vector3d RodLaw::Lever(int tendon, const Vector3d& u) const {
  const Eigen::Vector2d& hole = rod_.holes[static_cast<std::size_t>(tendon)];
  const Vector3d w = Along(hole, u);
  return Vector3d(w.z() * hole.y(), -w.z() * hole.x(), u.z() * hole.squaredNorm()) / w.norm();
}

bool RodLaw::At(int piece, const Vector3d& u, const Vector3d& /*n*/,
                statics::RodSection& section) const {
  section.moment = elastic() * (u - rod_.natural);
  section.stretch = axis();
  section.moment_by_zeta = elastic();
  for (int k = 0; k < pulling(); ++k) {
    const Eigen::Vector2d& hole = rod_.holes[static_cast<std::size_t>(k)];
    const Vector3d w = Along(hole, u);
    if (!(w.z() > 0)) return false;
    const double r2 = hole.squaredNorm(), square = w.squaredNorm();
    const double share = tension_(k, piece) / std::sqrt(square);
    const Vector3d by_z(hole.y(), -hole.x(), 0);  // dw_z/du
    section.moment += share * (w.z() * by_z + Vector3d(0, 0, u.z() * r2));
    // Hessian of |w| by (w_z, u_z): (u_z^2 r2, -w_z u_z r2; ., w_z^2 r2)/|w|^3.
    const double cube = share / square * r2;
    const Vector3d across = u.z() * by_z - Vector3d(0, 0, w.z());
    section.moment_by_zeta += cube * across * across.transpose();
  }
  return true;
}

namespace {

// What contacts that rest add to the stiffness: `force` has the slopes of the tendons' lengths, so
// that its sums over the pieces beyond a contact are what the contact holds.
Eigen::MatrixXd HeldTendons(const RodLaw& law, const Eigen::MatrixXd& force) {
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(force.rows(), force.rows());
  const auto pieces = static_cast<int>(force.cols()) / std::max(1, law.pulling());
  for (int k = 0; k < law.pulling(); ++k) {
    Eigen::VectorXd beyond = Eigen::VectorXd::Zero(force.rows());
    for (int i = pieces - 1; i >= 0; --i) {
      beyond += force.col(law.pulling() * i + k);
      const double stiffness = law.Holds(i, k);
      if (stiffness > 0) held += stiffness * beyond * beyond.transpose();
    }
  }
  return held;
}

}  // namespace

int UnstableDirections(const statics::RodChain<RodLaw>& chain, const RodLaw& law,
                       const statics::RodChain<RodLaw>::Shape& shape) {
  if (!law.friction() && !law.holds()) return chain.UnstableDirections();
  const int pieces = chain.pieces();
  const double h = 1.0 / pieces;
  // What tensions do to the nodes, and how they follow the strains, which follow the turns.
  Eigen::MatrixXd force = Eigen::MatrixXd::Zero(3 * pieces, law.pulling() * pieces);
  Eigen::MatrixXd follow(law.pulling() * pieces, 3 * pieces);
  Eigen::Matrix3Xd zeta = chain.zeta();
  RodLaw changed = law;
  const double small = 1e-6;
  Eigen::MatrixXd by_strain(law.pulling() * pieces, 3 * pieces);
  for (int i = 0; i < pieces; ++i) {
    for (int a = 0; a < 3; ++a) {
      const double middle = zeta(a, i);
      zeta(a, i) = middle + small;
      changed.Prepare(zeta);
      by_strain.col(3 * i + a) = (changed.tension() - law.tension()).reshaped() / small;
      zeta(a, i) = middle;
    }
  }
  for (int i = 0; i < pieces; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Eigen::Matrix3d R = shape[at].slerp(0.5, shape[at + 1]).normalized().toRotationMatrix();
    for (int k = 0; k < law.pulling(); ++k) {
      const Vector3d lever = R * law.Lever(k, zeta.col(i));
      force.block<3, 1>(3 * i, law.pulling() * i + k) = lever;
      if (i > 0) force.block<3, 1>(3 * (i - 1), law.pulling() * i + k) = -lever;
    }
    const Eigen::MatrixXd turned = by_strain.middleCols<3>(3 * i) * R.transpose() / h;
    follow.middleCols<3>(3 * i) = turned;
    if (i > 0) follow.middleCols<3>(3 * (i - 1)) -= turned;
  }
  const Eigen::MatrixXd k = chain.Dense() + force * follow + HeldTendons(law, force);
  const Eigen::MatrixXd symmetric = 0.5 * (k + k.transpose());
  if (Eigen::LLT<Eigen::MatrixXd>(symmetric).info() == Eigen::Success) return 0;
  return NegativeEigenvalues(symmetric);
}

}  // namespace continuum::tdcr
