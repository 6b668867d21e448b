#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/law_terms.h"
#include "identification/inverse_dynamics/measured_motion.h"
#include "identification/result/folds.h"

namespace continuum {

/// A term at some joints, with numbers for its shapes.
struct PlacedTerm {
  LawTerm term;
  std::vector<double> shapes;
};

/// The missing force of all joints at rows of the logs, below each other, each joint's in units of
/// its own, and what a written law does there.
///
/// Measured accelerations are means over eleven rows (missing_force.h, 2): so is what a law gives,
/// or a force that is periodic in a fast joint would look smaller than it is. Rows whose means
/// reach beyond a log are left out; of many rows some are.
class LawRows {
 public:
  using Vector = Problem::Vector;
  using Matrix = Problem::Matrix;

  /// folds: logs that belong together; none: four stretches of time of each log.
  LawRows(const Experiment& experiment, const EquationErrors& view, const std::vector<Fold>& folds);

  const std::vector<MissingForce>& joints() const { return view_.joints(); }
  Eigen::Index size() const { return static_cast<Eigen::Index>(joints().size() * rows_.size()); }
  /// [joint][row] of a fold: logs that are left out together.
  const std::vector<std::size_t>& groups() const { return groups_; }
  /// The missing force, and what each fitted parameter does there.
  Vector Missing() const { return Picked(view_.missing()); }
  Matrix Columns() const;
  /// A force at these rows, each log's moved round by a random part of it: as large and as smooth,
  /// but of nothing that is there.
  Vector Shifted(const Vector& force, std::uint64_t seed) const;
  /// What each part of a term, of size 1, makes the joints feel: minus the part, as force·v is
  /// power into the effect.
  Matrix Of(const PlacedTerm& placed, const std::vector<std::size_t>& at) const;

 private:
  struct Run {
    std::size_t begin, end;  // rows of one log, [begin, end)
    double start;            // of the log [s]
  };
  Vector Picked(const Vector& all) const;
  std::vector<double> Values(const LawTerm::Part& part, const PlacedTerm& placed, std::size_t joint,
                             std::size_t other) const;
  std::vector<double> Heat(std::size_t joint, double constant) const;

  const EquationErrors& view_;
  std::vector<Run> runs_;
  std::vector<Quartic> means_;       // [row that is kept]
  std::vector<std::size_t> rows_;    // that are kept, of a joint's
  std::vector<std::size_t> run_of_;  // [row that is kept]
  std::vector<std::size_t> groups_;
};

}  // namespace continuum
