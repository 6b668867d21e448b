#include "binding/pull.h"

namespace continuum {
namespace {

double StiffnessOf(const mjModel& m, int a) {
  const double gear = m.actuator_gear[6 * a];
  const double position = m.actuator_biasprm[mjNBIAS * a + 1];
  return m.actuator_biastype[a] == mjBIAS_AFFINE && position < 0 ? -position * gear * gear : 0;
}

}  // namespace

double Drive::Stiffness(const mjModel& m) const {
  double k = 0;
  for (const int a : actuators) k += StiffnessOf(m, a);
  return k;
}

double Drive::Tension(const mjModel& m, const mjData& d) const {
  double tension = 0;
  for (const int a : actuators) {
    tension -= m.actuator_gear[6 * a] * d.actuator_force[m.actuator_outadr[a]];
  }
  return tension;
}

void Drive::Add(const mjModel& m, mjData& d, double change) const {
  const double k = Stiffness(m);
  for (const int a : actuators) {
    const double share = StiffnessOf(m, a) / k;
    if (share > 0)
      d.actuator_force[m.actuator_outadr[a]] -= change * share / m.actuator_gear[6 * a];
  }
}

double Drive::Tension(const mjModel& m, const double* force) const {
  double tension = 0;
  for (const int a : actuators) tension -= m.actuator_gear[6 * a] * force[a];
  return tension;
}

void Drive::Add(const mjModel& m, double change, double* force) const {
  const double k = Stiffness(m);
  for (const int a : actuators) {
    const double share = StiffnessOf(m, a) / k;
    if (share > 0) force[a] -= change * share / m.actuator_gear[6 * a];
  }
}

void Drive::PutPull(const mjModel& m, const double* force, int first, LawSlopes& slopes) const {
  using Kind = Number::Kind;
  const Number tension{Kind::kScratch, first}, stiffness{Kind::kScratch, first + 1};
  for (const int a : actuators) {
    const double gear = m.actuator_gear[6 * a], bias = m.actuator_biasprm[mjNBIAS * a + 1];
    slopes.signals.push_back({tension, {Kind::kActuator, a}, -gear});
    slopes.signals.push_back({tension, {Kind::kGear, a}, -force[a]});
    if (StiffnessOf(m, a) == 0) continue;
    slopes.signals.push_back({stiffness, {Kind::kBias, 3 * a + 1}, -gear * gear});
    slopes.signals.push_back({stiffness, {Kind::kGear, a}, -2 * bias * gear});
  }
}

// A servo's force changes by −change s, s = −bias gear/k.
void Drive::PutChange(const mjModel& m, double change, int first, LawSlopes& slopes) const {
  using Kind = Number::Kind;
  const double k = Stiffness(m);
  for (const int a : actuators) {
    if (StiffnessOf(m, a) == 0) continue;
    const double gear = m.actuator_gear[6 * a], bias = m.actuator_biasprm[mjNBIAS * a + 1];
    const double s = -bias * gear / k;
    const Number next{Kind::kActuatorNext, a};
    slopes.signals.push_back({next, {Kind::kScratch, first + 2}, -s});
    slopes.signals.push_back({next, {Kind::kScratch, first + 1}, change * s / k});
    slopes.signals.push_back({next, {Kind::kBias, 3 * a + 1}, change * gear / k});
    slopes.signals.push_back({next, {Kind::kGear, a}, change * bias / k});
  }
}

std::vector<Drive> MatchDrives(const mjModel& m, const Config& config) {
  std::vector<Drive> drives;
  for (const int t : config.Match(Place::kTendon)) {
    Drive drive{t, {}};
    for (int a = 0; a < m.nactuator; ++a) {
      if (m.actuator_trntype[a] != mjTRN_TENDON || m.actuator_trnid[2 * a] != t) continue;
      drive.actuators.push_back(a);
    }
    drives.push_back(std::move(drive));
  }
  return drives;
}

std::string WithoutServo(const mjModel& m, std::span<const Drive> drives) {
  for (const Drive& drive : drives) {
    if (drive.Stiffness(m) > 0) continue;
    return "tendon '" + std::string(mj_id2name(&m, mjOBJ_TENDON, drive.tendon)) +
           "' is not pulled by a position servo, and a given force stays what it is";
  }
  return "";
}

}  // namespace continuum
