#include "sim/model/effect_kind.h"

#include <string>

#include "effects/all.h"

namespace continuum {
namespace {

// Calls use<E>() with the law of a plugin instance, if it is on the list.
template <class Use>
void WithLaw(const mjModel& m, int instance, Use&& use) {
  const std::string plugin = mjp_getPluginAtSlot(m.plugin[instance])->name;
  All::ForEach([&]<class E>() {
    if (plugin == "continuum." + std::string(E::kName)) use.template operator()<E>();
  });
}

template <class E>
constexpr bool HasChambers() {
  return SegmentLaw<E> && requires(ParamsOf<E, double> p) { E::template Chambers<double>(p); };
}

}  // namespace

bool HasPathLaw(const mjModel& m) {
  bool found = false;
  for (int i = 0; i < m.nplugin; ++i) WithLaw(m, i, [&]<class E>() { found |= PathLaw<E>; });
  return found;
}

bool HasChamberLaw(const mjModel& m) {
  bool found = false;
  for (int i = 0; i < m.nplugin; ++i) WithLaw(m, i, [&]<class E>() { found |= HasChambers<E>(); });
  return found;
}

std::vector<double> FrictionlessPath(const mjModel& m, int instance) {
  std::vector<double> none;
  WithLaw(m, instance, [&]<class E>() {
    if constexpr (PathLaw<E>) {
      for (const Param& p : E::kParams) none.push_back(p.null);
    }
  });
  return none;
}

}  // namespace continuum
