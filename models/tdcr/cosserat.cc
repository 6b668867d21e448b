#include "models/tdcr/cosserat.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <type_traits>

#include "models/statics/dual_value.h"
#include "models/statics/slide.h"
#include "models/tdcr/rubbing.h"

namespace continuum::tdcr {
namespace {

struct NoTensions {};
struct NoLengths {};

constexpr int kFewTendons = 4;  // more of them need larger states, which cost time to copy

template <class Matrix>
auto Values(const Matrix& m) {
  return m.unaryExpr([](const auto& x) { return statics::Value(x); }).eval();
}

}  // namespace

// Rotation as a quaternion (w first), curvature, position and, with friction, tensions; of contacts
// that remember, the tendons' lengths so far.
template <class T, int kRubbing, bool kSlides>
struct RodBalance::State {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  using Tensions =
      std::conditional_t<kRubbing != 0, Eigen::Matrix<T, Eigen::Dynamic, 1, 0, kRubbing, 1>,
                         NoTensions>;
  static constexpr bool kPosition = std::is_same_v<T, double>;  // the residual needs none

  Eigen::Matrix<T, 4, 1> q;
  Vector3 u, p;
  [[no_unique_address]] Tensions tension;
  [[no_unique_address]] std::conditional_t<kSlides, Tensions, NoLengths> way;

  void Add(double h, const State& slope) {
    q += T(h) * slope.q;
    u += T(h) * slope.u;
    if constexpr (kPosition) p += T(h) * slope.p;
    if constexpr (kRubbing > 0) tension += T(h) * slope.tension;
    if constexpr (kSlides) way += T(h) * slope.way;
  }
};

RodBalance::RodBalance(const Robot& robot, const Loads& loads, bool friction, int steps)
    : length_(robot.length),
      unit_(robot.moment() / robot.length),
      tendons_(robot.tendons),
      to_(robot, loads, friction),
      from_(to_.Unloaded()),
      rod_(to_),
      steps_(steps) {}

RodBalance RodBalance::Remembering(const Robot& robot, const Loads& loads, int steps,
                                   const Loads* earlier) {
  RodBalance balance(robot, loads, true, steps);
  balance.remembers_ = &loads;
  balance.to_ = UnitRod(robot, loads, true, true);
  balance.from_ = earlier ? UnitRod(robot, *earlier, true, true) : balance.to_.Unloaded();
  balance.rod_ = balance.to_;
  const int count = robot.disks * steps;
  Eigen::MatrixXd& beyond = balance.beyond_before_;
  beyond.setConstant(count, robot.tendons, 1.0 / count);
  if (loads.from.length.size() > 0) beyond = loads.from.length / robot.length;
  for (int i = count - 2; i >= 0; --i) beyond.row(i) += beyond.row(i + 1);
  balance.contacts_ = loads.AsItSlides() && loads.mu > 0 ? count : 1;
  return balance;
}

Eigen::VectorXd RodBalance::Unslid(const Eigen::Vector3d& u) const {
  return Unknowns(u, beyond_before_);
}

Eigen::VectorXd RodBalance::Unknowns(const Eigen::Vector3d& u,
                                     const Eigen::MatrixXd& beyond) const {
  Eigen::VectorXd x(unknowns());
  x.head<3>() = u;
  const auto parts = static_cast<double>(beyond.rows());
  const Eigen::Index tendons = beyond.cols(), last = beyond.rows() - 1;
  for (Eigen::Index i = 0; i < contacts_; ++i) {
    const double at = parts * static_cast<double>(i) / contacts_;
    const auto part = static_cast<Eigen::Index>(at);
    const double within = at - static_cast<double>(part);
    x.segment(3 + i * tendons, tendons) = (1 - within) * beyond.row(part);
    if (part < last) x.segment(3 + i * tendons, tendons) += within * beyond.row(part + 1);
  }
  return x;
}

Eigen::VectorXd RodBalance::Slid(const Eigen::Vector3d& u) const {
  const Eigen::MatrixXd& way = Integrate(Unslid(u)).way;
  const Eigen::Index count = way.rows() - 1;
  return Unknowns(u, way.row(count).replicate(count, 1) - way.topRows(count));
}

void RodBalance::SetLoad(double load) {
  load_ = load;
  rod_.Mix(from_, to_, load);
}

void RodBalance::SetTension(const Eigen::VectorXd& tension) {
  for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
    rod_.pull[k] = to_.pull[k] = from_.pull[k] = tension[static_cast<Eigen::Index>(k)] / unit_;
  }
  for (Integrated& known : integrated_) known.load = -1;
}

