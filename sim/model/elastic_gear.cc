#include "sim/model/elastic_gear.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

constexpr std::string_view kPrefix = ".gear_";
constexpr double kNothing = 1e-12;  // kg, kg m²: MuJoCo's bodies weigh something

std::string NameOf(const mjsJoint& joint) { return mjs_getString(mjs_getName(joint.element)); }

std::string Who(const mjsJoint& joint) { return "joint '" + NameOf(joint) + "'"; }

std::vector<mjsActuator*> ActuatorsOf(mjSpec& spec, const std::string& joint) {
  std::vector<mjsActuator*> all;
  for (mjsElement* e = mjs_firstElement(&spec, mjOBJ_ACTUATOR); e; e = mjs_nextElement(&spec, e)) {
    mjsActuator& a = *mjs_asActuator(e);
    if (a.trntype != mjTRN_JOINT && a.trntype != mjTRN_JOINTINPARENT) continue;
    if (mjs_getString(a.target) == joint) all.push_back(&a);
  }
  return all;
}

void RequireMotor(mjSpec& spec, const mjsJoint& joint) {
  if (joint.type != mjJNT_HINGE && joint.type != mjJNT_SLIDE)
    throw Error::Input(Who(joint), "a hinge or slide joint for an elastic gear", "another one");
  if (NameOf(joint).empty())
    throw Error::Input("an elastic gear", "a joint with a name", "one without");
  if (ActuatorsOf(spec, NameOf(joint)).empty())
    throw Error::Input(Who(joint), "an actuator that an elastic gear passes on", "none");
  if (!(joint.armature > 0))
    throw Error::Input(Who(joint) + ": armature",
                       "a positive number, the inertia of the motor of an elastic gear",
                       Decimal(joint.armature));
}

// Whether steps can show how motor and joint swing against each other.
bool IsResolved(const mjSpec& spec, const mjsJoint& joint, const mjModel& compiled, double k) {
  constexpr double kMost = 1;  // rad in a step; from two on they grow
  const int id = mj_name2id(&compiled, mjOBJ_JOINT, NameOf(joint).c_str());
  const int dof = compiled.jnt_dofadr[id];
  const double behind = std::max(kNothing, compiled.dof_M0[dof] - compiled.dof_armature[dof]);
  const double h = spec.option.timestep;
  return h * h * k * (1 / joint.armature + 1 / behind) <= kMost * kMost;
}

// A body without mass may hang anywhere: on the joint's own, its rate is a descendant's of the
// joint's, and implicit integrators know how the damper couples both.
mjsJoint& MakeMotor(const mjsJoint& joint, const std::string& name, const GearEdits& edits) {
  mjsBody& body = *mjs_addBody(mjs_getParent(joint.element), nullptr);
  edits.made(body.element);
  mjs_setName(body.element, name.c_str());
  body.explicitinertial = 1;
  body.mass = kNothing;
  std::fill_n(body.ipos, 3, 0.0), std::fill_n(body.inertia, 3, kNothing);
  mjsJoint& motor = *mjs_addJoint(&body, nullptr);
  mjs_setName(motor.element, name.c_str());
  motor.type = joint.type;
  motor.ref = joint.ref, motor.springref = joint.ref;
  std::fill_n(motor.stiffness, mjNPOLY + 1, 0.0), std::fill_n(motor.damping, mjNPOLY + 1, 0.0);
  std::fill_n(motor.springdamper, 2, 0.0);
  motor.springyield = 0, motor.frictionloss = 0;
  motor.limited = mjLIMITED_FALSE;
  motor.actfrclimited = joint.actfrclimited;
  std::copy_n(joint.actfrcrange, 2, motor.actfrcrange);
  motor.armature = joint.armature;
  return motor;
}

mjsTendon& MakeSpring(mjSpec& spec, const std::string& joint, const std::string& name,
                      const GearEdits& edits) {
  mjsTendon& spring = *mjs_addTendon(&spec, nullptr);
  edits.made(spring.element);
  mjs_setName(spring.element, name.c_str());
  std::fill_n(spring.stiffness, mjNPOLY + 1, 0.0), std::fill_n(spring.damping, mjNPOLY + 1, 0.0);
  std::fill_n(spring.springlength, 2, 0.0);
  spring.springyield = 0, spring.frictionloss = 0, spring.armature = 0;
  spring.limited = spring.actfrclimited = mjLIMITED_FALSE;
  mjs_wrapJoint(&spring, name.c_str(), 1);
  mjs_wrapJoint(&spring, joint.c_str(), -1);
  return spring;
}

