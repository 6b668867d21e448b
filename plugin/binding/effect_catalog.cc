#include "binding/effect_catalog.h"

#include "binding/config.h"
#include "effects/all.h"
#include "error.h"

namespace continuum {
namespace {

using Kind = EffectInfo::Kind;

template <class E>
constexpr Kind KindOf() {
  if constexpr (ForceLaw<E> || std::same_as<E, Formula>)
    return Kind::kForce;
  else if constexpr (FrictionLaw<E> || std::same_as<E, FormulaFriction>)
    return Kind::kFriction;
  else if constexpr (PathLaw<E>)
    return Kind::kPath;
  else if constexpr (SegmentLaw<E>)
    return Kind::kSegment;
  else if constexpr (SignalLaw<E>)
    return Kind::kSignal;
  else if constexpr (MeasureLaw<E>)
    return Kind::kMeasure;
  else
    return Kind::kEdit;
}

template <class E>
EffectInfo InfoOf() {
  EffectInfo info{E::kName, E::kSummary, E::kSource, KindOf<E>(), {}, {}, {}};
  info.places.assign(E::kPlaces.begin(), E::kPlaces.end());
  info.params.assign(E::kParams.begin(), E::kParams.end());
  const auto choices = ChoicesOf<E>();
  info.choices.assign(choices.begin(), choices.end());
  if constexpr (SignalLaw<E>) info.tap = E::kTap;
  if constexpr (requires { E::kStates.size(); }) info.remembers = E::kStates.size() > 0;
  if constexpr (FormulaLaw<E>) info.text = E::kText;
  if constexpr (requires { E::kNative; }) info.native = E::kNative;
  if constexpr (requires { E::kAddsTo; }) info.adds_to = E::kAddsTo;
  if constexpr (requires { E::kKin; }) info.kin = E::kKin;
  if constexpr (requires { E::kOnlyListed; }) info.only_listed = E::kOnlyListed;
  if constexpr (requires { E::kCoulombLevel; }) info.coulomb_level = E::kCoulombLevel;
  if constexpr (requires { E::kDamping; }) info.damping = E::kDamping;
  if constexpr (requires { E::kLiteral; }) info.literal = E::kLiteral;
  if constexpr (SegmentLaw<E>) info.arc_radius = E::kArcRadius;
  return info;
}

template <class Effects>
std::vector<EffectInfo> InfosOf() {
  std::vector<EffectInfo> all;
  Effects::ForEach([&]<class E>() { all.push_back(InfoOf<E>()); });
  return all;
}

}  // namespace

const std::vector<EffectInfo>& Catalog() {
  static const auto catalog = InfosOf<All>();
  return catalog;
}

const EffectInfo& EffectNamed(std::string_view name) {
  static const auto written = InfosOf<FormulaLaws>();
  for (const EffectInfo& info : written) {
    if (info.name == name) return info;
  }
  std::string all;
  for (const EffectInfo& info : Catalog()) {
    if (info.name == name) return info;
    all += (all.empty() ? "" : ", ") + std::string(info.name);
  }
  throw Error::Input("effect", all, "'" + std::string(name) + "'");
}

std::string_view EffectNameOf(const mjModel& m, int instance) {
  const mjpPlugin* const plugin = mjp_getPluginAtSlot(m.plugin[instance]);
  const std::string_view name = plugin ? plugin->name : "";
  const bool ours = name.starts_with(kPluginPrefix) && name != kWrenchPlugin;
  return ours ? name.substr(kPluginPrefix.size()) : "";
}

const EffectInfo* EffectOf(const mjModel& m, int instance) {
  const std::string_view name = EffectNameOf(m, instance);
  return name.empty() ? nullptr : &EffectNamed(name);
}

std::string_view KindName(Kind kind) {
  constexpr std::string_view names[] = {"force",  "friction", "path", "segment",
                                        "signal", "measure",  "edit"};
  return names[static_cast<int>(kind)];
}

std::string_view Becomes(Kind kind) {
  constexpr std::string_view becomes[] = {"force", "row",        "contact path", "force",
                                          "force", "experiment", "native"};
  return becomes[static_cast<int>(kind)];
}

}  // namespace continuum
