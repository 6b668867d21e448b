#include "models/tdcr/unit_rod.h"

#include <algorithm>
#include <cmath>

namespace continuum::tdcr {
namespace {

using Eigen::Vector3d;

// (kappa_x, kappa_y, tau) as a rotation vector.
Vector3d Rotation(const Vector3d& u) { return {-u.y(), u.x(), u.z()}; }

/// Into how many arcs the rod between two disks is cut: none is longer than twice their mean, nor
/// bends twice as easily. So integrator and chain of pieces are fine where the rod moves.
class Cuts {
 public:
  explicit Cuts(const Robot& robot) : robot_(robot) {
    for (const Section& s : robot.sections) compliance_ += s.length() / Stiffness(s);
  }
  int Of(const Section& section, double length) const {
    if (!robot_.has_sections()) return 1;
    const double share =
        std::max(length / robot_.length, length / Stiffness(section) / compliance_);
    return std::max(1, static_cast<int>(std::ceil(robot_.disks * share / 2 - 1e-6)));
  }

 private:
  static double Stiffness(const Section& section) { return std::min(section.EI, section.GJ); }

  const Robot& robot_;
  double compliance_ = 0;  ///< of the whole rod [rad/(N m)]
};

// Arcs of a section that begins at `start` [m].
void AddArcs(const Robot& robot, const Section& section, double start, bool cut, RodShape& shape) {
  const double unit = robot.EI();
  const Vector3d stiffness(section.EI / unit, section.EI / unit, section.GJ / unit);
  const auto count = static_cast<double>(section.disks.size());
  double from = 0;
  for (std::size_t i = 0; i < section.disks.size(); ++i) {
    const double whole = section.disks[i] - from;
    const int parts = cut ? Cuts(robot).Of(section, whole) : 1;
    const double length = whole / parts;
    RodArc arc{robot.length / length, (start + from) / length, stiffness,
               robot.length * Rotation(section.natural), false};
    if (!robot.has_sections()) {  // without rounding
      arc.per_rod = count;
      arc.before = static_cast<double>(i);
      arc.stiffness.z() = 1 / (1 + robot.nu);
    }
    arc.disk = static_cast<int>(shape.arcs_to.size());
    arc.parts = parts;
    for (; arc.part < parts; ++arc.part, arc.before += 1) shape.arcs.push_back(arc);
    shape.arcs_to.push_back(shape.arcs.size());
    from = section.disks[i];
  }
}

Channel ChannelIn(const RodArc& arc, const Route& route, double L) {
  const auto disk = static_cast<std::size_t>(arc.disk);
  const double wider = (route.radius[disk] - route.radius[disk - 1]) / arc.parts;
  const double turned = (route.angle[disk] - route.angle[disk - 1]) / arc.parts;
  const double radius = route.radius[disk - 1] + arc.part * wider;
  Channel channel;
  channel.start = arc.start();
  channel.radius = radius / L;
  channel.angle = route.angle[disk - 1] + arc.part * turned;
  channel.widens = wider / L * arc.per_rod;
  channel.turns = turned * arc.per_rod;
  channel.parallel = channel.widens == 0 && (channel.turns == 0 || channel.radius == 0);
  channel.hole = {radius * std::cos(channel.angle) / L, radius * std::sin(channel.angle) / L};
  return channel;
}

bool Bends(const Channel& before, const Channel& after) {
  constexpr double kStraightOn = 1e-12;
  const Eigen::Vector2d a = before.At(after.start).slope, b = after.At(after.start).slope;
  return (a - b).norm() > kStraightOn;
}

}  // namespace

RodShape::RodShape(const Robot& robot, bool cut) {
  double start = 0;
  for (const Section& section : robot.Sections()) {
    AddArcs(robot, section, start, cut, *this);
    start += section.length();
  }
  for (std::size_t i = 1; i < arcs.size(); ++i) {
    arcs[i].jump =
        arcs[i].stiffness != arcs[i - 1].stiffness || arcs[i].natural != arcs[i - 1].natural;
  }
  channels.resize(static_cast<std::size_t>(robot.tendons) * arcs.size());
  for (int k = 0; k < robot.tendons; ++k) {
    const Route route = robot.RouteOf(k);
    ends.push_back(ArcsTo(route.end()));
    Channel* const channel = &channels[static_cast<std::size_t>(k) * arcs.size()];
    for (std::size_t i = 0; i < ends.back(); ++i) {
      channel[i] = ChannelIn(arcs[i], route, robot.length);
      if (i > 0 && Bends(channel[i - 1], channel[i])) arcs[i].jump = true;
    }
    if (ends.back() < arcs.size()) arcs[ends.back()].jump = true;
  }
}

double RodShape::RestLength(std::size_t tendon, std::size_t arc, double from, double to) const {
  if (arc >= ends[tendon]) return 0;
  if (At(tendon, arc).parallel && arcs[arc].natural.isZero(0)) return to - from;
  const auto along = [&](double s) {
    return Along(At(tendon, arc).At(s), arcs[arc].natural).norm();
  };
  return (to - from) / 6 * (along(from) + 4 * along((from + to) / 2) + along(to));
}

double RodShape::RestLength(std::size_t tendon) const {
  constexpr int kParts = 64;  // of an arc
  double length = 0;
  for (std::size_t arc = 0; arc < ends[tendon]; ++arc) {
    const double part = arcs[arc].length() / kParts;
    for (int i = 0; i < kParts; ++i) {
      const double from = arcs[arc].start() + i * part;
      length += RestLength(tendon, arc, from, from + part);
    }
  }
  return length;
}

int CountArcs(const Robot& robot) { return static_cast<int>(RodShape(robot).arcs.size()); }

Eigen::VectorXd RestLengths(const Robot& robot) {
  if (!robot.has_sections()) return Eigen::VectorXd::Constant(robot.tendons, robot.length);
  const RodShape shape(robot);
  Eigen::VectorXd lengths(robot.tendons);
  for (Eigen::Index k = 0; k < lengths.size(); ++k) {
    lengths[k] = robot.length * shape.RestLength(static_cast<std::size_t>(k));
  }
  return lengths;
}

UnitRod::UnitRod(const Robot& robot, const Loads& loads, bool with_friction, bool all)
    : shape(std::make_shared<const RodShape>(robot)),
      mu(with_friction ? loads.mu : 0),
      friction(with_friction && (loads.mu > 0 || all)) {
  const double unit = robot.length / robot.moment();  // L^2/EI
  for (int k = 0; k < robot.tendons; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (loads.tension[i] == 0 && !all) continue;
    tendon.push_back(k);
    pull.push_back(unit * loads.tension[i]);
    direction.push_back(loads.direction[i]);
  }
  SetForces(robot, loads);
}

// Of an arc: forces at the disks beyond it, and what other sections beyond weigh more than its own
// rod would.
void UnitRod::SetForces(const Robot& robot, const Loads& loads) {
  const double unit = robot.length / robot.moment();
  beyond.resize(3, arcs());
  weight.resize(3, arcs());
  Vector3d after = unit * loads.tip_force;  // of all disks of the sections beyond
  int arc = arcs();
  const std::vector<Section> sections = robot.Sections();
  for (auto s = sections.size(); s-- > 0;) {
    const Section& section = sections[s];
    Vector3d more = Vector3d::Zero();
    for (auto other = s + 1; other < sections.size(); ++other) {
      more += unit * (sections[other].mass_per_length - section.mass_per_length) *
              sections[other].length() * loads.gravity;
    }
    const Vector3d disk = unit * section.disk_mass * loads.gravity;
    const auto disks = static_cast<int>(section.disks.size());
    for (int i = 1; i <= disks; ++i) {
      do {
        --arc;
        weight.col(arc) = unit * section.mass_per_length * robot.length * loads.gravity;
        beyond.col(arc) = after + i * disk + more;
      } while (Arc(arc).part > 0);
    }
    after += disks * disk;
  }
  Vector3d sum = Vector3d::Zero();
  for (Eigen::Index i = loads.disk_force.cols(); i-- > 0;) {
    sum += unit * loads.disk_force.col(i);
    const auto from = shape->ArcsTo(static_cast<int>(i)),
               to = shape->ArcsTo(static_cast<int>(i) + 1);
    for (auto at = from; at < to; ++at) beyond.col(static_cast<Eigen::Index>(at)) += sum;
  }
  if (loads.disk_moment.cols() > 0) moment.setZero(3, arcs());
  for (Eigen::Index i = 0; i < loads.disk_moment.cols(); ++i) {
    const auto last = shape->ArcsTo(static_cast<int>(i) + 1) - 1;
    moment.col(static_cast<Eigen::Index>(last)) = loads.disk_moment.col(i) / robot.moment();
  }
}

int UnitRod::ArcAt(double s) const {
  const auto& all = shape->arcs;
  const auto after = std::upper_bound(
      all.begin(), all.end(), s, [](double at, const RodArc& arc) { return at < arc.start(); });
  return std::max(0, static_cast<int>(after - all.begin()) - 1);
}

void UnitRod::ShareMoments(UnitRod& other) {
  if (has_moments() && !other.has_moments()) other.moment.setZero(3, arcs());
  if (!has_moments() && other.has_moments()) moment.setZero(3, arcs());
}

void UnitRod::Mix(const UnitRod& from, const UnitRod& to, double share) {
  const double rest = 1 - share;
  for (std::size_t k = 0; k < pull.size(); ++k) pull[k] = rest * from.pull[k] + share * to.pull[k];
  beyond = rest * from.beyond + share * to.beyond;
  weight = rest * from.weight + share * to.weight;
  moment = rest * from.moment + share * to.moment;
}

UnitRod UnitRod::Unloaded() const {
  UnitRod none = *this;
  none.pull.assign(pull.size(), 0);
  none.beyond.setZero();
  none.weight.setZero();
  none.moment.setZero();
  return none;
}

}  // namespace continuum::tdcr