// The motor's place in keyframes: after all that the joint's body carries, at the joint's angle.
void ExtendKeys(mjSpec& spec, const mjModel& compiled, int joint, const GearEdits& edits) {
  const int body = compiled.jnt_bodyid[joint];
  int last = joint;
  for (int j = joint; j < compiled.njnt; ++j) {
    int b = compiled.jnt_bodyid[j];
    while (b > body) b = compiled.body_parentid[b];
    if (b == body) last = j;
  }
  const bool end = last + 1 == compiled.njnt;
  const auto extend = [&](mjDoubleVec* all, long count, int from, long to) {
    int size = 0;
    const double* const values = mjs_getDouble(all, &size);
    if (size != count) return;
    const std::vector<double> was(values, values + size);
    edits.undo([all, was] { mjs_setDouble(all, was.data(), static_cast<int>(was.size())); });
    std::vector<double> now = was;
    now.insert(now.begin() + to, was[from]);
    mjs_setDouble(all, now.data(), size + 1);
  };
  for (mjsElement* e = mjs_firstElement(&spec, mjOBJ_KEY); e; e = mjs_nextElement(&spec, e)) {
    mjsKey& key = *mjs_asKey(e);
    extend(key.qpos, compiled.nq, compiled.jnt_qposadr[joint],
           end ? compiled.nq : compiled.jnt_qposadr[last + 1]);
    extend(key.qvel, compiled.nv, compiled.jnt_dofadr[joint],
           end ? compiled.nv : compiled.jnt_dofadr[last + 1]);
  }
}

}  // namespace

std::string GearName(const std::string& joint) { return std::string(kPrefix) + joint; }

mjsTendon* GearOf(mjSpec& spec, const mjsJoint& joint) {
  mjsElement* const e = mjs_findElement(&spec, mjOBJ_TENDON, GearName(NameOf(joint)).c_str());
  return e ? mjs_asTendon(e) : nullptr;
}

mjsJoint* GearMotorOf(mjSpec& spec, const mjsJoint& joint) {
  mjsElement* const e = mjs_findElement(&spec, mjOBJ_JOINT, GearName(NameOf(joint)).c_str());
  return e ? mjs_asJoint(e) : nullptr;
}

void SetGearCompliance(mjSpec& spec, mjsJoint& joint, const mjModel& compiled, double compliance,
                       const GearEdits& edits) {
  if (mjsTendon* const present = GearOf(spec, joint)) {
    if (!(compliance > 0))
      throw Error::Input(Who(joint) + ": gear_compliance",
                         "a positive number, as the model has its elastic gear",
                         Decimal(compliance));
    edits.before(present->element);
    present->stiffness[0] = 1 / compliance;
    return;
  }
  RequireMotor(spec, joint);
  if (!IsResolved(spec, joint, compiled, 1 / compliance)) return;
  const std::string name = NameOf(joint), gear = GearName(name);
  ExtendKeys(spec, compiled, mj_name2id(&compiled, mjOBJ_JOINT, name.c_str()), edits);
  MakeMotor(joint, gear, edits);
  MakeSpring(spec, name, gear, edits).stiffness[0] = 1 / compliance;
  for (mjsActuator* const a : ActuatorsOf(spec, name)) {
    edits.undo([a, name] { mjs_setString(a->target, name.c_str()); });
    mjs_setString(a->target, gear.c_str());
  }
  joint.armature = 0;
  joint.actfrclimited = mjLIMITED_FALSE;
}

int GearMotorOf(const mjModel& m, int joint) {
  const char* const name = mj_id2name(&m, mjOBJ_JOINT, joint);
  return name ? mj_name2id(&m, mjOBJ_JOINT, GearName(name).c_str()) : -1;
}

bool IsGearMotor(const mjModel& m, int joint) {
  if (joint < 0) return false;
  const char* const name = mj_id2name(&m, mjOBJ_JOINT, joint);
  return name && std::string_view(name).starts_with(kPrefix);
}

int GearMotors(const mjModel& m) {
  int count = 0;
  for (int j = 0; j < m.njnt; ++j) count += IsGearMotor(m, j);
  return count;
}

void FollowGears(const mjModel& m, double* qpos, double* qvel) {
  for (int j = 0; j < m.njnt; ++j) {
    const int motor = GearMotorOf(m, j);
    if (motor < 0) continue;
    qpos[m.jnt_qposadr[motor]] = qpos[m.jnt_qposadr[j]];
    qvel[m.jnt_dofadr[motor]] = qvel[m.jnt_dofadr[j]];
  }
}

void PlaceJoint(const mjModel& m, mjData& d, int joint, double q, double v) {
  double &angle = d.qpos[m.jnt_qposadr[joint]], &speed = d.qvel[m.jnt_dofadr[joint]];
  if (const int motor = GearMotorOf(m, joint); motor >= 0) {
    d.qpos[m.jnt_qposadr[motor]] += q - angle;
    d.qvel[m.jnt_dofadr[motor]] += v - speed;
  }
  angle = q, speed = v;
}

}  // namespace continuum
