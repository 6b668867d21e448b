#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/statics/solve_request.h"
#include "models/tdcr/measured.h"
#include "models/tdcr/model.h"

namespace continuum::tdcr {

/// Throws Error where a job lacks the file of an option.
void Need(const std::filesystem::path& path, const std::string& option, const std::string& job);
/// Throws Error where an option is given that the job does not have.
void Refuse(bool given, const std::string& option, const std::string& job);

/// That of the request; without one eas, and crt for a robot with sections or precurvature.
std::string MethodName(const SolveRequest& request, const Robot& robot);

/// The cases of --input, with warnings of implausible ones.
std::vector<Case> ReadInput(const SolveRequest& request, const Robot& robot);
/// The shapes of --measured, with a warning of points far off; none without the option.
std::vector<Measured> ReadMeasurements(const SolveRequest& request, const Robot& robot);
/// Throws Error for cases by length, to jobs that take tensions.
void RefuseLengths(const SolveRequest& request, const std::vector<Case>& cases,
                   const std::string& job);

}  // namespace continuum::tdcr
