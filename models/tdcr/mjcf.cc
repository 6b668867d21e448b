#include "models/tdcr/mjcf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <vector>

#include "error.h"
#include "models/mjcf/mjcf_builder.h"
#include "models/mjcf/slow_pull.h"
#include "models/tdcr/unit_rod.h"
#include "sim/io/decimal.h"

namespace continuum::tdcr {
namespace {

constexpr double kStep = 1e-3, kLead = 5e-3, kLargestTension = 20, kLargestForce = 5, kRim = 1.5e-3;
constexpr ModalLimit kPace{200, 0.02};
constexpr double kDiskThickness = 2e-3;
constexpr double kMostBend = 10;  // rad that a tendon alone may bend the rod by

const char* const kComment =
    "Written by: continuum make {0}{1}{2}. Values, their sources and "
    "conventions: {1} and README.md. Armature and damping of the joints pace it for statics";

// Of tendons that end in the first section, the second, ..
constexpr Colour kTendons[] = {
    {0.13F, 0.40F, 0.85F, 1}, {0.80F, 0.22F, 0.20F, 1}, {0.16F, 0.58F, 0.30F, 1}};

const char* Variant(Guides guides, Loaded loaded) {
  if (guides == Guides::kDisks) return " --variant disks";
  return loaded == Loaded::kDisks ? " --variant loads" : "";
}

class Builder {
 public:
  Builder(const Robot& robot, int links, Guides guides, const std::string& name, Loaded loaded)
      : robot_(robot),
        links_(links),
        per_arc_(links / robot.disks),
        guides_(guides),
        loaded_(loaded),
        sections_(robot.Sections()),
        mjcf_("tdcr",
              fmt::format(fmt::runtime(kComment), robot.has_sections() ? "" : "models/tdcr/", name,
                          Variant(guides, loaded))),
        holes_(static_cast<std::size_t>(robot.tendons)) {
    for (std::size_t s = 0; s < sections_.size(); ++s) {
      section_.insert(section_.end(), sections_[s].disks.size(), s);
    }
    for (int k = 0; k < robot.tendons; ++k) routes_.push_back(robot.RouteOf(k));
    if (links < robot.disks || links % robot.disks != 0) {
      throw Error::Input("links", fmt::format("a multiple of the {} disks", robot.disks),
                         std::to_string(links));
    }
  }

  std::string Build() {
    mjcf_.spec().option.timestep = kStep;
    mjcf_.spec().option.integrator = mjINT_IMPLICITFAST;
    mjcf_.spec().option.gravity[0] = robot_.gravity.x();
    mjcf_.spec().option.gravity[1] = -robot_.gravity.y();
    mjcf_.spec().option.gravity[2] = -robot_.gravity.z();
    AddScene();
    mjsBody* body = AddBase();
    for (int i = 1; i <= links_; ++i) body = AddLink(body, i);
    mjsBody* const tip = mjcf_.AddBody(body, "tip", {0, 0, Piece(links_) / 2});
    mjcf_.SetInertia(tip, 0, {0, 0, 0}, {0, 0, 0});
    mjcf_.AddSite(tip, "tip", {0, 0, 0}, 1e-3);
    AddTendons();
    return mjcf_.Text(std::vector<EffectInstance>{
        {"capstan", "cable_friction", {{"tendon", "cable*"}, {"mu", Decimal(robot_.mu)}}}});
  }

 private:
  // Pieces count from 1, as the links that begin in their middles.
  int ArcOf(int piece) const { return std::min((piece - 1) / per_arc_, robot_.disks - 1); }
  double Piece(int piece) const {
    if (!robot_.has_sections()) return robot_.length / links_;
    const int arc = ArcOf(piece);
    return (robot_.Place(arc + 1) - robot_.Place(arc)) / per_arc_;
  }
  const Section& Of(int piece) const {
    return sections_[section_[static_cast<std::size_t>(ArcOf(piece))]];
  }
  bool HasDisk(int link) const { return link % per_arc_ == 0; }
  // Of disk 0 .. n.
  double DiskRadius(int disk) const {
    const Section& section = Of(std::max(1, disk * per_arc_));
    if (section.disk_radius > 0) return section.disk_radius;
    double radius = 0;
    for (const Route& route : routes_) {
      if (disk <= route.end())
        radius = std::max(radius, route.radius[static_cast<std::size_t>(disk)]);
    }
    return std::max(radius, section.diameter / 2) + kRim;
  }
  // Of a tendon where a piece ends (0: at the base), and `ahead` [m] beyond along the tendon.
  Eigen::Vector2d Hole(std::size_t tendon, int piece, double ahead) const {
    if (!robot_.has_sections()) return robot_.Hole(static_cast<int>(tendon));
    const ChannelPoint at = piece == 0 ? shape_.At(tendon, 0).At(0) : EndOf(tendon, piece);
    return robot_.length * at.a + ahead * at.slope;
  }
  ChannelPoint EndOf(std::size_t tendon, int piece) const {
    const auto arc = static_cast<std::size_t>(ArcOf(piece));
    const RodArc& rod = shape_.arcs[arc];
    const double within = static_cast<double>(piece - ArcOf(piece) * per_arc_) / per_arc_;
    return shape_.At(tendon, arc).At(rod.start() + within * rod.length());
  }

