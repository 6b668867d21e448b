#pragma once

#include <CLI/App.hpp>

namespace continuum {

/// Adds the subcommand `solve`: the static model of a robot over a table of cases. exit_code is set
/// when it runs. @throws Error (while parsing) for bad input.
void AddSolve(CLI::App& app, int& exit_code);

}  // namespace continuum
