#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hidden_effects/noise.h"
#include "hidden_effects/outside/dry_friction.h"
#include "hidden_effects/robot.h"
#include "identification/diagnosis/diagnosis.h"

namespace continuum::hidden {

/// What one run of the suite is about; its logs follow from it and repeat exactly.
struct Case {
  std::vector<std::string> effects;  ///< hidden; empty: none
  double factor = 1;                 ///< of the moderate size
  NoiseKind noise = NoiseKind::kWhite;
  std::uint64_t seed = 1;
  bool listed = true;  ///< whether the hidden effects are among the candidates
  bool told = false;   ///< whether nothing else is
  std::string robot = "arm";
  bool background = false;  ///< of the background suite (WriteBackground)
  /// What is wrong with the logs, of the arm: "turned" by 5 deg as its tip is seen, "late" by 10
  /// ms, inputs "flipped" in sign or "exchanged" for others; empty: nothing.
  std::string spoilt = "";
  std::vector<std::string> among = {};  ///< the candidates; empty: all
  Law law = Law::kStick;                ///< of dry friction in the outside suite
  bool one_joint = false;               ///< there, dry friction of the first joint only
  Effort effort = Effort::kThorough;    ///< of the diagnosis

  std::string Name() const;
};

/// What became of a set when the experiment that the diagnosis proposed was run as well.
struct Followed {
  std::string input;
  double separation = 0;
  std::vector<std::string> named;
  bool right = false, unique = false;
};

/// What the diagnosis made of it.
struct Answer {
  std::string verdict;
  std::vector<std::string> named;           ///< effects, likeliest first
  std::vector<std::string> relatives = {};  ///< of the named one, that fit as well
  bool corrects = false;                    ///< the partner only corrects a number of the model
  std::vector<std::string> partner = {};    ///< of a second cause beside those
  double truth = 0, value = 0, low = 0, high = 0;  ///< of the first effect, when it is in named
  double by_numbers = 0;                           ///< Uncertainty::by_numbers of it
  double removed = 0;                              ///< error removed on the validate logs
  std::optional<double> explained = {};  ///< of what is explainable of it, where that is known
  double p = 1;                          ///< family-wise, of the best candidate to first order
  double lack = 1;                       ///< p-value of what the model that is left standing leaves
  double next = 0;                       ///< likelihood between the two best
  double closest = 0;  ///< how far the closest other effect is from the likeliest, to first order
  double seconds = 0, cpu = 0;        ///< by the clock, and of all processors together
  std::string screened = "";          ///< the effect that explains most to first order
  std::optional<bool> complete = {};  ///< whether what is left looks like noise, where it is said
  std::string leading = "";           ///< what came closest where nothing is named
  /// Probability of every effect, at whatever place; empty where none is stated or two act.
  std::map<std::string, double> stated = {};
  std::string detail;  ///< the summary
  NextExperiment next_experiment = {};
  std::optional<Followed> followed = {};
};

/// Writes model, logs and experiment of a case into a folder, and returns the experiment's path.
std::filesystem::path WriteCase(const Case& c, const std::filesystem::path& folder);
/// A case of the background suite: one log in windows, without replicates; beside the hidden effect
/// every length is 3 % wrong, three small forces act that no candidate is, and what these leave is
/// 10 to 100 times the noise.
std::filesystem::path WriteBackground(const Case& c, const std::filesystem::path& folder);
/// Inputs and outputs as a log.
std::string Csv(const Robot& robot, const Columns& u, const Columns& y);
/// Every effect that the diagnosis knows, but the hidden ones if they are not to be listed.
std::string CandidatesOf(const Case& c);
/// A case, diagnosed.
Answer Solve(const Case& c, const std::filesystem::path& folder);
/// The same; of the arm, where the answer is a set with an experiment that would part it, once more
/// with logs of that.
Answer SolveAndFollow(const Case& c, const std::filesystem::path& folder);

/// Whether the answer holds the truth (of two effects: both), and whether it is one name. Where
/// dry friction is made by another law than the tool's (Case::law), any of its family is the truth.
bool InSet(const Case& c, const Answer& a);
/// The same, by the very name.
bool InSetExactly(const Case& c, const Answer& a);
/// Whether it holds a declared sibling of the first hidden effect; in the outside suite its family
/// too.
bool Sibling(const Case& c, const Answer& a);
bool Unique(const Answer& a);

}  // namespace continuum::hidden
