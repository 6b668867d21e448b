#include "models/tdcr/mjcf.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "error.h"
#include "models/mjcf/mjcf_builder.h"
#include "models/mjcf/slow_pull.h"
#include "sim/io/decimal.h"

namespace continuum::tdcr {
namespace {

constexpr double kStep = 1e-3, kLead = 5e-3, kLargestTension = 20, kLargestForce = 5;
constexpr ModalLimit kPace{200, 0.02};
constexpr double kDiskThickness = 2e-3;

const char* const kComment =
    "Written by: continuum make models/tdcr/tdcr.yaml{}. Values, their sources and "
    "conventions: tdcr.yaml and README.md. Armature and damping of the joints pace it for statics";

class Builder {
 public:
  Builder(const Robot& robot, int links, Guides guides)
      : robot_(robot),
        links_(links),
        guides_(guides),
        mjcf_("tdcr", fmt::format(fmt::runtime(kComment),
                                  guides == Guides::kLinks ? "" : " --variant disks")),
        holes_(static_cast<std::size_t>(robot.tendons)) {
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
    mjsBody* const tip = mjcf_.AddBody(body, "tip", {0, 0, Piece() / 2});
    mjcf_.SetInertia(tip, 0, {0, 0, 0}, {0, 0, 0});
    mjcf_.AddSite(tip, "tip", {0, 0, 0}, 1e-3);
    AddTendons();
    return mjcf_.Text(std::vector<EffectInstance>{
        {"capstan", "cable_friction", {{"tendon", "cable*"}, {"mu", Decimal(robot_.mu)}}}});
  }

 private:
  double Piece() const { return robot_.length / links_; }
  bool HasDisk(int link) const { return link % (links_ / robot_.disks) == 0; }
  double DiskRadius() const { return robot_.tendon_radius + 1.5e-3; }

  void AddScene() {
    mjcf_.AddMaterial("disk", {0.66F, 0.69F, 0.73F, 1}, 0.5F);
    mjcf_.AddMaterial("rod", {0.88F, 0.52F, 0.18F, 1});
    mjcf_.AddMaterial("mount", {0.32F, 0.35F, 0.40F, 1});
    const double L = robot_.length;
    mjcf_.AddStudio(-1.2 * L, 0.4);
    mjcf_.spec().visual.map.shadowscale = 0.3F;  // of the light's cone: thin tendons
    mjcf_.AddCamera("side", {0, -2.3 * L, 0}, {0, 0, -0.5 * L}, 35);
  }

  void AddHoles(mjsBody* body, const std::string& place, double z) {
    for (int k = 0; k < robot_.tendons; ++k) {
      auto& names = holes_[static_cast<std::size_t>(k)];
      names.push_back(fmt::format("cable{}_{}", k + 1, place));
      const Eigen::Vector2d hole = robot_.Hole(k);
      mjcf_.AddSite(body, names.back(), {hole.x(), hole.y(), z}, 0.3e-3);
    }
  }
  void DrawDisk(mjsBody* body, double z, const std::string& material) {
    const double half = kDiskThickness / 2;
    mjcf_.AddCylinder(body, {0, 0, z - half}, {0, 0, z + half}, DiskRadius(), material);
  }

  mjsBody* AddBase() {
    mjsBody* const base = mjcf_.AddBody(mjcf_.world(), "base", {0, 0, 0});
    base->quat[0] = 0, base->quat[1] = 1;  // half a turn about x
    mjcf_.AddSite(base, "base", {0, 0, 0}, 0.5e-3);
    if (guides_ == Guides::kLinks) AddHoles(base, "lead", -kLead);
    AddHoles(base, "0", 0);
    DrawDisk(base, 0, "mount");
    mjcf_.AddCapsule(base, {0, 0, 0}, {0, 0, Piece() / 2}, robot_.diameter / 2, "rod");
    return base;
  }

  mjsBody* AddLink(mjsBody* parent, int i) {
    const double l = Piece(), length = i < links_ ? l : l / 2;
    mjsBody* const link =
        mjcf_.AddBody(parent, fmt::format("link{}", i), {0, 0, i == 1 ? l / 2 : l});
    for (const auto& [axis, at] : {std::pair{'x', Point{1, 0, 0}}, {'y', Point{0, 1, 0}}}) {
      mjcf_.AddElasticHinge(link, fmt::format("bend{}_{}", i, axis), at, robot_.EI() / l, kPace);
    }
    mjcf_.AddElasticHinge(link, fmt::format("twist{}", i), {0, 0, 1}, robot_.GJ() / l, kPace);
    Weigh(link, i, length);
    mjcf_.AddCapsule(link, {0, 0, 0}, {0, 0, length}, robot_.diameter / 2, "rod");
    if (HasDisk(i) || guides_ == Guides::kLinks) AddHoles(link, std::to_string(i), l / 2);
    if (HasDisk(i)) DrawDisk(link, l / 2, "disk");
    return link;
  }

  // A piece of thin rod and the disk on it, both about their common centre.
  void Weigh(mjsBody* link, int i, double length) {
    const double rod = robot_.density * robot_.area() * length;
    const double disk = HasDisk(i) ? robot_.disk_mass : 0, mass = rod + disk;
    if (!(mass > 0)) return mjcf_.SetInertia(link, 0, {0, 0, 0}, {0, 0, 0});
    const double centre = (rod * length + disk * Piece()) / (2 * mass);
    const double apart = (Piece() - length) / 2, reduced = rod * disk / mass;
    const double d2 = robot_.diameter * robot_.diameter, R2 = DiskRadius() * DiskRadius();
    const double across = rod * (length * length / 12 + d2 / 16) + disk * R2 / 4;
    const double bend = across + reduced * apart * apart, roll = rod * d2 / 8 + disk * R2 / 2;
    mjcf_.SetInertia(link, mass, {0, 0, centre}, {bend, bend, roll});
  }

  void AddTendons() {
    for (int k = 0; k < robot_.tendons; ++k) {
      const std::string name = fmt::format("cable{}", k + 1);
      mjcf_.AddCable(name, holes_[static_cast<std::size_t>(k)], 0.4e-3, {0.13F, 0.40F, 0.85F, 1});
      mjcf_.AddTension(name, name, kLargestTension);
    }
    mjcf_.AddForce("tip", "base", kLargestForce);
    mjcf_.AddPosition("tip_pos", "tip", "base");
  }

  const Robot& robot_;
  int links_;
  Guides guides_;
  Mjcf mjcf_;
  std::vector<std::vector<std::string>> holes_;  ///< names, by tendon
};

}  // namespace

std::string SegmentMjcf(const Robot& robot, int links, Guides guides) {
  return Builder(robot, links, guides).Build();
}

Eigen::Vector3d PulledTip(const ModelSpec& mjcf, const Loads& loads) {
  const Change friction{"plugin:cable_friction", "mu", loads.mu};
  const ModelAndData machine = mjcf.Build(std::span(&friction, 1));
  SlowPull pull;
  pull.gravity = {loads.gravity.x(), -loads.gravity.y(), -loads.gravity.z()};
  for (std::size_t k = 0; k < loads.tension.size(); ++k) {
    pull.control[fmt::format("cable{}", k + 1)] = loads.tension[k];
  }
  for (int i = 0; i < 3; ++i) pull.control[std::string("tip_f") + "xyz"[i]] = loads.tip_force[i];
  Pull(machine, pull);
  const auto tip = SensedPoint(machine, "tip_pos");
  return {tip[0], tip[1], tip[2]};
}

}  // namespace continuum::tdcr
