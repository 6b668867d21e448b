#include "identification/report/diagnosis_words.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "identification/diagnosis/candidate_fitter.h"
#include "identification/diagnosis/gain.h"
#include "identification/diagnosis/numbers_off.h"
#include "identification/diagnosis/unseen_effects.h"
#include "identification/report/model_changes.h"
#include "sim/io/rounded.h"

namespace continuum {
namespace {

using Kind = Verdict::Kind;

// How many times what noise and time step make an error is; 0 where the noise is not known.
double TimesFloor(const Diagnosis& d, const TwoErrors& error) {
  return d.noise.known() && d.noise.floor() > 0 ? error.train / d.noise.floor() : 0;
}

bool OnlyNoiseRemains(const Diagnosis& d, const TwoErrors& error) {
  return d.verdict.complete && TimesFloor(d, error) > 0;
}

// Other places at which the named effect does as well.
std::vector<std::string> OpenPlaces(const Diagnosis& d) {
  std::vector<std::string> places;
  if (!d.chosen() || !d.noise_limited) return places;
  const Hypothesis& h = d.chosen()->hypothesis;
  for (const CandidateResult& c : d.candidates) {
    const bool same = &c != d.chosen() && c.hypothesis.Name() == h.Name() && c.fitted.complete();
    if (same && d.chosen()->likelihood - c.likelihood < d.criteria.rival_margin)
      places.push_back(c.hypothesis.where);
  }
  return places;
}

std::string Siblings(const Diagnosis& d) {
  std::vector<std::string> names;
  for (const std::size_t i : d.verdict.siblings)
    if (i < d.candidates.size()) names.push_back(d.candidates[i].hypothesis.NameAtPlace());
  return fmt::format("{}", fmt::join(names, ", "));
}

// "a, b, c and 12 more".
std::string FirstOf(const std::vector<std::string>& all) {
  constexpr std::size_t kShown = 4;
  const std::size_t shown = std::min(kShown, all.size());
  const auto end = all.begin() + static_cast<std::ptrdiff_t>(shown);
  std::string text = fmt::format("{}", fmt::join(all.begin(), end, ", "));
  if (all.size() > shown) text += fmt::format(" and {} more", all.size() - shown);
  return text;
}

// What keeps a named cause from being sure, one sentence each.
std::vector<std::string> Doubts(const Diagnosis& d) {
  std::vector<std::string> doubts;
  if (!d.noise.known()) {
    doubts.emplace_back("These logs do not show how large their noise is.");
  } else if (!d.verdict.complete || !d.noise_limited) {
    constexpr double kAbove = 1.05;  // what one digit shows as more than noise
    const double times = TimesFloor(d, d.after());
    doubts.push_back(times > kAbove
                         ? fmt::format("The error with it is still {:.1f} times the noise.", times)
                         : "Its error is no larger than the noise, but does not look like it.");
  }
  if (const auto places = OpenPlaces(d); !places.empty())
    doubts.push_back(fmt::format("It fits as well at {}.", fmt::join(places, " and at ")));
  if (!d.verdict.siblings.empty())
    doubts.push_back(
        fmt::format("Relatives of it fit nearly as well, or as well: {}.", Siblings(d)));
  if (d.chosen() && NumbersMayDoAsMuch(*d.chosen())) {
    doubts.push_back(fmt::format("Lengths and masses that are {:g} % off may do as much.",
                                 100 * d.criteria.link_known));
  }
  for (const std::size_t i : d.verdict.far_off) {
    if (i < d.candidates.size())
      doubts.push_back(fmt::format("{} fits as well, but its size is not plausible.",
                                   d.candidates[i].hypothesis.NameAtPlace()));
  }
  if (const auto unseen = UnseenEffects(d); !unseen.empty())
    doubts.push_back(fmt::format("There was no time to look at {}.", FirstOf(unseen)));
  for (const CandidateResult& c : d.unlisted) {
    doubts.push_back(
        fmt::format("{}, which was not asked for, fits as well.", c.hypothesis.NameAtPlace()));
  }
  if (d.gain_interval && !(d.gain_interval->low > 0))
    doubts.emplace_back("On some of the logs left out it may not help.");
  return doubts;
}

std::string Closest(const Diagnosis& d) {
  const auto leading = d.verdict.leading;
  if (!leading || *leading >= d.candidates.size()) return "";
  const CandidateResult& c = d.candidates[*leading];
  if (!d.noise_limited && !c.failures.empty())
    return fmt::format(" {} comes closest, but {}.", c.hypothesis.NameAtPlace(),
                       c.failures.front());
  return fmt::format(" {} comes closest: it takes {} of what can be explained.",
                     c.hypothesis.NameAtPlace(), Percent(d.verdict.leading_share));
}

std::string Sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// A reason without "(p = 0.001)", which belongs to the details.
std::string WithoutP(std::string reason) {
  for (auto at = reason.find(" (p = "); at != reason.npos; at = reason.find(" (p = "))
    reason.erase(at, reason.find(')', at) - at + 1);
  return reason;
}

std::string WhyUnexplained(const Diagnosis& d) {
  if (!d.verdict.explained_by.empty() || d.verdict.taken_back)
    return Sentence(WithoutP(d.verdict.reason) + ".");
  if (NothingWasTried(d)) return "No candidate was fitted, as there was no time.";
  return (d.left_out.empty() ? "No candidate explains enough of it."
                             : "No candidate that there was time for explains enough of it.") +
         Closest(d);
}

// Whether one of several numbers is a little off, no one knows which.
bool NumbersInstead(const Diagnosis& d) {
  return d.Is(Kind::kAmbiguous) && !d.partner && d.verdict.numbers;
}

std::string WhyAmbiguous(const Diagnosis& d) {
  if (NumbersInstead(d))
    return fmt::format(
        "{} a number by a few per cent. Others that are a little off, such as lengths, may do the "
        "same.",
        d.verdict.named.size() > 1 ? "Each changes" : "It changes");
  if (OnlyCorrections(d))
    return "Both change numbers by a few per cent. Others that are a little off, such as lengths, "
           "may do the same.";
  const std::string alike = "These logs do not distinguish the causes.";
  if (!TooManyUnseen(d)) return alike;
  return fmt::format("{} There was no time to look at {}.",
                     d.verdict.named.size() > 1
                         ? alike
                         : "It does better than every other candidate that there was time for.",
                     FirstOf(UnseenEffects(d)));
}

std::string IntervalInWords(const Diagnosis& d) {
  if (!d.gain_interval) return " (interval not computed)";
  return fmt::format(" (95 %: {} … {})", Fixed(100 * d.gain_interval->low, 0),
                     Percent(d.gain_interval->high));
}

// Where no log is kept for validation.
std::string GainOfFolds(const Diagnosis& d) {
  return Percent(Median(Gains(d.chosen()->record))) +
         " of the error is removed, in the median of the logs that were left out in turn" +
         IntervalInWords(d);
}

// Whether a named cause changes less than the time-discretisation error.
bool IsBelowStep(const Diagnosis& d) {
  return WithoutPart(d.before.error.train, d.chosen()->fitted.error.train) <= d.noise.step;
}

std::string WhyAdequate(const Diagnosis& d) {
  if (d.verdict.numbers_off > 0)
    return fmt::format(
        "What shows in these logs is what lengths and masses would do that are at most {:.1f} % "
        "off.",
        100 * d.verdict.numbers_off);
  return d.noise.known() ? "The error is what the noise and the model's own time step make."
                         : "No candidate lowers the error, but these logs do not show how large "
                           "their noise is.";
}

}  // namespace

bool OnlyCorrections(const Diagnosis& d) {
  return d.Is(Kind::kAmbiguous) && d.partner && d.verdict.named.size() == 1 &&
         d.partner->correction == Partner::Correction::kBoth;
}

std::string WhyNotFitted(const Dismissed& candidate) {
  switch (candidate.why) {
    case Dismissed::Why::kExplainsTooLittle:
      return "to first order it explains too little";
    case Dismissed::Why::kNoTimeForALook:
      return "there was no time for a look at it";
    case Dismissed::Why::kNoTimeForAFit:
      return "there was no time";
    case Dismissed::Why::kOthersInVain:
      return "of many that promise more none did better than the best";
  }
  return "";
}

std::string HeadlineOf(const Diagnosis& d) {
  switch (d.verdict.kind) {
    case Kind::kAdequate:
      return d.verdict.numbers_off > 0
                 ? "The model follows these logs, but for lengths and masses that are a little off"
                 : "The model follows these logs";
    case Kind::kNamed:
      return (d.partner ? "Causes: " : "Cause: ") + CausesInWords(d);
    case Kind::kAmbiguous:
      return (OnlyCorrections(d)  ? "Numbers that are a little off: "
              : NumbersInstead(d) ? "A number that is a little off: "
                                  : "Cause: ") +
             CausesInWords(d);
    case Kind::kUnexplained:
      break;
  }
  if (!d.verdict.explained_by.empty())
    return "Something is missing in the model, and none of the candidates asked for explains it";
  if (d.verdict.open)
    return "There was no time to find out whether something is missing in the model";
  if (!d.left_out.empty())
    return "Something is missing in the model, and there was no time to find out what";
  return "Something is missing in the model, and no candidate explains it";
}

std::string DeviationInWords(const Deviation& d) {
  return fmt::format("**{}**, {} at {}: the simulation {}.", d.log, d.channel, d.when, d.what);
}

std::string InWords(Certainty certainty) {
  switch (certainty) {
    case Certainty::kSure:
      return "sure";
    case Certainty::kLikely:
      return "likely";
    case Certainty::kCannotSay:
      break;
  }
  return "cannot say";
}

Certainty CertaintyOf(const Diagnosis& d) {
  if (d.Is(Kind::kAmbiguous) || d.Is(Kind::kUnexplained)) return Certainty::kCannotSay;
  if (d.interrupted) return Certainty::kLikely;
  if (d.Is(Kind::kAdequate) && d.verdict.numbers_off > 0) return Certainty::kLikely;
  if (d.Is(Kind::kAdequate)) return d.noise.known() ? Certainty::kSure : Certainty::kLikely;
  return Doubts(d).empty() ? Certainty::kSure : Certainty::kLikely;
}

namespace {

std::string WhyThis(const Diagnosis& d) {
  switch (d.verdict.kind) {
    case Kind::kAdequate:
      return WhyAdequate(d);
    case Kind::kAmbiguous:
      return WhyAmbiguous(d);
    case Kind::kUnexplained:
      return WhyUnexplained(d);
    case Kind::kNamed:
      break;
  }
  const auto doubts = Doubts(d);
  if (doubts.empty())
    return "With it the error is what the noise and the time step make, and every other candidate "
           "does clearly worse.";
  return fmt::format("It does clearly better than every other {}candidate. {}",
                     d.verdict.far_off.empty() ? "" : "plausible ", fmt::join(doubts, " "));
}

// Where the lengths of links were fitted as well.
std::string LengthsInWords(const Diagnosis& d) {
  if (!d.lengths_as_given) return "";
  return fmt::format(
      " Lengths of links were fitted too, within {:.0f} %: with those of the model the answer is "
      "{}, with {:.3g} {} left on the train logs.",
      100 * d.criteria.lengths_off, d.lengths_as_given->verdict, d.lengths_as_given->error.train,
      d.pool.unit());
}

}  // namespace

std::string WhyInWords(const Diagnosis& d) { return WhyThis(d) + LengthsInWords(d); }

std::string NoiseSourceInWords(const Noise& noise) {
  if (noise.resampled == 0) return noise.source;
  return fmt::format("{}, {} of them brought onto the rows of another", noise.source,
                     noise.resampled);
}

std::string CausesInWords(const Diagnosis& d) {
  std::string text;
  for (const std::size_t i : d.verdict.named)
    text += (text.empty() ? "" : " or ") + d.candidates[i].hypothesis.NameAtPlace();
  if (!d.partner || text.empty()) return text;
  const std::string partner = d.partner->hypothesis.NameAtPlace();
  return d.partner->main ? partner + " and " + text : text + " and " + partner;
}

std::string GainInWords(const Diagnosis& d, const ExtensionRun& run) {
  if (!d.chosen()) return "none, as nothing was added";
  if (!run.offered && run.extended.xml.size() > 0) {
    if (run.removed_finely)
      return fmt::format(
          "at the time step of the model the held-out error does not fall, so the extension is not "
          "offered; at a quarter of that step it falls by {}",
          Percent(*run.removed_finely));
    return "the held-out error does not fall, so the extension is not offered";
  }
  if (!(d.before.error.validate > 0)) return GainOfFolds(d);
  const double removed = GainOf(d, run.after).removed;
  const std::string much = removed < 0 ? "the held-out error rises by " + Percent(-removed)
                                       : Percent(removed) + " of the held-out error is removed";
  return much + IntervalInWords(d);
}

std::vector<std::string> WorseFoldsInWords(const Diagnosis& d) {
  std::vector<std::string> worse;
  if (!d.chosen()) return worse;
  const FoldRecord& record = d.chosen()->record;
  for (std::size_t f = 0; f < std::min(record.after.size(), d.folds.size()); ++f) {
    if (!(record.after[f] > record.before[f])) continue;
    worse.push_back(fmt::format("fitted without {}, the error there rises: {:.4g} → {:.4g} {}",
                                d.folds[f].name, record.before[f], record.after[f], d.pool.unit()));
  }
  return worse;
}

std::string RemainsInWords(const Diagnosis& d, const ExtensionRun& run) {
  const std::string unit = d.pool.unit();
  std::string text = fmt::format("The error is {:.3g} {} on the train logs", run.after.train, unit);
  const double times = TimesFloor(d, run.after);
  if (OnlyNoiseRemains(d, run.after))
    return text + ", which is what noise and time step make. Nothing else shows in these logs.";
  text += times == 0 ? ". These logs do not show how much of it is noise."
                     : fmt::format(", {:.1f} times what noise and time step make.", times);
  if (!d.remaining.where.empty()) text += " It is largest in " + d.remaining.where + ".";
  if (!d.remaining.would_take.empty()) text += " " + Sentence(d.remaining.would_take) + ".";
  return text;
}

std::vector<std::string> NextStepsInWords(const Experiment& e, const Diagnosis& d,
                                          const ExtensionRun& run) {
  std::vector<std::string> steps;
  const bool extended = run.offered && !run.extended.xml.empty();
  for (const std::string& bound : AtBoundInWords(d, run))
    steps.push_back(fmt::format("Check {}: the best value may lie beyond.", bound));
  if (d.Is(Kind::kAmbiguous) && !d.next.input.empty()) {
    steps.push_back(d.next.log ? fmt::format("To find out which, record: {} (inputs in `{}`).",
                                             d.next.input, kNextInputs)
                               : Sentence(d.next.input + "."));
  }
  if (OnlyCorrections(d) || NumbersInstead(d) || d.verdict.numbers_off > 0)
    steps.emplace_back("Measure lengths, masses and the zero of the sensors again.");
  if (extended && (d.Is(Kind::kNamed) || OnlyCorrections(d)))
    steps.push_back(fmt::format("Simulate with `{}` in place of the model.", kExtendedModel));
  if (!extended && d.chosen() && run.removed_finely) {
    steps.push_back(fmt::format("Take a time step of {:g} s: with it the cause can be added.",
                                d.system.model().opt.timestep / 4));
  } else if (!extended && d.chosen() && IsBelowStep(d)) {
    steps.emplace_back(
        "Take a finer time step: the cause changes less than the error of this one.");
  }
  if (extended && d.Is(Kind::kNamed) && !OnlyNoiseRemains(d, run.after))
    steps.push_back(
        fmt::format("Look for the next cause: `continuum diagnose {}`.", kExtendedExperiment));
  if (d.Is(Kind::kUnexplained)) {
    if (!d.verdict.explained_by.empty())
      steps.push_back(fmt::format("Add {} to the candidates.", d.verdict.explained_by));
    else if (!e.all_candidates && d.left_out.empty())
      steps.emplace_back("Try every effect: write `candidates: all` in the experiment.");
    if (d.missing_force.joint.empty())
      steps.emplace_back("Measure every joint: then the report shows which force is missing.");
    if (d.fallback)
      steps.push_back(fmt::format("Until then `{}` simulates with {}.", kFallbackModel,
                                  "a smooth force that has no cause"));
  }
  if (!d.left_out.empty())
    steps.push_back((d.interrupted ? "It was stopped before " : "There was no time for ") +
                    FirstOf(d.left_out) +
                    (d.interrupted ? ". The same command again takes its time."
                                   : ". `--effort thorough` takes it."));
  if (d.noise.source != "replicates")
    steps.emplace_back("Record each trial twice: only that shows how large the noise is.");
  return steps;
}

}  // namespace continuum
