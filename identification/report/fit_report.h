#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "identification/result/identify_result.h"
#include "sim/page/page.h"

namespace continuum {

/// Writes report.html of a fit. Parts that cannot be made leave a badge at their place and are
/// added to `missing`.
void WriteFitReport(const Experiment& experiment, const IdentifyResult& result,
                    const std::filesystem::path& file, std::vector<MissingPart>& missing);

/// Adds a table of the parameters of a fit with the values x, their standard errors and intervals;
/// without the starts of trials. Throws Error where the uncertainty has other parameters.
void AddParameterTable(Page& page, const std::vector<FreeParameter>& parameters,
                       const Eigen::VectorXd& x, const Uncertainty& uncertainty);

/// Says that a fit was started again elsewhere (Fit::anew).
inline constexpr char kAnewInWords[] =
    "started again where the equations of motion fit the measured motion best, as the first fit "
    "ended far above the noise";

/// Says that a fit is over pieces of the logs (Fit::over_pieces), and what is left there; empty: it
/// is not.
std::string OverPiecesInWords(const IdentifyResult& result);

/// Says that the residuals of a fit are more than noise, and what to do; empty: they are not.
std::string OverNoiseInWords(const IdentifyResult& result);

}  // namespace continuum
