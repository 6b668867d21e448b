#pragma once

#include <array>
#include <string_view>

namespace continuum {

/// A number that decides what a diagnosis tries, keeps, names or offers.
struct Rule {
  std::string_view name;
  double value;
  std::string_view unit;    ///< of the value, or what it is a share or multiple of
  std::string_view reason;  ///< why there is such a rule, and why of this size
  std::string_view source = {};

  constexpr operator double() const { return value; }
};

/// All rules of the search and of the verdict.
///
/// They are constants of the method: the defaults are what every diagnosis uses, and what reports
/// quote. Other values are for tests, which show for each rule that a verdict depends on it.
///
/// Squares are whitened sums of squares, that is twice a log-likelihood, unless said otherwise.
struct Criteria {
  // A cause by cross-validation.
  Rule folds_better{"folds_better", 0.8, "share of folds",
                    "a cause that helps on some groups of logs only is none of the others; one "
                    "fold in five may be spoilt"};
  Rule median_gain{"median_gain", 0.10, "share of the error",
                   "smaller gains are common among random forces on logs of real machines"};
  Rule fit_gain{"fit_gain", 0.05, "share of the error",
                "a fit that lowers its own error by less will not lower that of other logs by "
                "twice as much, and folds are expensive"};
  Rule amplitude_spread{"amplitude_spread", 0.3, "share of the median",
                        "one physical constant has one size and one sign on all logs"};
  Rule placebo_share{"placebo_share", 0.95, "share of the random forces",
                     "a law with as many parameters that names no cause must do worse (5 %)"};
  Rule fold_margin{"fold_margin", 0.05, "share of the rival's error",
                   "what else is wrong with the model favours one candidate or the other by a few "
                   "per cent"};
  Rule rival_gain{"rival_gain", 0.5, "share of the best candidate's gain",
                  "one that gains less is no alternative to the best, however it scatters"};
  Rule fold_share{"fold_share", 0.5, "share of the squares above the noise on logs left out",
                  "where repeated trials tell the noise, a cause that does less is not what is "
                  "mainly wrong"};
  Rule least_folds{"least_folds", 2, "folds", "one fold shows no spread"};

  // How much is left to explain.
  Rule at_noise{"at_noise", 1.1, "times the noise",
                "the noise is known to about a tenth from a few replicates"};
  Rule near_noise{"near_noise", 1.25, "times the noise",
                  "up to here a named candidate's residual shows no further cause"};
  Rule model_limited{"model_limited", 3, "times the noise",
                     "above it the residual is model error: likelihoods are not calibrated there"};
  Rule scatter_limit{"scatter_limit", 10, "times the scatter from row to row",
                     "without replicates the scatter is a lower bound of the noise; more than this "
                     "is no noise"};

  // A cause by likelihood.
  Rule significance{"significance", 0.045, "probability",
                    "family-wise level of any name; with the two tests of lack of fit at 0.002 "
                    "false alarms add up to 5 %"};
  Rule lack_of_fit{"lack_of_fit", 0.002, "probability",
                   "level of each of two tests of what no candidate explains; above"};
  Rule parameter_cost{"parameter_cost", 3.84, "squares",
                      "what one more parameter must gain: 95 % of chi-squared with one degree of "
                      "freedom",
                      "Wilks 1938, Ann. Math. Stat. 9:60"};
  Rule rival_margin{"rival_margin", 5, "squares",
                    "by which a rival must be less likely: a factor of 12 in the likelihood"};
  Rule nested_margin{"nested_margin", 2.8, "squares",
                     "by which a law must beat, beyond parameter_cost, one that it contains: 6.64 "
                     "in all, 99 % of chi-squared with one degree of freedom",
                     "Wilks 1938, Ann. Math. Stat. 9:60"};
  Rule left_share{"left_share", 0.2, "share of the squares above the noise that the best leaves",
                  "what else is wrong with a model favours one rival or the other by as much"};
  Rule structure_share{"structure_share", 0.002, "share of what the best explains",
                       "lengths and masses are known to a per cent or two, which leaves so much of "
                       "the squares of what a large effect does"};
  Rule structure_least{"structure_least", 1e-4, "share of what the best explains",
                       "a per cent of the error that a large effect makes is left by lengths and "
                       "masses, also where another law happens to leave none"};
  Rule main_share{"main_share", 0.75, "share of the squares above the noise",
                  "a main cause takes at least half of the error off that noise does not explain"};
  Rule family_share{"family_share", 0.95, "share of what the best of the family explains",
                    "a richer law of one family must explain more than what is left of a plain one "
                    "by the way in which friction is simulated"};
  Rule plainly_more{"plainly_more", 2, "times the noise and time step, on logs left out",
                    "what a plain law leaves below it, lengths and masses that are a per cent off "
                    "make too, and a richer law bends to that"};
  Rule earned_share{"earned_share", 0.1, "share of the error of logs left out",
                    "where more than noise is left a law that contains another one makes up for "
                    "some of it: it must also help where it was not fitted"};
  Rule step_share{"step_share", 0.005, "share of what is put down to the time step",
                  "first order in the step may miss that much: closer candidates are not "
                  "distinguished"};
  Rule plain_noise{"plain_noise", 0.05, "probability",
                   "below it \"nothing but noise\" would say too much of a residual"};

