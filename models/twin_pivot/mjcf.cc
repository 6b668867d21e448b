#include "models/twin_pivot/mjcf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "error.h"
#include "models/mjcf/mjcf_builder.h"
#include "models/mjcf/slow_pull.h"
#include "sim/io/decimal.h"

namespace continuum::twin_pivot {
namespace {

constexpr double kStep = 2e-4, kLargestTension = 100, kLargestForce = 10;
constexpr ModalLimit kPace{500, 0.01};

// What is only drawn, and the disc's own inertia.
constexpr double kDiscRadius = 8e-3, kRodRadius = 0.4e-3, kRodApart = 3e-3, kLead = 10e-3;

const char* const kComment =
    "Written by: continuum make models/twin_pivot/a.yaml. Values, their sources and "
    "conventions: a.yaml and README.md. Armature and damping of the joints pace it for statics";

// Point masses and a disc as one body.
class Lump {
 public:
  void Add(double mass, const Point& at, const Point& own = {}) {
    mass_ += mass;
    for (int i = 0; i < 3; ++i) {
      first_[i] += mass * at[i];
      second_[i] += mass * at[i] * at[i];
      own_[i] += own[i];
    }
  }
  void Give(Mjcf& mjcf, mjsBody* body) const {
    if (!(mass_ > 0)) return mjcf.SetMovingInertia(body, 0, {0, 0, 0}, {0, 0, 0});
    Point centre, spread, moments;
    for (int i = 0; i < 3; ++i) {
      centre[i] = first_[i] / mass_;
      spread[i] = second_[i] - mass_ * centre[i] * centre[i];
    }
    for (int i = 0; i < 3; ++i) moments[i] = own_[i] + spread[(i + 1) % 3] + spread[(i + 2) % 3];
    mjcf.SetMovingInertia(body, mass_, centre, moments);
  }

 private:
  double mass_ = 0;
  Point first_{}, second_{}, own_{};
};

class Builder {
 public:
  explicit Builder(const Robot& robot)
      : robot_(robot),
        links_(robot.Links()),
        mjcf_("twin_pivot", kComment),
        holes_(robot.Cables()) {}

  std::string Build() {
    mjcf_.spec().option.timestep = kStep;
    mjcf_.spec().option.integrator = mjINT_IMPLICITFAST;
    mjcf_.spec().option.gravity[0] = robot_.gravity.x();
    mjcf_.spec().option.gravity[1] = -robot_.gravity.z();
    mjcf_.spec().option.gravity[2] = robot_.gravity.y();
    AddScene();
    mjsBody* body = AddBase();
    for (int m = 1; m <= robot_.Joints(); ++m) body = AddJoint(body, m);
    AddTip(body);
    AddCables();
    const Friction& f = robot_.friction;
    return mjcf_.Text(std::vector<EffectInstance>{{"capstan",
                                                   "cable_friction",
                                                   {{"tendon", "cable*"},
                                                    {"mu", Decimal(f.c)},
                                                    {"mu1", Decimal(f.b)},
                                                    {"mu2", Decimal(f.a)}}}});
  }

 private:
  double Length() const { return robot_.Length(); }

  void AddScene() {
    mjcf_.AddMaterial("disc", {0.66F, 0.69F, 0.73F, 1}, 0.5F);
    mjcf_.AddMaterial("rod", {0.88F, 0.52F, 0.18F, 1});
    mjcf_.AddStudio(-0.8 * Length(), 0.4);
    mjcf_.AddCamera("side", {0.45 * Length(), -2.2 * Length(), 0.45 * Length()},
                    {0.45 * Length(), 0, -0.05 * Length()}, 40);
  }

  // Holes of the cables that run on at this place.
  void AddHoles(mjsBody* body, const std::string& place, double x, int disc) {
    for (int j = 0; j < robot_.Cables(); ++j) {
      if (disc > robot_.Anchor(j)) continue;
      holes_[j].push_back(fmt::format("cable{}_{}", j + 1, place));
      mjcf_.AddSite(body, holes_[j].back(), Hole(j, x), 0.3e-3);
    }
  }
  Point Hole(int j, double x) const {
    const double r = robot_.r[j], phi = robot_.phi[j];
    return {x, r * std::cos(phi), r * std::sin(phi)};
  }

  // The rods on the bending axis, between two places along x.
  void DrawRods(mjsBody* body, int m, double from, double to) {
    for (const double side : {-kRodApart, kRodApart}) {
      const double y = m % 2 ? 0 : side, z = m % 2 ? side : 0;
      mjcf_.AddCapsule(body, {from, y, z}, {to, y, z}, kRodRadius, "rod");
    }
  }

  mjsBody* AddBase() {
    mjsBody* const base = mjcf_.AddBody(mjcf_.world(), "base", {0, 0, 0});
    base->quat[0] = base->quat[1] = std::sqrt(0.5);  // Y up
    const double face = links_.front().before;
    mjcf_.AddSite(base, "base", {0, 0, 0}, 0.5e-3);
    AddHoles(base, "lead", -face - kLead, 0);
    AddHoles(base, "out0", face, 0);
    mjcf_.AddCylinder(base, {-face - kLead, 0, 0}, {face, 0, 0}, 1.1 * kDiscRadius, "disc");
    DrawRods(base, 1, face, face + links_.front().L / 6);
    return base;
  }

