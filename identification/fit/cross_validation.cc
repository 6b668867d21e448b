#include "identification/fit/cross_validation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/numerics/shared_loop.h"

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
  FoldScores scores{std::vector<double>(folds.size()), std::vector<Problem::Vector>(folds.size())};
  const auto leave_out = [&](std::size_t f) {
    const std::vector<bool>& out = folds[f].left_out;
    std::vector<bool> kept = out;
    kept.flip();
    scores.x[f] = FitStarts(problem, RefitByChords(problem, x, r, J, kept), out);
    const double error = problem.PooledRms(problem.Residuals(scores.x[f], out), out);
    scores.error[f] = std::isfinite(error) ? error : kDiverged * problem.PooledRms(r, out);
  };
  ShareTasks(folds.size(), leave_out,
             [&](auto& archive, std::size_t f) { archive(scores.error[f], scores.x[f]); });
  return scores;
}

}  // namespace continuum
