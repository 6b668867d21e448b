#include "binding/segment.h"

#include <cmath>
#include <set>
#include <span>
#include <sstream>

#include "binding/actuator_type.h"

namespace continuum {
namespace {

constexpr double kAligned = 1e-9;    // of axes, whose quaternions are rounded
constexpr double kLength = 0.01;     // of a length, which may have been measured
constexpr double kVacuum = -101325;  // gauge pressure of a vacuum at sea level [Pa]

// Ids of the objects named under key, in the order given.
std::vector<int> Named(const Config& config, Place place, std::size_t count) {
  const std::string key(PlaceName(place));
  const auto names = Words(config.Get(key));
  if (names.size() != count) {
    throw Error::Input(config.Who() + ": " + key, std::to_string(count) + " names",
                       std::to_string(names.size()));
  }
  std::vector<int> ids;
  for (const std::string& word : names) {
    const std::string name = Unescaped(word);
    ids.push_back(config.Find(place, name));
    if (ids.back() < 0) {
      throw Error::Input(config.Who() + ": " + key, "no " + key + " '" + name + "' in the model");
    }
  }
  if (std::set<int>(ids.begin(), ids.end()).size() != count) {
    throw Error::Input(config.Who() + ": " + key, "different names",
                       "'" + std::string(config.Get(key)) + "'");
  }
  return ids;
}

// Bodies beyond base up to tip, in this order.
std::vector<int> Path(const mjModel& m, const Config& config, int base, int tip) {
  std::vector<int> path;
  for (int b = tip, below = tip; b != base; below = b, b = m.body_parentid[b]) {
    if (b == 0) {
      throw Error::Input(
          config.Who() + ": body",
          std::string("'") + mj_id2name(&m, mjOBJ_BODY, tip) +
              "' on a chain of bodies that begins at '" + mj_id2name(&m, mjOBJ_BODY, base) + "'",
          std::string("one that begins at '") + mj_id2name(&m, mjOBJ_BODY, below) + "'");
    }
    path.insert(path.begin(), b);
  }
  return path;
}

std::string Listed(std::span<const double> numbers) {
  std::ostringstream out;
  for (const double x : numbers) out << (out.tellp() > 0 ? " " : "") << x;
  return "'" + out.str() + "'";
}

bool HasGear(const mjModel& m, int actuator) {
  const double* const gear = m.actuator_gear + 6 * actuator;
  return std::any_of(gear, gear + 6, [](double g) { return g != 0; });
}

void CheckSupply(const std::string& where, const char* range, bool limited, const double* limits) {
  if (!limited || (limits[0] >= kVacuum && std::isfinite(limits[1]))) return;
  throw Error::Input(where, std::string(range) + " of finite gauge pressures from -101325 Pa on",
                     std::to_string(limits[0]) + " " + std::to_string(limits[1]));
}

// Pressure is the control times a gain, later by a lag.
void CheckLine(const std::string& where, const mjModel& m, int a) {
  const int dynamics = m.actuator_dyntype[a];
  if (dynamics != mjDYN_NONE && dynamics != mjDYN_FILTER && dynamics != mjDYN_FILTEREXACT) {
    throw Error::Input(where,
                       "dyntype none, filter or filterexact, because its control is a pressure",
                       ActuatorType(m.actuator_gaintype[a], m.actuator_biastype[a], dynamics));
  }
  const double gain = m.actuator_gainprm[mjNGAIN * a], bias = m.actuator_biasprm[mjNBIAS * a],
               lag = m.actuator_dynprm[mjNDYN * a];
  if (gain >= 0 && lag >= 0 && std::isfinite(gain + bias + lag)) return;
  throw Error::Input(where, "a finite gain and lag from 0 on and a finite bias",
                     std::to_string(gain) + " " + std::to_string(lag) + " " + std::to_string(bias));
}

void CheckDirection(const mjModel& m, const Config& config, int body, const double* step) {
  if (step[2] >= -kAligned) return;
  const char* const name = mj_id2name(&m, mjOBJ_BODY, body);
  throw Error::Input(config.Who() + ": body '" + (name ? name : std::to_string(body)) + "'",
                     "a place beyond its parent along the z axis of the base body",
                     Listed({step, 3}) + " from it");
}

}  // namespace

Chain::Chain(const mjModel& m, const Config& config) {
  const auto ends = Named(config, Place::kBody, 2);
  links_.push_back({ends[0], {1, 0, 0}, {0, 1, 0}});
  double to_base[4] = {1, 0, 0, 0}, tip[3] = {0, 0, 0};
  for (const int body : Path(m, config, ends[0], ends[1])) {
    double turned[4], back[4], step[3];
    mju_rotVecQuat(step, m.body_pos + 3 * body, to_base);
    CheckDirection(m, config, body, step);
    mju_addTo3(tip, step);
    mju_mulQuat(turned, to_base, m.body_quat + 4 * body);
    mju_copy4(to_base, turned);
    for (int j = 0; j < m.body_jntnum[body]; ++j) {
      AddJoint(m, config, m.body_jntadr[body] + j, to_base);
    }
    Link link{body, {}, {}};
    mju_negQuat(back, to_base);
    mju_rotVecQuat(link.x.data(), links_[0].x.data(), back);
    mju_rotVecQuat(link.y.data(), links_[0].y.data(), back);
    links_.push_back(link);
  }
  if (joints_.empty()) throw Error::Input(config.Who() + ": body", "joints between them", "none");
  length_ = mju_norm3(tip);
  if (tip[2] > kAligned) return;
  throw Error::Input(config.Who() + ": body", "a tip that is beyond its base along the base's z",
                     "one at " + Listed(tip));
}

void Chain::RequireLength(const Config& config, std::string_view key, double length) const {
  if (config.Get(key).empty() || std::abs(length - length_) <= kLength * length_) return;
  throw Error::Input(
      config.Who() + ": " + std::string(key),
      "the length of the chain at rest, " + std::to_string(length_) + " m, within 1 %",
      "'" + std::string(config.Get(key)) + "'");
}

// Chains of the same law in series share a body, not a joint.
void Chain::RequireItsOwn(const mjModel& m, const Config& config) const {
  for (int i = 0; i < config.instance(); ++i) {
    if (m.plugin[i] != m.plugin[config.instance()]) continue;
    const Config other(m, i);
    for (const Joint& theirs : Chain(m, other).joints_) {
      for (const Joint& ours : joints_) {
        if (ours.dof != theirs.dof) continue;
        throw Error::Input(config.Who() + ": body", "a chain that no other instance acts on",
                           "'" + std::string(config.Get("body")) + "', of which " + other.Who() +
                               " has '" + std::string(other.Get("body")) + "'");
      }
    }
  }
}

void Chain::AddJoint(const mjModel& m, const Config& config, int id, const double* to_base) {
  double axis[3];
  mju_rotVecQuat(axis, m.jnt_axis + 3 * id, to_base);
  Joint joint{m.jnt_qposadr[id], m.jnt_dofadr[id], 0, 0, 0};
  const bool hinge = m.jnt_type[id] == mjJNT_HINGE && std::abs(axis[2]) < kAligned;
  const bool slide = m.jnt_type[id] == mjJNT_SLIDE && std::abs(axis[2]) > 1 - kAligned;
  if (!hinge && !slide) {
    const char* const name = mj_id2name(&m, mjOBJ_JOINT, id);
    throw Error::Input(config.Who() + ": joint '" + (name ? name : std::to_string(id)) + "'",
                       "a hinge across or a slide along the z axis of the base body",
                       std::string(JointType(m.jnt_type[id])) + " along " + Listed(axis));
  }
  if (hinge) {
    joint.u = axis[1];
    joint.v = -axis[0];
  } else {
    joint.l = axis[2];
  }
  joints_.push_back(joint);
}

Vec<double, 3> Chain::Sum(const double* q, const double* rest, int Joint::*index,
                          double ref) const {
  Vec<double, 3> sum{};
  for (const Joint& joint : joints_) {
    const double x = q[joint.*index] - (rest ? rest[joint.*index] : 0);
    sum[0] += ref * joint.u * x;
    sum[1] += ref * joint.v * x;
    sum[2] += joint.l * x;
  }
  return sum;
}

Vec<double, 3> Chain::Positions(const mjModel& m, const mjData& d, double reference) const {
  return Sum(d.qpos, m.qpos0, &Joint::qpos, reference);
}

Vec<double, 3> Chain::Velocities(const mjData& d, double reference) const {
  return Sum(d.qvel, nullptr, &Joint::dof, reference);
}

void Chain::Add(const Vec<double, 3>& on, double reference, std::span<double> force) const {
  for (const Joint& joint : joints_) {
    force[joint.dof] += reference * (joint.u * on[0] + joint.v * on[1]) + joint.l * on[2];
  }
}

void Chain::PutSums(LawSlopes& slopes) const {
  using Kind = Number::Kind;
  for (const Joint& joint : joints_) {
    const double part[3] = {joint.u, joint.v, joint.l};
    for (int i = 0; i < 3; ++i) {
      if (part[i] == 0) continue;
      slopes.forces.push_back({{Kind::kScratch, i}, {Kind::kPosition, joint.dof}, part[i]});
      slopes.forces.push_back({{Kind::kScratch, 3 + i}, {Kind::kSpeed, joint.dof}, part[i]});
    }
  }
}

void Chain::PutForces(LawSlopes& slopes) const {
  using Kind = Number::Kind;
  for (const Joint& joint : joints_) {
    const double part[3] = {joint.u, joint.v, joint.l};
    for (int i = 0; i < 3; ++i) {
      if (part[i] != 0)
        slopes.forces.push_back({{Kind::kForce, joint.dof}, {Kind::kScratch, 6 + i}, part[i]});
    }
  }
}

void Chain::Link::Point(const mjData& d, const Vec<double, 2>& at, double* world) const {
  double local[3];
  for (int i = 0; i < 3; ++i) local[i] = at[0] * x[i] + at[1] * y[i];
  mju_mulMatVec3(world, d.xmat + 9 * body, local);
  mju_addTo3(world, d.xpos + 3 * body);
}

Vec<int, 3> MatchChambers(const mjModel& m, const Config& config) {
  const auto ids = Named(config, Place::kActuator, 3);
  for (const int a : ids) {
    const std::string where =
        config.Who() + ": actuator '" + mj_id2name(&m, mjOBJ_ACTUATOR, a) + "'";
    if (HasGear(m, a)) {
      throw Error::Input(where, "gear=\"0\", because its force is a pressure",
                         Listed({m.actuator_gear + 6 * a, 6}));
    }
    CheckSupply(where, "a ctrlrange", m.actuator_ctrllimited[a], m.actuator_ctrlrange + 2 * a);
    CheckSupply(where, "a forcerange", m.actuator_forcelimited[a], m.actuator_forcerange + 2 * a);
    CheckLine(where, m, a);
  }
  return {ids[0], ids[1], ids[2]};
}

double ChamberPressure(const mjModel& m, const mjData& d, int actuator) {
  const double force = d.actuator_force[actuator];
  if (!m.actuator_forcelimited[actuator]) return force;
  const double* const range = m.actuator_forcerange + 2 * actuator;
  return std::clamp(force, range[0], range[1]);
}

void DrawChamber(const mjModel& m, const mjData& d, const Chain& chain, const Vec<double, 2>& at,
                 double area, int actuator, mjvScene& scene) {
  const double full =
      m.actuator_ctrllimited[actuator] ? m.actuator_ctrlrange[2 * actuator + 1] : 1e5;
  const float x = static_cast<float>(std::clamp(ChamberPressure(m, d, actuator) / full, 0.0, 1.0));
  const float rgba[4] = {0.13f + 0.80f * x, 0.40f - 0.25f * x, 0.85f - 0.75f * x, 1};
  const double radius = std::sqrt(area / mjPI);
  const std::size_t last = chain.links().size() - 1;
  bool first = true;
  double from[3], to[3];
  chain.links()[0].Point(d, at, from);
  for (std::size_t k = 1; k <= last && scene.ngeom < scene.maxgeom; ++k) {
    chain.links()[k].Point(d, at, to);
    double end[3], along[3];
    mju_copy3(end, to);
    mju_sub3(along, to, from);
    const double length = mju_normalize3(along);
    if (first && length < radius && k < last) continue;  // no room for its round end
    if (first) mju_addToScl3(from, along, radius);
    if (k == last) mju_addToScl3(to, along, -std::min(radius, 0.95 * length));
    mjvGeom* const geom = scene.geoms + scene.ngeom++;
    mjv_initGeom(geom, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, rgba);
    mjv_connector(geom, mjGEOM_CAPSULE, radius, from, to);
    geom->objtype = mjOBJ_ACTUATOR;
    geom->objid = actuator;
    geom->category = mjCAT_DECOR;
    mju_copy3(from, end);
    first = false;
  }
}

}  // namespace continuum