// (5), of a tendon whose direction is not given.
template <class T>
T RodBalance::Share(int step, std::size_t tendon, const T& beyond) const {
  const int direction = rod_.direction[tendon];
  if (direction != kAsItSlides) return T(direction);
  const auto k = static_cast<Eigen::Index>(tendon);
  const Contacts& from = remembers_->from;
  const double before = from.share.size() > 0 ? from.share(step, k) : 0;
  return statics::SlideFrom(before, T((length_ / kGivesWay) * (beyond_before_(step, k) - beyond)));
}

template <class T, int kRubbing, bool kSlides>
Eigen::Matrix<T, 3, 1> RodBalance::Moment(const State<T, kRubbing, kSlides>& y) const {
  using std::sqrt;
  Eigen::Matrix<T, 3, 1> moment(y.u.x() - rod_.natural.x(), y.u.y() - rod_.natural.y(),
                                rod_.twist * (y.u.z() - rod_.natural.z()));
  for (std::size_t k = 0; k < rod_.holes.size(); ++k) {
    const double ax = rod_.holes[k].x(), ay = rod_.holes[k].y(), r2 = rod_.holes[k].squaredNorm();
    const T wz = 1.0 + y.u.x() * ay - y.u.y() * ax;
    T pull = T(rod_.pull[k]);
    if constexpr (kRubbing > 0) pull = y.tension[static_cast<Eigen::Index>(k)];
    pull /= sqrt(wz * wz + r2 * y.u.z() * y.u.z());
    moment.x() += pull * wz * ay;
    moment.y() -= pull * wz * ax;
    moment.z() += pull * y.u.z() * r2;
  }
  return moment;
}

// Flattened, as Rub is: dual numbers are so short that calls would cost as much as the work.
template <class T, int kRubbing, bool kSlides>
[[gnu::flatten]] bool RodBalance::Slope(const State<T, kRubbing, kSlides>& y,
                                        const Eigen::Vector3d& force, const T* share,
                                        State<T, kRubbing, kSlides>& dy) const {
  using std::sqrt;
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  const Vector3& u = y.u;
  Vector3 moment(u.x() - rod_.natural.x(), u.y() - rod_.natural.y(),
                 rod_.twist * (u.z() - rod_.natural.z()));
  T hxx(1), hxy(0), hyy(1), hxz(0), hyz(0), hzz(rod_.twist);
  if constexpr (kSlides) dy.way.resize(y.way.size());
  for (std::size_t k = 0; k < rod_.holes.size(); ++k) {
    const double ax = rod_.holes[k].x(), ay = rod_.holes[k].y(), r2 = rod_.holes[k].squaredNorm();
    T pull = T(rod_.pull[k]);
    if constexpr (kRubbing > 0) pull = y.tension[static_cast<Eigen::Index>(k)];
    const T wz = 1.0 + u.x() * ay - u.y() * ax;
    if (!(wz > T(0))) return false;
    const T side = r2 * u.z() * u.z();
    const T square = wz * wz + side;
    const T along = sqrt(square);
    if constexpr (kSlides) dy.way[static_cast<Eigen::Index>(k)] = along;
    const T inverse = pull / along;
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
    Rub(y, hessian, right, share, dy);
  }
  if constexpr (State<T, kRubbing, kSlides>::kPosition) dy.p = tangent;
  dy.q = 0.5 * Eigen::Matrix<T, 4, 1>(
                   -q1 * u.x() - q2 * u.y() - q3 * u.z(), q0 * u.x() + q2 * u.z() - q3 * u.y(),
                   q0 * u.y() + q3 * u.x() - q1 * u.z(), q0 * u.z() + q1 * u.y() - q2 * u.x());
  return true;
}

