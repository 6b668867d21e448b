#include "models/annelida/statics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "effects/pcc_kinematics.h"
#include "models/annelida/chain_balance.h"
#include "sim/numerics/decompositions.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"

namespace continuum {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d, Eigen::VectorXd;

// (1) in parts of K: residuals of z, two numbers a section.
class ArcBalance {
 public:
  ArcBalance(const AnnelidaParameters& p, const AnnelidaLoad& load, double share)
      : p_(p), load_(load), share_(share) {}

  template <class T>
  bool operator()(const T* z, T* f) const {
    const int sections = static_cast<int>(p_.sections.size());
    Suspended<T> below(share_ * load_.force);
    std::vector<Eigen::Matrix<T, 3, 3>> frame(static_cast<std::size_t>(sections) + 1);
    std::vector<Eigen::Matrix<T, 3, 1>> origin(frame.size());
    frame[0].setIdentity(), origin[0].setZero();
    for (int s = 0; s < sections; ++s) {
      const PccTip<T> tip = PccTipPose<T>(Segment<T>(s), Bend(z, s));
      Eigen::Matrix<T, 3, 3> turn;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) turn(i, j) = tip.rotation[i][j];
      }
      const Eigen::Matrix<T, 3, 1> to(tip.position[0], tip.position[1], tip.position[2]);
      origin[s + 1] = origin[s] + frame[s] * to;
      frame[s + 1] = frame[s] * turn;
    }
    below.moment = origin.back().cross(below.force);
    for (int s = sections - 1; s >= 0; --s) {
      Add(z, s, frame[s], frame[s + 1], origin[s], origin[s + 1], below, f + 2 * s);
    }
    return true;
  }

 private:
  // Forces on what hangs below, and their moment about the base's origin.
  template <class T>
  struct Suspended {
    explicit Suspended(const Vector3d& on_tip) : force(on_tip.cast<T>()) { moment.setZero(); }
    Eigen::Matrix<T, 3, 1> force, moment;
  };

  double Modules(int s) const { return p_.sections[static_cast<std::size_t>(s)]; }
  template <class T>
  PccSegment<T> Segment(int s, double share = 1) const {
    return {T(share * Modules(s) * p_.Pitch()), T(1.0)};
  }
  template <class T>
  static Vec<T, 3> Bend(const T* z, int s, double share = 1) {
    return {share * z[2 * s], share * z[2 * s + 1], T(0.0)};
  }

  template <class T>
  void Add(const T* z, int s, const Eigen::Matrix<T, 3, 3>& frame,
           const Eigen::Matrix<T, 3, 3>& end, const Eigen::Matrix<T, 3, 1>& origin,
           const Eigen::Matrix<T, 3, 1>& tip, Suspended<T>& below, T* f) const {
    const PccTip<T> pose = PccTipPose<T>(Segment<T>(s), Bend(z, s));
    const PccPoint<T> at = PccCentreLine<T>(Segment<T>(s), 1, Bend(z, s), Vec<T, 3>{});
    const Eigen::Matrix<T, 3, 1> about_tip = below.moment - tip.cross(below.force);
    for (int k = 0; k < 2; ++k) {
      const Eigen::Matrix<T, 3, 1> turning(pose.turning[0][k], pose.turning[1][k],
                                           pose.turning[2][k]);
      const Eigen::Matrix<T, 3, 1> moving(at.jacobian[0][k], at.jacobian[1][k], at.jacobian[2][k]);
      const T work = (frame * moving).dot(below.force) + (end * turning).dot(about_tip);
      f[k] = z[2 * s + k] / Modules(s) + (Cables(z, s, k) - work) / p_.K;
    }
    for (int i = 1; i <= Modules(s); ++i) Hang(z, s, i, frame, origin, below, f);
  }

  // The weight of link i of the section.
  template <class T>
  void Hang(const T* z, int s, int i, const Eigen::Matrix<T, 3, 3>& frame,
            const Eigen::Matrix<T, 3, 1>& origin, Suspended<T>& below, T* f) const {
    const bool last = s + 1 == static_cast<int>(p_.sections.size()) && i == Modules(s);
    const double weight = share_ * p_.gravity * (last ? p_.m_last : p_.m);
    const double share = (i * p_.Pitch() - p_.b2 / 2) / (Modules(s) * p_.Pitch());
    const PccPoint<T> at = PccCentreLine<T>(Segment<T>(s), share, Bend(z, s), Vec<T, 3>{});
    for (int k = 0; k < 2; ++k) {
      T lower(0.0);
      for (int row = 0; row < 3; ++row) lower += frame(2, row) * at.jacobian[row][k];
      f[k] -= weight * lower / p_.K;
    }
    const Eigen::Matrix<T, 3, 1> local(at.position[0], at.position[1], at.position[2]);
    const Eigen::Matrix<T, 3, 1> down(T(0.0), T(0.0), T(weight));
    below.force += down;
    below.moment += Eigen::Matrix<T, 3, 1>(origin + frame * local).cross(down);
  }

  // Σ T ∂ℓ/∂z_k of the cables that pass the section.
  template <class T>
  T Cables(const T* z, int s, int k) const {
    const double n = Modules(s), half = 1 / (2 * n);
    const T zx = z[2 * s], zy = z[2 * s + 1], zk = z[2 * s + k];
    const auto c = Stumpff<4>(T((zx * zx + zy * zy) * half * half));
    T sum(0.0);
    for (int j = kCablesOfSection * s; j < p_.Cables(); ++j) {
      const auto direction = p_.Direction(j);
      const T toward = zx * direction[0] + zy * direction[1];
      // d(2 n b cos) and d(a toward sinc), with dc_0 = -c_1/2 and dc_1 = (c_3 - c_2)/2 by the
      // square.
      const T bent = -p_.b1 * half * zk * c[1];
      const T side = p_.a * (direction[k] * c[1] + toward * (c[3] - c[2]) * zk * half * half);
      sum += share_ * load_.tension[j] * (bent - side);
    }
    return sum;
  }

  const AnnelidaParameters& p_;
  const AnnelidaLoad& load_;
  double share_;
};

