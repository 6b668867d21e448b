#include "models/tdcr/cosserat.h"

#include <utility>

#include "models/tdcr/cosserat_walk.h"

namespace continuum::tdcr {

template <class T>
bool RodBalance::operator()(const T* x, T* f) const {
  const auto nothing = [](int, const auto&) {};
  return remembers() ? WalkAny<T, true>(x, f, nothing) : WalkAny<T, false>(x, f, nothing);
}

template bool RodBalance::operator()(const double* x, double* f) const;
template bool RodBalance::operator()(const ceres::Jet<double, 4>* x,
                                     ceres::Jet<double, 4>* f) const;

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
  const int count = rod_.arcs() * steps_;
  shape.disks.setZero(3, disks_);
  shape.middles.setZero(3, disks_);
  shape.ends.setZero(3, rod_.arcs());
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
    const int number = (step - 1) / steps_, within = step - number * steps_;
    const RodArc& arc = rod_.Arc(number);
    if (static_cast<int>(shape.frames.size()) == step) {
      shape.ends.col(number) = y.u;
      shape.frames.push_back(Eigen::Quaterniond(y.q[0], y.q[1], y.q[2], y.q[3]).normalized());
    }
    shape.points.col(step) = y.p;
    shape.u.col(step) = y.u;
    if constexpr (requires { y.tension.size(); }) shape.tension.row(step) = y.tension.transpose();
    if constexpr (requires { y.way.size(); }) shape.way.row(step) = y.way.transpose();
    if (2 * (arc.part * steps_ + within) == arc.parts * steps_)
      shape.middles.col(arc.disk - 1) << y.u.y() / length_, -y.u.x() / length_, y.u.z() / length_;
    if (within == steps_ && arc.ends_at_disk()) shape.disks.col(arc.disk - 1) = y.p * length_;
  };
  Eigen::VectorXd end = Eigen::VectorXd::Zero(unknowns());
  shape.valid = remembers() ? WalkAny<double, true>(x.data(), end.data(), keep)
                            : WalkAny<double, false>(x.data(), end.data(), keep);
  shape.residual = end.head<3>();
  return shape;
}

}  // namespace continuum::tdcr