// u' with friction: H u' + sum_k T_k'(u') a_k x t_k = right, from the u' without it. Steps along
// the first tangent, off by a thousandth, in plain numbers; one more in T has the derivatives too.
template <class T, int kRubbing, bool kSlides>
[[gnu::flatten]] void RodBalance::Rub(const State<T, kRubbing, kSlides>& y,
                                      const Eigen::Matrix<T, 3, 3>& hessian,
                                      const Eigen::Matrix<T, 3, 1>& right, const T* share,
                                      State<T, kRubbing, kSlides>& dy) const {
  using Vector3 = Eigen::Matrix<T, 3, 1>;
  constexpr int kMostRounds = 12;
  constexpr double kLastStep = 1e-7;
  using Vector = Eigen::Vector3d;
  const auto count = static_cast<std::size_t>(y.tension.size());
  std::array<Rubbing<double>, kRubbing> plain;
  const Eigen::Matrix3d elastic = Values(hessian);
  const Vector known = Values(right);
  Vector du = Values(dy.u);
  Eigen::Matrix3d tangent = elastic;
  for (std::size_t k = 0; k < count; ++k) {
    const double tension = statics::Value(y.tension[static_cast<Eigen::Index>(k)]);
    const double direction = kSlides ? statics::Value(share[k]) : rod_.direction[k];
    plain[k] = Rubbing<double>(rod_.holes[k], Values(y.u), direction * rod_.mu * tension);
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
    const T loss = kSlides ? T(rod_.mu * share[k]) : T(rod_.direction[k] * rod_.mu);
    const Rubbing<T> rubbing(rod_.holes[k], y.u, loss * y.tension[i]);
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

template <class T, int kRubbing, bool kSlides>
RodBalance::State<T, kRubbing, kSlides> RodBalance::Base(const T* x) const {
  State<T, kRubbing, kSlides> y;
  y.q << T(1), T(0), T(0), T(0);
  y.u << x[0], x[1], x[2];
  y.p.setZero();
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  if constexpr (kRubbing > 0) {
    y.tension.resize(tendons);
    for (Eigen::Index k = 0; k < tendons; ++k) {
      y.tension[k] = T(rod_.pull[static_cast<std::size_t>(k)]);
    }
  }
  if constexpr (kSlides) y.way.setZero(tendons);
  return y;
}

// Shares of the contacts of a step, and their (5).
template <class T, int kRubbing>
void RodBalance::Slide(int step, const T* x, const State<T, kRubbing, true>& y, T* share,
                       T* end) const {
  const std::size_t tendons = rod_.pull.size();
  for (std::size_t k = 0; k < tendons; ++k) {
    share[k] = step < contacts_ ? Share(step, k, Beyond(x, step, k)) : T(rod_.direction[k]);
    if (step == 0 || step >= contacts_) continue;
    const T& way = y.way[static_cast<Eigen::Index>(k)];
    end[3 + static_cast<std::size_t>(step) * tendons + k] =
        Beyond(x, 0, k) - way - Beyond(x, step, k);
  }
}

// R nu(1), and (5) of the first contacts.
template <class T, int kRubbing, bool kSlides>
void RodBalance::End(const T* x, const State<T, kRubbing, kSlides>& y, T* end) const {
  // R nu by the quaternion: nu + 2 q_0 (q x nu) + 2 q x (q x nu).
  const Eigen::Matrix<T, 3, 1> axis = y.q.template tail<3>(), moment = Moment(y);
  const Eigen::Matrix<T, 3, 1> turned = 2.0 * axis.cross(moment);
  Eigen::Map<Eigen::Matrix<T, 3, 1>>(end, 3) = moment + y.q[0] * turned + axis.cross(turned);
  if constexpr (kSlides) {
    for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
      end[3 + k] = y.way[static_cast<Eigen::Index>(k)] - x[3 + k];
    }
  }
}

// Dormand-Prince's fifth-order formula, `steps_` equal steps per piece. end: R nu(1), then (5).
template <class T, int kRubbing, bool kSlides, class AtNode>
bool RodBalance::Walk(const T* x, T* end, AtNode&& at_node) const {
  static constexpr double kNodes[6] = {0, 0.2, 0.3, 0.8, 8. / 9, 1};
  static constexpr double kA[7][6] = {
      {},
      {1. / 5},
      {3. / 40, 9. / 40},
      {44. / 45, -56. / 15, 32. / 9},
      {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
      {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
      {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
  using S = State<T, kRubbing, kSlides>;
  S y = Base<T, kRubbing, kSlides>(x);
  std::array<S, 6> slope;
  std::array<T, kSlides ? kRubbing : 1> share{};
  const double h = 1.0 / (rod_.disks * steps_);
  for (int step = 0; step < rod_.disks * steps_; ++step) {
    if constexpr (kSlides) Slide(step, x, y, share.data(), end);
    for (int stage = 0; stage <= 6; ++stage) {
      S at = y;
      for (int j = 0; j < stage; ++j) {
        if (kA[stage][j] != 0) at.Add(h * kA[stage][j], slope[static_cast<std::size_t>(j)]);
      }
      if (stage == 6) {
        y = at;
      } else if (!Slope(at, rod_.Force(step / steps_, h * (step + kNodes[stage])), share.data(),
                        slope[static_cast<std::size_t>(stage)])) {
        return false;
      }
    }
    at_node(step + 1, y);
  }
  End(x, y, end);
  return true;
}

template <class T, bool kSlides, class AtNode>
bool RodBalance::WalkAny(const T* x, T* end, AtNode&& at_node) const {
  if constexpr (kSlides) {
    return Walk<T, kMaxTendons, true>(x, end, at_node);
  } else {
    if (!rod_.friction) return Walk<T, 0, false>(x, end, at_node);
    return rod_.pull.size() <= kFewTendons ? Walk<T, kFewTendons, false>(x, end, at_node)
                                           : Walk<T, kMaxTendons, false>(x, end, at_node);
  }
}

template <class T>
bool RodBalance::operator()(const T* x, T* f) const {
  const auto nothing = [](int, const auto&) {};
  return remembers() ? WalkAny<T, true>(x, f, nothing) : WalkAny<T, false>(x, f, nothing);
}

template bool RodBalance::operator()(const double* x, double* f) const;
template bool RodBalance::operator()(const ceres::Jet<double, 4>* x,
                                     ceres::Jet<double, 4>* f) const;

bool RodBalance::Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f,
                          Eigen::MatrixXd& jacobian) const {
  constexpr int kBlock = 4;
  using Dual = ceres::Jet<double, kBlock>;
  std::vector<Dual> dual_x(static_cast<std::size_t>(x.size())), dual_f(dual_x.size());
  const std::vector<Eigen::Index> coupled = Coupled(x);
  jacobian.setZero();
  jacobian.diagonal().setConstant(-1);
  for (std::size_t first = 0; first < coupled.size(); first += kBlock) {
    const auto count = static_cast<int>(std::min<std::size_t>(kBlock, coupled.size() - first));
    for (Eigen::Index i = 0; i < x.size(); ++i) dual_x[static_cast<std::size_t>(i)] = Dual(x[i]);
    for (int i = 0; i < count; ++i) {
      dual_x[static_cast<std::size_t>(coupled[first + static_cast<std::size_t>(i)])].v[i] = 1;
    }
    if (!(*this)(dual_x.data(), dual_f.data())) return false;
    for (Eigen::Index row = 0; row < f.size(); ++row) {
      const Dual& value = dual_f[static_cast<std::size_t>(row)];
      f[row] = value.a;
      for (int i = 0; i < count; ++i) {
        jacobian(row, coupled[first + static_cast<std::size_t>(i)]) = value.v[i];
      }
    }
  }
  return f.allFinite() && jacobian.allFinite();
}

std::vector<Eigen::Index> RodBalance::Coupled(const Eigen::VectorXd& x) const {
  using Dual = ceres::Jet<double, 4>;
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  std::vector<Eigen::Index> coupled;
  for (Eigen::Index i = 0; i < 3 + tendons; ++i) coupled.push_back(i);
  for (Eigen::Index i = 3 + tendons; i < x.size(); ++i) {
    const auto contact = static_cast<int>((i - 3) / tendons);
    const auto tendon = static_cast<std::size_t>((i - 3) % tendons);
    if (Share(contact, tendon, Dual(x[i], 0)).v[0] != 0) coupled.push_back(i);
  }
  return coupled;
}

const RodBalance::Shape& RodBalance::Integrate(const Eigen::VectorXd& x) const {
  for (const Integrated& known : integrated_) {
    if (known.x.size() == x.size() && known.x == x && known.load == load_ &&
        known.steps == steps_) {
      return known.shape;
    }
  }
  std::swap(integrated_[0], integrated_[1]);
  Integrated& now = integrated_[0];
  now.x = x;
  now.load = load_;
  now.steps = steps_;
  Shape& shape = now.shape;
  const int count = rod_.disks * steps_;
  shape.disks.setZero(3, rod_.disks);
  shape.middles.setZero(3, rod_.disks);
  shape.frames.assign(1, Eigen::Quaterniond::Identity());
  shape.frames.reserve(static_cast<std::size_t>(count) + 1);
  shape.points.setZero(3, count + 1);
  shape.u.resize(3, count + 1);
  shape.u.col(0) = x.head<3>();
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  shape.tension.resize(count + 1, tendons);
  for (Eigen::Index k = 0; k < tendons; ++k) {
    shape.tension.col(k).setConstant(rod_.pull[static_cast<std::size_t>(k)]);
  }
  if (remembers()) shape.way.setZero(count + 1, tendons);
  const auto keep = [&](int step, const auto& y) {
    const int piece = (step - 1) / steps_, within = step - piece * steps_;
    shape.frames.push_back(Eigen::Quaterniond(y.q[0], y.q[1], y.q[2], y.q[3]).normalized());
    shape.points.col(step) = y.p;
    shape.u.col(step) = y.u;
    if constexpr (requires { y.tension.size(); }) shape.tension.row(step) = y.tension.transpose();
    if constexpr (requires { y.way.size(); }) shape.way.row(step) = y.way.transpose();
    if (2 * within == steps_)
      shape.middles.col(piece) << y.u.y() / length_, -y.u.x() / length_, y.u.z() / length_;
    if (within == steps_) shape.disks.col(piece) = y.p * length_;
  };
  Eigen::VectorXd end = Eigen::VectorXd::Zero(unknowns());
  shape.valid = remembers() ? WalkAny<double, true>(x.data(), end.data(), keep)
                            : WalkAny<double, false>(x.data(), end.data(), keep);
  shape.residual = end.head<3>();
  return shape;
}

Line RodBalance::LineOf(const Shape& shape) const {
  const Eigen::Index count = shape.points.cols();
  Line line{Eigen::VectorXd::LinSpaced(count, 0, length_),
            length_ * shape.points,
            shape.frames,
            std::vector<int>(static_cast<std::size_t>(count), -1),
            shape.u / length_,
            Eigen::MatrixXd::Zero(count, tendons_)};
  const Eigen::Index per_disk = (count - 1) / rod_.disks;
  for (int i = 0; i <= rod_.disks; ++i) line.disk[static_cast<std::size_t>(i * per_disk)] = i;
  for (std::size_t k = 0; k < rod_.tendon.size(); ++k) {
    line.tension.col(rod_.tendon[k]) = unit_ * shape.tension.col(static_cast<Eigen::Index>(k));
  }
  return line;
}

Contacts RodBalance::ContactsAt(const Eigen::VectorXd& x) const {
  const Eigen::MatrixXd& way = Integrate(x).way;
  const Eigen::Index count = way.rows() - 1, tendons = way.cols();
  Eigen::MatrixXd beyond = way.row(count).replicate(count, 1) - way.topRows(count);
  if (contacts_ == count) {
    beyond = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(x.data() + 3, count,
                                                                              tendons);
  }
  Contacts contacts{length_ * beyond, Eigen::MatrixXd(count, tendons)};
  contacts.length.topRows(count - 1) -= length_ * beyond.bottomRows(count - 1);
  for (Eigen::Index k = 0; k < tendons; ++k) {
    for (int i = 0; i < count; ++i) {
      contacts.share(i, k) = Share(i, static_cast<std::size_t>(k), beyond(i, k));
    }
  }
  return contacts;
}

}  // namespace continuum::tdcr
