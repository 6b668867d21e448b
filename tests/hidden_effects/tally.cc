#include "hidden_effects/tally.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

#include "binding/effect_catalog.h"
#include "hidden_effects/families.h"

namespace continuum::hidden {
namespace {

constexpr char kAll[] = "all", kTwo[] = "two effects", kNothing[] = "nothing";

bool One(const Outcome& o) { return o.effects.size() == 1 && o.listed; }

std::string RowOf(const Outcome& o) {
  if (o.effects.empty()) return kNothing;
  if (o.effects.size() > 1) return kTwo;
  return GroupOf(o.effects.front()) + (o.listed ? "" : ", not listed");
}

std::string ColumnOf(const Outcome& o) {
  if (o.named.empty()) return o.verdict;
  return o.partner.empty() ? GroupOf(o.named.front()) : kTwo;
}

std::string WorthOf(const Outcome& o) {
  if (o.named.empty()) return o.verdict;
  return (o.verdict == "named" ? "named" : "set") + std::string(o.right ? ", right" : ", wrong");
}

std::size_t IndexOf(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

// Nothing first, then the groups, and what is not listed last.
std::vector<std::string> Rows(const std::vector<Outcome>& outcomes) {
  std::set<std::string> none, listed, two, unlisted;
  for (const Outcome& o : outcomes) {
    auto& rows = o.effects.empty()      ? none
                 : o.effects.size() > 1 ? two
                 : o.listed             ? listed
                                        : unlisted;
    rows.insert(RowOf(o));
  }
  std::vector<std::string> rows;
  for (const auto* some : {&none, &listed, &two, &unlisted})
    rows.insert(rows.end(), some->begin(), some->end());
  return rows;
}

Matrix Against(const std::vector<Outcome>& outcomes, std::string title,
               std::vector<std::string> columns, std::string (*column)(const Outcome&)) {
  Matrix m{std::move(title), Rows(outcomes), std::move(columns), {}};
  m.count.assign(m.rows.size(), std::vector<int>(m.columns.size(), 0));
  for (const Outcome& o : outcomes)
    ++m.count.at(IndexOf(m.rows, RowOf(o))).at(IndexOf(m.columns, column(o)));
  return m;
}

// The error of a size in standard deviations, by the side of its interval on which the truth lies.
double ErrorOf(const Outcome& o) {
  constexpr double k95 = 1.959964;
  const double half = o.truth > o.value ? o.high - o.value : o.value - o.low;
  return k95 * std::abs(o.truth - o.value) / half;
}

}  // namespace

std::string GroupOf(const std::string& effect) {
  if (IsDryFriction(effect)) return "dry friction";
  if (const auto family = FamilyOf(effect); family.size() > 1)
    return family.front() == "payload" ? "mass" : "lateness";
  const EffectInfo& info = EffectNamed(effect);
  if (info.kind == EffectInfo::Kind::kMeasure) return "measurement";
  if (info.places.front() == Place::kActuator) return "input";
  if (info.kind == EffectInfo::Kind::kEdit) return "load";
  return std::string(KindName(info.kind));
}

Matrix Confusion(const std::vector<Outcome>& outcomes) {
  std::set<std::string> groups;
  for (const Outcome& o : outcomes) {
    if (o.effects.size() == 1) groups.insert(GroupOf(o.effects.front()));
    if (!o.named.empty() && o.partner.empty()) groups.insert(GroupOf(o.named.front()));
  }
  std::vector<std::string> columns(groups.begin(), groups.end());
  columns.insert(columns.end(), {kTwo, "unexplained", "adequate"});
  return Against(outcomes, "hidden, and likeliest name", std::move(columns), ColumnOf);
}

Matrix Worth(const std::vector<Outcome>& outcomes) {
  return Against(
      outcomes, "hidden, and answer",
      {"named, right", "set, right", "set, wrong", "named, wrong", "unexplained", "adequate"},
      WorthOf);
}

std::vector<Power> PowerOf(const std::vector<Outcome>& outcomes) {
  std::map<std::string, std::map<double, Power::Point>> groups;
  for (const Outcome& o : outcomes) {
    if (!One(o)) continue;
    for (const std::string& group : {GroupOf(o.effects.front()), std::string(kAll)}) {
      Power::Point& p = groups[group][o.factor];
      p.factor = o.factor;
      ++p.n, p.in_set += o.right, p.alone += o.right && o.unique;
    }
  }
  std::vector<Power> all;
  for (const auto& [group, points] : groups) {
    all.push_back({group, {}});
    for (const auto& [factor, point] : points) all.back().points.push_back(point);
  }
  std::stable_partition(all.begin(), all.end(), [](const Power& p) { return p.group != kAll; });
  return all;
}

std::vector<Stated> ReliabilityOf(const std::vector<Outcome>& outcomes) {
  constexpr double kEdges[] = {0, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 1};
  std::vector<Stated> bins;
  for (std::size_t i = 0; i + 1 < std::size(kEdges); ++i)
    bins.push_back({kEdges[i], kEdges[i + 1]});
  for (const Outcome& o : outcomes) {
    if (!One(o)) continue;
    for (const auto& [effect, p] : o.stated) {
      const auto bin =
          std::find_if(bins.begin(), bins.end() - 1, [p = p](const Stated& s) { return p < s.to; });
      ++bin->n, bin->sum += p, bin->true_ones += effect == o.effects.front();
    }
  }
  return bins;
}

std::vector<Coverage> CoverageOf(const std::vector<Outcome>& outcomes) {
  std::vector<Coverage> all;
  for (const double nominal : {0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99}) {
    all.push_back({nominal});
    for (const Outcome& o : outcomes) {
      if (!One(o) || !o.HasSize()) continue;
      ++all.back().n;
      all.back().covered += std::erf(ErrorOf(o) / std::numbers::sqrt2) <= nominal;
    }
  }
  return all;
}

std::vector<Covered> CoveredByGroup(const std::vector<Outcome>& outcomes) {
  std::map<std::string, Covered> groups;
  for (const Outcome& o : outcomes) {
    if (!One(o) || !o.HasSize()) continue;
    Covered& c = groups[GroupOf(o.effects.front())];
    ++c.n, c.covered += o.Covered();
  }
  std::vector<Covered> all;
  for (auto& [group, c] : groups) {
    c.group = group;
    all.push_back(c);
  }
  return all;
}

}  // namespace continuum::hidden
