#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/statics/results.h"
#include "models/stiff_flop/case.h"
#include "sim/page/chart.h"

namespace continuum::stiff_flop {

/// A closed line of a deformed section.
struct Outline {
  std::string part;  ///< body, hole, bore_i, wall_i: inner and outer wall of the tubes of line i
  std::vector<double> psi;         ///< where its points were before, see OutlinesOf [rad]
  std::vector<double> x, z;        ///< in the frame of the section [m]
  std::vector<double> gamma = {};  ///< lead angle of the thread there [rad]; empty: body, hole
};

/// The lines of the section at one place of a module. psi of body and hole: the angle of the point
/// in the undeformed section, in the sense of phi. psi of a tube: from toward the centre of bending
/// (chamber.h). Tubes of one line are drawn as one, at the angle of the line.
std::vector<Outline> OutlinesOf(const Module& module, const Method& method,
                                const Axis<double>& axis, int points);

/// What --outlines writes: the sections of every module of solved cases. .csv or .json: columns
/// `case`, `module` (from 1), `s` [m] of its undeformed axis from its lower end, `part`, `psi`,
/// `x`, `z`, `gamma`. .svg: the sections at the lower ends, and gamma over psi.
class OutlineTable {
 public:
  /// @throws Error for another ending.
  explicit OutlineTable(std::filesystem::path path);

  /// Lower end, middle and upper end of every module; the arc of the inverse model is the same
  /// everywhere.
  void Add(const ModuleSeries& series, const Method& method, Direction direction, const Case& row,
           const Solution& solution);
  void Write() const;

 private:
  void AddSection(const std::string& name, const Module& module, const Method& method,
                  std::size_t number, double s, const Axis<double>& axis);
  void Draw(const std::string& name, std::size_t module, const std::vector<Outline>& outlines);

  std::filesystem::path path_;
  statics::Results results_;
  std::vector<Chart> charts_;
  std::vector<std::string> cases_;  // that are drawn
};

}  // namespace continuum::stiff_flop
