#include "models/tdcr/cosserat.h"

#include <Eigen/Geometry>
#include <array>
#include <type_traits>

#include "models/statics/dual_value.h"
#include "models/tdcr/rubbing.h"

namespace continuum::tdcr {
namespace {

struct NoTensions {};

constexpr int kFewTendons = 4;  // more of them need larger states, which cost time to copy

template <class Matrix>
auto Values(const Matrix& m) {
  return m.unaryExpr([](const auto& x) { return statics::Value(x); }).eval();
}

}  // namespace

// Rotation as a quaternion (w first), curvature, position and, with friction, tensions.
template <class T, int kRubbing>
struct RodBalance::State {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  using Tensions =
      std::conditional_t<kRubbing != 0, Eigen::Matrix<T, Eigen::Dynamic, 1, 0, kRubbing, 1>,
                         NoTensions>;
  static constexpr bool kPosition = std::is_same_v<T, double>;  // the residual needs none

  Eigen::Matrix<T, 4, 1> q;
  Vector3 u, p;
  [[no_unique_address]] Tensions tension;

  void Add(double h, const State& slope) {
    q += T(h) * slope.q;
    u += T(h) * slope.u;
    if constexpr (kPosition) p += T(h) * slope.p;
    if constexpr (kRubbing > 0) tension += T(h) * slope.tension;
  }
};

RodBalance::RodBalance(const Robot& robot, const Loads& loads, bool friction, int steps)
    : length_(robot.length), rod_(robot, loads, friction), steps_(steps) {}

Eigen::Vector3d RodBalance::DeadForce(int piece, double s) const {
  return load_ * rod_.Force(piece, s);
}

template <class T, int kRubbing>
Eigen::Matrix<T, 3, 1> RodBalance::Moment(const State<T, kRubbing>& y) const {
  using std::sqrt;
  Eigen::Matrix<T, 3, 1> moment(y.u.x() - rod_.natural.x(), y.u.y() - rod_.natural.y(),
                                rod_.twist * (y.u.z() - rod_.natural.z()));
  for (std::size_t k = 0; k < rod_.holes.size(); ++k) {
    const double ax = rod_.holes[k].x(), ay = rod_.holes[k].y(), r2 = rod_.holes[k].squaredNorm();
    const T wz = 1.0 + y.u.x() * ay - y.u.y() * ax;
    T pull = T(load_ * rod_.pull[k]);
    if constexpr (kRubbing > 0) pull = y.tension[static_cast<Eigen::Index>(k)];
    pull /= sqrt(wz * wz + r2 * y.u.z() * y.u.z());
    moment.x() += pull * wz * ay;
    moment.y() -= pull * wz * ax;
    moment.z() += pull * y.u.z() * r2;
  }
  return moment;
}

// Flattened, as Rub is: dual numbers are so short that calls would cost as much as the work.
template <class T, int kRubbing>
[[gnu::flatten]] bool RodBalance::Slope(const State<T, kRubbing>& y, const Eigen::Vector3d& force,
                                        State<T, kRubbing>& dy) const {
  using std::sqrt;
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  const Vector3& u = y.u;
  Vector3 moment(u.x() - rod_.natural.x(), u.y() - rod_.natural.y(),
                 rod_.twist * (u.z() - rod_.natural.z()));
  T hxx(1), hxy(0), hyy(1), hxz(0), hyz(0), hzz(rod_.twist);
  for (std::size_t k = 0; k < rod_.holes.size(); ++k) {
    const double ax = rod_.holes[k].x(), ay = rod_.holes[k].y(), r2 = rod_.holes[k].squaredNorm();
    T pull = T(load_ * rod_.pull[k]);
    if constexpr (kRubbing > 0) pull = y.tension[static_cast<Eigen::Index>(k)];
    const T wz = 1.0 + u.x() * ay - u.y() * ax;
    if (!(wz > T(0))) return false;
    const T side = r2 * u.z() * u.z();
    const T square = wz * wz + side;
    const T inverse = pull / sqrt(square);
    moment.x() += inverse * wz * ay;
    moment.y() -= inverse * wz * ax;
    moment.z() += inverse * u.z() * r2;
    // Hessian of T |w| by (wz, u_z), with dwz/du = (ay, -ax, 0).
    const T cube = inverse / square;
    const T by_wz = cube * side;
    const T mixed = cube * wz * u.z() * r2;
    hxx += by_wz * (ay * ay);
    hxy -= by_wz * (ax * ay);
    hyy += by_wz * (ax * ax);
    hxz -= mixed * ay;
    hyz += mixed * ax;
    hzz += cube * wz * wz * r2;
  }
  const T &q0 = y.q[0], &q1 = y.q[1], &q2 = y.q[2], &q3 = y.q[3];
  const Vector3 tangent(2.0 * (q1 * q3 + q0 * q2), 2.0 * (q2 * q3 - q0 * q1),
                        q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3);
  const T nx = (q0 * q0 + q1 * q1 - q2 * q2 - q3 * q3) * force.x() +
               2.0 * ((q1 * q2 + q0 * q3) * force.y() + (q1 * q3 - q0 * q2) * force.z());
  const T ny = (q0 * q0 - q1 * q1 + q2 * q2 - q3 * q3) * force.y() +
               2.0 * ((q1 * q2 - q0 * q3) * force.x() + (q2 * q3 + q0 * q1) * force.z());
  const Vector3 right(moment.y() * u.z() - moment.z() * u.y() + ny,
                      moment.z() * u.x() - moment.x() * u.z() - nx,
                      moment.x() * u.y() - moment.y() * u.x());

  const T cxx = hyy * hzz - hyz * hyz, cxy = hxz * hyz - hxy * hzz, cxz = hxy * hyz - hxz * hyy;
  const T cyy = hxx * hzz - hxz * hxz, cyz = hxy * hxz - hxx * hyz, czz = hxx * hyy - hxy * hxy;
  const T determinant = 1.0 / (hxx * cxx + hxy * cxy + hxz * cxz);
  const auto solve = [&](const Vector3& b) {
    return Vector3((cxx * b.x() + cxy * b.y() + cxz * b.z()) * determinant,
                   (cxy * b.x() + cyy * b.y() + cyz * b.z()) * determinant,
                   (cxz * b.x() + cyz * b.y() + czz * b.z()) * determinant);
  };
  dy.u = solve(right);
  if constexpr (kRubbing > 0) {
    Eigen::Matrix<T, 3, 3> hessian;
    hessian << hxx, hxy, hxz, hxy, hyy, hyz, hxz, hyz, hzz;
    Rub(y, hessian, right, dy);
  }
  if constexpr (State<T, kRubbing>::kPosition) dy.p = tangent;
  dy.q = 0.5 * Eigen::Matrix<T, 4, 1>(
                   -q1 * u.x() - q2 * u.y() - q3 * u.z(), q0 * u.x() + q2 * u.z() - q3 * u.y(),
                   q0 * u.y() + q3 * u.x() - q1 * u.z(), q0 * u.z() + q1 * u.y() - q2 * u.x());
  return true;
}

// u' with friction: H u' + sum_k T_k'(u') a_k x t_k = right, from the u' without it. Steps along
// the first tangent, off by a thousandth, in plain numbers; one more in T has the derivatives too.
template <class T, int kRubbing>
[[gnu::flatten]] void RodBalance::Rub(const State<T, kRubbing>& y,
                                      const Eigen::Matrix<T, 3, 3>& hessian,
                                      const Eigen::Matrix<T, 3, 1>& right,
                                      State<T, kRubbing>& dy) const {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  constexpr int kMostRounds = 12;
  constexpr double kLastStep = 1e-7;
  const auto count = static_cast<std::size_t>(y.tension.size());
  std::array<Rubbing<double>, kRubbing> plain;
  const Eigen::Matrix3d elastic = Values(hessian);
  const Vector known = Values(right);
  Vector du = Values(dy.u);
  Eigen::Matrix3d tangent = elastic;
  for (std::size_t k = 0; k < count; ++k) {
    const double tension = statics::Value(y.tension[static_cast<Eigen::Index>(k)]);
    plain[k] = Rubbing<double>(rod_.holes[k], Values(y.u), rod_.direction[k] * rod_.mu * tension);
    tangent += plain[k].Lever() * plain[k].Gradient(du).transpose();
  }
  const Eigen::Matrix3d inverse = tangent.inverse();
  for (int round = 0; round < kMostRounds; ++round) {
    Vector rest = known - elastic * du;
    for (std::size_t k = 0; k < count; ++k) rest -= plain[k].Slope(du) * plain[k].Lever();
    const Vector step = inverse * rest;
    du += step;
    if (step.squaredNorm() <= kLastStep * kLastStep * (1 + du.squaredNorm())) break;
  }
  const Vector3 at = du.cast<T>();
  Vector3 rest = right - hessian * at;
  dy.tension.resize(y.tension.size());
  for (std::size_t k = 0; k < count; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Rubbing<T> rubbing(rod_.holes[k], y.u, T(rod_.direction[k] * rod_.mu) * y.tension[i]);
    dy.tension[i] = rubbing.Slope(at);
    rest -= dy.tension[i] * rubbing.Lever();
  }
  const Vector3 step = inverse.cast<T>() * rest;
  dy.u = at + step;
  for (std::size_t k = 0; k < count; ++k) {
    const Vector gradient = plain[k].Gradient(du);
    for (int i = 0; i < 3; ++i) dy.tension[static_cast<Eigen::Index>(k)] += gradient[i] * step[i];
  }
}

// Dormand-Prince's fifth-order formula, `steps_` equal steps per piece.
template <class T, int kRubbing, class AtNode>
bool RodBalance::Walk(const T* x, Eigen::Matrix<T, 3, 1>& end, AtNode&& at_node) const {
  static constexpr double kNodes[6] = {0, 0.2, 0.3, 0.8, 8. / 9, 1};
  static constexpr double kA[7][6] = {
      {},
      {1. / 5},
      {3. / 40, 9. / 40},
      {44. / 45, -56. / 15, 32. / 9},
      {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
      {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
      {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
  using S = State<T, kRubbing>;
  S y;
  y.q << T(1), T(0), T(0), T(0);
  y.u << x[0], x[1], x[2];
  y.p.setZero();
  if constexpr (kRubbing > 0) {
    y.tension.resize(static_cast<Eigen::Index>(rod_.pull.size()));
    for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
      y.tension[static_cast<Eigen::Index>(k)] = T(load_ * rod_.pull[k]);
    }
  }
  std::array<S, 6> slope;
  const double h = 1.0 / (rod_.disks * steps_);
  for (int step = 0; step < rod_.disks * steps_; ++step) {
    for (int stage = 0; stage <= 6; ++stage) {
      S at = y;
      for (int j = 0; j < stage; ++j) {
        if (kA[stage][j] != 0) at.Add(h * kA[stage][j], slope[static_cast<std::size_t>(j)]);
      }
      if (stage == 6) {
        y = at;
      } else if (!Slope(at, DeadForce(step / steps_, h * (step + kNodes[stage])),
                        slope[static_cast<std::size_t>(stage)])) {
        return false;
      }
    }
    at_node(step + 1, y);
  }
  // R nu by the quaternion: nu + 2 q_0 (q x nu) + 2 q x (q x nu).
  const Eigen::Matrix<T, 3, 1> axis = y.q.template tail<3>(), moment = Moment(y);
  const Eigen::Matrix<T, 3, 1> turned = 2.0 * axis.cross(moment);
  end = moment + y.q[0] * turned + axis.cross(turned);
  return true;
}

template <class T, class AtNode>
bool RodBalance::WalkAny(const T* x, Eigen::Matrix<T, 3, 1>& end, AtNode&& at_node) const {
  if (!rod_.friction) return Walk<T, 0>(x, end, at_node);
  if (rod_.pull.size() <= kFewTendons) return Walk<T, kFewTendons>(x, end, at_node);
  return Walk<T, kMaxTendons>(x, end, at_node);
}

template <class T>
bool RodBalance::operator()(const T* x, T* f) const {
  Eigen::Matrix<T, 3, 1> end;
  if (!WalkAny(x, end, [](int, const auto&) {})) return false;
  for (int i = 0; i < 3; ++i) f[i] = end[i];
  return true;
}

template bool RodBalance::operator()(const double* x, double* f) const;
template bool RodBalance::operator()(const ceres::Jet<double, 4>* x,
                                     ceres::Jet<double, 4>* f) const;

const RodBalance::Shape& RodBalance::Integrate(const Vector& x) const {
  for (const Integrated& known : integrated_) {
    if (known.x == x && known.load == load_ && known.steps == steps_) return known.shape;
  }
  std::swap(integrated_[0], integrated_[1]);
  Integrated& now = integrated_[0];
  now.x = x;
  now.load = load_;
  now.steps = steps_;
  Shape& shape = now.shape;
  shape.disks.setZero(3, rod_.disks);
  shape.middles.setZero(3, rod_.disks);
  shape.frames.assign(1, Eigen::Quaterniond::Identity());
  shape.frames.reserve(static_cast<std::size_t>(rod_.disks * steps_) + 1);
  const auto keep = [&](int step, const auto& y) {
    const int piece = (step - 1) / steps_, within = step - piece * steps_;
    shape.frames.push_back(Eigen::Quaterniond(y.q[0], y.q[1], y.q[2], y.q[3]).normalized());
    if (2 * within == steps_)
      shape.middles.col(piece) << y.u.y() / length_, -y.u.x() / length_, y.u.z() / length_;
    if (within == steps_) shape.disks.col(piece) = y.p * length_;
  };
  shape.valid = WalkAny(x.data(), shape.residual, keep);
  return shape;
}

}  // namespace continuum::tdcr
