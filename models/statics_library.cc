#include "models/statics_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "error.h"
#include "models/statics/held_robot.h"
#include "models/stiff_flop/held.h"
#include "models/tdcr/held.h"
#include "models/twin_pivot/held.h"
#include "sim/io/yaml.h"

struct ContinuumStatics {
  std::unique_ptr<continuum::statics::HeldRobot> robot;
  std::string columns;
  std::vector<std::string> why;  ///< of the rows solved last
};

namespace continuum {
namespace {

std::unique_ptr<statics::HeldRobot> Hold(const std::string& file, const std::string& method,
                                         bool inverse) {
  const Yaml robot = Yaml::Read(file);
  const Yaml name =
      robot.Has("robot") || !robot.Has("model") ? robot.At("robot") : robot.At("model");
  const std::string kind = name.Text();
  if (kind == "stiff_flop") return stiff_flop::Hold(file, method, inverse);
  if (inverse) throw Error::Input(name.Where(), "stiff_flop for shapes to pressures", kind);
  if (kind == "tdcr") return tdcr::Hold(file, method);
  if (kind == "twin_pivot") return twin_pivot::Hold(file, method);
  throw Error::Input(name.Where(), "tdcr, twin_pivot or stiff_flop", "'" + kind + "'");
}

// Numbers as text that reads back exactly: models read tables.
CsvTable TableOf(const char* header, const char* constants, const double* values, std::size_t rows,
                 std::size_t columns) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "case,{}\n", header);
  for (std::size_t i = 0; i < rows; ++i) {
    fmt::format_to(std::back_inserter(text), "{}", i + 1);
    for (std::size_t k = 0; k < columns; ++k) {
      fmt::format_to(std::back_inserter(text), ",{}", values[i * columns + k]);
    }
    fmt::format_to(std::back_inserter(text), "{}\n", constants);
  }
  return CsvTable::Parse({text.data(), text.size()}, "cases");
}

// No exception crosses C. @returns Error::exit_code(), 0 when all went well.
template <class Work>
int Guarded(char* error, std::size_t size, const Work& work) {
  const auto say = [&](const char* what) {
    if (size == 0) return;
    std::strncpy(error, what, size - 1);
    error[size - 1] = '\0';
  };
  try {
    work();
    return 0;
  } catch (const Error& e) {
    say(e.what());
    return e.exit_code();
  } catch (const std::exception& e) {
    say(e.what());
    return 1;
  }
}

}  // namespace
}  // namespace continuum

ContinuumStatics* continuum_statics_open(const char* robot, const char* method, int inverse,
                                         char* error, size_t size) {
  ContinuumStatics* held = nullptr;
  continuum::Guarded(error, size, [&] {
    auto made = std::make_unique<ContinuumStatics>();
    made->robot = continuum::Hold(robot, method, inverse != 0);
    for (const std::string& name : made->robot->columns()) {
      made->columns += (made->columns.empty() ? "" : ",") + name;
    }
    held = made.release();
  });
  return held;
}

void continuum_statics_close(ContinuumStatics* held) { delete held; }

const char* continuum_statics_columns(const ContinuumStatics* held) {
  return held->columns.c_str();
}

int continuum_statics_solve(ContinuumStatics* held, const char* header, const char* constants,
                            const double* values, size_t rows, size_t columns, double* results,
                            char* error, size_t size) {
  return continuum::Guarded(error, size, [&] {
    const auto table = continuum::TableOf(header, constants, values, rows, columns);
    const auto solved = held->robot->Solve(table, held->why);
    std::copy(solved.data(), solved.data() + solved.size(), results);
  });
}

const char* continuum_statics_why(const ContinuumStatics* held, size_t row) {
  return row < held->why.size() ? held->why[row].c_str() : "";
}
