#include "models/tdcr/inputs.h"

#include <algorithm>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/sweep.h"
#include "models/tdcr/columns.h"
#include "models/tdcr/plausible.h"

namespace continuum::tdcr {
namespace {

// Millimetres, or another origin: no disk is farther from the base than the rod is long.
void WarnOfFarPoints(const SolveRequest& request, const Robot& robot,
                     const std::vector<Measured>& measured) {
  double farthest = 0;
  for (const Measured& m : measured) {
    for (int i = 0; i < robot.disks; ++i) {
      if (m.Has(i)) farthest = std::max(farthest, m.disks.col(i).norm());
    }
  }
  if (farthest <= 2 * robot.length) return;
  request.warn(fmt::format("{}: points up to {:.3g} m from the base of a rod of {:.3g} m",
                           request.measured.string(), farthest, robot.length));
}

}  // namespace

void Need(const std::filesystem::path& path, const std::string& option, const std::string& job) {
  if (path.empty()) throw Error::Input(option, "a file for " + job, "nothing");
}

void Refuse(bool given, const std::string& option, const std::string& job) {
  if (given) throw Error::Input(option, "not with " + job);
}

std::string MethodName(const SolveRequest& request, const Robot& robot) {
  if (!request.method.empty()) return request.method;
  return robot.has_sections() || !robot.natural.isZero(0) ? "crt" : "eas";
}

std::vector<Case> ReadInput(const SolveRequest& request, const Robot& robot) {
  const CsvTable table = statics::CasesOf(request);
  auto cases = ReadCases(table, robot);
  WarnOfImplausibleCases(request, table, robot, cases);
  return cases;
}

std::vector<Measured> ReadMeasurements(const SolveRequest& request, const Robot& robot) {
  if (request.measured.empty()) return {};
  const CsvTable table = CsvTable::Read(request.measured);
  auto measured = statics::ReadMeasuredPoints(table, robot.disks);
  WarnOfFarPoints(request, robot, measured);
  return measured;
}

void RefuseLengths(const SolveRequest& request, const std::vector<Case>& cases,
                   const std::string& job) {
  if (cases.empty() || cases.front().loads.length.size() == 0) return;
  throw Error::Input(request.input.string() + ":1", "columns T1, T2, .. with " + job, "'L1'");
}

}  // namespace continuum::tdcr
