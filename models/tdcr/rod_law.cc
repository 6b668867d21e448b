#include "models/tdcr/rod_law.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "models/tdcr/section_moment.h"
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
      per_arc_(pieces / rod_.arcs()),
      share_(std::move(share)),
      tension_(pulling(), pieces) {}

std::vector<double> RodLaw::lengths() const {
  std::vector<double> lengths;
  for (int i = 0; i < pieces_; ++i) lengths.push_back(Length(i));
  return lengths;
}

Vector3d RodLaw::Force(double s) const { return rod_.Force(rod_.ArcAt(s), s); }

Vector3d RodLaw::DeadMoment(int node) const {
  return node % per_arc_ == 0 ? rod_.MomentAfter(node / per_arc_ - 1) : Vector3d::Zero();
}

// In the middle of a piece.
ChannelPoint RodLaw::Hole(int piece, int tendon) const {
  const int arc = ArcOf(piece);
  const double s = rod_.Arc(arc).start() + (piece - arc * per_arc_ + 0.5) * Length(piece);
  return rod_.ChannelOf(static_cast<std::size_t>(tendon), arc).At(s);
}

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
      if (Runs(i, k)) length += Along(Hole(i, k), Vector3d(zeta.col(i))).norm() * Length(i);
      beyond(i, k) = length;
    }
  }
  return beyond;
}

bool RodLaw::Prepare(const Eigen::Matrix3Xd& zeta) {
  for (int k = 0; k < pulling(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    for (int i = 0; i < pieces_; ++i) tension_(k, i) = Runs(i, k) ? rod_.pull[at] : 0;
    if (rod_.friction && rod_.direction[at] != 0) LoseTension(k, zeta);
  }
  return true;
}

// Half of the first piece's turn, then the turns from middle to middle.
void RodLaw::LoseTension(int k, const Eigen::Matrix3Xd& zeta) {
  const Vector3d first = zeta.col(0);
  const ChannelPoint hole = Hole(0, k);
  const double length = Along(hole, first).norm();
  Vector3d before = Along(hole, first) / length;
  const Vector3d drift = AlongDrift(hole, first);
  const Vector3d turn = first.cross(before) + (drift - before * before.dot(drift)) / length;
  double angle = 0.5 * Length(0) * Share(0, k) * turn.norm();
  for (int i = 0; i < pieces_ && Runs(i, k); ++i) {
    const Vector3d t = Along(Hole(i, k), Vector3d(zeta.col(i))).normalized();
    if (i > 0) {
      const double h = 0.5 * (Length(i) + Length(i - 1));
      const Vector3d u = 0.5 * (zeta.col(i) + zeta.col(i - 1));
      angle += Share(i, k) * (h * u.cross(Vector3d(0.5 * (t + before))) + t - before).norm();
    }
    before = t;
    tension_(k, i) *= std::exp(-rod_.mu * angle);
  }
}

Vector3d RodLaw::LeverOf(int piece, int tendon, const Vector3d& u) const {
  if (!Runs(piece, tendon)) return Vector3d::Zero();
  const ChannelPoint hole = Hole(piece, tendon);
  return Lever(hole.a, Vector3d(Along(hole, u).normalized()));
}

bool RodLaw::At(int piece, const Vector3d& u, const Vector3d& /*n*/,
                statics::RodSection& section) const {
  const RodArc& arc = rod_.Arc(ArcOf(piece));
  SectionMoment<double> sum(u, arc.natural, arc.stiffness);
  double along = 0;
  for (int k = 0; k < pulling(); ++k) {
    if (!Runs(piece, k)) continue;
    const ChannelPoint hole = Hole(piece, k);
    const bool parallel = rod_.ChannelOf(static_cast<std::size_t>(k), ArcOf(piece)).parallel;
    const double pull = tension_(k, piece);
    const bool inside =
        parallel ? sum.AddParallel(hole.a, pull, u, along) : sum.AddSlanted(hole, pull, u, along);
    if (!inside) return false;
  }
  section.moment = sum.moment;
  section.stretch = axis();
  section.moment_by_zeta = sum.Hessian();
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
  const std::vector<double> lengths = law.lengths();
  // What tensions do to the nodes, and how they follow the strains, which follow the turns. A
  // tension of a piece acts on its two nodes alone.
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
      const Vector3d lever = R * law.LeverOf(i, k, zeta.col(i));
      force.block<3, 1>(3 * i, law.pulling() * i + k) = lever;
      if (i > 0) force.block<3, 1>(3 * (i - 1), law.pulling() * i + k) = -lever;
    }
    const Eigen::MatrixXd turned = by_strain.middleCols<3>(3 * i) * R.transpose() / lengths[at];
    follow.middleCols<3>(3 * i) = turned;
    if (i > 0) follow.middleCols<3>(3 * (i - 1)) -= turned;
  }
  Eigen::MatrixXd k = chain.Dense() + HeldTendons(law, force);
  for (int i = 0; i < pieces; ++i) {
    const int first = 3 * std::max(0, i - 1), rows = 3 * i + 3 - first, pulling = law.pulling();
    k.middleRows(first, rows) +=
        force.block(first, pulling * i, rows, pulling) * follow.middleRows(pulling * i, pulling);
  }
  const Eigen::MatrixXd symmetric = 0.5 * (k + k.transpose());
  if (Eigen::LLT<Eigen::MatrixXd>(symmetric).info() == Eigen::Success) return 0;
  return NegativeEigenvalues(symmetric);
}

}  // namespace continuum::tdcr
