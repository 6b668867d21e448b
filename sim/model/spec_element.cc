#include "sim/model/spec_element.h"

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <type_traits>

#include <mujoco/mjspecmacro.h>

#include <Eigen/Dense>

#include "binding/actuator_type.h"
#include "binding/config.h"
#include "error.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

struct Field {
  double* data;
  int size;
};
using Fields = std::map<std::string, Field, std::less<>>;

template <class T>
void Put(Fields& fields, const char* name, T* data, int size) {
  if constexpr (std::is_same_v<T, double>) fields[name] = {data, size};
}

// Every double of a specification struct under its own name, from MuJoCo's lists of members.
#define X(type, name, size) Put(fields, #name, &s->name, size);
#define XVEC(type, name, size) Put(fields, #name, &s->name[0], size);
Fields Of(mjsJoint* s) {
  Fields fields;
  MJSJOINT_FIELDS
  return fields;
}
Fields Of(mjsBody* s) {
  Fields fields;
  MJSBODY_FIELDS
  return fields;
}
Fields Of(mjsSite* s) {
  Fields fields;
  MJSSITE_FIELDS
  return fields;
}
Fields Of(mjsGeom* s) {
  Fields fields;
  MJSGEOM_FIELDS
  return fields;
}
Fields Of(mjsTendon* s) {
  Fields fields;
  MJSTENDON_FIELDS
  return fields;
}
Fields Of(mjsActuator* s) {
  Fields fields;
  MJSACTUATOR_FIELDS
  return fields;
}
Fields Of(mjsSensor* s) {
  Fields fields;
  MJSSENSOR_FIELDS
  return fields;
}
#undef X
#undef XVEC

Fields FieldsOf(mjsElement* e) {
  switch (e->elemtype) {
    case mjOBJ_JOINT:
      return Of(mjs_asJoint(e));
    case mjOBJ_BODY:
      return Of(mjs_asBody(e));
    case mjOBJ_SITE:
      return Of(mjs_asSite(e));
    case mjOBJ_GEOM:
      return Of(mjs_asGeom(e));
    case mjOBJ_TENDON:
      return Of(mjs_asTendon(e));
    case mjOBJ_ACTUATOR:
      return Of(mjs_asActuator(e));
    case mjOBJ_SENSOR:
      return Of(mjs_asSensor(e));
    default:
      return {};
  }
}

// "gear[2]" → ("gear", 2); no index is 0.
std::pair<std::string, int> SplitIndex(std::string_view attribute) {
  const std::size_t open = attribute.find('[');
  if (open == attribute.npos) return {std::string(attribute), 0};
  int index = -1;
  if (attribute.ends_with(']')) {
    index = 0;
    for (const char c : attribute.substr(open + 1, attribute.size() - open - 2)) {
      index = c >= '0' && c <= '9' && index >= 0 ? 10 * index + (c - '0') : -1;
    }
  }
  return {std::string(attribute.substr(0, open)), index};
}

const std::map<std::string, mjtObj, std::less<>>& Kinds() {
  static const std::map<std::string, mjtObj, std::less<>> kinds{
      {"joint", mjOBJ_JOINT},  {"body", mjOBJ_BODY},     {"site", mjOBJ_SITE},
      {"geom", mjOBJ_GEOM},    {"tendon", mjOBJ_TENDON}, {"actuator", mjOBJ_ACTUATOR},
      {"sensor", mjOBJ_SENSOR}};
  return kinds;
}

std::string KindName(mjtObj kind) {
  for (const auto& [name, value] : Kinds()) {
    if (value == kind) return name;
  }
  return "element";
}

}  // namespace

SpecElement::SpecElement(mjSpec* spec, mjsElement* element, const mjModel* compiled)
    : spec_(spec), element_(element), compiled_(compiled) {}

