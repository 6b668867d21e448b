#include "identification/inverse_dynamics/regressor.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "identification/inverse_dynamics/measured_equations.h"
#include "identification/inverse_dynamics/separable_swarm.h"
#include "identification/inverse_dynamics/train_equations.h"
#include "identification/statistics/uncertainty.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;
using Part = MeasuredEquations::Part;
using Columns = TrainEquations::Columns;

constexpr double kLinearStep = 0.1;  // of a parameter's size: of what is linear, any will do
constexpr double kSlopeStep = 1e-3;  // the same of what bends

class InverseFit {
 public:
  InverseFit(const Problem& problem, const std::vector<bool>& use, const RegressorOptions& options)
      : problem_(problem),
        options_(options),
        measured_(problem, use, options.cutoff),
        joints_(problem, measured_, Part::kJoints),
        wrench_(problem, measured_, Part::kWrench) {
    found_.x = problem.Start();
    step_.assign(found_.x.size(), kLinearStep);
  }

  Regression Make() {
    Columns left(found_.x.size());
    std::iota(left.begin(), left.end(), Eigen::Index{0});
    if (measured_.has_wrench()) FitWrench(left);
    FitJoints(left);
    AddErrors();
    AddUncertainty();
    return std::move(found_);
  }

 private:
  // Takes from left what the wrench depends on, where it distinguishes all of it.
  void FitWrench(Columns& left) {
    Columns seen;
    const auto r = wrench_.Residuals(found_.x);
    for (const Eigen::Index k : left) {
      const auto slopes = wrench_.Slopes(found_.x, r, {k}, kLinearStep);
      if (std::any_of(slopes.begin(), slopes.end(), [](const Matrix& m) { return !m.isZero(0); }))
        seen.push_back(k);
    }
    if (seen.empty()) return;
    const auto slopes = wrench_.Slopes(found_.x, r, seen, kLinearStep);
    if (!wrench_.Linear(found_.x, r, slopes, seen).AreDistinct()) return;
    std::erase_if(left, [&](auto k) { return std::ranges::find(seen, k) != seen.end(); });
    found_.x = wrench_.Refined(found_.x, seen);
    Say(NamesOf(seen) + " from forces and torques");
  }

  void FitJoints(const Columns& columns) {
    if (columns.empty()) return;
    const ParameterShapes shapes =
        ShapesOf(problem_, found_.x, columns, [&](const Vector& x) { return joints_.Stacked(x); });
    if (shapes.outer.empty()) {
      const auto r = joints_.Residuals(found_.x);
      const auto linear =
          joints_.Linear(found_.x, r, joints_.Slopes(found_.x, r, columns, kLinearStep), columns);
      linear.RequireDistinct();
      found_.x = linear.Solve().x;
      return Say(NamesOf(columns) + " by linear least squares");
    }
    const SwarmFound swarm = SearchSeparable(problem_, joints_, found_.x, shapes, options_);
    found_.iterations = swarm.iterations;
    found_.x = joints_.Refined(swarm.x, columns);
    for (const Eigen::Index k : shapes.outer) step_[k] = kSlopeStep;
    Say(NamesOf(shapes.outer) + " by a particle swarm" +
        (shapes.inner.empty() ? ""
                              : ", " + NamesOf(shapes.inner) + " by linear least squares inside"));
  }

  // Of all logs, with the rows at which dry friction may hold.
  void AddErrors() {
    const auto r = measured_.Residuals(found_.x, Part::kJoints, true);
    const auto relative = [&](bool train) {
      double missing = 0, forces = 0;
      for (std::size_t l = 0; l < r.size(); ++l) {
        if (measured_.use()[l] != train) continue;
        missing += r[l].squaredNorm();
        forces += measured_.forces()[l].squaredNorm();
      }
      return forces > 0 ? 100 * std::sqrt(missing / forces) : 0;
    };
    found_.train = relative(true), found_.validate = relative(false);
  }

  // A block for each joint and number of a wrench.
  void AddUncertainty() {
    std::vector<std::vector<Scores>> motions(measured_.use().size());
    for (const TrainEquations* const part : {&joints_, &wrench_}) {
      const auto r = part->Residuals(found_.x);
      std::vector<Matrix> slopes;
      for (const Vector& e : r) slopes.emplace_back(e.size(), found_.x.size());
      for (Eigen::Index k = 0; k < found_.x.size(); ++k)
        part->Differ(found_.x, r, k, step_[k], slopes, k);
      for (std::size_t l = 0; l < r.size(); ++l) {
        const Eigen::Index rows = measured_.rows(l);
        for (Eigen::Index at = 0; at < r[l].size(); at += rows) {
          const Vector weight = part->weight(l).segment(at, rows);
          if (slopes[l].middleRows(at, rows).isZero(0)) continue;  // prescribed
          motions[l].push_back({weight.cwiseProduct(r[l].segment(at, rows)),
                                weight.asDiagonal() * slopes[l].middleRows(at, rows),
                                Vector::Ones(rows)});
        }
        if (part == &joints_ && r[l].size())
          found_.rows += static_cast<std::size_t>(part->weight(l).sum());
      }
    }
    std::erase_if(motions, [](const auto& blocks) { return blocks.empty(); });
    found_.uncertainty = UncertaintyFrom(problem_, found_.x, motions);
  }

  std::string NamesOf(const Columns& columns) const {
    std::vector<std::string> names;
    for (const Eigen::Index k : columns) names.push_back(problem_.parameters()[k].name);
    return fmt::format("{}", fmt::join(names, ", "));
  }
  void Say(const std::string& how) { found_.how += (found_.how.empty() ? "" : "; ") + how; }

  const Problem& problem_;
  const RegressorOptions& options_;
  MeasuredEquations measured_;
  TrainEquations joints_, wrench_;
  Regression found_;
  std::vector<double> step_;  // [parameter] of slopes, share of its size
};

}  // namespace

Regression FitByRegressor(const Problem& problem, const std::vector<bool>& use,
                          const RegressorOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Regression found = InverseFit(problem, use, options).Make();
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

}  // namespace continuum
