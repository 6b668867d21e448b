#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "identification/problem/problem.h"
#include "identification/result/confounding.h"
#include "identification/result/fit.h"
#include "identification/result/multi_start.h"
#include "identification/result/regression.h"
#include "identification/result/uncertainty.h"
#include "sim/replay/replay.h"

namespace continuum {

/// What there is to tell of a fit beside its parameters.
struct FitRecord {
  std::string method = "lm";
  /// After a fit on the smooth path: parameters that suit the model's own step better; fitted.xml
  /// and fitted.yaml get these.
  const Problem::Vector* for_step = nullptr;
  const Regression* regression = nullptr;  ///< of the inverse model
  const MultiStart* starts = nullptr;      ///< where there were several
  /// One line per step of what the intervals still take.
  std::function<void(const std::string&)> progress = {};
};

/// What is said of a fit that began anew (Fit::anew).
inline constexpr char kAnewInWords[] =
    "begun anew where the equations of motion hold best along what was measured, as from its start "
    "it ended far above the noise";

/// How well the logs determine the parameters.
struct Determined {
  Uncertainty uncertainty;
  std::vector<Confounding> trade_offs;  ///< what they do not determine alone
  std::optional<SplitError> at_step;    ///< after a fit on the smooth path: as the model steps
  std::string beyond_noise = {};        ///< in words, where far more than noise is left
};

/// Writes fit.json, fitted.xml, fitted.yaml (the experiment with that model and every value that
/// was fitted of single logs or of the measurement), simulated/*.csv and report.html of a fit into
/// a folder. Returns what they say of the parameters.
Determined WriteFit(const Problem& problem, const Fit& fit, const std::filesystem::path& folder,
                    const FitRecord& record = {});

/// The values that a fit.json has for the parameters of a problem. Throws Error when it is none,
/// lacks one, or has one beyond its bounds.
Problem::Vector ValuesIn(const std::filesystem::path& fit, const Problem& problem);

}  // namespace continuum
