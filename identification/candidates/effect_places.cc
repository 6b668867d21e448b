#include "identification/candidates/effect_places.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "binding/config.h"
#include "sim/model/elastic_gear.h"

namespace continuum {
namespace {

// Whether an effect makes sense at one object of the model.
bool Fits(const mjModel& m, const EffectInfo& effect, Place place, int id,
          const Experiment& experiment) {
  switch (place) {
    case Place::kJoint:
      return m.jnt_type[id] == mjJNT_HINGE || m.jnt_type[id] == mjJNT_SLIDE;
    case Place::kTendon: {
      if (effect.kind != EffectInfo::Kind::kPath) return true;
      if (m.tendon_num[id] < 3) return false;  // no contact
      for (int w = m.tendon_adr[id]; w < m.tendon_adr[id] + m.tendon_num[id]; ++w) {
        if (m.wrap_type[w] != mjWRAP_SITE) return false;
      }
      return true;
    }
    case Place::kActuator: {
      const double kp = m.actuator_gainprm[mjNGAIN * id];
      const bool servo = m.actuator_gaintype[id] == mjGAIN_FIXED &&
                         m.actuator_biastype[id] == mjBIAS_AFFINE && kp != 0 &&
                         kp == -m.actuator_biasprm[mjNBIAS * id + 1];
      if (effect.tap == Tap::kServoError && !servo) return false;
      const char* name = mj_id2name(&m, mjOBJ_ACTUATOR, id);
      return std::any_of(experiment.inputs.begin(), experiment.inputs.end(), [&](const Input& in) {
        return !in.column.empty() && name && in.actuator == name;
      });
    }
    case Place::kSite:
      return true;
    default: {  // bodies: the ends of the tree, or every one for what scales or turns them
      if (id == 0) return false;
      const Param& first = effect.params.front();
      if (first.null == 1 || first.unit == "rad") return m.body_mass[id] > 0;
      for (int b = id + 1; b < m.nbody; ++b) {
        if (m.body_parentid[b] == id && !IsGearMotor(m, m.body_jntadr[b])) return false;
      }
      return true;
    }
  }
}

}  // namespace

std::vector<std::string> NamesLike(const mjModel& m, Place place, const std::string& globs) {
  std::vector<std::string> names;
  for (int i = 0; i < ObjectCount(m, place); ++i) {
    const char* const name = mj_id2name(&m, ObjectType(place), i);
    if (name && *name && AnyGlobMatches(globs, name)) names.emplace_back(name);
  }
  return names;
}

std::vector<std::string> PlacesFor(const mjModel& m, const EffectInfo& effect, Place place,
                                   const std::string& globs, const Experiment& experiment) {
  if (place == Place::kWorld) return {"world"};
  std::vector<std::string> names = NamesLike(m, place, globs);
  if (globs != "*" && place == Place::kBody) return names;  // as chosen
  std::erase_if(names, [&](const std::string& name) {
    const int id = mj_name2id(&m, ObjectType(place), name.c_str());
    return !Fits(m, effect, place, id, experiment);
  });
  return names;
}

std::string GlobsOf(const std::vector<std::string>& names) {
  std::vector<std::string> words;
  for (const std::string& name : names) words.push_back(Escaped(name));
  return fmt::format("{}", fmt::join(words, " "));
}

std::string PlaceText(Place place, const std::vector<std::string>& names) {
  if (place == Place::kWorld) return "world";
  std::string text(PlaceName(place));
  if (names.size() > 1) text = place == Place::kBody ? "bodies" : text + "s";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == 6) return text + fmt::format(" … ({} in all)", names.size());
    text += (i ? ", " : " ") + names[i];
  }
  return text;
}

}  // namespace continuum
