#include "hidden_effects/report.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "hidden_effects/measures.h"

namespace continuum::hidden {
namespace {

// Counts of one group of cases.
struct Count {
  int n = 0, alarm = 0, right = 0, unique_right = 0, unique_wrong = 0, covered = 0, with_value = 0;
  double seconds = 0;
  void Add(const Outcome& o) {
    ++n;
    alarm += o.verdict != "adequate";
    right += o.right;
    unique_right += o.unique && o.right;
    unique_wrong += o.unique && !o.right;
    seconds += o.seconds;
    with_value += o.HasSize();
    covered += o.HasSize() && o.Covered();
  }
};

struct Counts {
  std::map<std::string, Count> none, effects, unlisted;
  Count all, pairs;

  explicit Counts(const std::vector<Outcome>& outcomes) {
    for (const Outcome& o : outcomes) {
      if (o.effects.empty()) {
        none[o.noise].Add(o);
      } else if (o.effects.size() > 1) {
        pairs.Add(o);
      } else if (!o.listed) {
        unlisted[o.effects.front()].Add(o);
      } else {
        effects[o.effects.front()].Add(o);
        all.Add(o);
      }
    }
  }
};

std::string EffectRow(const std::string& name, const Count& c) {
  return fmt::format("  {:<18} {:3} {:3} {:3} of {:3}   {:3} of {:3}", name, c.right,
                     c.unique_right, c.unique_wrong, c.n, c.covered, c.with_value);
}

std::string ByEffect(const Counts& counts) {
  std::string text = "nothing hidden: alarms\n";
  for (const auto& [noise, c] : counts.none)
    text += fmt::format("  {:<18} {:3} of {:3}\n", noise, c.alarm, c.n);
  text +=
      "hidden and listed: truth in the set, one right name, one wrong name, intervals that "
      "cover\n";
  for (const auto& [name, c] : counts.effects)
    text += EffectRow(name, c) + fmt::format("   {:.1f} s each\n", c.seconds / c.n);
  text += EffectRow("all", counts.all) + "\n";
  text += fmt::format("two hidden: both found {} of {}, single names that are wrong {}\n",
                      counts.pairs.right, counts.pairs.n, counts.pairs.unique_wrong);
  text += "hidden and not listed: one (wrong) name\n";
  for (const auto& [name, c] : counts.unlisted)
    text += fmt::format("  {:<18} {:3} of {:3}\n", name, c.unique_wrong, c.n);
  return text;
}

std::string ApartText(const std::vector<Outcome>& outcomes) {
  constexpr double kApart = 15;
  int n = 0, right = 0;
  for (const Outcome& o : outcomes) {
    if (o.effects.size() != 1 || !o.listed || o.closest < kApart) continue;
    ++n;
    right += o.unique && o.right;
  }
  return fmt::format("one right name where every other effect is apart by {:g} or more: {} of {}\n",
                     kApart, right, n);
}

std::string FollowedText(const std::vector<Outcome>& outcomes) {
  int n = 0, kept = 0, resolved = 0, wrong = 0;
  for (const Outcome& o : outcomes) {
    if (!o.followed || !o.right) continue;
    ++n;
    kept += o.followed->right;
    resolved += o.followed->right && o.followed->unique;
    wrong += !o.followed->right && o.followed->unique;
  }
  if (n == 0) return "";
  return fmt::format(
      "sets with the truth, after the proposed experiment: one right name {} of {}, "
      "truth in the set {}, one wrong name {}\n",
      resolved, n, kept, wrong);
}

std::string MatrixText(const Matrix& m) {
  std::size_t width = 0;
  for (const auto& row : m.rows) width = std::max(width, row.size());
  std::string text = fmt::format("{}\n  {:<{}}", m.title, "", width);
  for (const auto& column : m.columns) text += "  " + column;
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    text += fmt::format("\n  {:<{}}", m.rows[i], width);
    for (std::size_t j = 0; j < m.columns.size(); ++j)
      text += fmt::format("  {:>{}}", m.count[i][j], m.columns[j].size());
  }
  return text + "\n";
}

std::string PowerText(const std::vector<Power>& curves) {
  std::string text = "power: truth in the set (alone) of how many, over the size\n";
  for (const Power& curve : curves) {
    text += fmt::format("  {:<16}", curve.group);
    for (const Power::Point& p : curve.points)
      text += fmt::format("  x{:g}: {} ({}) of {}", p.factor, p.in_set, p.alone, p.n);
    text += "\n";
  }
  return text;
}

std::string ReliabilityText(const std::vector<Stated>& bins) {
  std::string text = "reliability: stated probability, its mean, share that is true\n";
  for (const Stated& s : bins) {
    if (s.n == 0) continue;
    text += fmt::format("  {:4.2f} to {:4.2f}  {:.3f}  {:.3f}  ({} of {})\n", s.from, s.to,
                        s.sum / s.n, static_cast<double>(s.true_ones) / s.n, s.true_ones, s.n);
  }
  return text;
}

std::string CoverageText(const std::vector<Outcome>& outcomes) {
  std::string text = "coverage: nominal share, true sizes within\n";
  for (const Coverage& c : CoverageOf(outcomes)) {
    if (c.n > 0) text += fmt::format("  {:4.2f}  {:3} of {:3}\n", c.nominal, c.covered, c.n);
  }
  text += "intervals of 95 % that cover, by group\n";
  for (const Covered& c : CoveredByGroup(outcomes))
    text += fmt::format("  {:<16} {:3} of {:3}\n", c.group, c.covered, c.n);
  return text;
}

}  // namespace

std::string Report(const std::vector<Outcome>& outcomes) {
  return MeasureTable(MeasuresOf(outcomes)) + ByEffect(Counts(outcomes)) + ApartText(outcomes) +
         FollowedText(outcomes) + MatrixText(Worth(outcomes)) + MatrixText(Confusion(outcomes)) +
         PowerText(PowerOf(outcomes)) + ReliabilityText(ReliabilityOf(outcomes)) +
         CoverageText(outcomes);
}

}  // namespace continuum::hidden
