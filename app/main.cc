#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>

#include "app/console.h"
#include "app/solve.h"
#include "app/study.h"
#include "error.h"
#include "sim/io/interrupt.h"

namespace {

bool IsSubcommand(const CLI::App& app, const std::string& name) {
  const auto known =
      app.get_subcommands([&](const CLI::App* sub) { return sub->get_name() == name; });
  return !known.empty();
}

// A value that is empty says nothing, whatever the option.
void RefuseEmptyValues(CLI::App& app) {
  const auto check = [](const std::string& text) {
    return text.empty() ? "expected a value, found ''" : "";
  };
  for (CLI::App* const sub : app.get_subcommands({})) {
    for (CLI::Option* const option : sub->get_options()) {
      if (option->get_expected_min() > 0) option->check(check);
    }
  }
}

// CLI11 has exit codes of its own; ours are 0 done, 1 failed, 2 wrong use.
int Parse(CLI::App& app, int argc, char** argv) {
  if (argc > 1 && argv[1][0] != '-' && !IsSubcommand(app, argv[1])) {
    std::fprintf(stderr, "continuum: no subcommand '%s'. See continuum --help.\n", argv[1]);
    return 2;
  }
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::CallForHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForAllHelp& e) {
    return app.exit(e);
  } catch (const CLI::CallForVersion& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "continuum: %s\nSee continuum --help.\n", e.what());
    return 2;
  }
}

// What was printed may only now turn out to be lost.
void RequirePrinted() {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  throw continuum::Error::Input("standard output", "a writable file",
                                errno ? std::strerror(errno) : "one that failed");
}

// Asks the work to end with whole files; who asks again does not want to wait for them.
void Stop(int) {
  if (continuum::StopRequested()) std::_Exit(1);
  continuum::RequestStop();
  constexpr char kText[] = "\ncontinuum: stopping; once more to end at once\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof kText - 1);
}

}  // namespace

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, Stop);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit fails where it is written
  CLI::App app{
      "Continuum robots in MuJoCo: run, fit, and find out what the simulation gets wrong."};
  app.set_version_flag("--version", CONTINUUM_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Example:\n  continuum demo\n"
      "continuum SUBCOMMAND --help shows the options of one.");
  int exit_code = 0;
  continuum::AddRun(app);
  continuum::AddCheck(app);
  continuum::AddReplay(app);
  continuum::AddRender(app);
  continuum::AddIdentify(app);
  continuum::AddDiagnose(app);
  continuum::AddStudy(app, exit_code);
  continuum::AddDemo(app);
  continuum::AddApply(app);
  continuum::AddSolve(app, exit_code);
  continuum::AddEffects(app);
  continuum::AddModels(app);
  RefuseEmptyValues(app);
  try {
    const int parsed = Parse(app, argc, argv);
    continuum::EndProgress();
    RequirePrinted();
    return parsed ? parsed : exit_code;
  } catch (const continuum::Error& e) {
    continuum::EndProgress();
    std::fprintf(stderr, "continuum: %s\n", e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    continuum::EndProgress();
    std::fprintf(stderr, "continuum: %s\n", e.what());
    return 1;
  }
}
