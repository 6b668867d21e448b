#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/console.h"
#include "app/solve.h"
#include "app/study.h"
#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/rank_messages.h"
#include "sim/numerics/ranks.h"

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

// What several ranks can work on; of anything else each would do the same, into one place.
void RequireSharedWork(const std::string& subcommand) {
  if (continuum::RankCount() == 1) return;
  for (const char* const shared : {"study", "identify", "diagnose"})
    if (subcommand == shared) return;
  throw continuum::Error::Input("mpirun", "study, identify or diagnose", subcommand);
}

// Says why the program ends, on one rank for all of them.
int Fail(const std::string& why, int exit_code) {
  continuum::EndProgress();
  continuum::EndRanks(exit_code, [&](const std::string& who) {
    std::fprintf(stderr, "continuum: %s%s\n", who.c_str(), why.c_str());
  });
  return exit_code;
}

// CLI11 has exit codes of its own; ours are 0 done, 1 failed, 2 wrong use.
int Parse(CLI::App& app, int argc, char** argv) {
  if (argc > 1 && argv[1][0] != '-' && !IsSubcommand(app, argv[1])) {
    return Fail(fmt::format("no subcommand '{}'. See continuum --help.", argv[1]), 2);
  }
  if (argc > 1 && IsSubcommand(app, argv[1])) RequireSharedWork(argv[1]);
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
    return Fail(std::string(e.what()) + "\nSee continuum --help.", 2);
  }
}

// What was printed may only now turn out to be lost.
void RequirePrinted() {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return;
  throw continuum::Error::Input("standard output", "a writable file",
                                errno ? std::strerror(errno) : "one that failed");
}

// "0.1.0" and, on a line of its own, by what ranks talk.
std::string Version() {
  const std::string mpi = continuum::mpi::Library();
  return std::string(CONTINUUM_VERSION) + "\n" + (mpi.empty() ? "without MPI" : "with " + mpi);
}

// Asks the work to end with whole files; who asks again does not want to wait for them.
void Stop(int) {
  if (continuum::StopRequested()) std::_Exit(1);
  continuum::RequestStop();
  if (continuum::RankCount() > 1) return;  // mpirun said it
  constexpr char kText[] = "\ncontinuum: stopping; once more to end at once\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof kText - 1);
}

}  // namespace

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, Stop);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit fails where it is written
  CLI::App app{
      "Continuum robots in MuJoCo: run, fit, and find out what the simulation gets wrong."};
  app.set_version_flag("--version", Version());
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
  continuum::AddMake(app);
  continuum::AddEffects(app);
  continuum::AddModels(app);
  RefuseEmptyValues(app);
  try {
    continuum::JoinRanks(CONTINUUM_VERSION);
    if (continuum::ThisRank() > 0 && !std::freopen("/dev/null", "w", stdout)) return 1;
    const int parsed = Parse(app, argc, argv);
    continuum::EndProgress();
    RequirePrinted();
    continuum::LeaveRanks();
    return parsed ? parsed : exit_code;
  } catch (const continuum::Error& e) {
    return Fail(e.what(), e.exit_code());
  } catch (const std::exception& e) {
    return Fail(e.what(), 1);
  }
}
