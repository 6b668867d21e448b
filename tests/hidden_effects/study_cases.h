#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "hidden_effects/suite.h"

namespace continuum::hidden {

/// Writes each case into a folder of its own, and study.csv, a row `diagnose` for each of them with
/// the truth as labels. effort: of all rows. Cases that are written already stay.
void WriteStudy(const std::vector<Case>& cases, const std::string& effort,
                const std::filesystem::path& folder);

/// The lines of a suite's file (outcome.h), of what `continuum study` made of such rows. A row that
/// failed has no answer; one that has not run has no line. Throws Error where the study is one of
/// other cases.
std::vector<nlohmann::json> LinesOfStudy(const std::vector<Case>& cases,
                                         const std::filesystem::path& study,
                                         const std::filesystem::path& results);

/// What a diagnosis.json says.
Answer AnswerFrom(const Case& c, const nlohmann::json& diagnosis);

/// Of a case that ended without a diagnosis.
nlohmann::json NoAnswer(const Case& c, const std::string& why);

}  // namespace continuum::hidden
