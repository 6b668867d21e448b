#include "models/mjcf/tendon_arm.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "error.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

constexpr double kLargest = 1e9;

Point ReadPoint(const Yaml& y) {
  const std::vector<double> p = y.Parameters();
  if (p.size() != 3) throw Error::Input(y.Where(), "three numbers", std::to_string(p.size()));
  return {p[0], p[1], p[2]};
}

TendonArm::Segment ReadSegment(const Yaml& y) {
  y.Only({"length", "links", "EI", "plate_mass", "pretension", "marker"});
  TendonArm::Segment s;
  s.length = y.At("length").Parameter(1e-4, 100);
  s.links = static_cast<int>(std::lround(y.At("links").Parameter()));
  if (s.links < 1 || s.links > 200)
    throw Error::Input(y.At("links").Where(), "1 to 200 links", std::to_string(s.links));
  s.EI = y.At("EI").Parameter(1e-12, kLargest);
  s.plate_mass = y.At("plate_mass").Parameter(0, kLargest);
  s.pretension = y.At("pretension").Parameter(-kLargest, kLargest);
  s.marker = ReadPoint(y.At("marker"));
  return s;
}

TendonArm::Tendon ReadTendon(const Yaml& y, int segments) {
  y.Only({"name", "segment", "azimuth", "travel"});
  TendonArm::Tendon t;
  t.name = y.At("name").Text();
  t.segment = y.At("segment").Integer();
  if (t.segment < 1 || t.segment > segments)
    throw Error::Input(y.At("segment").Where(), "a segment from 1 to " + std::to_string(segments),
                       y.At("segment").Text());
  t.azimuth = y.At("azimuth").Parameter();
  t.travel = y.At("travel").Parameter();
  return t;
}

// The arm in the making: joints and plates from the base to the tip.
class Builder {
 public:
  explicit Builder(const TendonArm& arm);
  std::string Text() const { return mjcf_.Text({}); }

 private:
  void AddScene();
  mjsBody* AddBase();
  mjsBody* AddLink(mjsBody* parent, std::size_t segment, int i);
  void AddPlate(mjsBody* body, const std::string& place, std::size_t segment, double z);
  void AddTendons();

  double Interval(std::size_t s) const { return arm_.segments[s].length / arm_.segments[s].links; }
  // From a joint to the next one, or to the end of the arm.
  double Reach(std::size_t s, int i) const {
    if (i < arm_.segments[s].links) return Interval(s);
    return Interval(s) / 2 + (s + 1 < arm_.segments.size() ? Interval(s + 1) / 2 : 0);
  }

  const TendonArm& arm_;
  Mjcf mjcf_;
  std::map<std::string, std::vector<std::string>> path_;
  int links_ = 0;
  double next_ = 0;  // from the last body's origin to the next joint
};

Builder::Builder(const TendonArm& arm)
    : arm_(arm),
      mjcf_(arm.robot, "Written by: continuum make " + arm.robot +
                           ".yaml. Values and their sources: there and README.md") {
  mjcf_.spec().option.timestep = arm.timestep;
  mjcf_.spec().option.integrator = mjINT_IMPLICITFAST;
  mjcf_.spec().option.gravity[2] = 0 - arm.gravity;  // 0, not -0
  AddScene();
  mjsBody* body = AddBase();
  for (std::size_t s = 0; s < arm.segments.size(); ++s) {
    for (int i = 1; i <= arm.segments[s].links; ++i) body = AddLink(body, s, i);
  }
  mjsBody* const tip = mjcf_.AddBody(body, "tip", {0, 0, next_});
  // Said explicitly, because MuJoCo puts the centre of a body without inertial and geoms elsewhere.
  mjcf_.SetInertia(tip, 0, {0, 0, 0}, {0, 0, 0});
  AddTendons();
}

void Builder::AddScene() {
  mjcf_.AddMaterial("plate", {0.66F, 0.69F, 0.73F, 1}, 0.5F);
  mjcf_.AddMaterial("rod", {0.88F, 0.52F, 0.18F, 1});
  mjcf_.AddMaterial("mount", {0.32F, 0.35F, 0.40F, 1});
  double length = 0;
  for (const auto& s : arm_.segments) length += s.length;
  const double middle = arm_.hangs ? -0.55 * length : 0.5 * length;
  mjcf_.AddStudio(arm_.hangs ? -1.3 * length : -0.1 * length, 1.5 * length);
  mjcf_.AddCamera("side", {0.3 * length, -3.1 * length, middle + 0.4 * length}, {0, 0, middle}, 30);
}

mjsBody* Builder::AddBase() {
  mjsSite* const frame = mjcf_.AddSite(mjcf_.world(), "frame", arm_.frame, 0.001);
  frame->group = 4;  // not drawn
  std::copy(arm_.frame_quaternion.begin(), arm_.frame_quaternion.end(), frame->quat);
  mjsBody* const base = mjcf_.AddBody(mjcf_.world(), "base", {0, 0, 0});
  const double down[] = {0, 1, 0, 0};  // half a turn about x
  if (arm_.hangs) std::copy(down, down + 4, base->quat);
  const double height = arm_.guide_radius / 2;
  mjcf_.AddCylinder(base, {0, 0, -height}, {0, 0, 0}, 1.6 * arm_.guide_radius, "mount");
  AddPlate(base, "base", 0, 0);
  next_ = Interval(0) / 2;
  mjcf_.AddCylinder(base, {0, 0, 0}, {0, 0, next_}, arm_.rod_radius, "rod");
  return base;
}

