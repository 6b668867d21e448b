#include <algorithm>

#include "models/tdcr/cosserat.h"

namespace continuum::tdcr {

RodBalance::RodBalance(const Robot& robot, const Loads& loads, bool friction, int steps)
    : length_(robot.length),
      unit_(robot.moment() / robot.length),
      tendons_(robot.tendons),
      disks_(robot.disks),
      to_(robot, loads, friction),
      from_(to_.Unloaded()),
      rod_(to_),
      steps_(steps) {}

RodBalance RodBalance::Remembering(const Robot& robot, const Loads& loads, int steps,
                                   const Loads* earlier) {
  RodBalance balance(robot, loads, true, steps);
  balance.remembers_ = true;
  balance.slid_from_ = loads.from;
  balance.to_ = UnitRod(robot, loads, true, true);
  balance.from_ = earlier ? UnitRod(robot, *earlier, true, true) : balance.to_.Unloaded();
  balance.to_.ShareMoments(balance.from_);
  balance.rod_ = balance.to_;
  const int count = balance.rod_.arcs() * steps;
  Eigen::MatrixXd& beyond = balance.beyond_before_;
  beyond = balance.RestLengths(steps);
  if (loads.from.length.size() > 0) beyond = loads.from.length / robot.length;
  SumBeyond(beyond);
  balance.contacts_ = loads.AsItSlides() && loads.mu > 0 ? count : 1;
  return balance;
}

void RodBalance::SumBeyond(Eigen::MatrixXd& length) {
  for (Eigen::Index i = length.rows() - 2; i >= 0; --i) length.row(i) += length.row(i + 1);
}

Eigen::MatrixXd RodBalance::RestLengths(int steps) const {
  Eigen::MatrixXd rest(rod_.arcs() * steps, tendons_);
  for (int i = 0; i < rest.rows(); ++i) {
    const auto arc = static_cast<std::size_t>(i / steps);
    const RodArc& rod = rod_.shape->arcs[arc];
    const double part = 1 / (rod.per_rod * steps);
    const double from = rod.start() + (i % steps) * part;
    for (int k = 0; k < tendons_; ++k) {
      rest(i, k) = rod_.shape->RestLength(static_cast<std::size_t>(k), arc, from, from + part);
    }
  }
  return rest;
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

void RodBalance::Forget() {
  for (Integrated& known : integrated_) known.load = -1;
}

void RodBalance::SetWidth(double width) {
  if (width == width_) return;
  width_ = width;
  Forget();
}

void RodBalance::SetTension(const Eigen::VectorXd& tension) {
  for (std::size_t k = 0; k < rod_.pull.size(); ++k) {
    rod_.pull[k] = to_.pull[k] = from_.pull[k] = tension[static_cast<Eigen::Index>(k)] / unit_;
  }
  Forget();
}

Line RodBalance::LineOf(const Shape& shape) const {
  const Eigen::Index count = shape.points.cols();
  Line line{Eigen::VectorXd(count),
            length_ * shape.points,
            shape.frames,
            std::vector<int>(static_cast<std::size_t>(count), -1),
            shape.u / length_,
            shape.ends / length_,
            Eigen::MatrixXd::Zero(count, tendons_)};
  const int arcs = rod_.arcs();
  const Eigen::Index per_arc = (count - 1) / arcs;
  for (Eigen::Index i = 0; i < count; ++i) {
    const RodArc& arc = rod_.Arc(static_cast<int>(std::min(i / per_arc, arcs - Eigen::Index{1})));
    const auto within = static_cast<double>(i % per_arc) / static_cast<double>(per_arc);
    line.s[i] = i == count - 1 ? length_ : length_ * (arc.before + within) / arc.per_rod;
  }
  for (int i = 0; i <= disks_; ++i) {
    line.disk[rod_.shape->ArcsTo(i) * static_cast<std::size_t>(per_arc)] = i;
  }
  for (std::size_t k = 0; k < rod_.tendon.size(); ++k) {
    // A tendon that ends before the tip has no tension from there on.
    const auto end = static_cast<int>(rod_.shape->ends[static_cast<std::size_t>(rod_.tendon[k])]);
    const Eigen::Index places = end == arcs ? count : end * per_arc;
    line.tension.col(rod_.tendon[k]).head(places) =
        unit_ * shape.tension.col(static_cast<Eigen::Index>(k)).head(places);
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

void RodBalance::GoOnFrom(const Eigen::VectorXd& x) {
  if (contacts_ < rod_.arcs() * steps_) return;
  slid_from_ = ContactsAt(x);
  beyond_before_ = slid_from_.length / length_;
  SumBeyond(beyond_before_);
  Forget();
}

Eigen::VectorXd RodBalance::SlidAt(const Eigen::VectorXd& x) const {
  if (contacts_ < rod_.arcs() * steps_) return {};
  Eigen::VectorXd slid = (-length_ / kGivesWay) * x.tail(x.size() - 3);
  const auto tendons = static_cast<Eigen::Index>(rod_.pull.size());
  for (Eigen::Index i = 0; i < slid.size(); ++i) {
    if (rod_.direction[static_cast<std::size_t>(i % tendons)] != kAsItSlides) slid[i] = 0;
  }
  return slid;
}

bool RodBalance::SomeRest(const Eigen::VectorXd& x) const { return tdcr::SomeRest(ContactsAt(x)); }

}  // namespace continuum::tdcr
