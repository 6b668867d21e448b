#pragma once

#include <string>
#include <vector>

#include "hidden_effects/suite.h"

namespace continuum::hidden {

/// The large suite: every effect at six sizes, nothing hidden, effects that are not listed; noise
/// of five kinds in turn.
std::vector<Case> Cases(const std::string& robot, int repeats);
/// White noise, two sizes of every effect, and nothing hidden twice.
std::vector<Case> QuickCases(const std::string& robot);
/// The background suite: every effect, and nothing beside the background as often.
std::vector<Case> BackgroundCases(int repeats);
/// Logs that are wrong themselves, with nothing hidden.
std::vector<Case> SpoiltCases(int repeats);
/// All suites, of every robot.
std::vector<Case> AllCases(int repeats);
/// Those with one hidden effect, which alone is tried: for its size and interval, at little cost.
std::vector<Case> DescribedCases(std::vector<Case> cases);

}  // namespace continuum::hidden
