#include "models/tdcr/disks.h"

#include <utility>

#include "models/statics/skew.h"
#include "models/statics/slide.h"

namespace continuum::tdcr {
namespace {

using statics::Skew;

// The constitutive moment over EI/L for x = L u: (-kappa_y, kappa_x, tau/(1 + nu)).
void SubtractStiffness(const double* x, double twist, double* f) {
  f[0] -= -x[1];
  f[1] -= x[0];
  f[2] -= twist * x[2];
}

template <class Block>
void SubtractStiffness(double twist, Block&& jacobian) {
  jacobian(0, 1) += 1;
  jacobian(1, 0) -= 1;
  jacobian(2, 2) -= twist;
}

}  // namespace

Chain Forward(const Eigen::VectorXd& lengths, const Eigen::Matrix3Xd& u) {
  Chain chain{{Eigen::Matrix3d::Identity()}, {Eigen::Vector3d::Zero()}};
  for (Eigen::Index i = 0; i < u.cols(); ++i) {
    const Arc arc(lengths[i], u.col(i));
    chain.O.push_back(chain.O.back() + chain.R.back() * arc.p());
    chain.R.push_back(chain.R.back() * arc.Twisted(arc.Q()));
  }
  return chain;
}

Eigen::Matrix3Xd Positions(const Eigen::VectorXd& lengths, const Eigen::Matrix3Xd& u) {
  const Chain chain = Forward(lengths, u);
  Eigen::Matrix3Xd disks(3, u.cols());
  for (Eigen::Index i = 0; i < u.cols(); ++i)
    disks.col(i) = chain.O[static_cast<std::size_t>(i) + 1];
  return disks;
}

template <int C>
DiskBalance<C>::DiskBalance(const Robot& robot, const Loads& loads, const Loads* from)
    : robot_(robot),
      loads_(loads),
      from_(from ? *from : loads.Scaled(0)),
      slid_from_(loads.from),
      mass_(robot.disk_mass + robot.density * robot.area() * robot.arc()) {
  const auto n = static_cast<std::size_t>(robot.disks);
  const int columns = C == Eigen::Dynamic ? 3 * robot.disks : C;
  for (int k = 0; k < robot.tendons; ++k) holes_.push_back(robot.Hole(k));
  SetLoad(1);
  arcs_.reserve(n);
  m_.resize(n);
  G_.resize(n);
  R_.assign(n + 1, Eigen::Matrix3d::Identity());
  O_.assign(n + 1, Eigen::Vector3d::Zero());
  dm_.assign(n, Columns::Zero(3, columns));
  dO_.assign(n + 1, Columns::Zero(3, columns));
  dphi_.assign(n + 1, Columns::Zero(3, columns));
  dphi_end_.assign(n, Columns::Zero(3, columns));
  chords_.resize(n);
  share_.assign(n, 0);
  dshare_.assign(n, Row::Zero(1, columns));
}

template <int C>
void DiskBalance<C>::SetLoad(double load) {
  load_ = load;
  if (!pulls_grow_) return;
  pull_.resize(holes_.size());
  for (std::size_t k = 0; k < pull_.size(); ++k) {
    pull_[k] = Now(loads_.tension[k], from_.tension[k]);
  }
}

template <int C>
void DiskBalance<C>::SetTension(const Eigen::VectorXd& tension) {
  pulls_grow_ = false;
  pull_.assign(tension.begin(), tension.end());
}

template <int C>
Eigen::Vector3d DiskBalance<C>::Curvature(const double* x, int i) const {
  using Map = Eigen::Map<const Eigen::Vector3d>;
  if constexpr (C == Eigen::Dynamic) {
    return Map(x + 3 * (i - 1)) / robot_.length;
  } else {
    const double w = Fraction(i, robot_.disks);
    return ((1 - w) * Map(x) + w * Map(x + 3)) / robot_.length;
  }
}

template <int C>
Eigen::Matrix3Xd DiskBalance<C>::Curvatures(const Vector& x) const {
  Eigen::Matrix3Xd u(3, robot_.disks);
  for (int i = 1; i <= robot_.disks; ++i) u.col(i - 1) = Curvature(x.data(), i);
  return u;
}

// Adds a derivative by (v_x, v_y, psi) of arc i, which are x/n of that arc.
template <int C>
template <class Target, class Local>
void DiskBalance<C>::Scatter(int i, const Local& local, Target& target) const {
  const double share = 1.0 / robot_.disks;
  if constexpr (C == Eigen::Dynamic) {
    target.template middleCols<3>(3 * (i - 1)) += share * local;
  } else {
    const double w = Fraction(i, robot_.disks);
    target.template leftCols<3>() += (share * (1 - w)) * local;
    target.template rightCols<3>() += (share * w) * local;
  }
}

// The share of disk i follows from what has slid through it: the change of all chords beyond.
template <int C>
template <bool kDerivatives>
void DiskBalance<C>::FindShares(std::size_t tendon) const {
  const auto k = static_cast<Eigen::Index>(tendon);
  const Contacts& from = slid_from_;
  double longer = 0;
  Row d_longer = Row::Zero(1, unknowns());
  for (int i = robot_.disks - 1; i >= 1; --i) {
    const auto at = static_cast<std::size_t>(i);
    longer += chords_[at].length - (from.length.size() ? from.length(i, k) : robot_.arc());
    const double before = from.share.size() ? from.share(i - 1, k) : 0;
    const ceres::Jet<double, 1> pulled(-longer / kGivesWay, 0);
    const auto share = statics::SlideFrom(before, pulled);
    share_[at - 1] = share.a;
    if (!kDerivatives) continue;
    Scatter(i + 1, chords_[at].d_length, d_longer);
    dshare_[at - 1] = (-share.v[0] / kGivesWay) * d_longer;
  }
}

template <int C>
Contacts DiskBalance<C>::ContactsAt(const Vector& x) const {
  const auto tendons = static_cast<Eigen::Index>(holes_.size());
  Contacts contacts{Eigen::MatrixXd(robot_.disks, tendons),
                    Eigen::MatrixXd::Zero(robot_.disks, tendons)};
  arcs_.clear();
  for (int i = 1; i <= robot_.disks; ++i) arcs_.emplace_back(robot_.arc(), Curvature(x.data(), i));
  for (std::size_t k = 0; k < holes_.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    for (int i = 0; i < robot_.disks; ++i) {
      const auto at = static_cast<std::size_t>(i);
      TendonChord(arcs_[at], holes_[k], false, chords_[at]);
      contacts.length(i, column) = chords_[at].length;
    }
    const int direction = loads_.direction[k];
    if (direction == kAsItSlides) FindShares<false>(k);
    for (int i = 0; i < robot_.disks - 1; ++i) {
      contacts.share(i, column) =
          direction == kAsItSlides ? share_[static_cast<std::size_t>(i)] : direction;
    }
  }
  return contacts;
}

template <int C>
Eigen::VectorXd DiskBalance<C>::SlidAt(const Vector& x) const {
  if (!loads_.AsItSlides() || loads_.mu == 0) return {};
  Eigen::MatrixXd beyond = LengthsAt(x).bottomRows(robot_.disks - 1) / -kGivesWay;
  for (Eigen::Index i = beyond.rows() - 2; i >= 0; --i) beyond.row(i) += beyond.row(i + 1);
  for (std::size_t k = 0; k < loads_.direction.size(); ++k) {
    if (loads_.direction[k] != kAsItSlides) beyond.col(static_cast<Eigen::Index>(k)).setZero();
  }
  return beyond.reshaped();
}

template <int C>
Eigen::MatrixXd DiskBalance<C>::LengthsAt(const Vector& x) const {
  Eigen::MatrixXd lengths(robot_.disks, static_cast<Eigen::Index>(holes_.size()));
  arcs_.clear();
  for (int i = 1; i <= robot_.disks; ++i) arcs_.emplace_back(robot_.arc(), Curvature(x.data(), i));
  Chord chord;
  for (std::size_t k = 0; k < holes_.size(); ++k) {
    for (std::size_t at = 0; at < arcs_.size(); ++at) {
      TendonChord(arcs_[at], holes_[k], false, chord);
      lengths(static_cast<Eigen::Index>(at), static_cast<Eigen::Index>(k)) = chord.length;
    }
  }
  return lengths;
}

template <int C>
Eigen::MatrixXd DiskBalance<C>::TensionsAt(const Vector& x) const {
  tension_.setZero(robot_.disks, static_cast<Eigen::Index>(holes_.size()));
  Assemble<false>(x.data());
  return std::exchange(tension_, {});
}

template <int C>
template <bool kDerivatives>
bool DiskBalance<C>::AddTendons() const {
  Row dF = Row::Zero(1, unknowns());
  for (std::size_t k = 0; k < holes_.size(); ++k) {
    double F = pull_[k];
    if (F == 0) continue;
    for (std::size_t at = 0; at < arcs_.size(); ++at) {
      if (!TendonChord(arcs_[at], holes_[k], kDerivatives, chords_[at])) return false;
    }
    const int direction = loads_.direction[k];
    const bool friction = loads_.mu > 0 && direction != 0;
    const bool slides = friction && direction == kAsItSlides;
    if (slides) FindShares<kDerivatives>(k);
    if (kDerivatives) dF.setZero();
    for (int i = 1; i <= robot_.disks; ++i) {
      const auto at = static_cast<std::size_t>(i - 1);
      const Chord& chord = chords_[at];
      if (friction && i > 1) {
        const Chord& before = chords_[at - 1];
        const double share = slides ? share_[at - 1] : direction;
        const int s = share < 0 ? -1 : 1;
        const double mu = loads_.mu * std::abs(share);
        const FrictionRatio ratio(before.end, chord.start, mu, s);
        if (kDerivatives) {
          dF *= ratio.x;
          Scatter(i - 1, F * ratio.d_end.transpose() * before.d_end, dF);
          Scatter(i, F * ratio.d_start.transpose() * chord.d_start, dF);
          if (slides)
            dF +=
                (F * ratio.ByMu(before.end, chord.start, mu, s) * s * loads_.mu) * dshare_[at - 1];
        }
        F *= ratio.x;
      }
      m_[at] += F * chord.moment;
      if (tension_.size() > 0) tension_(i - 1, static_cast<Eigen::Index>(k)) = F;
      if (kDerivatives) {
        Scatter(i, F * chord.d_moment, dm_[at]);
        if (friction && i > 1) dm_[at].noalias() += chord.moment * dF;
      }
    }
  }
  return true;
}

template <int C>
template <bool kDerivatives>
void DiskBalance<C>::AddDeadForces() const {
  const int n = robot_.disks;
  for (int i = 1; i <= n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Arc& arc = arcs_[at - 1];
    const Eigen::Matrix3d& R = R_[at - 1];
    const Eigen::Matrix3d q = arc.Q();
    const Eigen::Vector3d p = R * arc.p();
    G_[at - 1].noalias() = R * q;
    R_[at] = arc.Twisted(G_[at - 1]);
    O_[at] = O_[at - 1] + p;
    if (kDerivatives) {
      Eigen::Matrix3d local = Eigen::Matrix3d::Zero();
      local.leftCols<2>().noalias() = R * arc.dp();
      dO_[at] = dO_[at - 1];
      dO_[at].noalias() -= Skew(p) * dphi_[at - 1];
      Scatter(i, local, dO_[at]);
      local.leftCols<2>().noalias() = R * arc.Rotation();
      dphi_end_[at - 1] = dphi_[at - 1];
      Scatter(i, local, dphi_end_[at - 1]);
      dphi_[at] = dphi_end_[at - 1];
      local.leftCols<2>().setZero();
      local.col(2) = R_[at].col(2);
      Scatter(i, local, dphi_[at]);
    }
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Columns d_sum = Columns::Zero(3, unknowns());
  const Eigen::Vector3d weight = mass_ * Now(loads_.gravity, from_.gravity);
  const Eigen::Vector3d force = Now(loads_.tip_force, from_.tip_force);
  const Eigen::Matrix3d weight_cross = Skew(weight), force_cross = Skew(force);
  for (int i = n; i >= 1; --i) {
    const auto at = static_cast<std::size_t>(i);
    const double count = n - i + 1;
    sum += O_[at];
    const Eigen::Vector3d& base = O_[at - 1];
    const Eigen::Vector3d M = (sum - count * base).cross(weight) + (O_.back() - base).cross(force);
    const Eigen::Matrix3d& G = G_[at - 1];
    m_[at - 1].noalias() += G.transpose() * M;
    if (kDerivatives) {
      d_sum += dO_[at];
      const Eigen::Matrix3d turned = G.transpose() * Skew(M);
      const Eigen::Matrix3d by_weight = G.transpose() * weight_cross;
      const Eigen::Matrix3d by_force = G.transpose() * force_cross;
      dm_[at - 1].noalias() += turned * dphi_end_[at - 1];
      dm_[at - 1].noalias() -= by_weight * d_sum;
      dm_[at - 1].noalias() -= by_force * dO_.back();
      dm_[at - 1].noalias() += (count * by_weight + by_force) * dO_[at - 1];
    }
  }
}

template <int C>
template <bool kDerivatives>
bool DiskBalance<C>::Assemble(const double* x) const {
  arcs_.clear();
  for (int i = 1; i <= robot_.disks; ++i) arcs_.emplace_back(robot_.arc(), Curvature(x, i));
  for (auto& m : m_) m.setZero();
  if (kDerivatives) {
    for (auto& dm : dm_) dm.setZero();
  }
  if (!AddTendons<kDerivatives>()) return false;
  const bool dead = mass_ > 0 && !(loads_.gravity.isZero(0) && from_.gravity.isZero(0));
  if (dead || !loads_.tip_force.isZero(0) || !from_.tip_force.isZero(0)) {
    AddDeadForces<kDerivatives>();
  }
  return true;
}

// The line through rows i = 1..n at i = 1 and i = n is sum_i (1/n +- (i - c)/spread) row_i.
template <class Add>
void FitLine(int n, Add&& add) {
  const double centre = (n + 1) / 2.0;
  const double spread = n * (n + 1.0) / 6;  // sum of (i - c)^2 over half the range
  for (int i = 1; i <= n; ++i) {
    const double slope = (i - centre) / spread;
    add(static_cast<std::size_t>(i - 1), 1.0 / n - slope, 1.0 / n + slope);
  }
}

template <int C>
void DiskBalance<C>::Project(const double* x, double* f) const {
  const double scale = 1 / robot_.moment();
  const double twist = 1 / (1 + robot_.nu);
  using Map = Eigen::Map<Eigen::Vector3d>;
  if constexpr (C == Eigen::Dynamic) {
    for (int i = 0; i < robot_.disks; ++i) {
      Map(f + 3 * i) = scale * m_[static_cast<std::size_t>(i)];
      SubtractStiffness(x + 3 * i, twist, f + 3 * i);
    }
  } else {
    Map first(f), last(f + 3);
    first.setZero();
    last.setZero();
    FitLine(robot_.disks, [&](std::size_t i, double at_first, double at_last) {
      first += (scale * at_first) * m_[i];
      last += (scale * at_last) * m_[i];
    });
    SubtractStiffness(x, twist, f);
    SubtractStiffness(x + 3, twist, f + 3);
  }
}

template <int C>
bool DiskBalance<C>::operator()(const double* x, double* f) const {
  if (!Assemble<false>(x)) return false;
  Project(x, f);
  return true;
}

template <int C>
bool DiskBalance<C>::Jacobian(const Vector& x, Vector& f, Matrix& jacobian) const {
  if (!Assemble<true>(x.data())) return false;
  Project(x.data(), f.data());
  const double scale = 1 / robot_.moment();
  const double twist = 1 / (1 + robot_.nu);
  if constexpr (C == Eigen::Dynamic) {
    for (int i = 0; i < robot_.disks; ++i) {
      jacobian.template middleRows<3>(3 * i) = scale * dm_[static_cast<std::size_t>(i)];
      SubtractStiffness(twist, jacobian.template block<3, 3>(3 * i, 3 * i));
    }
  } else {
    jacobian.setZero();
    FitLine(robot_.disks, [&](std::size_t i, double at_first, double at_last) {
      jacobian.template topRows<3>() += (scale * at_first) * dm_[i];
      jacobian.template bottomRows<3>() += (scale * at_last) * dm_[i];
    });
    SubtractStiffness(twist, jacobian.template topLeftCorner<3, 3>());
    SubtractStiffness(twist, jacobian.template bottomRightCorner<3, 3>());
  }
  return true;
}

template <int C>
typename DiskBalance<C>::Matrix DiskBalance<C>::Stiffness(const Matrix& relative) const {
  Matrix stiffness = relative;
  if constexpr (C != Eigen::Dynamic) {
    double first = 0, both = 0, last = 0;  // sums of the products of the ends' shares
    for (int i = 1; i <= robot_.disks; ++i) {
      const double w = Fraction(i, robot_.disks);
      first += (1 - w) * (1 - w) / robot_.disks;
      both += w * (1 - w) / robot_.disks;
      last += w * w / robot_.disks;
    }
    stiffness.template topRows<3>() =
        first * relative.template topRows<3>() + both * relative.template bottomRows<3>();
    stiffness.template bottomRows<3>() =
        both * relative.template topRows<3>() + last * relative.template bottomRows<3>();
  }
  for (int i = 2; i < unknowns(); i += 3) stiffness.row(i) /= 1 + robot_.nu;
  return stiffness;
}

template class DiskBalance<6>;
template class DiskBalance<Eigen::Dynamic>;

}  // namespace continuum::tdcr