  void AddScene() {
    mjcf_.AddMaterial("disk", {0.66F, 0.69F, 0.73F, 1}, 0.5F);
    mjcf_.AddMaterial("rod", {0.88F, 0.52F, 0.18F, 1});
    mjcf_.AddMaterial("mount", {0.32F, 0.35F, 0.40F, 1});
    const double L = robot_.length;
    mjcf_.AddStudio(-1.2 * L, 0.4);
    mjcf_.spec().visual.map.shadowscale = 0.3F;  // of the light's cone: thin tendons
    mjcf_.AddCamera("side", {0, -2.3 * L, 0}, {0, 0, -0.5 * L}, 35);
  }

  // `ahead` [m] beyond the end of a piece.
  void AddHoles(mjsBody* body, const std::string& place, int piece, double z, double ahead = 0) {
    for (std::size_t k = 0; k < routes_.size(); ++k) {
      if (piece > routes_[k].end() * per_arc_) continue;
      auto& names = holes_[k];
      names.push_back(fmt::format("cable{}_{}", k + 1, place));
      const Eigen::Vector2d hole = Hole(k, piece, ahead);
      mjcf_.AddSite(body, names.back(), {hole.x(), hole.y(), z + ahead}, 0.3e-3);
    }
  }
  void DrawDisk(mjsBody* body, int disk, double z, const std::string& material) {
    const double half = kDiskThickness / 2;
    mjcf_.AddCylinder(body, {0, 0, z - half}, {0, 0, z + half}, DiskRadius(disk), material);
  }

  mjsBody* AddBase() {
    mjsBody* const base = mjcf_.AddBody(mjcf_.world(), "base", {0, 0, 0});
    base->quat[0] = 0, base->quat[1] = 1;  // half a turn about x
    mjcf_.AddSite(base, "base", {0, 0, 0}, 0.5e-3);
    if (guides_ == Guides::kLinks) AddHoles(base, "lead", 0, 0, -kLead);
    AddHoles(base, "0", 0, 0);
    DrawDisk(base, 0, 0, "mount");
    mjcf_.AddCapsule(base, {0, 0, 0}, {0, 0, Piece(1) / 2}, Of(1).diameter / 2, "rod");
    return base;
  }

  mjsBody* AddLink(mjsBody* parent, int i) {
    const double l = Piece(i), length = i < links_ ? (l + Piece(i + 1)) / 2 : l / 2;
    const Section& section = Of(i);
    mjsBody* const link = mjcf_.AddBody(parent, fmt::format("link{}", i),
                                        {0, 0, i == 1 ? l / 2 : (Piece(i - 1) + l) / 2});
    const Eigen::Vector3d u = section.natural;
    for (const auto& [axis, at, rest] :
         {std::tuple{'x', Point{1, 0, 0}, -u.y()}, {'y', Point{0, 1, 0}, u.x()}}) {
      mjcf_.AddElasticHinge(link, fmt::format("bend{}_{}", i, axis), at, section.EI / l, kPace,
                            rest * l);
    }
    mjcf_.AddElasticHinge(link, fmt::format("twist{}", i), {0, 0, 1}, section.GJ / l, kPace,
                          u.z() * l);
    Weigh(link, i, length);
    mjcf_.AddCapsule(link, {0, 0, 0}, {0, 0, length}, section.diameter / 2, "rod");
    if (HasDisk(i) || guides_ == Guides::kLinks) AddHoles(link, std::to_string(i), i, l / 2);
    if (HasDisk(i)) DrawDisk(link, i / per_arc_, l / 2, "disk");
    if (HasDisk(i) && loaded_ == Loaded::kDisks) {
      mjcf_.AddSite(link, fmt::format("disk{}", i / per_arc_), {0, 0, l / 2}, 0.5e-3);
    }
    return link;
  }

