#include "identification/diagnosis/law_rows.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "binding/expression.h"
#include "effects/formula.h"

namespace continuum {
namespace {

constexpr std::size_t kMostRows = 12000;  // of all joints
constexpr std::size_t kStretches = 4;     // of a log, where there are no folds

// "q" of "q[knee]"; nothing where a name has no brackets.
std::pair<std::string, std::string> Split(const std::string& name) {
  const std::size_t open = name.find('[');
  return {name.substr(0, open), name.substr(open + 1, name.size() - open - 2)};
}

std::size_t FoldOf(const std::vector<Fold>& folds, std::size_t log) {
  for (std::size_t f = 0; f < folds.size(); ++f) {
    if (folds[f].left_out[log]) return f;
  }
  return folds.size();
}

}  // namespace

LawRows::LawRows(const Experiment& e, const EquationErrors& view, const std::vector<Fold>& folds)
    : view_(view) {
  const MissingForce& first = joints().front();
  for (std::size_t begin = 0, k = 1; k <= first.log.size(); ++k) {
    if (k < first.log.size() && first.log[k] == first.log[begin]) continue;
    runs_.push_back({begin, k, e.logs[first.log[begin]].time.front()});
    begin = k;
  }
  std::vector<std::size_t> group;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Run& run = runs_[r];
    const std::vector<double> time(first.time.begin() + static_cast<std::ptrdiff_t>(run.begin),
                                   first.time.begin() + static_cast<std::ptrdiff_t>(run.end));
    if (time.size() < 2 * kQuarticRows) continue;
    const std::vector<Quartic> means = QuarticsOf(time);
    for (std::size_t k = 0; k < means.size(); ++k) {
      means_.push_back(means[k]);
      rows_.push_back(run.begin + k + kHalfRows), run_of_.push_back(r);
      group.push_back(folds.size() > 1 ? FoldOf(folds, first.log[run.begin])
                                       : kStretches * k / means.size());
    }
  }
  const std::size_t stride = 1 + rows_.size() * joints().size() / kMostRows;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows_.size(); k += stride, ++kept) {
    means_[kept] = means_[k], rows_[kept] = rows_[k], run_of_[kept] = run_of_[k];
    group[kept] = group[k];
  }
  means_.erase(means_.begin() + static_cast<std::ptrdiff_t>(kept), means_.end());
  rows_.resize(kept), run_of_.resize(kept), group.resize(kept);
  for (std::size_t j = 0; j < joints().size(); ++j)
    groups_.insert(groups_.end(), group.begin(), group.end());
}

LawRows::Vector LawRows::Picked(const Vector& all) const {
  Vector some(size());
  const auto whole = static_cast<Eigen::Index>(joints().front().log.size());
  Eigen::Index at = 0;
  for (std::size_t j = 0; j < joints().size(); ++j) {
    for (const std::size_t row : rows_)
      some[at++] = all[static_cast<Eigen::Index>(j) * whole + static_cast<Eigen::Index>(row)];
  }
  return some;
}

LawRows::Matrix LawRows::Columns() const {
  Matrix columns(size(), view_.columns().cols());
  for (Eigen::Index i = 0; i < columns.cols(); ++i) columns.col(i) = Picked(view_.columns().col(i));
  return columns;
}

LawRows::Vector LawRows::Shifted(const Vector& force, std::uint64_t seed) const {
  std::mt19937_64 random(seed);
  Vector shifted = force;
  for (std::size_t begin = 0, k = 1; k <= rows_.size(); ++k) {
    if (k < rows_.size() && run_of_[k] == run_of_[begin]) continue;
    const auto n = static_cast<Eigen::Index>(k - begin);
    const auto by = std::uniform_int_distribution<Eigen::Index>(n / 5, n - n / 5)(random);
    for (std::size_t j = 0; j < joints().size(); ++j) {
      const auto from = static_cast<Eigen::Index>(j * rows_.size() + begin);
      for (Eigen::Index i = 0; i < n; ++i) shifted[from + i] = force[from + (i + by) % n];
    }
    begin = k;
  }
  return shifted;
}

// As BoundFormula::Advance has it, from rest at the first row.
std::vector<double> LawRows::Heat(std::size_t j, double constant) const {
  const MissingForce& joint = joints()[j];
  std::vector<double> heat(joint.log.size(), 0);
  for (const Run& run : runs_) {
    for (std::size_t k = run.begin + 1; k < run.end; ++k) {
      const double motor = joint.load[k - 1];
      const double keeps = std::exp(-(joint.time[k] - joint.time[k - 1]) / constant);
      heat[k] = motor * motor + (heat[k - 1] - motor * motor) * keeps;
    }
  }
  return heat;
}

// Of one part at the rows of a joint. other: the other one of two.
std::vector<double> LawRows::Values(const LawTerm::Part& part, const PlacedTerm& placed,
                                    std::size_t j, std::size_t other) const {
  const MissingForce& joint = joints()[j];
  std::vector<std::string> names(Formula::kVariables.begin(), Formula::kVariables.end());
  for (const TermShape& shape : placed.term.shapes) names.push_back(shape.name);
  const auto brackets = Expression::BracketNames(part.text);
  names.insert(names.end(), brackets.begin(), brackets.end());
  const Expression force(part.text, names, "a term");

  std::vector<double> heat;
  for (std::size_t s = 0; s < placed.shapes.size(); ++s) {
    if (placed.term.shapes[s].name == Formula::kHeatTime) heat = Heat(j, placed.shapes[s]);
  }
  std::vector<const std::vector<double>*> of_others;
  for (const std::string& name : brackets) {
    const auto [variable, of] = Split(name);
    std::size_t i = other;
    for (std::size_t k = 0; k < joints().size(); ++k)
      if (joints()[k].joint == of) i = k;
    of_others.push_back(variable == "v" ? &joints()[i].velocity : &joints()[i].angle);
  }
  std::vector<double> values(names.size()), out(joint.log.size());
  for (const Run& run : runs_) {
    for (std::size_t k = run.begin; k < run.end; ++k) {
      const double variables[] = {
          joint.angle[k],  joint.velocity[k],         joint.load[k],
          joint.weight[k], joint.time[k] - run.start, heat.empty() ? 0 : heat[k]};
      auto next = std::copy(std::begin(variables), std::end(variables), values.begin());
      next = std::copy(placed.shapes.begin(), placed.shapes.end(), next);
      for (const auto* const signal : of_others) *next++ = (*signal)[k];
      out[k] = force(values);
    }
  }
  return out;
}

LawRows::Matrix LawRows::Of(const PlacedTerm& placed, const std::vector<std::size_t>& at) const {
  Matrix columns = Matrix::Zero(size(), std::ssize(placed.term.parts));
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::size_t j = at[i], other = at.size() == 2 ? at[1 - i] : j;
    for (std::size_t p = 0; p < placed.term.parts.size(); ++p) {
      const auto value = Values(placed.term.parts[p], placed, j, other);
      auto row = static_cast<Eigen::Index>(j * rows_.size());
      for (std::size_t k = 0; k < rows_.size(); ++k, ++row) {
        const std::size_t first = rows_[k] - kHalfRows;
        double mean = 0;
        for (std::size_t n = 0; n + 1 < kQuarticRows; ++n) {
          mean += means_[k].mean[static_cast<Eigen::Index>(n)] *
                  (value[first + n] + value[first + n + 1]) / 2;
        }
        columns(row, static_cast<Eigen::Index>(p)) = -mean / view_.unit(j);
      }
    }
  }
  return columns;
}

}  // namespace continuum
