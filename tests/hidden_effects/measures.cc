#include "hidden_effects/measures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "hidden_effects/families.h"
#include "hidden_effects/robot.h"

namespace continuum::hidden {
namespace {

using Test = bool (*)(const Outcome&);

constexpr std::size_t kFew = 4;       // names: more than that tell nothing
constexpr double kDetected = 0.0012;  // p-value in the median, where 5 % detect with a power of 0.9
constexpr double kApart = 15;         // λ of the closest rival
constexpr double kNormalCpu = 120;    // s on both of two cores: 60 s by the clock

std::optional<Goal> AtLeast(double share) { return Goal{share, 1}; }
std::optional<Goal> AtMost(double share) { return Goal{0, share}; }

bool Nothing(const Outcome& o) { return o.effects.empty() && o.spoilt.empty(); }
bool Single(const Outcome& o) { return o.effects.size() == 1 && o.listed; }
bool Pair(const Outcome& o) { return o.effects.size() == 2 && o.listed; }
bool Sized(const Outcome& o) { return Single(o) && o.HasSize(); }
bool Answered(const Outcome& o) { return o.verdict != "no answer"; }
bool Robots(const Outcome& o) { return o.suite == "robots"; }
bool Outside(const Outcome& o) { return o.suite == "outside"; }
bool Background(const Outcome& o) { return o.suite == "background"; }
bool IsAlone(const Outcome& o) { return o.unique && o.right; }
bool IsWrongAlone(const Outcome& o) { return o.unique && !o.right; }
bool IsAlarm(const Outcome& o) { return o.verdict != "adequate"; }

bool IsOne(const std::string& of, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), of) != names.end();
}

bool IsOfFamily(const Outcome& o, const std::string& member) {
  return !o.named.empty() && IsOne(o.named.front(), FamilyOf(member));
}

// In the outside suite: nothing else looks the same, and it is at least moderate.
bool IsIsolable(const Outcome& o) {
  return o.factor >= 1 && RobotNamed(o.robot).Named(o.effects.front()).siblings.empty();
}

bool IsWithin15Percent(const Outcome& o) {
  return IsAlone(o) && std::abs(o.value - o.truth) <= 0.15 * std::abs(o.truth);
}

class Tally {
 public:
  explicit Tally(const std::vector<Outcome>& outcomes) : outcomes_(outcomes) {}

  // Of the cases that are all of some, the share that is good.
  Tally& Share(const std::string& name, std::optional<Goal> small, std::optional<Goal> large,
               const std::vector<Test>& some, Test good) {
    int n = 0, yes = 0;
    for (const Outcome* o : Those(some)) ++n, yes += good(*o);
    return Add(name, small, large, n ? static_cast<double>(yes) / n : 0, n);
  }
  Tally& Median(const std::string& name, std::optional<Goal> small, std::optional<Goal> large,
                const std::vector<Test>& some, double (*value)(const Outcome&)) {
    std::vector<double> values;
    for (const Outcome* o : Those(some)) values.push_back(value(*o));
    const auto middle = values.begin() + std::ssize(values) / 2;
    std::nth_element(values.begin(), middle, values.end());
    return Add(name, small, large, values.empty() ? 0 : *middle, static_cast<int>(values.size()));
  }

  std::vector<Measure> measures() const { return measures_; }

 private:
  std::vector<const Outcome*> Those(const std::vector<Test>& some) const {
    std::vector<const Outcome*> those;
    for (const Outcome& o : outcomes_) {
      if (std::all_of(some.begin(), some.end(), [&](Test test) { return test(o); }))
        those.push_back(&o);
    }
    return those;
  }
  Tally& Add(const std::string& name, std::optional<Goal> small, std::optional<Goal> large,
             double reached, int n) {
    measures_.push_back({name, small, large, reached, n});
    return *this;
  }

  const std::vector<Outcome>& outcomes_;
  std::vector<Measure> measures_;
};

void AddRobots(Tally& t) {
  const Test detected = [](const Outcome& o) { return o.p <= kDetected; };
  const Test unlisted = [](const Outcome& o) { return o.effects.size() == 1 && !o.listed; };
  t.Share("false alarms in all, nothing hidden", AtMost(0.085), Goal{0.029, 0.071},
          {Robots, Nothing}, IsAlarm)
      .Share("truth in the set, detection power >= 0.9", AtLeast(0.9), AtLeast(0.95),
             {Robots, Single, detected}, [](const Outcome& o) { return o.right; })
      .Share("one name, and wrong", AtMost(0.03), AtMost(0.01), {Robots, Single}, IsWrongAlone)
      .Share("one name, right, every rival 15 apart", AtLeast(0.85), AtLeast(0.95),
             {Robots, Single, [](const Outcome& o) { return o.closest >= kApart; }}, IsAlone)
      .Share("not in the library: unexplained, a set or a sibling", AtLeast(0.8), AtLeast(0.9),
             {Robots, unlisted}, IsRight)
      .Share("not in the library: one name, and wrong", std::nullopt, AtMost(0.05),
             {Robots, unlisted}, [](const Outcome& o) { return o.unique && !o.sibling; })
      .Share("two causes: both found", std::nullopt, AtLeast(0.85), {Robots, Pair}, IsRight);
}

