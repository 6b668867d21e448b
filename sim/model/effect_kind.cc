#include "sim/model/effect_kind.h"

#include "binding/effect_catalog.h"

namespace continuum {
namespace {

bool IsKind(const mjModel& m, int instance, EffectInfo::Kind kind) {
  const EffectInfo* const effect = EffectOf(m, instance);
  return effect && effect->kind == kind;
}

bool HasKind(const mjModel& m, EffectInfo::Kind kind) {
  for (int i = 0; i < m.nplugin; ++i) {
    if (IsKind(m, i, kind)) return true;
  }
  return false;
}

}  // namespace

bool HasSegmentLaw(const mjModel& m) { return HasKind(m, EffectInfo::Kind::kSegment); }

std::vector<double> FrictionlessPath(const mjModel& m, int instance) {
  std::vector<double> none;
  if (!IsKind(m, instance, EffectInfo::Kind::kPath)) return none;
  for (const Param& p : EffectOf(m, instance)->params) none.push_back(p.null);
  return none;
}

}  // namespace continuum
