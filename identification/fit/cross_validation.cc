#include "identification/fit/cross_validation.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace continuum {

std::vector<Fold> FoldsOf(const Experiment& e) {
  std::vector<Fold> folds;
  for (const auto kind : e.folds) {
    std::map<std::string, std::vector<bool>> groups;
    for (std::size_t l = 0; l < e.logs.size(); ++l) {
      const Log& log = e.logs[l];
      const std::string name = kind == Experiment::Folds::kTrial ? "trial " + log.trial
                               : kind == Experiment::Folds::kCondition
                                   ? "condition " + log.condition
                                   : "window " + log.label;
      auto& group = groups.try_emplace(name, e.logs.size(), false).first->second;
      group[l] = true;
    }
    if (groups.size() < 2) continue;
    for (auto& [name, left_out] : groups) folds.push_back({name, left_out});
  }
  return folds;
}

// What a model that diverges on logs that it was not fitted to is off, over what it is off where it
// was.
constexpr double kDiverged = 1e6;

FoldScores CrossValidate(const Problem& problem, const Problem::Vector& x,
                         const std::vector<Problem::Vector>& r,
                         const std::vector<Problem::Matrix>& J, const std::vector<Fold>& folds) {
  FoldScores scores;
  for (const Fold& fold : folds) {
    std::vector<bool> kept = fold.left_out;
    kept.flip();
    const auto refitted = RefitByChords(problem, x, r, J, kept);
    scores.x.push_back(FitStarts(problem, refitted, fold.left_out));
    const auto there = problem.Residuals(scores.x.back(), fold.left_out);
    const double error = problem.PooledRms(there, fold.left_out);
    scores.error.push_back(std::isfinite(error) ? error
                                                : kDiverged * problem.PooledRms(r, fold.left_out));
  }
  return scores;
}

}  // namespace continuum
