#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "identification/study/row_record.h"

namespace continuum {

/// How a row stands.
struct RowStatus {
  enum class State {
    kDone,     ///< its folder holds the result of these inputs
    kFailed,   ///< it cannot run, or its last run with these inputs failed
    kChanged,  ///< its folder holds something else
    kMissing   ///< it did not run yet, or its result was deleted
  };
  State state = State::kMissing;
  std::string reason;               ///< of a row that is not done
  std::optional<RowInputs> inputs;  ///< as they are now; none where they cannot be read
  std::optional<RowRecord> record;  ///< of the run that it stands by
};

/// Whether a run takes a row: one that did not run or failed, and where asked for `again` one with
/// the result of other inputs. What is no result is never replaced.
bool MayRun(const RowStatus& status, bool again);

/// "12 rows: 10 done, 1 failed, 1 changed".
std::string CountsInWords(const std::vector<RowStatus::State>& rows);

/// "done", "failed", "changed" or "missing".
const char* StateName(RowStatus::State state);

/// The name of the folder of a row's failed run.
std::string FailedName(const StudyRow& row);

/// How a row stands in the folder of a study's results. version: of the program.
RowStatus StatusOf(const StudyTable& study, const StudyRow& row, const std::filesystem::path& out,
                   const std::string& version, FileHashes& hashes);

/// A status as a message between ranks, and back to the last bit.
std::string ToMessage(const RowStatus& status);
RowStatus StatusFrom(const std::string& message);

}  // namespace continuum