  // The time-discretisation error.
  Rule step_seen{"step_seen", 15, "squares",
                 "a smaller time-discretisation error could not be seen in the noise"};
  Rule step_tolerance{"step_tolerance", 1.25, "times the time-discretisation error",
                      "how far a first-order estimate of it is off"};
  Rule step_falls{"step_falls", 0.75, "share of the squares above the noise",
                  "what a fit at a quarter of the step may keep: to first order a sixteenth, but "
                  "where joints stick and slip the error falls slowly"};
  Rule step_rough{"step_rough", 0.15, "standard deviation over its mean",
                  "a time-discretisation error that is less certain is measured at a finer step"};
  Rule step_resolved{"step_resolved", 0.1, "times the noise",
                     "by which the time step may add more to a fit than the fit removes"};
  Rule step_varies{"step_varies", 4, "times the deviation from first order",
                   "what h/2 deviates from first order to h/4, extrapolated to a step of zero"};
  Rule step_least_spread{"step_least_spread", 0.1, "share of the time-discretisation error",
                         "it is never known better"};
  Rule step_most_spread{"step_most_spread", 3, "times the time-discretisation error",
                        "nor worse, or it would explain anything"};
  Rule step_farthest{"step_farthest", 2, "standard deviations",
                     "more of it is a cause, as a delay of several steps"};
  Rule late{"late", 0.15, "time steps",
            "by which a log may be early or late: within a step it is convention when a row was "
            "taken and an input came"};

  // The screen: what is looked at, and from which sizes.
  Rule unseen{"unseen", 0.25, "share of the effects",
              "where there was no time to look at more of them, a name may be any of them"};
  Rule probe_far{"probe_far", 5, "times what is to be explained",
                 "a probe that does so much more, or less, is repeated at a share of its size: "
                 "first order holds within a few"};
  Rule probe_least{"probe_least", 20, "squares", "effects that do less are not worth resolving"};
  Rule start_share{"start_share", 0.05, "share of the probed size",
                   "a fit starts at least so far from absence, where a bound or a kink hides the "
                   "slope"};
  Rule as_good{"as_good", 0.99, "share of what the best start explains",
               "first order does not distinguish starts that are closer"};
  Rule contained{"contained", 0.01, "share of the squares",
                 "of a candidate's directions that another one, which contains it, may miss"};
  Rule same_noise{"same_noise", 10, "squares",
                  "by which fits that say the same may differ beyond what one gains"};
  Rule same_gain{"same_gain", 30, "squares", "more gained is never the same"};
  Rule same_share{"same_share", 0.02, "share of the squares that one takes off",
                  "the same where the noise is not known"};

