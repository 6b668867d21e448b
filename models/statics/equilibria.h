#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "models/statics/rising_load.h"
#include "sim/numerics/decompositions.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/portable_random.h"
#include "sim/numerics/work_limit.h"

namespace continuum::statics {

struct SearchOptions {
  int starts = 60;            ///< random ones, beside those next to every root
  int next_to_roots = 4;      ///< of every root
  int most_steps = 60;        ///< from one start
  double longest = 1;         ///< of a step
  double tolerance = 1e-11;   ///< |f| at a root
  double same = 1e-5;         ///< distance of two roots that are one
  long most_systems = 40000;  ///< linear ones: then the search is given up
};

/// A root and what distinguishes it.
template <class Vector>
struct Root {
  Vector x;
  double energy;
  bool neutral;  ///< a direction costs nothing: the root is one of a family
};

/// What a search has found.
template <class Vector>
struct Roots {
  std::vector<Vector> x;
  std::string gave_up = {};  ///< why the search did not come to its end
};

/// Newton's method from many starts that avoids the roots known before (deflation): on
/// f(x) prod_r (1 + 1/|x - r|^2), which has the roots of f but those known, r.
template <class Vector, class Problem, class Energy>
class RootSearch {
 public:
  RootSearch(const Problem& problem, const Energy& energy, const SearchOptions& options)
      : problem_(problem), energy_(energy), options_(options) {}

  void From(const Vector& start) {
    Root<Vector> found{start, 0, false};
    if (!Descend(found.x, found.neutral)) return;
    found.energy = energy_(found.x);
    avoided_.push_back(found.x);
    for (const auto& root : roots_) {
      if (Same(root, found)) return;
    }
    roots_.push_back(std::move(found));
  }

  /// From next to the roots that were found since the last call.
  void FromRoots(Random& random) {
    for (; looked_at_ < roots_.size(); ++looked_at_) {
      const Vector root = roots_[looked_at_].x;
      for (int i = 0; i < options_.next_to_roots; ++i) {
        Vector start = root;
        for (auto& value : start) value += 0.1 * random.Normal();
        From(start);
      }
    }
  }

  std::vector<Root<Vector>> Take() { return std::move(roots_); }

 private:
  using Matrix = Eigen::Matrix<double, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime>;

  bool Same(const Root<Vector>& a, const Root<Vector>& b) const {
    if ((a.x - b.x).norm() <= options_.same * (1 + a.x.norm())) return true;
    return a.neutral && b.neutral &&
           std::abs(a.energy - b.energy) <= 1e-8 * (1 + std::abs(a.energy));
  }

  // To a root that is not avoided.
  bool Descend(Vector& x, bool& neutral) const {
    Vector f = x;
    Matrix k(x.size(), x.size());
    for (int i = 0; i < options_.most_steps; ++i) {
      numerics::WorkLimit::Spend();
      if (!numerics::Linearize(problem_, x, f, k)) return false;
      const Eigen::MatrixXd square = k.transpose() * k;
      if (f.norm() <= options_.tolerance) {
        neutral = Singular(square);
        return true;
      }
      const Vector step = Step(x, square, -(k.transpose() * f));
      if (!step.allFinite()) return false;
      x += std::min(1.0, options_.longest / step.norm()) * step;
    }
    return false;
  }

  static bool Singular(const Eigen::MatrixXd& square) {
    constexpr double kSingular = 1e-7;  // of the largest singular value
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(square, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return values[0] < kSingular * kSingular * values[values.size() - 1];
  }

  // That of f alone, scaled; the shortest where the tangent is singular.
  Vector Step(const Vector& x, Eigen::MatrixXd square, const Eigen::VectorXd& right) const {
    square.diagonal().array() += 1e-14 * square.trace();
    const Vector step = Eigen::LDLT<Eigen::MatrixXd>(square).solve(right);
    double slope = 0;
    for (const Vector& r : avoided_) {
      const Vector away = x - r;
      const double q = away.squaredNorm() + 1e-300;
      slope -= 2 * away.dot(step) / (q * (1 + q));
    }
    return step / (1 - slope);
  }

  const Problem& problem_;
  const Energy& energy_;
  SearchOptions options_;
  std::vector<Vector> avoided_;
  std::vector<Root<Vector>> roots_;
  std::size_t looked_at_ = 0;
};

/// Roots that a search finds from `known`, from `draw(random)`, and from next to every root. It
/// finds saddles as well as minima; that it finds all of them is likely, not certain. After
/// options.most_systems it is given up, with the roots that it has.
///
/// Of a family of roots (any plane in which a round column buckles) the first one stands for all:
/// those that are neutral and of one energy, `energy(x)`.
/// Source: Farrell, Birkisson, Funke, "Deflation techniques for finding distinct solutions of
/// nonlinear partial differential equations", SIAM J. Sci. Comput. 37(4), 2015.
template <class Vector, class Problem, class Draw, class Energy>
Roots<Vector> FindRoots(const Problem& problem, const std::vector<Vector>& known, const Draw& draw,
                        const Energy& energy, const SearchOptions& options = {}) {
  RootSearch<Vector, Problem, Energy> search(problem, energy, options);
  Random random(1);
  Roots<Vector> roots;
  try {
    const numerics::WorkLimit limit(options.most_systems);
    for (const Vector& x : known) search.From(x);
    for (int i = 0; i < options.starts; ++i) {
      search.FromRoots(random);
      search.From(draw(random));
    }
  } catch (const numerics::GaveUp& at) {
    roots.gave_up = "the search for equilibria was " + at.Sentence() + "; there may be others";
  }
  for (auto& root : search.Take()) roots.x.push_back(std::move(root.x));
  return roots;
}

/// The equilibria of a case by rising energy, those that are the same listed once: its own solution
/// `known` when it has one, and those next to `roots`, `near(root)`, on the branch `other`.
/// `same(a, b)` and `energy(a)` are of solutions. One that is not ok ends the list of a search that
/// was given up.
template <class Solution, class Vector, class Near, class Same, class Energy>
std::vector<Solution> ByEnergy(const Solution& known, const Roots<Vector>& roots, const Near& near,
                               const Same& same, const Energy& energy) {
  std::vector<std::pair<double, Solution>> found;
  const auto add = [&](Solution s) {
    const auto is = [&](const auto& other) { return same(other.second, s); };
    if (!s.outcome.ok() || std::any_of(found.begin(), found.end(), is)) return;
    const double its = energy(s);
    found.emplace_back(its, std::move(s));
  };
  add(known);
  for (const auto& root : roots.x) {
    Solution s = near(root);
    s.stability.branch = Branch::kOther;
    add(std::move(s));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Solution> list;
  for (auto& [value, solution] : found) list.push_back(std::move(solution));
  if (!roots.gave_up.empty()) {
    list.emplace_back();
    list.back().outcome.why = roots.gave_up;
  }
  return list;
}

}  // namespace continuum::statics