SpecElement::Saved SpecElement::Save() const {
  // The structs hold numbers and pointers to strings; only numbers are edited here.
  const auto copy = [](auto* s) {
    Saved saved{s, std::vector<std::byte>(sizeof *s), nullptr};
    std::memcpy(saved.bytes.data(), s, sizeof *s);
    return saved;
  };
  switch (element_->elemtype) {
    case mjOBJ_JOINT:
      return copy(mjs_asJoint(element_));
    case mjOBJ_BODY:
      return copy(mjs_asBody(element_));
    case mjOBJ_SITE:
      return copy(mjs_asSite(element_));
    case mjOBJ_GEOM:
      return copy(mjs_asGeom(element_));
    case mjOBJ_TENDON:
      return copy(mjs_asTendon(element_));
    case mjOBJ_ACTUATOR:
      return copy(mjs_asActuator(element_));
    default:
      return copy(mjs_asSensor(element_));
  }
}

void SpecElement::Saved::Restore() const {
  if (created_in) {
    mjs_delete(created_in, static_cast<mjsElement*>(address));
  } else {
    std::memcpy(address, bytes.data(), bytes.size());
  }
}

std::string SpecElement::Name() const { return mjs_getString(mjs_getName(element_)); }

std::string SpecElement::Who() const { return KindName(element_->elemtype) + " '" + Name() + "'"; }

double* SpecElement::Address(std::string_view attribute, double& unit) const {
  const auto [name, index] = SplitIndex(attribute);
  const Fields fields = FieldsOf(element_);
  const auto field = fields.find(name);
  if (field == fields.end()) {
    std::string all;
    for (const auto& [known, f] : fields) all += (all.empty() ? "" : ", ") + known;
    throw Error::Input(Who(), "one of the attributes " + all, "'" + std::string(attribute) + "'");
  }
  if (index < 0 || index >= field->second.size) {
    throw Error::Input(Who(), name + " with an index below " + std::to_string(field->second.size),
                       "'" + std::string(attribute) + "'");
  }
  unit = 1;
  if (element_->elemtype == mjOBJ_JOINT && spec_->compiler.degree &&
      (name == "ref" || name == "springref" || name == "range") &&
      (mjs_asJoint(element_)->type == mjJNT_HINGE || mjs_asJoint(element_)->type == mjJNT_BALL)) {
    unit = std::numbers::pi / 180;
  }
  return field->second.data + index;
}

double SpecElement::Get(std::string_view attribute) const {
  if (element_->elemtype == mjOBJ_BODY && attribute == "mass") return BodyMass();
  if (element_->elemtype == mjOBJ_TENDON) {
    if (attribute == "springlength" || attribute == "springlength[0]") return RestLength(0);
    if (attribute == "springlength[1]") return RestLength(1);
  }
  if (element_->elemtype == mjOBJ_BODY && attribute == "point_mass") return 0;
  if (element_->elemtype == mjOBJ_ACTUATOR) {
    const mjsActuator& a = *mjs_asActuator(element_);
    if (attribute == "kp") return a.gainprm[0];
    if (attribute == "kv") return -a.biasprm[2];
    if (attribute == "force_scale") return 1;
    if (attribute == "lag") return a.dyntype == mjDYN_NONE ? 0 : a.dynprm[0];
    if (attribute == "delay") return a.delay;
  }
  double unit = 1;
  return *Address(attribute, unit) * unit;
}

void SpecElement::Set(std::string_view attribute, double value) {
  if (element_->elemtype == mjOBJ_BODY && attribute == "mass") return SetBodyMass(value);
  if (element_->elemtype == mjOBJ_BODY && attribute == "point_mass") return AddPointMass(value);
  if (element_->elemtype == mjOBJ_TENDON && attribute.starts_with("springlength")) {
    double* const ends = mjs_asTendon(element_)->springlength;
    const bool both = attribute == "springlength";
    const double now[2] = {RestLength(0), RestLength(1)};
    for (const int end : {0, 1}) ends[end] = both ? value : now[end];
    if (both) return;
  }
  if (element_->elemtype == mjOBJ_ACTUATOR) {
    if (attribute == "lag") return SetLag(value);
    if (attribute == "delay") return SetDelay(value);
    if (attribute == "force_scale") return Scale("force_scale", value);
    if (attribute == "kp") {
      mjsActuator& a = Affine();
      a.gainprm[0] = value, a.biasprm[1] = -value;
      return;
    }
    if (attribute == "kv") {
      if (value < 0) throw Error::Input(Who() + ": kv", "a number >= 0", std::to_string(value));
      Affine().biasprm[2] = -value;
      return;
    }
    mjs_asActuator(element_)->type = mjACTUATOR_GENERAL;
  }
  double unit = 1;
  double* const address = Address(attribute, unit);
  *address = value / unit;
}

