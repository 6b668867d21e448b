#include "models/twin_pivot/cases.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/columns.h"
#include "models/statics/results.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"

namespace continuum::twin_pivot {
namespace {

constexpr double kNewtonPerKilogram = 9.81;

std::string Cell(const CsvTable& table, std::size_t row, const std::string& column) {
  return table.Where(row) + ", column '" + column + "'";
}

std::string Quoted(const std::string& text) {
  return text.empty() ? "an empty cell" : "'" + text + "'";
}

double NotNegative(const CsvTable& table, std::size_t row, const std::string& column) {
  const double value = table.Number(row, column);
  if (value >= 0) return value;
  throw Error::Input(Cell(table, row, column), "a number >= 0", Decimal(value));
}

// The columns of the cables: all lengths, tensions or masses.
std::string LoadDrive(const CsvTable& table) { return statics::DriveOf(table, {"L", "F", "m"}); }

// Of loads on discs: fx_k .. Mz_k and payload_k, k = 1..discs.
bool IsDiscLoad(const std::string& column, int discs) {
  const std::size_t at = column.find('_');
  if (at == column.npos) return false;
  constexpr std::array<const char*, 7> kLoads = {"fx", "fy", "fz", "Mx", "My", "Mz", "payload"};
  if (std::find(kLoads.begin(), kLoads.end(), column.substr(0, at)) == kLoads.end()) return false;
  for (int k = 1; k <= discs; ++k) {
    if (column.substr(at + 1) == std::to_string(k)) return true;
  }
  return false;
}

void RequireColumns(const CsvTable& table, const std::vector<std::string>& loads, int discs) {
  std::vector<std::string> known = {"case", "condition", "payload", "fx", "fy", "fz",       "Mx",
                                    "My",   "Mz",        "gx",      "gy", "gz", "reference"};
  known.insert(known.end(), loads.begin(), loads.end());
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
  const auto is_known = [&](const std::string& column) {
    return std::find(known.begin(), known.end(), column) != known.end() ||
           IsDiscLoad(column, discs);
  };
  const std::string loads_of_discs = fmt::format(
      ", or fx_k, fy_k, fz_k, Mx_k, My_k, Mz_k, payload_k of a disc k = 1 to {}", discs);
  statics::RefuseOtherColumns(table, is_known, "one of the columns " + all + loads_of_discs);
  std::vector<std::string> needed = {"case"};
  needed.insert(needed.end(), loads.begin(), loads.end());
  statics::RequireColumns(table, needed, " (F1.., m1.. or L1.. for every cable)");
}

Condition ReadCondition(const CsvTable& table, std::size_t row) {
  if (!table.Has("condition")) return Condition::kV;
  const std::string& text = table.Text(row, "condition");
  const auto found = std::find(kConditions.begin(), kConditions.end(), text);
  if (found != kConditions.end()) return static_cast<Condition>(found - kConditions.begin());
  throw Error::Input(Cell(table, row, "condition"), "I, II, III, IV or V", Quoted(text));
}

// The components that have a column; the others stay as they are.
void ReadVector(const CsvTable& table, std::size_t row, const std::string& prefix,
                Eigen::Vector3d& vector, const std::string& suffix = "") {
  for (int i = 0; i < 3; ++i) {
    const std::string column = prefix + "xyz"[i] + suffix;
    if (table.Has(column)) vector[i] = table.Number(row, column);
  }
}

int ReadReference(const CsvTable& table, std::size_t row,
                  const std::map<std::string, int>& earlier) {
  if (!table.Has("reference")) return -1;
  const std::string& label = table.Text(row, "reference");
  if (label.empty()) return -1;
  const auto found = earlier.find(label);
  if (found != earlier.end()) return found->second;
  throw Error::Input(Cell(table, row, "reference"), "the case of an earlier row", Quoted(label));
}

void ReadDiscLoads(const CsvTable& table, std::size_t row, int discs, Load& load) {
  for (int k = 1; k <= discs; ++k) {
    const std::string suffix = "_" + std::to_string(k);
    DiscLoad on_disc{k};
    ReadVector(table, row, "f", on_disc.force, suffix);
    ReadVector(table, row, "M", on_disc.moment, suffix);
    if (!on_disc.force.isZero(0) || !on_disc.moment.isZero(0)) load.on_discs.push_back(on_disc);
    if (!table.Has("payload" + suffix)) continue;
    if (load.disc_payload.size() == 0) load.disc_payload.setZero(discs);
    load.disc_payload[k - 1] = NotNegative(table, row, "payload" + suffix);
  }
}

Load ReadLoad(const CsvTable& table, std::size_t row, const std::vector<std::string>& columns,
              const Robot& robot) {
  Load load;
  load.condition = ReadCondition(table, row);
  const std::string drive = LoadDrive(table);
  const double scale = drive == "F" ? 1 : kNewtonPerKilogram;
  for (const std::string& column : columns) {
    const double value = NotNegative(table, row, column);
    load.tension.push_back(drive == "L" ? 0 : scale * value);
    if (drive != "L") continue;
    if (value == 0) throw Error::Input(Cell(table, row, column), "a length above 0", "0");
    load.length.conservativeResize(static_cast<Eigen::Index>(load.tension.size()));
    load.length.tail<1>()[0] = value;
  }
  if (table.Has("payload")) load.payload = NotNegative(table, row, "payload");
  load.gravity = robot.gravity;
  ReadVector(table, row, "f", load.force);
  ReadVector(table, row, "M", load.moment);
  ReadVector(table, row, "g", load.gravity);
  ReadDiscLoads(table, row, robot.Joints(), load);
  return load;
}

}  // namespace

std::vector<Case> ReadCases(const std::filesystem::path& file, const Robot& robot) {
  return ReadCases(CsvTable::Read(file), robot);
}

std::vector<Case> ReadCases(const CsvTable& table, const Robot& robot) {
  const auto columns = statics::Numbered(LoadDrive(table), robot.Cables());
  RequireColumns(table, columns, robot.Joints());
  table.RequireRows();
  std::vector<Case> cases;
  std::map<std::string, int> earlier;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Case read;
    read.label = table.Text(row, "case");
    if (read.label.empty() || earlier.contains(read.label)) {
      throw Error::Input(Cell(table, row, "case"), "a name that no other case has",
                         Quoted(read.label));
    }
    read.load = ReadLoad(table, row, columns, robot);
    read.reference = ReadReference(table, row, earlier);
    earlier[read.label] = static_cast<int>(row);
    cases.push_back(std::move(read));
  }
  return cases;
}

}  // namespace continuum::twin_pivot
