#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sim/io/csv.h"

namespace continuum::statics {

/// A column that nothing reads is a mistake of spelling or of unit more often than a note.
/// @throws Error that names the file, its header and the first of them; `expected` says which
/// there are.
void RefuseOtherColumns(const CsvTable& table,
                        const std::function<bool(const std::string&)>& is_known,
                        const std::string& expected);
void RefuseOtherColumns(const CsvTable& table, const std::vector<std::string>& known,
                        const std::string& expected);

/// @throws Error for the first of these columns that the table lacks; `hint` follows its name.
void RequireColumns(const CsvTable& table, const std::vector<std::string>& needed,
                    const std::string& hint = "");

/// The first of these letters of which the table has a numbered column, such as L2; the last where
/// it has none. Which of them is missing is for RequireColumns.
std::string DriveOf(const CsvTable& table, const std::vector<std::string>& letters);

}  // namespace continuum::statics
