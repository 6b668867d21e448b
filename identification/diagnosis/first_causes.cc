#include "identification/diagnosis/first_causes.h"

#include <algorithm>
#include <string>

#include "identification/diagnosis/search_rules.h"
#include "identification/diagnosis/verdict.h"

namespace continuum {
namespace {

struct Family {
  std::string name;
  const CandidateResult *best, *plain = nullptr;
};

bool IsPlainer(const CandidateResult& a, const CandidateResult& b) {
  return KinOf(a.hypothesis.Card()).PlainerThan(KinOf(b.hypothesis.Card()));
}

// Another one of a family that has a best one.
void Join(const CandidateResult& c, Family& family, const Criteria& criteria) {
  if (!IsPlainer(c, *family.best) || (family.plain && !IsPlainer(c, *family.plain))) return;
  if (c.likelihood >= criteria.family_share * family.best->likelihood) {
    family.best = &c;
  } else if (MayDoBesideAnother(c.likelihood, family.best->likelihood, criteria)) {
    family.plain = &c;
  }
}

}  // namespace

std::vector<const CandidateResult*> FirstCauses(const std::vector<CandidateResult>& candidates,
                                                const Criteria& criteria) {
  std::vector<Family> families;
  for (const CandidateResult& c : candidates) {
    if (!c.was_fitted) continue;
    const std::string name = FamilyOf(c.hypothesis.Card());
    const auto known = std::find_if(families.begin(), families.end(),
                                    [&](const Family& f) { return f.name == name; });
    if (known != families.end()) {
      Join(c, *known, criteria);
    } else if (static_cast<double>(families.size()) < criteria.pair_singles) {
      families.push_back({name, &c});
    }
  }
  std::vector<const CandidateResult*> firsts;
  for (const Family& f : families) {
    if (f.plain && IsPlainer(*f.plain, *f.best)) firsts.push_back(f.plain);
    firsts.push_back(f.best);
  }
  return firsts;
}

}  // namespace continuum