  // The fits: who gets one, and how far.
  Rule worth_a_fit{"worth_a_fit", 0.04, "share of the residual squares",
                   "to first order; 0.19 of them would make a name where the noise is not known"};
  Rule fit_behind{"fit_behind", 15, "squares",
                  "behind the best to first order: where little is to be explained it is right to "
                  "a few units"};
  Rule fit_always{"fit_always", 45, "squares", "a candidate that explains more is always fitted"};
  Rule fit_share{"fit_share", 0.02, "share of what the best explains",
                 "but never where it is a fiftieth: first order is wrong by factors, not by orders "
                 "of magnitude"};
  Rule force_least{"force_least", 0.05, "share of the missing force's squares",
                   "noise of the accelerations lets a candidate explain less by chance"};
  Rule force_share{"force_share", 0.5, "share of what the best explains of the missing force",
                   "one that explains less may be the cause only where first order sees it"};
  Rule rival_share{"rival_share", 0.3, "share of what the best of the list explains",
                   "a candidate that is not on the list may outdo it from here on"};
  Rule outdoes{"outdoes", 0.1, "share of what the best explains",
               "once a fit reaches the noise hardly one that explains less does so too"};
  Rule hopeless_factor{"hopeless_factor", 1.1, "times the best cost so far",
                       "a fit that is not going to come nearer is given up"};
  Rule hopeless_offset{"hopeless_offset", 50, "half squares", "added to that"};
  Rule fits_in_vain{"fits_in_vain", 8, "fits",
                    "in the order of what they promise: where so many in a row bring nothing, what "
                    "is left of the time is better spent on two causes"};
  Rule kept_share{"kept_share", 0.5, "share of what first order promises",
                  "where a simulation keeps less, first order was asked too far from the fit"};
  Rule completed_within{"completed_within", 50, "squares",
                        "behind the best: candidates beyond get no sensitivities, which are "
                        "expensive"};
  Rule still_gains{"still_gains", 0.5, "half squares",
                   "by its last step, for a fit to go on that is out of iterations"};
  Rule still_gains_share{"still_gains_share", 1e-3, "share of the cost",
                         "the same where the noise is not known"};
  Rule second_chances{"second_chances", 6, "candidates",
                      "whose abandoned fits go on to the end where none reaches the noise: a swing "
                      "that is out of phase gains late"};
  Rule fresh_starts{"fresh_starts", 4, "candidates",
                    "fitted again from the experiment's own start where nothing explains it"};

  // Two causes.
  Rule pair_hopeless{"pair_hopeless", 100, "times the noise",
                     "where the best single cause has a larger residual, one more is not enough"};
  Rule pair_singles{"pair_singles", 3, "families", "from which the search for two causes starts"};
  Rule pair_plain{"pair_plain", 0.5, "share of what the best of the family explains",
                  "a richer law bends to what a second cause does; the plain one may be the truth "
                  "beside it"};
  Rule pair_bases{"pair_bases", 4, "candidates", "tried as one of two causes: each is a search"};
  Rule second_share{"second_share", 0.05, "share of the squares above the noise",
                    "what is left by the way in which a cause is simulated is less: a second "
                    "cause of that size is told, not named"};
  Rule rest_noise{"rest_noise", 2, "times the noise",
                  "a main cause that leaves more may hide one that is small beside it"};
  Rule correction{"correction", 0.05, "share of a number of the model",
                  "masses, gains and stiffnesses are known to a few per cent: such a change beside "
                  "a cause is none of its own"};
  Rule whole_correction{"whole_correction", 0.02, "share of mass, weight or time; rad",
                        "the whole is known better than its parts: scales, screws, how it stands, "
                        "a cheap clock"};
  Rule link_known{"link_known", 0.015, "share of a length or a mass of a body",
                  "drawings and scales are a per cent or two off: one standard deviation"};
  Rule lengths_off{"lengths_off", 0.05, "share of a length of a link",
                   "free within that, where logs do not tell their noise and nothing is named"};
  Rule lengths_gain{"lengths_gain", 0.5, "times the least error with lengths as they are",
                    "what is left with free lengths, for that answer to be taken"};
  Rule numbers_most{"numbers_most", 0.02, "share of a length or a mass of a body",
                    "where no more than that does all that shows, nothing is missing"};
  Rule numbers_share{"numbers_share", 0.95, "share of the squares above the noise",
                     "what they do not do by themselves is something else"};
  Rule correction_share{"correction_share", 0.5, "share of what a cause explains beside another",
                        "where lengths and masses that are a little off explain as much, it is no "
                        "cause of its own"};
  Rule factor_most{"factor_most", 2, "times a number of the model, or its inverse",
                   "gains, scales, lengths and masses are rarely further off: a cause that has to "
                   "be is none beside another one that does as well"};
  Rule tilt_most{
      "tilt_most", 0.25, "rad",
      "a base that stands 14 degrees askew is seen: a larger tilt of gravity is no cause "
      "beside another one that does as well"};
  Rule clock_most{"clock_most", 0.02, "share of time",
                  "the cheapest clocks are a per cent or two off: a larger skew is no cause beside "
                  "another one that does as well"};
  Rule pair_share{"pair_share", 0.5, "share of the squares above the noise",
                  "a second cause must explain where the time step may explain them too"};

