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

bool ContainsByCard(const Hypothesis& b, const Hypothesis& a) {
  const EffectInfo &rich = EffectNamed(b.Card()), &plain = EffectNamed(a.Card());
  return a.where == b.where && rich.coulomb_level && !rich.IsConstantFriction() &&
         plain.IsConstantFriction();
}

bool IsPlainerThan(const Hypothesis& plain, const Hypothesis& rich) {
  return plain.where == rich.where &&
         (KinOf(plain.Card()).PlainerThan(KinOf(rich.Card())) || ContainsByCard(rich, plain));
}

bool IsRich(const Hypothesis& h) { return KinOf(h.Card()).depth > 0; }

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

std::optional<Problem::Vector> StartFromRich(const CandidateResult& rich, const Hypothesis& plain) {
  const Hypothesis& law = rich.hypothesis;
  const Problem::Vector found = rich.fitted.fit.x.tail(std::ssize(law.extra));
  std::vector<double> own = plain.starts.front();
  bool shared = false;
  const auto take = [&](std::size_t i, std::size_t from) {
    own[i] = std::clamp(found[static_cast<Eigen::Index>(from)], plain.extra[i].lower,
                        plain.extra[i].upper);
    shared = true;
  };
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (std::size_t k = 0; k < law.extra.size(); ++k)
      if (law.extra[k].name == plain.extra[i].name) take(i, k);
  }
  const std::size_t size = SizeOf(plain);
  const std::string_view unit = UnitOf(plain, plain.extra[size].name);
  if (const auto alike = Heirs(law, "", unit); !shared && !alike.empty()) take(size, alike.front());
  if (!shared) return {};
  return Append(rich.fitted.fit.x.head(rich.first_extra()), own);
}

}  // namespace continuum
