#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "identification/study/row_inputs.h"

namespace continuum {

/// The file of a row's folder that says what the result follows from, and how it was made.
inline constexpr char kRowRecord[] = "row.json";

struct RowRecord {
  RowInputs inputs;
  std::string reason;  ///< why it failed; empty: it is done
  int exit_code = 0;   ///< of the subcommand; -1: a signal ended it, or it never began
  double seconds = 0;  ///< by the clock
  double processor_seconds = 0;
  double peak_megabytes = 0;  ///< of memory [1e6 bytes]
  std::string host;           ///< the machine's name
};

/// As its file has it. From throws nlohmann::json::exception for what is no record.
nlohmann::json ToJson(const RowRecord& record);
RowRecord RecordFrom(const nlohmann::json& json);

/// Writes it into a folder. Throws Error when that is impossible.
void WriteRecord(const RowRecord& record, const std::filesystem::path& folder);

/// The record of a folder; none where there is no folder or no whole record.
std::optional<RowRecord> ReadRecord(const std::filesystem::path& folder);

}  // namespace continuum
