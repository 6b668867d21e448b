#include "identification/candidates/candidate_generator.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "binding/config.h"
#include "binding/effect_catalog.h"
#include "error.h"
#include "identification/candidates/conflicts.h"
#include "identification/candidates/effect_places.h"
#include "identification/candidates/measurement_candidates.h"
#include "identification/candidates/model_candidates.h"
#include "identification/candidates/per_condition.h"

namespace continuum {
namespace {

using Kind = EffectInfo::Kind;
using Names = std::vector<std::string>;

// So many objects are few: each is tried too, beside all of them together.
constexpr std::size_t kFew = 4;

// The objects at which an effect that has no place is tried, out of those of one kind. first:
// whether it is the kind that it usually acts on; together: whether it may act on all of them.
std::vector<Names> ObjectsToTry(const Names& names, Place place, bool first, bool together,
                                SearchScope scope) {
  std::vector<Names> chosen;
  const bool others = scope == SearchScope::kOthers;
  if (!first && place != Place::kTendon) return chosen;
  if (together && others != first) chosen.push_back(names);
  const bool one_by_one = (names.size() > kFew || !first || !together) == others;
  for (std::size_t i = 0; one_by_one && names.size() > 1 && i < names.size(); ++i)
    chosen.push_back({names[i]});
  return chosen;
}

// The candidates of one entry of the list.
class Entry {
 public:
  Entry(const Candidate& wanted, const CandidateContext& context, SearchScope scope,
        std::vector<Hypothesis>& all, Names& skipped)
      : effect_(EffectNamed(wanted.effect)),
        wanted_(wanted),
        c_(context),
        scope_(scope),
        all_(all),
        skipped_(skipped) {}

  void Add() {
    Check();
    // Of segments and sensors the other places leave nothing out.
    const bool few = scope_ == SearchScope::kFew;
    if (effect_.kind == Kind::kSegment) {
      if (few) AddBesideSegments();
    } else if (effect_.kind == Kind::kMeasure) {
      if (few) AddMeasured();
    } else {
      AddAtObjects();
    }
  }

 private:
  const mjModel& model() const { return c_.from.system->model(); }
  bool anywhere() const { return wanted_.where.empty(); }
  // What follows the kind of object in `where`.
  std::string Globs() const {
    return anywhere() ? "*" : wanted_.where.substr(wanted_.where.find(':') + 1);
  }

  void Check() const {
    if (!wanted_.per_condition) return;
    if (effect_.kind == Kind::kMeasure)
      throw Error::Input(
          fmt::format("{}: candidates: {}: per", c_.experiment.file.string(), wanted_.Name()),
          "an effect of the model", "one of the measurement");
    TrainedConditions(c_.experiment, wanted_.Name());
  }

  void Skip(const std::string& why) {
    const std::string text = wanted_.Name() + why;
    if (std::find(skipped_.begin(), skipped_.end(), text) == skipped_.end())
      skipped_.push_back(text);
  }

  void AddBesideSegments() {
    const std::string why = ConflictBesideSegments(effect_, c_.experiment, model());
    if (!why.empty()) return Skip(": " + why);
    const Names segments = SegmentsFor(model(), effect_);
    if (segments.empty()) Skip(": no soft segment in the model");
    for (const std::string& segment : segments) TryAt({Place::kBody, {segment}});
  }

  void AddMeasured() {
    if (IsOfClock(effect_)) return TryAt({Place::kSensor, {}});
    const auto sets = OutputsTogether(effect_, Globs(), c_.experiment, model());
    if (sets.empty()) Skip(": no output that it acts on");
    for (const Names& names : sets) TryAt({Place::kSensor, names});
  }

  // At objects of the model. Throws Error where the experiment asks for a place that it has not.
  void AddAtObjects() {
    const std::size_t colon = wanted_.where.find(':');
    bool first = true;
    for (const Place place : effect_.places) {
      if (anywhere() ? place == Place::kSite && effect_.places.size() > 1
                     : wanted_.where.substr(0, colon) != PlaceName(place))
        continue;  // a site is a body's
      const Names names = PlacesFor(model(), effect_, place, Globs(), c_.experiment);
      if (names.empty()) continue;
      if (!AddAtPlace(place, names, first)) return;
      first = false;
    }
    if (!first) return;
    if (!anywhere() && !IsInModel()) {
      throw Error::Input(
          fmt::format("{}: candidates: {}", c_.experiment.file.string(), wanted_.Name()),
          "a place in the model where the effect can act", wanted_.where);
    }
    Skip(anywhere() ? ": " + WhyNowhere() : " at " + wanted_.where + ": it cannot act there");
  }

