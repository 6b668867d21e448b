#pragma once

#include <exception>
#include <functional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "error.h"

namespace continuum {

/// Runs a command-line tool: reads the options of `app`, then works. Errors go to stderr.
/// @returns the exit code: 0 done or help given, 2 for wrong use or bad input, 1 for other
/// failures.
inline int RunTool(CLI::App& app, int argc, char** argv, const std::function<void()>& work) {
  try {
    app.parse(argc, argv);
    work();
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

}  // namespace continuum
