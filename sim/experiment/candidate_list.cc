#include "sim/experiment/candidate_list.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "effects/all.h"
#include "error.h"
#include "sim/experiment/formula_candidate.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

// Every effect of the list, to be tried wherever it makes sense.
std::vector<Candidate> AllCandidates() {
  std::vector<Candidate> all;
  All::ForEach([&]<class E>() {
    if constexpr (requires { E::kOnlyListed; }) return;
    all.push_back({std::string(E::kName), "", false});
  });
  return all;
}

Candidate ReadCandidate(const Yaml& y) {
  Candidate c;
  const Yaml name = y.IsMap() ? y.At("effect") : y;
  c.effect = name.Text();
  if (y.IsMap() && IsWritten(c.effect)) return ReadWrittenLaw(y, c.effect);
  bool known = false;
  std::string all;
  All::ForEach([&]<class E>() {
    known |= c.effect == E::kName;
    all += (all.empty() ? "" : ", ") + std::string(E::kName);
  });
  if (!known) throw Error::Input(name.Where(), "an effect: " + all, "'" + c.effect + "'");
  if (!y.IsMap()) return c;
  y.Only({"effect", "where", "per"});
  if (const auto where = y.Find("where")) c.where = where->Text();
  if (const auto per = y.Find("per")) {
    if (per->Text() != "condition")
      throw Error::Input(per->Where(), "condition", "'" + per->Text() + "'");
    c.per_condition = true;
  }
  return c;
}

bool SameNumber(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool SameParameter(const Parameter& a, const Parameter& b) {
  return a.name == b.name && a.unit == b.unit && a.initial == b.initial && a.lower == b.lower &&
         a.upper == b.upper;
}

bool SameLaw(const Candidate& a, const Candidate& b) {
  const WrittenLaw &x = *a.law, &y = *b.law;
  return a.effect == b.effect && x.formula == y.formula &&
         std::equal(x.parameters.begin(), x.parameters.end(), y.parameters.begin(),
                    y.parameters.end(), SameParameter) &&
         std::equal(x.null.begin(), x.null.end(), y.null.begin(), y.null.end(), SameNumber);
}

// Results go by the name: another law of that name would hide behind the first.
void RequireNew(const Candidate& c, const std::vector<std::pair<Candidate, std::string>>& before,
                const Yaml& y) {
  for (const auto& [other, where] : before) {
    const bool other_law = c.law && other.law && !SameLaw(c, other);
    if (c == other || (other_law && c.Name() == other.Name()))
      throw Error::Input(y.Where(), "a candidate that is not yet there",
                         "'" + c.Name() + "' again, as in " + where);
  }
}

}  // namespace

std::vector<Candidate> ReadCandidates(const Yaml& list) {
  std::vector<Candidate> candidates;
  std::vector<std::pair<Candidate, std::string>> single;  // and where they stand
  for (const Yaml& item : list.Items()) {
    if (item.IsScalar() && item.Text() == "all") {
      for (Candidate& c : AllCandidates()) candidates.push_back(std::move(c));
      continue;
    }
    const Candidate c = ReadCandidate(item);
    RequireNew(c, single, item);
    single.emplace_back(c, item.Where());
    candidates.push_back(c);
  }
  return candidates;
}

}  // namespace continuum
