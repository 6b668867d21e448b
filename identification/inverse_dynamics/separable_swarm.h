#pragma once

#include "identification/inverse_dynamics/parameter_shapes.h"
#include "identification/inverse_dynamics/regressor_options.h"
#include "identification/inverse_dynamics/train_equations.h"

namespace continuum {

/// What a swarm over the outer parameters found, with linear least squares for the inner ones in
/// every place.
struct SwarmFound {
  Eigen::VectorXd x;  ///< all parameters
  int iterations;
};

/// Minimises Σ r² of the equations within the bounds. Throws Error for outer parameters without
/// finite bounds, and when the user asks to stop before any place had a cost.
SwarmFound SearchSeparable(const Problem& problem, const TrainEquations& equations,
                           const Eigen::VectorXd& start, const ParameterShapes& shapes,
                           const RegressorOptions& options);

}  // namespace continuum