// The root that the rising load leads to, and how many directions it gives way in.
template <class Make>
VectorXd Rise(Eigen::Index unknowns, const Make& make, AnnelidaShape& shape) {
  constexpr int kSteps = 10;
  VectorXd x = VectorXd::Zero(unknowns);
  shape.outcome = numerics::Timed([&] {
    numerics::Outcome total;
    numerics::Options options;
    options.max_step = 0.5;
    for (int step = 1; step <= kSteps; ++step) {
      const auto balance = make(double(step) / kSteps);
      const int before = total.iterations;
      total = numerics::Newton(balance, x, options);
      total.iterations += before;
      if (!total.ok()) return total;
    }
    VectorXd f(unknowns);
    Eigen::MatrixXd k(unknowns, unknowns);
    numerics::Linearize(make(1.0), x, f, k);
    const Eigen::MatrixXd symmetric = 0.5 * (k + k.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(symmetric);
    shape.stability.unstable_directions =
        static_cast<int>((modes.eigenvalues().array() <= 0).count());
    return total;
  });
  return x;
}

Isometry3d EndOf(const Arc& arc, double share) {
  return ArcPose({share * arc.u, share * arc.v, share * arc.s});
}

// Frames and lengths of arcs.
void PlaceArcs(const AnnelidaParameters& p, AnnelidaShape& shape) {
  const std::size_t sections = p.sections.size();
  Isometry3d base = Isometry3d::Identity();
  shape.frames = {base};
  shape.length.setZero(p.Cables());
  shape.holes.resize(static_cast<std::size_t>(p.Cables()));
  for (std::size_t s = 0; s < sections; ++s) {
    const Arc& arc = shape.sections[s];
    const int n = p.sections[s];
    for (int i = 1; i <= n; ++i) shape.frames.push_back(base * EndOf(arc, double(i) / n));
    for (int j = kCablesOfSection * static_cast<int>(s); j < p.Cables(); ++j) {
      shape.length[j] += n * p.b2 + PassedLength(p, j, n, arc);
    }
    base = shape.frames.back();
    shape.largest_bend = std::max({shape.largest_bend, std::abs(arc.u) / n, std::abs(arc.v) / n});
  }
  for (int j = 0; j < p.Cables(); ++j) {
    const auto [x, y] = p.Direction(j);
    for (int i = 0; i <= p.LinksOf(j); ++i) {
      shape.holes[static_cast<std::size_t>(j)].emplace_back(
          shape.frames[static_cast<std::size_t>(i)] * Vector3d(p.a * x, p.a * y, 0));
    }
  }
}

}  // namespace

