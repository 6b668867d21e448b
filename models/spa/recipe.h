#pragma once

#include <functional>
#include <string>

#include "models/spa/identify.h"
#include "models/spa/parameters.h"

namespace continuum {

struct SpaRecipe {
  SpaNoise noise;
  unsigned seed = 1;
  SpaFilter filter = 60;
  std::function<void(int done, int of)> progress = [](int, int) {};
};

/// Mean squared errors of one channel: over all steps, and of its best and worst step.
struct SpaError {
  std::string channel, unit;
  double all, best, worst;
  double best_share;  ///< root of best over the channel's largest measured magnitude
};

/// Difference of two models' responses to the validation steps: RMS over the range of the first.
struct SpaDifference {
  std::string what;
  Eigen::Vector3d share;  ///< of Δx, Δy, δL
};

struct SpaRecipeResult {
  SpaParameters<double> truth, found;
  std::vector<SpaError> identification, validation, simulation;
  std::vector<SpaDifference> differences;
};

/// The paper's validation procedure: 30 + 6 noisy step responses of the given model, regained
/// motion, identification, and errors of the inverse model, of the base wrench and of a free
/// simulation.
SpaRecipeResult RunSpaRecipe(const SpaFile& truth, const SpaRecipe& recipe);

/// The result as Markdown tables in the shape of the paper's Tables I and II and Fig. 6.
std::string SpaTables(const SpaRecipeResult& result);

}  // namespace continuum
