#include <string>

#include "error.h"
#include "sim/model/spec_element.h"

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

}  // namespace continuum
