#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "models/annelida/annelida.h"
#include "models/annelida/load.h"

namespace continuum {

/// Where links, joints and holes are at given joint angles, in the base frame.
template <class T>
class AnnelidaChain {
 public:
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;

  AnnelidaChain(const AnnelidaParameters& p, const T* q) : p_(p), turn_{Matrix::Identity()} {
    Vector at(T(0.0), T(0.0), T(p.b1));
    const int axes = p.torsion ? 3 : 2;
    for (int i = 0; i < p.Links(); ++i, q += axes) {
      const Matrix bent = turn_.back() * About(0, q[0]);
      Matrix turn = bent * About(1, q[1]);
      axes_.push_back(turn_.back().col(0));
      axes_.push_back(bent.col(1));
      if (p.torsion) axes_.push_back(turn.col(2));
      if (p.torsion) turn = turn * About(2, q[2]);
      turn_.push_back(turn);
      joints_.push_back(at);
      at += turn.col(2) * T(p.Pitch());
    }
  }

  /// link: from 1; 0 is the base.
  const Matrix& Turn(int link) const { return turn_[static_cast<std::size_t>(link)]; }
  const Vector& Joint(int link) const { return joints_[static_cast<std::size_t>(link - 1)]; }
  const Vector& Axis(int link, int k) const {
    return axes_[static_cast<std::size_t>((link - 1) * (p_.torsion ? 3 : 2) + k)];
  }
  /// A point of the axis of a link, at a distance from its joint.
  Vector Along(int link, double distance) const {
    return Joint(link) + Turn(link).col(2) * T(distance);
  }
  /// The holes of a cable on either side of a joint: before it, behind it.
  Vector Before(int link, int cable) const { return Joint(link) + Hole(link - 1, cable, -p_.b1); }
  Vector Behind(int link, int cable) const { return Joint(link) + Hole(link, cable, p_.b1); }

  std::vector<Eigen::Isometry3d> Frames() const {
    std::vector<Eigen::Isometry3d> frames(1, Eigen::Isometry3d::Identity());
    for (int i = 1; i <= p_.Links(); ++i) {
      frames.emplace_back(Eigen::Isometry3d::Identity());
      frames.back().linear() = Turn(i);
      frames.back().translation() = Along(i, p_.b1 + p_.b2);
    }
    return frames;
  }
  /// Of every cable, from the base on.
  std::vector<std::vector<Eigen::Vector3d>> Holes() const {
    std::vector<std::vector<Eigen::Vector3d>> holes(static_cast<std::size_t>(p_.Cables()));
    for (int j = 0; j < p_.Cables(); ++j) {
      auto& path = holes[static_cast<std::size_t>(j)];
      const int last = p_.LinksOf(j);
      for (int i = 1; i <= last; ++i) path.insert(path.end(), {Before(i, j), Behind(i, j)});
      path.push_back(Joint(last) + Hole(last, j, p_.b1 + p_.b2));
    }
    return holes;
  }

 private:
  static Matrix About(int axis, const T& angle) {
    using std::cos, std::sin;
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    Matrix turn = Matrix::Identity();
    turn(y, y) = turn(z, z) = cos(angle);
    turn(z, y) = sin(angle);
    turn(y, z) = -turn(z, y);
    return turn;
  }
  Vector Hole(int link, int cable, double along) const {
    const auto direction = p_.Direction(cable);
    return Turn(link) * Vector(T(p_.a * direction[0]), T(p_.a * direction[1]), T(along));
  }

  const AnnelidaParameters& p_;
  std::vector<Matrix> turn_;  ///< of the base and the links
  std::vector<Vector> joints_, axes_;
};

/// Balance (2) of statics.h in parts of K, a number for every joint angle.
class AnnelidaChainBalance {
 public:
  AnnelidaChainBalance(const AnnelidaParameters& p, const AnnelidaLoad& load, AnnelidaPull pull,
                       double share)
      : p_(p), load_(load), pull_(pull), share_(share) {}

  template <class T>
  bool operator()(const T* q, T* f) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const AnnelidaChain<T> chain(p_, q);
    const int links = p_.Links(), axes = p_.torsion ? 3 : 2;
    const std::vector<Vector> pulls = CableMoments(chain);
    Vector force = (share_ * load_.force).template cast<T>();
    Vector moment = chain.Along(links, p_.b1 + p_.b2).cross(force);  // about the base's origin
    for (int i = links; i >= 1; --i) {
      const double weight = share_ * p_.gravity * (i == links ? p_.m_last : p_.m);
      const Vector down(T(0.0), T(0.0), T(weight));
      force += down;
      moment += chain.Along(i, p_.b1 + p_.b2 / 2).cross(down);
      const Vector total =
          moment - chain.Joint(i).cross(force) - pulls[static_cast<std::size_t>(i - 1)];
      for (int k = 0; k < axes; ++k) {
        const double stiffness = k < 2 ? p_.K : p_.torsion->K;
        const int at = axes * (i - 1) + k;
        f[at] = (stiffness * q[at] - chain.Axis(i, k).dot(total)) / p_.K;
      }
    }
    return true;
  }

 private:
  // Σ T r × e of the free spans at every joint: what the cables do against the bend.
  template <class T>
  std::vector<Eigen::Matrix<T, 3, 1>> CableMoments(const AnnelidaChain<T>& chain) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    std::vector<Vector> moments(static_cast<std::size_t>(p_.Links()), Vector::Zero());
    for (int j = 0; j < p_.Cables(); ++j) {
      T wrapped(0.0);
      for (int i = 1; i <= p_.LinksOf(j); ++i) {
        const Vector behind = chain.Behind(i, j);
        const Vector span = (behind - chain.Before(i, j)).normalized();
        if (pull_ == AnnelidaPull::kSlowly) wrapped += Angle<T>(chain.Turn(i - 1).col(2), span);
        using std::exp;
        const T tension = share_ * load_.tension[j] * exp(-p_.mu * wrapped);
        moments[static_cast<std::size_t>(i - 1)] +=
            tension * Vector((behind - chain.Joint(i)).cross(span));
        if (pull_ == AnnelidaPull::kSlowly) wrapped += Angle<T>(span, chain.Turn(i).col(2));
      }
    }
    return moments;
  }

  // Between unit vectors, with a slope where they are parallel.
  template <class T>
  static T Angle(const Eigen::Matrix<T, 3, 1>& a, const Eigen::Matrix<T, 3, 1>& b) {
    constexpr double kTiny = 1e-24;
    using std::atan2, std::sqrt;
    return atan2(sqrt(a.cross(b).squaredNorm() + kTiny), a.dot(b));
  }

  const AnnelidaParameters& p_;
  const AnnelidaLoad& load_;
  AnnelidaPull pull_;
  double share_;
};

}  // namespace continuum