void SpecElement::Add(std::string_view attribute, double value) {
  if (element_->elemtype == mjOBJ_BODY && attribute == "point_mass") return AddPointMass(value);
  const bool place = element_->elemtype == mjOBJ_BODY || element_->elemtype == mjOBJ_SITE;
  if (place && attribute.starts_with("force[")) return AddForce(attribute, value);
  if (element_->elemtype == mjOBJ_ACTUATOR && attribute == "input") {
    if (value == 0) return;
    mjsActuator& a = Affine();
    a.biasprm[0] += a.gainprm[0] * value;
    return;
  }
  const bool lag = element_->elemtype == mjOBJ_ACTUATOR && attribute == "lag";
  const bool delay = element_->elemtype == mjOBJ_ACTUATOR && attribute == "delay";
  if ((lag || delay) && value == 0) return;
  if (lag && Get("lag") > 0) {
    throw Error::Input(Who(), "an actuator without a lag",
                       "one of " + std::to_string(Get("lag")) + " s");
  }
  Set(attribute, Get(attribute) + value);
}

void SpecElement::Scale(std::string_view attribute, double factor) {
  if (element_->elemtype == mjOBJ_ACTUATOR && attribute == "force_scale") {
    mjsActuator& a = Affine();
    a.gainprm[0] *= factor;
    for (int i = 0; i < 3; ++i) a.biasprm[i] *= factor;
    for (double& limit : a.forcerange) limit *= factor;
    return;
  }
  if (element_->elemtype == mjOBJ_ACTUATOR && attribute == "input") {
    if (factor != 1) Affine().gainprm[0] *= factor;
    return;
  }
  Set(attribute, Get(attribute) * factor);
}

// Where nothing is written (-1 at both ends), MuJoCo takes the length at qpos0.
double SpecElement::RestLength(int end) const {
  const double* const written = mjs_asTendon(element_)->springlength;
  const int id = mj_name2id(compiled_, mjOBJ_TENDON, Name().c_str());
  const bool none = written[0] == -1 && written[1] == -1;
  return none && id >= 0 ? compiled_->tendon_lengthspring[2 * id + end] : written[end];
}

void SpecElement::RequireOrder(std::string_view attribute) const {
  const auto [name, index] = SplitIndex(attribute);
  const bool length = name == "springlength";
  if (!length && !name.ends_with("range")) return;
  const double low = Get(name + "[0]"), high = Get(name + "[1]");
  if (length ? low <= high : low < high) return;
  const std::string ends[] = {name + "[0]", name + "[1]"};
  throw Error::Input(Who() + ": " + ends[index],
                     (index == 0 ? "a number below " : "a number above ") + ends[1 - index] +
                         " = " + Decimal(index == 0 ? high : low),
                     Decimal(index == 0 ? low : high));
}

// An actuator with fixed gain and at most affine bias, written with <general>.
mjsActuator& SpecElement::Affine() {
  mjsActuator& a = *mjs_asActuator(element_);
  if (a.gaintype != mjGAIN_FIXED || (a.biastype != mjBIAS_NONE && a.biastype != mjBIAS_AFFINE)) {
    throw Error::Input(Who(), "an actuator with a fixed gain and an affine bias",
                       ActuatorType(a.gaintype, a.biastype, a.dyntype));
  }
  a.type = mjACTUATOR_GENERAL;
  if (a.biastype == mjBIAS_NONE) {
    a.biastype = mjBIAS_AFFINE;
    for (double& b : a.biasprm) b = 0;
  }
  return a;
}

