#pragma once

#include <filesystem>
#include <string>

#include "identification/study/row_status.h"
#include "sim/io/progress.h"

namespace continuum {

/// What all rows of a run have in common.
struct StudyRun {
  std::filesystem::path program;  ///< the executable, whose subcommands are run
  std::filesystem::path out;      ///< absolute; of all results
  std::string version;            ///< of the program
  ProgressCallback progress;
};

/// Runs a row in a process of its own, and says how it stands then. Its folder appears whole or not
/// at all; that of a failed run is called FailedName, and leaves a result that was there. When the
/// user asks to stop, nothing changes. before: its status, MayRun; outer: the progress of all rows,
/// before this one.
RowStatus RunRow(const StudyTable& study, const StudyRow& row, const StudyRun& run,
                 const RowStatus& before, const Progress& outer);

}  // namespace continuum