mjsBody* Builder::AddLink(mjsBody* parent, std::size_t s, int i) {
  const TendonArm::Segment& segment = arm_.segments[s];
  const std::string number = std::to_string(++links_);
  mjsBody* const link = mjcf_.AddBody(parent, "link" + number, {0, 0, next_});
  const bool last = i == segment.links;
  const double l = Interval(s), reach = Reach(s, i), K = segment.EI / l;
  const double rod = arm_.rod_mass * reach, plate = last ? segment.plate_mass : 0;
  const double mass = rod + plate, centre = (rod * reach + plate * l) / (2 * mass);
  const double across = rod * (reach * reach / 12 + std::pow(reach / 2 - centre, 2)) +
                        plate * (std::pow(arm_.guide_radius, 2) / 4 + std::pow(l / 2 - centre, 2));
  const double along =
      (plate * std::pow(arm_.guide_radius, 2) + rod * std::pow(arm_.rod_radius, 2)) / 2;
  mjcf_.SetMovingInertia(link, mass, {0, 0, centre}, {across, across, along});
  mjcf_.AddBend(link, "bend" + number + "_x", {1, 0, 0}, K, arm_.tau * K);
  mjcf_.AddBend(link, "bend" + number + "_y", {0, 1, 0}, K, arm_.tau * K);
  mjcf_.AddCapsule(link, {0, 0, 0}, {0, 0, reach}, arm_.rod_radius, "rod");
  if (last || arm_.guided_links) AddPlate(link, number, s + 1, l / 2);
  if (last) {
    const std::string name = "plate" + std::to_string(s + 1);
    const Point& m = segment.marker;
    mjcf_.AddSite(link, name, {m[0], m[1], l / 2 + m[2]}, arm_.guide_radius / 6);
    mjcf_.AddPosition(name, name, "frame");
  }
  next_ = reach;
  return link;
}

// Guides of all tendons that reach this far; the base is segment 0.
void Builder::AddPlate(mjsBody* body, const std::string& place, std::size_t segment, double z) {
  const double thick = arm_.guide_radius / 12;
  mjcf_.AddCylinder(body, {0, 0, z - thick}, {0, 0, z + thick}, 1.2 * arm_.guide_radius, "plate");
  for (const TendonArm::Tendon& t : arm_.tendons) {
    if (t.segment < static_cast<int>(segment)) continue;
    path_[t.name].push_back(t.name + "_" + place);
    mjcf_.AddSite(
        body, path_[t.name].back(),
        {arm_.guide_radius * std::cos(t.azimuth), arm_.guide_radius * std::sin(t.azimuth), z},
        arm_.guide_radius / 20);
  }
}

void Builder::AddTendons() {
  for (const TendonArm::Tendon& t : arm_.tendons) {
    double length = 0;
    for (int s = 0; s < t.segment; ++s) length += arm_.segments[s].length;
    mjcf_.AddCable(t.name, path_[t.name], arm_.guide_radius / 20, {0.13F, 0.40F, 0.85F, 1});
    mjcf_.AddDrive(
        t.name, t.name,
        {t.travel, length, arm_.stiffness, arm_.damping, arm_.segments[t.segment - 1].pretension,
         arm_.pull_only ? 0 : -arm_.largest, arm_.largest});
  }
}

}  // namespace

TendonArm ReadTendonArm(const std::filesystem::path& file) {
  const Yaml y = Yaml::Read(file);
  y.Only({"format", "robot", "segments", "tendons", "guides", "pull_only", "rod_mass", "rod_radius",
          "tau", "guide_radius", "stiffness", "damping", "largest", "timestep", "gravity", "hangs",
          "frame", "frame_quaternion"});
  TendonArm arm;
  arm.robot = y.At("robot").Text();
  for (const Yaml& s : y.At("segments").Items()) arm.segments.push_back(ReadSegment(s));
  for (const Yaml& t : y.At("tendons").Items())
    arm.tendons.push_back(ReadTendon(t, static_cast<int>(arm.segments.size())));
  const std::string guides = y.At("guides").Text();
  if (guides != "links" && guides != "plates")
    throw Error::Input(y.At("guides").Where(), "links | plates", "'" + guides + "'");
  arm.guided_links = guides == "links";
  arm.pull_only = y.At("pull_only").Bool();
  arm.rod_mass = y.At("rod_mass").Parameter(1e-9, kLargest);
  arm.rod_radius = y.At("rod_radius").Parameter(1e-6, 1);
  arm.tau = y.At("tau").Parameter(0, 100);
  arm.guide_radius = y.At("guide_radius").Parameter(1e-6, 10);
  arm.stiffness = y.At("stiffness").Parameter(0, kLargest);
  arm.damping = y.At("damping").Parameter(0, kLargest);
  arm.largest = y.At("largest").Parameter(1e-9, kLargest);
  arm.timestep = y.At("timestep").Parameter(1e-6, 0.1);
  arm.gravity = y.At("gravity").Parameter(0, 100);
  arm.hangs = y.At("hangs").Bool();
  arm.frame = ReadPoint(y.At("frame"));
  arm.frame_quaternion = y.At("frame_quaternion").Parameters();
  if (arm.frame_quaternion.size() != 4)
    throw Error::Input(y.At("frame_quaternion").Where(), "four numbers (w, x, y, z)",
                       std::to_string(arm.frame_quaternion.size()));
  return arm;
}

std::string TendonArmMjcf(const TendonArm& arm) { return Builder(arm).Text(); }

}  // namespace continuum