void SpecElement::SetLag(double lag) {
  mjsActuator& a = *mjs_asActuator(element_);
  const bool lagged = a.dyntype == mjDYN_FILTER || a.dyntype == mjDYN_FILTEREXACT;
  if (a.dyntype != mjDYN_NONE && !lagged) {
    throw Error::Input(Who(), "an actuator without dynamics or with a first-order lag",
                       ActuatorType(a.gaintype, a.biastype, a.dyntype));
  }
  a.type = mjACTUATOR_GENERAL;
  if (lag <= 0) {
    a.dyntype = mjDYN_NONE, a.actdim = -1;
    return;
  }
  if (!lagged) a.actearly = 1;  // else it would be a step late however short
  a.dyntype = mjDYN_FILTEREXACT;
  a.dynprm[0] = lag;
}

void SpecElement::SetDelay(double delay) {
  if (delay < 0) throw Error::Input(Who() + ": delay", "a number >= 0", std::to_string(delay));
  mjsActuator& a = *mjs_asActuator(element_);
  a.delay = delay;
  if (delay == 0) a.nsample = 0;
  if (delay > 0 && a.nsample == 0) a.interp = 1;
}

void SpecElement::CoverDelay() {
  mjsActuator& a = *mjs_asActuator(element_);
  if (a.delay <= 0) return;
  const double samples = 8 * (a.delay / spec_->option.timestep + 4);
  a.nsample = std::max(a.nsample, static_cast<int>(std::min(samples, 1e6)));
}

// Of the specification where it says so, else what compilation found in the geoms.
double SpecElement::BodyMass() const {
  const mjsBody& body = *mjs_asBody(element_);
  if (body.explicitinertial && spec_->compiler.inertiafromgeom != mjINERTIAFROMGEOM_TRUE)
    return body.mass;
  return compiled_->body_mass[mj_name2id(compiled_, mjOBJ_BODY, Name().c_str())];
}

// Makes the inertia that compilation found explicit, with a quaternion, so that it can be edited.
void SpecElement::FreezeInertia() {
  if (spec_->compiler.inertiafromgeom == mjINERTIAFROMGEOM_TRUE ||
      spec_->compiler.settotalmass > 0) {
    throw Error::Input(Who() + ": mass",
                       "a <compiler> without inertiafromgeom=\"true\" and settotalmass",
                       "one that overrides the mass of a body");
  }
  mjsBody& body = *mjs_asBody(element_);
  if (body.explicitinertial) {
    const char* const failed = mjs_resolveOrientation(body.iquat, spec_->compiler.degree,
                                                      spec_->compiler.eulerseq, &body.ialt);
    if (failed) throw Error::Input(Who() + ": inertial", failed);
    body.ialt.type = mjORIENTATION_QUAT;
    return;
  }
  const int b = mj_name2id(compiled_, mjOBJ_BODY, Name().c_str());
  body.explicitinertial = 1;
  body.mass = compiled_->body_mass[b];
  const bool massless = body.mass == 0;  // its compiled centre means nothing
  for (int i = 0; i < 3; ++i) {
    body.ipos[i] = massless ? 0 : compiled_->body_ipos[3 * b + i];
    body.inertia[i] = compiled_->body_inertia[3 * b + i];
  }
  const double unit[4] = {1, 0, 0, 0};
  for (int i = 0; i < 4; ++i) body.iquat[i] = massless ? unit[i] : compiled_->body_iquat[4 * b + i];
  body.ialt.type = mjORIENTATION_QUAT;
  body.fullinertia[0] = NAN;
}

void SpecElement::SetBodyMass(double mass) {
  FreezeInertia();
  mjsBody& body = *mjs_asBody(element_);
  const double factor = body.mass > 0 ? mass / body.mass : 0;
  body.mass = mass;
  for (double& i : body.inertia) i *= factor;
  if (std::isfinite(body.fullinertia[0])) {
    for (double& i : body.fullinertia) i *= factor;
  }
}

