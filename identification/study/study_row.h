#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace continuum {

/// One job of a study: a subcommand on an experiment, with a folder of its own.
struct StudyRow {
  std::size_t number = 0;  ///< from 1, in the order of the table
  std::string where;       ///< "study.csv:4", for messages
  std::string name;        ///< of its folder
  std::string experiment;  ///< from the folder of the study
  std::string command;     ///< one of RowCommands()
  std::vector<std::string> options = {};
  std::map<std::string, std::string> labels = {};
  std::string fault = {};  ///< why it cannot run, with where; empty: it can
};

/// A table of jobs.
struct StudyTable {
  std::string name;                 ///< the table's file, or the pattern
  std::filesystem::path folder;     ///< absolute; where relative paths of the table start
  std::vector<std::string> labels;  ///< names of all labels, in the order of the table
  std::vector<StudyRow> rows;
};

/// Subcommands that a row may ask for.
const std::vector<std::string>& RowCommands();

/// The name of a row's folder: its experiment without extension, and its command.
std::string RowName(const std::string& experiment, const std::string& command);

/// Throws Error (where) for a name that cannot be that of a row's folder: letters, digits and
/// `._+=@-`, not a number, none of the study's own names.
void CheckRowName(const std::string& name, const std::string& where);

}  // namespace continuum