  // Returns whether other kinds of objects are to be tried too.
  bool AddAtPlace(Place place, const Names& names, bool first) {
    const bool few = scope_ == SearchScope::kFew;
    const std::string conflict = Conflict(place, names);
    if (few && first && !conflict.empty()) {
      Skip(": " + conflict);
      return false;
    }
    std::vector<Names> chosen;
    if (anywhere()) chosen = ObjectsToTry(names, place, first, conflict.empty(), scope_);
    if (!anywhere() && few) chosen.push_back(names);
    for (const Names& some : chosen) {
      if (Conflict(place, some).empty()) TryAt({place, some});
    }
    return true;
  }

  std::string Conflict(Place place, const Names& names) const {
    return wanted_.law ? "" : ConflictAt(effect_, place, names, c_.experiment, model());
  }

  // Whether `where` names anything of a kind on which the effect may act.
  bool IsInModel() const {
    const std::string kind = wanted_.where.substr(0, wanted_.where.find(':'));
    return std::any_of(effect_.places.begin(), effect_.places.end(), [&](Place place) {
      return kind == PlaceName(place) && !NamesLike(model(), place, Globs()).empty();
    });
  }

  std::string WhyNowhere() const {
    for (const Place place : effect_.places) {
      const int count = ObjectCount(model(), place);
      if (count > 0 && NamesLike(model(), place, "*").empty())
        return fmt::format("no {} of the model has a name to bind it to", PlaceName(place));
    }
    return "nothing in the model to bind it to";
  }

  // Where the model cannot have it on all of the objects, on those where it can.
  void TryAt(const ObjectSet& objects) {
    for (int option = 0; option < OptionCount(effect_, wanted_); ++option) {
      const std::string why = TryAt(objects, option);
      if (why.empty()) continue;
      const Names able = Able(objects, option, why);
      if (!able.empty()) TryAt({objects.place, able}, option);
    }
  }

  // Returns why the model cannot have it; empty when it can.
  std::string TryAt(const ObjectSet& objects, int option) {
    try {
      Take(HypothesisAt(effect_, wanted_, objects, option, c_));
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  }

  // Those objects of several on which the model can have it one by one, if they are fewer; says why
  // of the others. why: of all together.
  Names Able(const ObjectSet& objects, int option, std::string why) {
    Names able, others;
    for (const std::string& name : objects.names) {
      try {
        if (objects.names.size() > 1) {
          HypothesisAt(effect_, wanted_, {objects.place, {name}}, option, c_);
          able.push_back(name);
          continue;
        }
      } catch (const Error& error) {
        if (others.empty()) why = error.what();
      }
      others.push_back(name);
    }
    if (others.empty()) others = std::exchange(able, {});
    const std::string where =
        objects.names.empty() ? "" : " at " + PlaceText(objects.place, others);
    Skip(where + ": " + why);
    return able;
  }

  // Places may be spelt in several ways: of one hypothesis there is one.
  void Take(Hypothesis h) {
    const auto same = [&](const Hypothesis& other) {
      return other.NameAtPlace() == h.NameAtPlace();
    };
    if (std::none_of(all_.begin(), all_.end(), same)) all_.push_back(std::move(h));
  }

  const EffectInfo& effect_;
  const Candidate& wanted_;
  const CandidateContext& c_;
  SearchScope scope_;
  std::vector<Hypothesis>& all_;
  Names& skipped_;
};

std::vector<Candidate> WholeCatalog() {
  std::vector<Candidate> all;
  for (const EffectInfo& effect : Catalog()) {
    if (!effect.only_listed) all.push_back({std::string(effect.name), "", false});
  }
  return all;
}

}  // namespace

std::vector<Hypothesis> MakeCandidates(const std::vector<Candidate>& list, const Experiment& e,
                                       const SearchBase& from, const Sizes& sizes,
                                       std::vector<std::string>& skipped, SearchScope scope) {
  const CandidateContext context{e, from, sizes};
  std::vector<Hypothesis> all;
  for (const Candidate& c : list) Entry(c, context, scope, all, skipped).Add();
  return all;
}

std::vector<Hypothesis> MakeCandidates(const Experiment& e, const SearchBase& from,
                                       const Sizes& sizes, std::vector<std::string>& skipped,
                                       SearchScope scope) {
  return MakeCandidates(e.all_candidates ? WholeCatalog() : e.candidates, e, from, sizes, skipped,
                        scope);
}

std::vector<std::string> Unlisted(const Experiment& e, const std::vector<std::string>& names) {
  std::set<std::string> listed(names.begin(), names.end());
  if (names.empty()) {
    for (const Candidate& c : e.candidates) listed.insert(c.effect);
  }
  std::vector<std::string> others;
  if (listed.empty() || (names.empty() && e.all_candidates)) return others;
  for (const Candidate& c : WholeCatalog()) {
    if (!listed.contains(c.effect)) others.push_back(c.effect);
  }
  return others;
}

}  // namespace continuum
