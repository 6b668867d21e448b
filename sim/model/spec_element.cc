#include "sim/model/spec_element.h"

#include <cstring>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "binding/config.h"
#include "error.h"
#include "sim/io/decimal.h"
#include "sim/model/actuator_edit.h"
#include "sim/model/body_inertia.h"
#include "sim/model/body_length.h"
#include "sim/model/body_turn.h"
#include "sim/model/elastic_gear.h"
#include "sim/model/spec_fields.h"

namespace continuum {
namespace {

const char* const kFrame = "external_force_frame";

// An actuator of the constant force 1 at a site, along gear in the axes of the world.
mjsActuator& MakeForce(mjSpec* spec, const std::string& name, const std::string& site) {
  mjsActuator& a = *mjs_addActuator(spec, nullptr);
  mjs_setName(a.element, name.c_str());
  a.type = mjACTUATOR_GENERAL;
  a.trntype = mjTRN_SITE;
  mjs_setString(a.target, site.c_str());
  mjs_setString(a.refsite, kFrame);
  a.gaintype = mjGAIN_FIXED, a.gainprm[0] = 0;
  a.biastype = mjBIAS_AFFINE, a.biasprm[0] = 1;
  for (double& g : a.gear) g = 0;
  return a;
}

mjsElement* MakeSite(mjsBody* body, const std::string& name) {
  mjsSite* const site = mjs_addSite(body, nullptr);
  mjs_setName(site->element, name.c_str());
  return site->element;
}

}  // namespace

SpecElement::SpecElement(mjSpec* spec, mjsElement* element, const mjModel* compiled)
    : spec_(spec), element_(element), compiled_(compiled) {}

SpecElement::Saved SpecElement::Save() const {
  // The structs hold numbers and pointers to strings; only numbers are edited here.
  const auto copy = [](auto* s) {
    Saved saved{s, std::vector<std::byte>(sizeof *s)};
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
  if (undo) {
    undo();
  } else if (created_in) {
    mjs_delete(created_in, static_cast<mjsElement*>(address));
  } else {
    std::memcpy(address, bytes.data(), bytes.size());
  }
}

std::string SpecElement::Name() const { return mjs_getString(mjs_getName(element_)); }

std::string SpecElement::Who() const { return KindName(element_->elemtype) + " '" + Name() + "'"; }

double* SpecElement::Address(std::string_view attribute, double& unit) const {
  const auto [name, index] = SplitIndex(attribute);
  if (element_->elemtype == mjOBJ_JOINT && name == "armature") {
    mjsJoint* const motor = GearMotorOf(*spec_, *mjs_asJoint(element_));
    if (motor) return SpecElement(spec_, motor->element, compiled_).Address(attribute, unit);
  }
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
  if (element_->elemtype == mjOBJ_BODY && attribute == "mass")
    return BodyMass(*spec_, *mjs_asBody(element_), *compiled_);
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

// What belongs to the gear of a joint; false: nothing else is called so.
bool SpecElement::SetGear(std::string_view attribute, double value) {
  if (attribute.starts_with("gear_") && !(value >= 0))
    throw Error::Input(Who() + ": " + std::string(attribute), "a number >= 0", Decimal(value));
  mjsJoint& joint = *mjs_asJoint(element_);
  const auto save = [&](mjsElement* e) {
    others_.push_back(SpecElement(spec_, e, compiled_).Save());
  };
  if (attribute == "gear_compliance") {
    const GearEdits edits{save,
                          [&](mjsElement* e) {
                            others_.push_back({e, {}, spec_});
                          },
                          [&](std::function<void()> undo) {
                            others_.push_back({nullptr, {}, nullptr, std::move(undo)});
                          }};
    SetGearCompliance(*spec_, joint, *compiled_, value, edits);
    return true;
  }
  if (mjsJoint* const motor = GearMotorOf(*spec_, joint); motor && attribute == "armature")
    save(motor->element);
  if (attribute != "gear_damping" && attribute != "gear_play") return false;
  mjsTendon* const gear = GearOf(*spec_, joint);
  if (!gear) return true;  // of a rigid gear
  save(gear->element);
  if (attribute == "gear_damping") {
    gear->damping[0] = value;
  } else {
    gear->springlength[0] = 0 - value / 2, gear->springlength[1] = value / 2;
  }
  return true;
}

void SpecElement::Set(std::string_view attribute, double value) {
  if (element_->elemtype == mjOBJ_JOINT && SetGear(attribute, value)) return;
  if (element_->elemtype == mjOBJ_BODY && attribute == "mass")
    return SetBodyMass(*spec_, *mjs_asBody(element_), *compiled_, value);
  if (element_->elemtype == mjOBJ_BODY && attribute == "point_mass")
    return AddPointMass(*spec_, *mjs_asBody(element_), *compiled_, value);
  if (element_->elemtype == mjOBJ_TENDON && attribute.starts_with("springlength")) {
    double* const ends = mjs_asTendon(element_)->springlength;
    const bool both = attribute == "springlength";
    const double now[2] = {RestLength(0), RestLength(1)};
    for (const int end : {0, 1}) ends[end] = both ? value : now[end];
    if (both) return;
  }
  if (element_->elemtype == mjOBJ_ACTUATOR) {
    if (attribute == "lag") return SetLag(*mjs_asActuator(element_), value);
    if (attribute == "delay") return SetDelay(*mjs_asActuator(element_), value);
    if (attribute == "force_limit") return LimitForce(*mjs_asActuator(element_), value);
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
  if (element_->elemtype == mjOBJ_BODY && attribute == "point_mass")
    return AddPointMass(*spec_, *mjs_asBody(element_), *compiled_, value);
  if (element_->elemtype == mjOBJ_BODY && attribute.starts_with("turn["))
    return TurnBody(*spec_, *mjs_asBody(element_), SplitIndex(attribute).second, value);
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
  Set(attribute, Get(attribute) + value);
}

void SpecElement::Scale(std::string_view attribute, double factor) {
  if (element_->elemtype == mjOBJ_BODY && attribute == "length") {
    return ScaleBodyLength(*spec_, *mjs_asBody(element_), *compiled_, factor, [&](mjsElement* e) {
      others_.push_back(SpecElement(spec_, e, compiled_).Save());
    });
  }
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

// Made once per place; another extension of the same model adds to it.
void SpecElement::AddForce(std::string_view attribute, double newtons) {
  const int axis = attribute == "force[0]" ? 0 : attribute == "force[1]" ? 1 : 2;
  const bool body = element_->elemtype == mjOBJ_BODY;
  const std::string name = "external_force_" + std::string(body ? "body_" : "site_") + Name();
  mjsElement* const present = mjs_findElement(spec_, mjOBJ_ACTUATOR, name.c_str());
  if (present) {
    others_.push_back(SpecElement(spec_, present, compiled_).Save());
    mjs_asActuator(present)->gear[axis] += newtons;
    return;
  }
  const auto created = [&](mjsElement* e) { others_.push_back({e, {}, spec_}); };
  if (!mjs_findElement(spec_, mjOBJ_SITE, kFrame)) {
    created(MakeSite(mjs_findBody(spec_, "world"), kFrame));
  }
  if (body) created(MakeSite(mjs_asBody(element_), name));
  mjsActuator& force = MakeForce(spec_, name, body ? name : Name());
  created(force.element);
  force.gear[axis] = newtons;
}

mjsActuator& SpecElement::Affine() {
  mjsActuator& a = *mjs_asActuator(element_);
  MakeAffine(a);
  return a;
}

void SpecElement::CoverDelay() {
  continuum::CoverDelay(*mjs_asActuator(element_), spec_->option.timestep);
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
  const auto kind = ElementKinds().find(target.substr(0, colon));
  if (colon == target.npos || kind == ElementKinds().end()) {
    std::string all = "option, plugin:NAME";
    for (const auto& [name, type] : ElementKinds()) all += ", " + name + ":GLOB";
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
