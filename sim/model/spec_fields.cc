#include "sim/model/spec_fields.h"

#include <cstddef>
#include <type_traits>

#include <mujoco/mjspecmacro.h>

namespace continuum {
namespace {

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

}  // namespace

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

const std::map<std::string, mjtObj, std::less<>>& ElementKinds() {
  static const std::map<std::string, mjtObj, std::less<>> kinds{
      {"joint", mjOBJ_JOINT},  {"body", mjOBJ_BODY},     {"site", mjOBJ_SITE},
      {"geom", mjOBJ_GEOM},    {"tendon", mjOBJ_TENDON}, {"actuator", mjOBJ_ACTUATOR},
      {"sensor", mjOBJ_SENSOR}};
  return kinds;
}

std::string KindName(mjtObj kind) {
  for (const auto& [name, value] : ElementKinds()) {
    if (value == kind) return name;
  }
  return "element";
}

}  // namespace continuum