  // What is offered.
  Rule fallback_ceiling{"fallback_ceiling", 0.5, "times median_gain",
                        "where forces of many terms reach less, one of few is not looked for"};
  Rule fallback_size{"fallback_size", 0.2, "times the typical torque",
                     "most of each term: a correction, no other robot"};
  Rule separation{"separation", 15, "squares",
                  "below it inputs do not distinguish two candidates; at 15 the wrong one is the "
                  "likelier in 2.6 % of noise draws"};
  Rule next_rivals{"next_rivals", 3, "candidates", "that the next experiment is to exclude"};
};

/// Every rule once, for what walks over them.
inline constexpr std::array kAllRules{
    &Criteria::folds_better,
    &Criteria::median_gain,
    &Criteria::fit_gain,
    &Criteria::amplitude_spread,
    &Criteria::placebo_share,
    &Criteria::fold_margin,
    &Criteria::rival_gain,
    &Criteria::fold_share,
    &Criteria::least_folds,
    &Criteria::at_noise,
    &Criteria::near_noise,
    &Criteria::model_limited,
    &Criteria::scatter_limit,
    &Criteria::significance,
    &Criteria::lack_of_fit,
    &Criteria::parameter_cost,
    &Criteria::rival_margin,
    &Criteria::nested_margin,
    &Criteria::left_share,
    &Criteria::structure_share,
    &Criteria::structure_least,
    &Criteria::main_share,
    &Criteria::family_share,
    &Criteria::plainly_more,
    &Criteria::earned_share,
    &Criteria::step_share,
    &Criteria::plain_noise,
    &Criteria::step_seen,
    &Criteria::step_tolerance,
    &Criteria::step_falls,
    &Criteria::step_rough,
    &Criteria::step_resolved,
    &Criteria::step_varies,
    &Criteria::step_least_spread,
    &Criteria::step_most_spread,
    &Criteria::step_farthest,
    &Criteria::late,
    &Criteria::unseen,
    &Criteria::probe_far,
    &Criteria::probe_least,
    &Criteria::start_share,
    &Criteria::as_good,
    &Criteria::contained,
    &Criteria::same_noise,
    &Criteria::same_gain,
    &Criteria::same_share,
    &Criteria::worth_a_fit,
    &Criteria::fit_behind,
    &Criteria::fit_always,
    &Criteria::fit_share,
    &Criteria::force_least,
    &Criteria::force_share,
    &Criteria::rival_share,
    &Criteria::outdoes,
    &Criteria::hopeless_factor,
    &Criteria::hopeless_offset,
    &Criteria::fits_in_vain,
    &Criteria::kept_share,
    &Criteria::completed_within,
    &Criteria::still_gains,
    &Criteria::still_gains_share,
    &Criteria::second_chances,
    &Criteria::fresh_starts,
    &Criteria::pair_hopeless,
    &Criteria::pair_singles,
    &Criteria::pair_plain,
    &Criteria::pair_bases,
    &Criteria::second_share,
    &Criteria::rest_noise,
    &Criteria::correction,
    &Criteria::whole_correction,
    &Criteria::link_known,
    &Criteria::lengths_off,
    &Criteria::lengths_gain,
    &Criteria::numbers_most,
    &Criteria::numbers_share,
    &Criteria::correction_share,
    &Criteria::factor_most,
    &Criteria::tilt_most,
    &Criteria::clock_most,
    &Criteria::pair_share,
    &Criteria::fallback_ceiling,
    &Criteria::fallback_size,
    &Criteria::separation,
    &Criteria::next_rivals,
};
static_assert(sizeof(Criteria) == kAllRules.size() * sizeof(Rule), "a rule is missing above");

}  // namespace continuum