  // A piece of thin rod, its mass spread evenly, and the disk on it, both about their common
  // centre.
  void Weigh(mjsBody* link, int i, double length) {
    const Section& section = Of(i);
    const double rod = i < links_ ? RodMass(i, length) : section.mass_per_length * length;
    const double disk = HasDisk(i) ? section.disk_mass : 0, mass = rod + disk;
    if (!(mass > 0)) return mjcf_.SetMovingInertia(link, 0, {0, 0, 0}, {0, 0, 0});
    const double centre = (rod * length + disk * Piece(i)) / (2 * mass);
    const double apart = (Piece(i) - length) / 2, reduced = rod * disk / mass;
    const double d2 = section.diameter * section.diameter;
    const double R2 = std::pow(DiskRadius(i / per_arc_), 2);
    const double across = rod * (length * length / 12 + d2 / 16) + disk * R2 / 4;
    const double bend = across + reduced * apart * apart, roll = rod * d2 / 8 + disk * R2 / 2;
    mjcf_.SetMovingInertia(link, mass, {0, 0, centre}, {bend, bend, roll});
  }

  // From the middle of a piece to that of the next.
  double RodMass(int i, double length) const {
    const double own = Of(i).mass_per_length, next = Of(i + 1).mass_per_length;
    return own == next ? own * length : (own * Piece(i) + next * Piece(i + 1)) / 2;
  }

  void AddTendons() {
    const double most = robot_.has_sections() ? kMostBend * robot_.tension() : 0;
    for (std::size_t k = 0; k < routes_.size(); ++k) {
      const std::string name = fmt::format("cable{}", k + 1);
      const std::size_t end = section_[static_cast<std::size_t>(routes_[k].end()) - 1];
      mjcf_.AddCable(name, holes_[k], 0.4e-3, kTendons[end % std::size(kTendons)]);
      mjcf_.AddTension(name, name, std::max(kLargestTension, std::ceil(most)));
    }
    AddLoads();
    mjcf_.AddPosition("tip_pos", "tip", "base");
  }

  void AddLoads() {
    mjcf_.AddForce("tip", "base", kLargestForce);
    if (loaded_ == Loaded::kTip) return;
    const double moment = kMostBend * robot_.moment();
    for (int i = 1; i <= robot_.disks; ++i) {
      const std::string site = fmt::format("disk{}", i);
      mjcf_.AddForce(site, "base", kLargestForce);
      mjcf_.AddMoment(site, "base", moment);
    }
  }

  const Robot& robot_;
  int links_, per_arc_;
  Guides guides_;
  Loaded loaded_;
  std::vector<Section> sections_;
  std::vector<std::size_t> section_;  ///< of the arcs
  std::vector<Route> routes_;
  RodShape shape_{robot_, false};
  Mjcf mjcf_;
  std::vector<std::vector<std::string>> holes_;  ///< names, by tendon
};

}  // namespace

std::string RobotMjcf(const Robot& robot, int links, Guides guides, const std::string& name,
                      Loaded loaded) {
  return Builder(robot, links, guides, name, loaded).Build();
}

namespace {

// Controls of dead loads at the disks, 3 x n; none where there are none.
void AddControls(const Eigen::Matrix3Xd& loads, char letter, SlowPull& pull) {
  for (Eigen::Index i = 0; i < loads.cols(); ++i) {
    if (loads.col(i).isZero(0)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      pull.control[fmt::format("disk{}_{}{}", i + 1, letter, "xyz"[axis])] = loads(axis, i);
    }
  }
}

}  // namespace

Eigen::Vector3d PulledTip(const ModelSpec& mjcf, const Loads& loads) {
  const Change friction{"plugin:cable_friction", "mu", loads.mu};
  const ModelAndData machine = mjcf.Build(std::span(&friction, 1));
  SlowPull pull;
  pull.gravity = {loads.gravity.x(), -loads.gravity.y(), -loads.gravity.z()};
  for (std::size_t k = 0; k < loads.tension.size(); ++k) {
    pull.control[fmt::format("cable{}", k + 1)] = loads.tension[k];
  }
  for (int i = 0; i < 3; ++i) pull.control[std::string("tip_f") + "xyz"[i]] = loads.tip_force[i];
  AddControls(loads.disk_force, 'f', pull);
  AddControls(loads.disk_moment, 'm', pull);
  Pull(machine, pull);
  const auto tip = SensedPoint(machine, "tip_pos");
  return {tip[0], tip[1], tip[2]};
}

}  // namespace continuum::tdcr
