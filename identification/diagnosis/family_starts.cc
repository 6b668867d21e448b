#include "identification/diagnosis/family_starts.h"

#include <algorithm>

#include "binding/effect_catalog.h"
#include "identification/diagnosis/probing.h"
#include "identification/diagnosis/verdict.h"

namespace continuum {
namespace {

// The size of a law: its first amplitude.
std::size_t SizeOf(const Hypothesis& h) { return h.Amplitudes().front(); }

std::string_view UnitOf(const Hypothesis& h, const std::string& name) {
  for (const Param& p : EffectNamed(h.Card()).params) {
    if (p.name == name) return p.unit;
  }
  return "";
}

// The amplitudes of a law that take over the size of a plainer one: that of its name, or else all
// of its unit, as the levels of both directions.
std::vector<std::size_t> Heirs(const Hypothesis& rich, const std::string& name,
                               std::string_view unit) {
  std::vector<std::size_t> same_name, same_unit;
  for (const std::size_t a : rich.Amplitudes()) {
    if (rich.extra[a].name == name) same_name.push_back(a);
    if (UnitOf(rich, rich.extra[a].name) == unit) same_unit.push_back(a);
  }
  return same_name.empty() ? same_unit : same_name;
}

}  // namespace

bool IsPlainerThan(const Hypothesis& plain, const Hypothesis& rich) {
  return plain.where == rich.where && KinOf(plain.Card()).PlainerThan(KinOf(rich.Card()));
}

std::vector<Problem::Vector> StartsFromPlain(const CandidateResult& plain, const Hypothesis& rich) {
  const Hypothesis& law = plain.hypothesis;
  const std::size_t size = SizeOf(law);
  const std::string& name = law.extra[size].name;
  const auto heirs = Heirs(rich, name, UnitOf(law, name));
  if (heirs.empty()) return {};
  const Problem::Vector base = plain.fitted.fit.x.head(plain.first_extra());
  const double value = plain.fitted.fit.x[plain.first_extra() + static_cast<Eigen::Index>(size)];
  std::vector<Problem::Vector> starts;
  const auto add = [&](std::vector<double> own) {
    for (const std::size_t a : heirs)
      own[a] = std::clamp(value, rich.extra[a].lower, rich.extra[a].upper);
    starts.push_back(Append(base, own));
  };
  std::vector<double> alone = rich.starts.front();
  for (const std::size_t a : rich.Amplitudes()) alone[a] = rich.AtShare(a, alone[a], 0);
  add(alone);
  add(rich.starts.front());
  for (const std::size_t s : rich.StartsOfShape(false)) add(rich.starts[s]);
  return starts;
}

}  // namespace continuum
