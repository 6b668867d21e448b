#pragma once

#include <CLI/App.hpp>

namespace continuum {

/// Adds the subcommand `study`: many experiments in folders of their own. exit_code is set when it
/// runs: 0 all rows are done, 3 some are not. @throws Error (while parsing) for bad input.
void AddStudy(CLI::App& app, int& exit_code);

}  // namespace continuum