  // Rod m and disc m, behind the disc before, whose centre is the origin of `before`, or, from the
  // second on, L/6 + h/2 beyond it, L of rod m-1.
  mjsBody* AddJoint(mjsBody* before, int m) {
    const int section = robot_.SectionOfJoint(m - 1);
    const Link& link = links_[static_cast<std::size_t>(m - 1)];
    const double L = link.L, stub = L / 6, h = 2 * link.after, mass = robot_.m_NiTi[section];
    const double last = m == 1 ? 0 : links_[static_cast<std::size_t>(m - 2)].L / 6;
    const Point axis = m % 2 ? Point{0, 0, 1} : Point{0, -1, 0};
    const double stiffness = 2 * robot_.Stiffness(section);
    const double to_face = m == 1 ? link.before : last + 2 * link.before;
    mjsBody* const rod = mjcf_.AddBody(before, fmt::format("rod{}", m), {to_face + stub, 0, 0});
    mjcf_.AddElasticHinge(rod, fmt::format("bend{}_in", m), axis, stiffness, kPace);
    const double swing = mass * L * L / 12, roll = mass * kRodApart * kRodApart;
    mjcf_.SetMovingInertia(rod, mass, {L / 3, 0, 0},
                           {roll, swing + (m % 2 ? roll : 0), swing + (m % 2 ? 0 : roll)});
    DrawRods(rod, m, 0, 4 * stub);

    mjsBody* const disc = mjcf_.AddBody(rod, fmt::format("disc{}", m), {4 * stub, 0, 0});
    mjcf_.AddElasticHinge(disc, fmt::format("bend{}_out", m), axis, stiffness, kPace);
    AddHoles(disc, fmt::format("in{}", m), stub, m);
    AddHoles(disc, fmt::format("out{}", m), stub + h, m + 1);
    Weigh(disc, m);
    mjcf_.AddCylinder(disc, {stub, 0, 0}, {stub + h, 0, 0}, kDiscRadius, "disc");
    DrawRods(disc, m, 0, stub);
    if (m < robot_.Joints()) {
      DrawRods(disc, m + 1, stub + h, stub + h + links_[static_cast<std::size_t>(m)].L / 6);
    }
    return disc;
  }

  // Disc m, half of the cables' pieces on either side, and locks.
  void Weigh(mjsBody* disc, int m) {
    const Link& link = links_[static_cast<std::size_t>(m - 1)];
    const double near = link.L / 6, h = 2 * link.after, far = near + h;
    const double mass = robot_.m_D[robot_.SectionOfJoint(m - 1)];
    const double R2 = kDiscRadius * kDiscRadius, across = mass * (3 * R2 + h * h) / 12;
    Lump lump;
    lump.Add(mass, {near + h / 2, 0, 0}, {mass * R2 / 2, across, across});
    for (int j = 0; j < robot_.Cables(); ++j) {
      const int section = robot_.SectionOfCable(j);
      const double half = robot_.rho_cable[section] / 2;
      if (m <= robot_.Anchor(j)) lump.Add(half * link.L, Hole(j, near));
      if (m < robot_.Anchor(j)) {
        lump.Add(half * links_[static_cast<std::size_t>(m)].L, Hole(j, far));
      }
      if (m == robot_.Anchor(j)) lump.Add(robot_.m_CL[section], Hole(j, far));
    }
    lump.Give(mjcf_, disc);
  }

  void AddTip(mjsBody* last) {
    const Link& link = links_.back();
    mjsBody* const tip = mjcf_.AddBody(last, "tip", {link.L / 6 + link.after, 0, 0});
    mjcf_.SetInertia(tip, 0, {0, 0, 0}, {0, 0, 0});
    mjcf_.AddSite(tip, "tip", {0, 0, 0}, 1e-3);
  }

  void AddCables() {
    for (int j = 0; j < robot_.Cables(); ++j) {
      const std::string name = fmt::format("cable{}", j + 1);
      mjcf_.AddCable(name, holes_[j], 0.3e-3, {0.13F, 0.40F, 0.85F, 1});
      mjcf_.AddTension(name, name, kLargestTension);
    }
    mjcf_.AddForce("tip", "base", kLargestForce);
    mjcf_.AddPosition("tip_pos", "tip", "base");
  }

  const Robot& robot_;
  const std::vector<Link> links_;
  Mjcf mjcf_;
  std::vector<std::vector<std::string>> holes_;  ///< names, by cable
};

}  // namespace

std::string RobotMjcf(const Robot& robot) { return Builder(robot).Build(); }

Eigen::Vector3d PulledTip(const ModelSpec& mjcf, const Load& load) {
  if (!load.moment.isZero()) throw Error::Input("Mx, My, Mz", "no moment on the MJCF", "one");
  if (!load.on_discs.empty() || load.disc_payload.size() > 0) {
    throw Error::Input("fx_k .. payload_k", "loads at the tip of the MJCF alone", "one on a disc");
  }
  const Change payload{"body:tip", "mass", load.condition == Condition::kV ? load.payload : 0};
  const ModelAndData machine = mjcf.Build(std::span(&payload, 1));
  SlowPull pull;
  // A chain sways the slower the longer it is, with the square: what is slow for six joints swings
  // twelve, and friction keeps where they swung to.
  const double joints = static_cast<double>(machine.model->nv) / 2;
  pull.rise *= std::max(1.0, joints * joints / 36);
  pull.gravity = {load.gravity.x(), -load.gravity.z(), load.gravity.y()};
  for (std::size_t j = 0; j < load.tension.size(); ++j) {
    pull.control[fmt::format("cable{}", j + 1)] = load.tension[j];
  }
  for (int i = 0; i < 3; ++i) pull.control[std::string("tip_f") + "xyz"[i]] = load.force[i];
  Pull(machine, pull);
  const auto tip = SensedPoint(machine, "tip_pos");
  return {tip[0], tip[1], tip[2]};
}

}  // namespace continuum::twin_pivot