// Adds a point mass at the body's origin: centre and inertia by the parallel-axis theorem.
void SpecElement::AddPointMass(double added) {
  if (added == 0) return;
  FreezeInertia();
  mjsBody& body = *mjs_asBody(element_);
  using Eigen::Matrix3d, Eigen::Vector3d;
  Matrix3d inertia;
  if (std::isfinite(body.fullinertia[0])) {
    const double* const f = body.fullinertia;
    inertia << f[0], f[3], f[4], f[3], f[1], f[5], f[4], f[5], f[2];
  } else {
    double r[9];
    mju_quat2Mat(r, body.iquat);
    const Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r);
    inertia = R * Eigen::Map<const Vector3d>(body.inertia).asDiagonal() * R.transpose();
  }
  const auto steiner = [](double m, const Vector3d& r) -> Matrix3d {
    return m * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
  };
  const Vector3d centre = Eigen::Map<const Vector3d>(body.ipos);
  const double total = body.mass + added;
  const Vector3d moved = centre * (body.mass / total);
  inertia += steiner(body.mass, centre - moved) + steiner(added, moved);
  body.mass = total;
  for (int i = 0; i < 3; ++i) body.ipos[i] = moved[i];
  // A point alone has no inertia; the compiler asks for some: that of a ball of 0.1 mm, however
  // light.
  if (inertia.eigenvalues().real().minCoeff() <= 1e-12)
    inertia.diagonal().array() += std::max(4e-9 * total, 1e-13);
  const double full[6] = {inertia(0, 0), inertia(1, 1), inertia(2, 2),
                          inertia(0, 1), inertia(0, 2), inertia(1, 2)};
  std::copy(full, full + 6, body.fullinertia);
  const double unit[4] = {1, 0, 0, 0};
  std::copy(unit, unit + 4, body.iquat);
  for (double& i : body.inertia) i = 0;
}

std::vector<SpecElement> Elements(mjSpec* spec, mjtObj kind, const mjModel* compiled) {
  std::vector<SpecElement> all;
  for (mjsElement* e = mjs_firstElement(spec, kind); e; e = mjs_nextElement(spec, e))
    all.emplace_back(spec, e, compiled);
  return all;
}

std::vector<SpecElement> MatchElements(mjSpec* spec, const mjModel* compiled,
                                       const std::string& target, const std::string& where) {
  const std::size_t colon = target.find(':');
  const auto kind = Kinds().find(target.substr(0, colon));
  if (colon == target.npos || kind == Kinds().end()) {
    std::string all = "option, plugin:NAME";
    for (const auto& [name, type] : Kinds()) all += ", " + name + ":GLOB";
    throw Error::Input(where, "a target such as " + all, "'" + target + "'");
  }
  const std::string globs = target.substr(colon + 1);
  std::vector<SpecElement> found;
  for (const SpecElement& e : Elements(spec, kind->second, compiled)) {
    if (!e.Name().empty() && AnyGlobMatches(globs, e.Name())) found.push_back(e);
  }
  if (found.empty()) {
    throw Error::Input(where, "a " + kind->first + " of the model", "no match for '" + globs + "'");
  }
  return found;
}

double& OptionAttribute(mjOption& option, std::string_view attribute, const std::string& where) {
  const std::map<std::string, Field, std::less<>> fields{{"gravity", {option.gravity, 3}},
                                                         {"timestep", {&option.timestep, 1}},
                                                         {"wind", {option.wind, 3}},
                                                         {"density", {&option.density, 1}},
                                                         {"viscosity", {&option.viscosity, 1}},
                                                         {"impratio", {&option.impratio, 1}}};
  const auto [name, index] = SplitIndex(attribute);
  const auto field = fields.find(name);
  if (field != fields.end() && index >= 0 && index < field->second.size) {
    return field->second.data[index];
  }
  throw Error::Input(where, "gravity[i], timestep, wind[i], density, viscosity or impratio",
                     "'" + std::string(attribute) + "'");
}

}  // namespace continuum
