#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "error.h"
#include "models/statics/details.h"
#include "sim/io/csv.h"
#include "sim/numerics/parallel.h"

namespace continuum::statics {

/// Numbers of solved cases: rows x columns, row after row.
using ResultRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A robot in memory that solves tables: for callers within the process, who want numbers.
class HeldRobot {
 public:
  virtual ~HeldRobot() = default;

  /// Names of the results' columns. First StateColumns().
  virtual const std::vector<std::string>& columns() const = 0;
  /// Solves the rows on all cores, each for itself: no column `reference`. NaN where a case has no
  /// answer, and why[i] says why. @throws Error for bad input.
  virtual ResultRows Solve(const CsvTable& cases, std::vector<std::string>& why) const = 0;
};

/// `ok` (1 or 0), `iterations`, `residual`, `micros`, `branch` (0 rising, 1 symmetric, 2 other).
inline std::vector<std::string> StateColumns() {
  return {"ok", "iterations", "residual", "micros", "branch"};
}

/// Writes the numbers of one case, column after column.
class RowWriter {
 public:
  explicit RowWriter(Eigen::Ref<Eigen::RowVectorXd> row) : row_(row) {
    row_.setConstant(std::numeric_limits<double>::quiet_NaN());
  }

  void Add(double value) { row_[at_++] = value; }
  template <class Derived>
  void Add(const Eigen::MatrixBase<Derived>& values) {
    for (Eigen::Index i = 0; i < values.size(); ++i)
      Add(values(i % values.rows(), i / values.rows()));
  }
  /// StateColumns().
  void Add(const numerics::Outcome& outcome, bool ok, Branch branch) {
    Add(ok ? 1.0 : 0.0);
    Add(outcome.iterations);
    Add(outcome.residual);
    Add(outcome.micros);
    Add(static_cast<int>(branch));
  }
  /// `qw..qz`, `Fx..Mz`, `strain_max`, `l_1..`, as DetailColumns names them.
  void Add(const Details& details) {
    const double sign = details.tip.w() < 0 ? -1 : 1;
    Add(sign * details.tip.w());
    Add(sign * details.tip.vec());
    Add(details.force);
    Add(details.moment);
    Add(details.strain);
    Add(details.length);
  }

 private:
  Eigen::Ref<Eigen::RowVectorXd> row_;
  Eigen::Index at_ = 0;
};

/// Calls solve(i) for all rows on all cores, neighbours mostly one after the other by one thread:
/// `fresh` where the one before was not row i - 1.
template <class Solve>
void ForNeighbours(std::size_t rows, const Solve& solve) {
  const std::size_t parts = std::min(rows, 8 * ThreadCount());
  ParallelFor(parts, [&](std::size_t, std::size_t part) {
    const std::size_t begin = rows * part / parts, end = rows * (part + 1) / parts;
    for (std::size_t i = begin; i < end; ++i) solve(i, i == begin);
  });
}

/// @throws Error for a table of cases with this column.
inline void RefuseColumn(const CsvTable& table, const std::string& column) {
  if (table.Has(column)) throw Error::Input(table.name(), "no column '" + column + "' here");
}

}  // namespace continuum::statics
