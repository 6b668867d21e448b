#pragma once

#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/numerics/decompositions.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/portable_random.h"

namespace continuum::statics {

struct SearchOptions {
  int starts = 60;           ///< random ones, beside those next to every root
  int next_to_roots = 4;     ///< of every root
  int most_steps = 60;       ///< from one start
  double longest = 1;        ///< of a step
  double tolerance = 1e-11;  ///< |f| at a root
  double same = 1e-5;        ///< distance of two roots that are one
};

/// A root and what distinguishes it.
template <class Vector>
struct Root {
  Vector x;
  double energy;
  bool neutral;  ///< a direction costs nothing: the root is one of a family
};

namespace internal {

// Newton's method on f(x) prod_r (1 + 1/|x - r|^2), which has the roots of f but those known, r:
// the step of f alone, scaled. The step is the shortest where the tangent is singular.
template <class Vector, class Problem>
bool FindNewRoot(const Problem& problem, const std::vector<Vector>& known, Vector& x,
                 const SearchOptions& options, bool& neutral) {
  constexpr double kSingular = 1e-7;  // of the largest singular value
  const auto n = x.size();
  Vector f = x;
  Eigen::Matrix<double, Vector::RowsAtCompileTime, Vector::RowsAtCompileTime> k(n, n);
  for (int i = 0; i < options.most_steps; ++i) {
    if (!numerics::Linearize(problem, x, f, k)) return false;
    Eigen::MatrixXd square = k.transpose() * k;
    if (f.norm() <= options.tolerance) {
      const Eigen::VectorXd values =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(square, Eigen::EigenvaluesOnly)
              .eigenvalues();
      neutral = values[0] < kSingular * kSingular * values[n - 1];
      return true;
    }
    const Eigen::VectorXd b = -(k.transpose() * f);
    square.diagonal().array() += 1e-14 * square.trace();
    const Eigen::VectorXd solved = Eigen::LDLT<Eigen::MatrixXd>(square).solve(b);
    Vector step = solved;
    double slope = 0;
    for (const Vector& r : known) {
      const Vector away = x - r;
      const double q = away.squaredNorm() + 1e-300;
      slope -= 2 * away.dot(step) / (q * (1 + q));
    }
    step /= 1 - slope;
    if (!step.allFinite()) return false;
    const double length = step.norm();
    if (length > options.longest) step *= options.longest / length;
    x += step;
  }
  return false;
}

}  // namespace internal

/// Roots that a search finds: Newton's method that avoids the roots known before (deflation), from
/// `draw(random)`, and from next to every root. It finds saddles as well as minima; that it finds
/// all of them is likely, not certain.
///
/// Of a family of roots (any plane in which a round column buckles) the first one stands for all:
/// those that are neutral and of one energy, `energy(x)`.
/// Source: Farrell, Birkisson, Funke, "Deflation techniques for finding distinct solutions of
/// nonlinear partial differential equations", SIAM J. Sci. Comput. 37(4), 2015.
template <class Vector, class Problem, class Draw, class Energy>
std::vector<Root<Vector>> FindRoots(const Problem& problem, std::vector<Vector> known,
                                    const Draw& draw, const Energy& energy,
                                    const SearchOptions& options = {}) {
  std::vector<Root<Vector>> roots;
  Random random(1);
  const auto same = [&](const Root<Vector>& a, const Root<Vector>& b) {
    if ((a.x - b.x).norm() <= options.same * (1 + a.x.norm())) return true;
    return a.neutral && b.neutral &&
           std::abs(a.energy - b.energy) <= 1e-8 * (1 + std::abs(a.energy));
  };
  std::vector<Vector> avoided;
  const auto search = [&](Vector x) {
    Root<Vector> found{x, 0, false};
    if (!internal::FindNewRoot(problem, avoided, found.x, options, found.neutral)) return false;
    found.energy = energy(found.x);
    avoided.push_back(found.x);
    for (const auto& root : roots) {
      if (same(root, found)) return false;
    }
    roots.push_back(std::move(found));
    return true;
  };
  const auto near = [&](const Vector& x) {
    for (int i = 0; i < options.next_to_roots; ++i) {
      Vector start = x;
      for (auto& value : start) value += 0.1 * random.Normal();
      search(start);
    }
  };
  for (const Vector& x : known) search(x);
  std::size_t looked_at = 0;
  for (int i = 0; i < options.starts; ++i) {
    for (; looked_at < roots.size(); ++looked_at) near(Vector(roots[looked_at].x));
    search(draw(random));
  }
  return roots;
}

}  // namespace continuum::statics
