#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identification/result/confounding.h"
#include "identification/result/extended_model.h"
#include "identification/result/fit.h"
#include "identification/result/free_parameter.h"
#include "identification/result/local_minima.h"
#include "identification/result/missing_parts.h"
#include "identification/result/multi_start.h"
#include "identification/result/prediction_error.h"
#include "identification/result/regression.h"
#include "identification/result/shooting_segments.h"
#include "identification/result/uncertainty.h"
#include "sim/replay/replay.h"

namespace continuum {

/// How parameters are searched for: by Levenberg-Marquardt, a particle swarm, or linear least
/// squares on the inverse model along the measured motion.
enum class FitMethod { kLevenbergMarquardt, kParticleSwarm, kInverseModel };

/// A fit of the differential equation, simulated as MuJoCo steps the model.
struct AtModelStep {
  double timestep;    ///< [s]
  Eigen::VectorXd x;  ///< [parameter] those of the fit, or others that suit the step better
  std::vector<Replayed> logs;
};

/// How many times the measurement noise the residuals of a fit are.
struct OverNoise {
  double times;
  std::string source;  ///< of the noise: "replicates", "sigma", "differences"
  bool far = false;    ///< so many that the model lacks something, or the fit is in a wrong place
};

/// All that `identify` found: the values of the parameters, how well the logs determine them, and
/// every log simulated with them. What could not be computed is in `missing`.
struct IdentifyResult {
  FitMethod method = FitMethod::kLevenbergMarquardt;
  Path path = Path::kStepped;
  std::vector<FreeParameter> parameters;
  std::vector<std::size_t> channels;  ///< those that count

  Fit fit;
  std::optional<Regression> regression;      ///< of the inverse model
  std::optional<ShootingSegments> segments;  ///< of long logs, fitted before the whole
  std::optional<MultiStart> starts;          ///< where there were several
  LocalMinima minima;                        ///< around the fit, where dry friction acts

  Uncertainty uncertainty;
  std::vector<Confounding> trade_offs;   ///< what the logs do not determine alone
  std::vector<Replayed> logs;            ///< [log] simulated with the fitted parameters
  std::vector<std::string> divergence;   ///< [log] why it diverges; empty: it does not
  std::optional<AtModelStep> at_step;    ///< after a fit on the smooth path
  std::optional<PredictionError> ahead;  ///< none where the outputs do not give the state
  std::optional<OverNoise> of_pieces;    ///< Fit::over_pieces: what is left there over the noise
  std::optional<OverNoise> over_noise;   ///< where the residuals are more than noise and step
  std::string start_hint;                ///< where trials begin elsewhere than measured; else empty
  ExtendedModel fitted;                  ///< fitted.xml and fitted.yaml
  std::vector<MissingPart> missing;

  /// In words, where other minima make the intervals doubtful; else empty.
  std::string SeveralMinima() const {
    const bool known = uncertainty.known() && uncertainty.lower.size() == fit.x.size();
    return known ? minima.Doubts(fit.x, fit.cost, uncertainty, parameters) : "";
  }
};

}  // namespace continuum
