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
#include "sim/io/output_folder.h"
#include "sim/io/yaml.h"

namespace continuum {

int Solve(const SolveRequest& request) {
  RequireDistinct({request.out, request.plot, request.shape, request.outlines, request.compliance,
                   request.errors, request.boxplot});
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
        std::pair("--outlines", !request.outlines.empty()),
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

// Rows of a stream as they come: one that has to be waited for, and with `together` those that are
// there already.
std::vector<std::string> NextRows(std::istream& in, bool together) {
  constexpr std::size_t kMost = 10'000;
  std::vector<std::string> rows;
  std::string line;
  while (std::getline(in, line)) {
    if (!IsBlank(line)) rows.push_back(line);
    const bool more = together && rows.size() < kMost && in.rdbuf()->in_avail() > 0;
    if (!rows.empty() && !more) break;
  }
  return rows;
}

// Answers tables of rows under one header.
class Stream {
 public:
  Stream(const SolveRequest& request, std::string header, std::ostream& out)
      : request_(request), one_(request), header_(std::move(header)), out_(out) {
    one_.out = "stream.csv";
    one_.take = [this](const std::string& csv) {
      out_ << (begun_ ? csv.substr(csv.find('\n') + 1) : csv) << std::flush;
      begun_ = true;
    };
    one_.warn = [this](const std::string& text) {  // of the robot, once
      if (said_.insert(text).second) request_.warn(text);
    };
  }

  bool begun() const { return begun_; }

  // All at once; where one is bad, those before it first, and then its own error.
  int Answer(const std::vector<std::string>& rows) {
    const int before = row_;
    try {
      return AnswerTable(rows);
    } catch (const Error&) {
      if (rows.size() == 1) throw;
    }
    row_ = before;
    int code = 0;
    for (const std::string& row : rows) code = std::max(code, AnswerTable({row}));
    return code;
  }

 private:
  int AnswerTable(const std::vector<std::string>& rows) {
    one_.input = fmt::format("standard input, row {}", row_ + 1);
    one_.row = header_ + '\n';
    for (const std::string& row : rows) one_.row += row + '\n';
    row_ += static_cast<int>(rows.size());
    return Solve(one_);
  }

  const SolveRequest& request_;
  SolveRequest one_;
  std::string header_;
  std::ostream& out_;
  int row_ = 0;
  bool begun_ = false;
  std::set<std::string> said_;
};

}  // namespace

int SolveStream(const SolveRequest& request, std::istream& in, std::ostream& out) {
  RefuseInStream(request);
  std::string header;
  while (IsBlank(header) && std::getline(in, header)) {
  }
  // Rows together see each other: a name that goes on from another would find it by chance.
  const bool together =
      header.find("case") == std::string::npos || header.find("reference") == std::string::npos;
  Stream stream(request, header, out);
  int code = 0;
  for (auto rows = NextRows(in, together); !rows.empty(); rows = NextRows(in, together)) {
    code = std::max(code, stream.Answer(rows));
  }
  if (!stream.begun()) throw Error::Input("standard input", "a header and rows of cases", "none");
  return code;
}

}  // namespace continuum
