#pragma once

#include <cstdint>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>

#include "sim/io/progress.h"

namespace continuum {

/// Progress on stderr: one line that is rewritten on a terminal, else a line for each new stage.
/// Of several ranks the first one shows its own.
void ShowProgress(const Progress& progress);
/// Ends a rewritten line.
void EndProgress();

/// Accepts a finite number from lower to upper.
CLI::Validator NumberWithin(double lower, double upper);
/// Accepts a whole number from lower to upper.
CLI::Validator WholeNumberWithin(std::uint64_t lower, std::uint64_t upper);

/// Subcommands; each sets exit_code when it runs and throws Error otherwise.
void AddRun(CLI::App& app);
void AddCheck(CLI::App& app);
void AddReplay(CLI::App& app);
void AddRender(CLI::App& app);
void AddIdentify(CLI::App& app);
void AddDiagnose(CLI::App& app);
void AddDemo(CLI::App& app);
void AddApply(CLI::App& app);
void AddMake(CLI::App& app);
void AddEffects(CLI::App& app);
void AddModels(CLI::App& app);

}  // namespace continuum