double PassedLength(const AnnelidaParameters& p, int cable, int n, const Arc& arc) {
  const auto [x, y] = p.Direction(cable);
  const double toward = std::atan2(y, x);
  return Module{p.a, p.b1, n}.Lengths(arc.Azimuth() - toward, arc.Angle())[0];
}

AnnelidaShape SolveArcs(const AnnelidaParameters& p, const AnnelidaLoad& load) {
  AnnelidaShape shape;
  const auto sections = static_cast<Eigen::Index>(p.sections.size());
  const VectorXd z = Rise(
      2 * sections, [&](double share) { return ArcBalance(p, load, share); }, shape);
  for (Eigen::Index s = 0; s < sections; ++s) {
    const double length = p.sections[static_cast<std::size_t>(s)] * p.Pitch();
    shape.sections.push_back({-z[2 * s + 1], z[2 * s], length});
  }
  PlaceArcs(p, shape);
  return shape;
}

AnnelidaShape ArcsOfLengths(const AnnelidaParameters& p, const VectorXd& length) {
  AnnelidaShape shape;
  shape.outcome = numerics::Timed([&] {
    VectorXd rest = length;  // of the cables, beyond the sections before
    for (std::size_t s = 0; s < p.sections.size(); ++s) {
      const int n = p.sections[s], first = kCablesOfSection * static_cast<int>(s);
      CableLengths spans;
      for (int j = 0; j < kCablesOfSection; ++j) spans[j] = rest[first + j] - n * p.b2;
      if (!(spans[0] + spans[1] + spans[2] + spans[3] > 0)) {
        return numerics::internal::Failed(
            {}, numerics::Status::kOutOfDomain,
            "lengths shorter than the links of section " + std::to_string(s + 1));
      }
      const auto [x, y] = p.Direction(first);
      const auto bend = Module{p.a, p.b1, n}.FromLengths(spans);
      shape.sections.push_back(Arc::Of(bend.azimuth + std::atan2(y, x), bend.angle, n * p.Pitch()));
      for (int j = first; j < p.Cables(); ++j) {
        rest[j] -= n * p.b2 + PassedLength(p, j, n, shape.sections.back());
      }
    }
    numerics::Outcome outcome;
    outcome.status = numerics::Status::kOk;
    outcome.residual = 0;
    return outcome;
  });
  if (!shape.outcome.ok()) return shape;
  PlaceArcs(p, shape);
  shape.mismatch = (shape.length - length).cwiseAbs().maxCoeff();
  return shape;
}

AnnelidaShape SolveChain(const AnnelidaParameters& p, const AnnelidaLoad& load, AnnelidaPull pull) {
  AnnelidaShape shape;
  const Eigen::Index axes = p.torsion ? 3 : 2;
  shape.joints = Rise(
      axes * p.Links(), [&](double share) { return AnnelidaChainBalance(p, load, pull, share); },
      shape);
  const AnnelidaChain<double> chain(p, shape.joints.data());
  shape.frames = chain.Frames();
  shape.holes = chain.Holes();
  shape.length.setZero(p.Cables());
  for (int j = 0; j < p.Cables(); ++j) {
    const auto& holes = shape.holes[static_cast<std::size_t>(j)];
    for (std::size_t i = 1; i < holes.size(); ++i)
      shape.length[j] += (holes[i] - holes[i - 1]).norm();
  }
  int link = 0;
  for (const int n : p.sections) {
    Arc turned{0, 0, n * p.Pitch()};
    for (int i = 0; i < n; ++i, ++link) {
      const double x = shape.joints[axes * link], y = shape.joints[axes * link + 1];
      turned.u += x, turned.v += y;
      shape.largest_bend = std::max({shape.largest_bend, std::abs(x), std::abs(y)});
    }
    shape.sections.push_back(turned);
  }
  return shape;
}

}  // namespace continuum
