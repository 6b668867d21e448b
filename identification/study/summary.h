#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "identification/study/population.h"

namespace continuum {

/// All rows of a study as they stand, and what they have in common.
struct StudySummary {
  const StudyTable* study;
  std::vector<StudyLine> lines;  ///< in the order of the table
  std::vector<Population> populations;

  std::size_t Count(RowStatus::State state) const;
  /// "12 rows: 10 done, 1 failed, 1 changed".
  std::string InWords() const;
};

/// Reads the results of the rows that are done; one that cannot be read has failed.
StudySummary Summarise(const StudyTable& study, std::vector<RowStatus> status,
                       const std::filesystem::path& out);

/// "named (sure)"; "64 % [60, 68]", empty where nothing was gained.
std::string VerdictInWords(const RowResult& result);
std::string GainInWords(const RowResult& result);
/// What a row found, on one line: "named (sure): dahl at joint hinge, 64 % [60, 68]".
std::string InWords(const RowResult& result);

/// Writes study.csv, study.json and study.html. Throws Error when that is impossible.
void WriteSummary(const StudySummary& summary, const std::filesystem::path& out);

/// The texts of study.csv and of study.json.
std::string SummaryCsv(const StudySummary& summary);
std::string SummaryJson(const StudySummary& summary);

/// Writes study.html.
void WriteStudyPage(const StudySummary& summary, const std::filesystem::path& file);

}  // namespace continuum
