#include "models/solve.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "models/annelida/solve.h"
#include "models/stiff_flop/solve.h"
#include "models/tdcr/solve.h"
#include "models/twin_pivot/solve.h"
#include "sim/io/yaml.h"

namespace continuum {

int Solve(const SolveRequest& request) {
  const Yaml robot = Yaml::Read(request.robot);
  const Yaml name =
      robot.Has("robot") || !robot.Has("model") ? robot.At("robot") : robot.At("model");
  const std::string kind = name.Text();
  if (kind == "annelida") return SolveAnnelida(request);
  if (kind == "tdcr") return SolveTdcr(request);
  if (kind == "twin_pivot") return SolveTwinPivot(request);
  if (kind == "stiff_flop") return SolveStiffFlop(request);
  throw Error::Input(name.Where(), "annelida, tdcr, twin_pivot or stiff_flop", "'" + kind + "'");
}

namespace {

void RefuseInStream(const SolveRequest& request) {
  for (const auto& [option, given] :
       {std::pair("--calibrate", request.calibrate), std::pair("--sweep", request.sweep != 0),
        std::pair("--plot", !request.plot.empty()), std::pair("--shape", !request.shape.empty()),
        std::pair("--compliance", !request.compliance.empty()),
        std::pair("--measured", !request.measured.empty()),
        std::pair("--reach", !request.reach.empty()),
        std::pair("--follow", !request.follow.empty()),
        std::pair("--hybrid train", request.hybrid == "train")}) {
    if (given) throw Error::Input(option, "not with a stream of cases (--input -)");
  }
}

bool IsBlank(const std::string& line) {
  return line.find_first_not_of(" \t\r") == std::string::npos;
}

}  // namespace

int SolveStream(const SolveRequest& request, std::istream& in, std::ostream& out) {
  RefuseInStream(request);
  std::string header, line;
  while (IsBlank(header) && std::getline(in, header)) {
  }
  SolveRequest one = request;
  one.out = "stream.csv";
  bool first = true;
  one.take = [&](const std::string& csv) {
    const std::size_t rows = csv.find('\n') + 1;
    out << (first ? csv : csv.substr(rows)) << std::flush;
    first = false;
  };
  std::set<std::string> said;  // of the robot, once
  one.warn = [&](const std::string& text) {
    if (said.insert(text).second) request.warn(text);
  };
  int code = 0;
  for (int row = 1; std::getline(in, line);) {
    if (IsBlank(line)) continue;
    one.input = fmt::format("standard input, row {}", row++);
    one.row = header + '\n' + line + '\n';
    code = std::max(code, Solve(one));
  }
  if (first) throw Error::Input("standard input", "a header and rows of cases", "none");
  return code;
}

}  // namespace continuum