void AddNumbers(Tally& t) {
  t.Median("size of the effect: |error|, median", std::nullopt, AtMost(0.02), {Robots, Sized},
           [](const Outcome& o) { return std::abs(o.value - o.truth) / std::abs(o.truth); })
      .Share("size of the effect: 95 % interval holds", std::nullopt, Goal{0.93, 0.97},
             {Robots, Sized}, [](const Outcome& o) { return o.Covered(); })
      .Median("held-out explainable error removed, median", AtLeast(0.001), AtLeast(0.9),
              {Robots, Single, IsAlone, [](const Outcome& o) { return o.explained.has_value(); }},
              [](const Outcome& o) { return *o.explained; })
      .Share("named: held-out error does not rise (else not offered)", std::nullopt, std::nullopt,
             {[](const Outcome& o) { return !o.named.empty(); }},
             [](const Outcome& o) { return o.removed >= 0; })
      .Share("proposed experiment leaves one right name", std::nullopt, AtLeast(0.8),
             {[](const Outcome& o) { return o.followed && o.right; }},
             [](const Outcome& o) { return o.followed->right && o.followed->unique; })
      .Share("at most 120 s of processor time", std::nullopt, AtLeast(1), {Answered},
             [](const Outcome& o) { return o.cpu <= kNormalCpu; });
}

void AddOutside(Tally& t) {
  t.Share("outside: right", std::nullopt, AtLeast(0.9), {Outside}, IsRight)
      .Share("outside: one effect, in the set", std::nullopt, AtLeast(0.95), {Outside, Single},
             [](const Outcome& o) { return o.right; })
      .Share("outside: the same, by its very name", std::nullopt, std::nullopt, {Outside, Single},
             [](const Outcome& o) { return o.exact; })
      .Share("outside: isolable, right and alone", std::nullopt, AtLeast(0.9),
             {Outside, Single, IsIsolable}, IsAlone)
      .Share("outside: pairs, both", std::nullopt, AtLeast(0.8), {Outside, Pair}, IsRight)
      .Share("outside: no answer", std::nullopt, AtMost(0), {Outside},
             [](const Outcome& o) { return !Answered(o); })
      .Share("outside: 95 % interval holds, as if no number were off", std::nullopt, std::nullopt,
             {Outside, Sized}, [](const Outcome& o) { return o.Covered(); })
      .Share("outside: the same, lengths and masses off by 1.5 %", std::nullopt, AtLeast(0.93),
             {Outside, Sized}, [](const Outcome& o) { return o.CoveredIfNumbersAreOff(); })
      .Share("outside: 2 kg on the pendulum within 15 %", AtLeast(1), AtLeast(1),
             {Outside, Single,
              [](const Outcome& o) {
                return o.robot == "pendulum" && o.effects.front() == "payload" && o.truth == 2;
              }},
             IsWithin15Percent);
}

void AddBackground(Tally& t) {
  const Test first = [](const Outcome& o) {
    return !o.named.empty() && o.named.front() == o.effects.front();
  };
  t.Share("background: likeliest name is right", AtLeast(0.65), AtLeast(0.75), {Background, Single},
          first)
      .Share("background: truth in the set", std::nullopt, AtLeast(0.95), {Background, Single},
             [](const Outcome& o) { return o.right; })
      .Share("background: one name, and wrong", AtMost(0.1), AtMost(0.05), {Background, Single},
             IsWrongAlone)
      .Share("background alone: one name", AtMost(0.1), AtMost(0.1), {Background, Nothing},
             [](const Outcome& o) { return o.unique; });
}

void AddSpoilt(Tally& t) {
  t.Share("wrong registration: found, or no name", AtLeast(1), AtLeast(1),
          {[](const Outcome& o) { return o.spoilt == "turned" || o.spoilt == "late"; }}, IsRight)
      .Share("inputs flipped or of another run: one name", AtMost(0), AtMost(0),
             {[](const Outcome& o) { return o.spoilt == "flipped" || o.spoilt == "exchanged"; }},
             [](const Outcome& o) { return o.unique; });
}

std::string Percent(double share) { return fmt::format("{:.3g}", 100 * share); }

std::string GoalText(const std::optional<Goal>& goal) {
  if (!goal) return "";
  if (goal->low > 0 && goal->high < 1)
    return Percent(goal->low) + " to " + Percent(goal->high) + " %";
  return (goal->low > 0 ? ">= " + Percent(goal->low) : "<= " + Percent(goal->high)) + " %";
}

}  // namespace

bool Measure::Meets(const std::optional<Goal>& goal) const {
  return !goal || n == 0 || (goal->low <= reached && reached <= goal->high);
}

bool IsRight(const Outcome& o) {
  if (o.verdict == "no answer") return false;
  if (o.spoilt == "late" && IsOfFamily(o, "dead_time")) return true;
  if (!o.spoilt.empty()) return !o.unique;
  if (o.effects.empty() && o.suite == "outside") return !o.unique || IsOfFamily(o, "payload");
  if (o.effects.empty()) return o.suite == "background" ? !o.unique : o.verdict == "adequate";
  if (!o.listed)
    return o.verdict == "unexplained" || ((o.sibling || o.right) && o.named.size() <= kFew);
  return o.right && o.named.size() + o.partner.size() <= kFew;
}

std::vector<Measure> MeasuresOf(const std::vector<Outcome>& outcomes) {
  Tally t(outcomes);
  AddRobots(t), AddNumbers(t), AddOutside(t), AddBackground(t), AddSpoilt(t);
  return t.measures();
}

std::string MeasureTable(const std::vector<Measure>& measures) {
  std::string text = fmt::format("{:<50} {:>12} {:>14} {:>9}   of\n", "measure", "goal small",
                                 "goal large", "reached");
  for (const Measure& m : measures) {
    text += fmt::format("{:<50} {:>12} {:>14} ", m.name, GoalText(m.small), GoalText(m.large));
    text += m.n == 0 ? fmt::format("{:>9}\n", "not run")
                     : fmt::format("{:>7} %   {}{}\n", Percent(m.reached), m.n,
                                   m.Meets(m.large) ? "" : "   missed");
  }
  return text;
}

}  // namespace continuum::hidden
