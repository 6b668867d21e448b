#include "identification/diagnosis/law_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "binding/expression.h"
#include "effects/formula.h"
#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

using Vector = LawRows::Vector;
using Matrix = LawRows::Matrix;
using Joints = std::vector<std::size_t>;

constexpr std::size_t kShifted = 19;    // of 20, the true one is the best by chance once
constexpr std::size_t kRefined = 12;    // terms whose shapes are searched
constexpr std::size_t kExtended = 4;    // terms that are given a second one
constexpr std::size_t kSeconds = 3;     // of which so many are refined
constexpr std::size_t kNumbers = 6;     // of sizes and shapes in all: two waves
constexpr double kEarned = 0.8;         // of the squares on the folds, that a second term may leave
constexpr double kLeast = 0.02;         // of the squares of the missing force
constexpr std::size_t kPlain = 2;       // of one term that are suggested in any case
constexpr std::size_t kAtOnePlace = 2;  // of those that are suggested, where there are others

// Directions that are taken off already, and what is left of targets.
class Remainder {
 public:
  Remainder(const Matrix& taken, const Matrix& targets) : basis_(BasisOf(taken)) {
    targets_ = Off(targets);
  }
  // With more directions taken off; of the first target.
  Remainder(const Remainder& before, const Matrix& more) {
    const Matrix others = BasisOf(before.Off(more));
    basis_.resize(others.rows(), before.basis_.cols() + others.cols());
    basis_ << before.basis_, others;
    targets_ = Off(before.targets_.leftCols(1));
  }
  Matrix Off(const Matrix& columns) const {
    return columns - basis_ * (basis_.transpose() * columns);
  }
  const Matrix& targets() const { return targets_; }

  // Squares that columns take of each target, by their normal equations. They are zero but in rows
  // of some joints, which are all that count.
  struct Rows {
    Eigen::Index begin, count;
  };
  Vector Amounts(const Matrix& columns, const std::vector<Rows>& where) const {
    constexpr double kNothing = 1e-9;  // of the squares of a direction
    const Eigen::Index n = columns.cols();
    Matrix inner = Matrix::Zero(n, n), taken = Matrix::Zero(basis_.cols(), n);
    Matrix with_targets = Matrix::Zero(n, targets_.cols());
    for (const Rows& rows : where) {
      const auto some = columns.middleRows(rows.begin, rows.count);
      inner += some.transpose() * some;
      taken += basis_.middleRows(rows.begin, rows.count).transpose() * some;
      with_targets += some.transpose() * targets_.middleRows(rows.begin, rows.count);
    }
    const Matrix left = inner - taken.transpose() * taken;
    if (!(left.trace() > kNothing * inner.trace())) return Vector::Zero(targets_.cols());
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
    solver.setThreshold(kNothing);
    solver.compute(left);
    const Matrix sizes = solver.solve(with_targets);
    return with_targets.cwiseProduct(sizes).colwise().sum().transpose();
  }

 private:
  static Matrix BasisOf(const Matrix& columns) {
    if (columns.cols() == 0) return columns;
    const Eigen::ColPivHouseholderQR<Matrix> qr(columns);
    return qr.householderQ() * Matrix::Identity(columns.rows(), qr.rank());
  }

  Matrix basis_, targets_;
};

// Least squares of some columns; those that the others say too count nothing.
Matrix Solve(const Matrix& columns, const Matrix& targets) {
  return columns.completeOrthogonalDecomposition().solve(targets);
}

struct Law {
  std::size_t place = 0;
  std::vector<PlacedTerm> terms;
  double amount = 0;  // of squares
  double left = 0;    // of the squares, on the folds
};

class LawSearch {
 public:
  LawSearch(const LawRows& rows, std::uint64_t seed)
      : rows_(rows), all_(Thin(rows.Columns()), Targets(rows, seed)) {
    const std::size_t n = rows.joints().size();
    for (const MissingForce& joint : rows.joints()) reach_.push_back(ReachOf(joint));
    for (std::size_t j = 0; j < n; ++j) AddPlace({j}, TermsAt(j));
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < j; ++i) AddPlace({i, j}, TermsOfTwo(reach_[i], reach_[j]));
    }
    const bool alike = std::all_of(reach_.begin(), reach_.end(), [&](const JointReach& r) {
      return r.slides == reach_.front().slides;
    });
    if (n > 1 && alike) {
      Joints every(n);
      std::iota(every.begin(), every.end(), std::size_t{0});
      AddPlace(every, TermsOf(Common()));
    }
  }

  std::vector<SuggestedLaw> Run(std::size_t most) {
    std::vector<Law> laws = OneTerm();
    if (laws.empty()) return {};
    const double chance = by_chance_;
    if (laws.front().amount <= chance) return {};
    laws.resize(std::min(laws.size(), kRefined));
    for (Law& law : laws) Refine(law, all_);
    Sort(laws);
    const std::size_t singles = std::min(laws.size(), kExtended);
    for (std::size_t i = 0; i < singles; ++i) {
      if (auto longer = Extended(laws[i])) laws.push_back(*std::move(longer));
    }
    Sort(laws);
    std::erase_if(
        laws, [&](const Law& law) { return !(1 - law.left >= kLeast) || law.amount <= chance; });
    if (laws.empty() || IsPlain(laws.front())) return {};
    std::erase_if(laws, IsPlain);
    return Few(laws, most);
  }

 private:
  struct Where {
    Joints joints;
    std::vector<LawTerm> terms;
  };

  // What the parameters leave of the missing force, and the same shifted.
  static Matrix Targets(const LawRows& rows, std::uint64_t seed) {
    Matrix targets(rows.size(), 1 + kShifted);
    targets.col(0) = Remainder(Thin(rows.Columns()), rows.Missing()).targets();
    for (std::size_t k = 1; k <= kShifted; ++k)
      targets.col(static_cast<Eigen::Index>(k)) = rows.Shifted(targets.col(0), seed + k);
    return targets;
  }
  // Columns of nothing have no directions.
  static Matrix Thin(const Matrix& columns) {
    std::vector<Eigen::Index> some;
    for (Eigen::Index i = 0; i < columns.cols(); ++i)
      if (columns.col(i).norm() > 0) some.push_back(i);
    Matrix thin(columns.rows(), std::ssize(some));
    for (Eigen::Index i = 0; i < thin.cols(); ++i)
      thin.col(i) = columns.col(some[static_cast<std::size_t>(i)]).normalized();
    return thin;
  }

  void AddPlace(Joints joints, std::vector<LawTerm> terms) {
    places_.push_back({std::move(joints), std::move(terms)});
  }
  std::vector<LawTerm> TermsAt(std::size_t j) const {
    std::vector<LawTerm> terms = TermsOf(reach_[j]);
    const auto add = [&](std::vector<LawTerm> more) {
      std::move(more.begin(), more.end(), std::back_inserter(terms));
    };
    for (std::size_t i = 0; i < reach_.size(); ++i) {
      if (i == j || !IsSayable(i)) continue;
      add(TermsWith(reach_[j], reach_[i], rows_.joints()[i].joint));
      for (std::size_t k = 0; k < i; ++k) {
        if (k != j && IsSayable(k))
          add(TermsWith(reach_[j], rows_.joints()[k].joint, rows_.joints()[i].joint));
      }
    }
    return terms;
  }
  // Whether a formula can name a joint.
  bool IsSayable(std::size_t j) const {
    return rows_.joints()[j].joint.find_first_of("[]") == std::string::npos;
  }
  // Of all joints, whose shapes are shared.
  JointReach Common() const {
    JointReach common = reach_.front();
    for (const JointReach& r : reach_) {
      common.lower = std::min(common.lower, r.lower),
      common.upper = std::max(common.upper, r.upper);
      common.speed = std::max(common.speed, r.speed);
    }
    return common;
  }

  Matrix ColumnsOf(const PlacedTerm& term, std::size_t place) const {
    Matrix columns = rows_.Of(term, places_[place].joints);
    if (!columns.allFinite()) columns.setZero();
    return columns;
  }
  std::vector<Remainder::Rows> RowsOf(std::size_t place) const {
    const Eigen::Index count = rows_.size() / std::ssize(rows_.joints());
    std::vector<Remainder::Rows> rows;
    for (const std::size_t j : places_[place].joints)
      rows.push_back({static_cast<Eigen::Index>(j) * count, count});
    return rows;
  }
  Matrix ColumnsOf(const Law& law) const {
    Matrix columns(rows_.size(), 0);
    for (const PlacedTerm& term : law.terms) {
      const Matrix more = ColumnsOf(term, law.place);
      columns.conservativeResize(Eigen::NoChange, columns.cols() + more.cols());
      columns.rightCols(more.cols()) = more;
    }
    return columns;
  }

  // The best shape of every term at a place on the grid, by what is left of the first target.
  struct Best {
    std::vector<double> shapes;
    double amount = 0, shifted = 0;
  };
  Best BestOnGrid(const LawTerm& term, std::size_t place, const Remainder& from) const {
    Best best;
    for (const std::vector<double>& shapes : term.Grid()) {
      const Vector amounts = from.Amounts(ColumnsOf({term, shapes}, place), RowsOf(place));
      if (best.shapes.size() < shapes.size() || amounts[0] > best.amount)
        best.shapes = shapes, best.amount = amounts[0];
      if (amounts.size() > 1)
        best.shifted = std::max(best.shifted, amounts.tail(kShifted).maxCoeff());
    }
    return best;
  }

  std::vector<Law> OneTerm() {
    std::vector<std::pair<std::size_t, std::size_t>> tasks;  // place, term
    for (std::size_t p = 0; p < places_.size(); ++p)
      for (std::size_t t = 0; t < places_[p].terms.size(); ++t) tasks.emplace_back(p, t);
    std::vector<Best> best(tasks.size());
    ParallelFor(tasks.size(), [&](std::size_t, std::size_t i) {
      const auto [p, t] = tasks[i];
      best[i] = BestOnGrid(places_[p].terms[t], p, all_);
    });
    std::vector<Law> laws;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const auto [p, t] = tasks[i];
      by_chance_ = std::max(by_chance_, best[i].shifted);
      laws.push_back({p, {{places_[p].terms[t], best[i].shapes}}, best[i].amount});
    }
    std::stable_sort(laws.begin(), laws.end(),
                     [](const Law& a, const Law& b) { return a.amount > b.amount; });
    return laws;
  }

  // The shapes of its last term, one after the other by ever smaller steps; then its score.
  void Refine(Law& law, const Remainder& from) const {
    constexpr int kRounds = 14;
    PlacedTerm& last = law.terms.back();
    const auto amount = [&](const PlacedTerm& term) {
      return from.Amounts(ColumnsOf(term, law.place), RowsOf(law.place))[0];
    };
    double best = amount(last);
    std::vector<double> step;
    for (std::size_t s = 0; s < last.shapes.size(); ++s) {
      const auto& grid = last.term.shapes[s].grid;
      step.push_back(grid.size() > 1
                         ? (grid.back() - grid.front()) / (2 * static_cast<double>(grid.size()))
                         : 0);
      step.back() =
          std::min(step.back(), std::max(0.3 * std::abs(last.shapes[s]), 1e-3 * step.back()));
    }
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t s = 0; s < step.size(); ++s) {
        bool moved = false;
        for (const double sign : {1.0, -1.0}) {
          PlacedTerm other = last;
          const TermShape& shape = last.term.shapes[s];
          other.shapes[s] = std::clamp(last.shapes[s] + sign * step[s], shape.lower, shape.upper);
          const double its = amount(other);
          if (!(its > best)) continue;
          best = its, last = std::move(other), moved = true;
          break;
        }
        if (!moved) step[s] /= 2;
      }
    }
    Score(law);
  }

  // What the law takes of what the parameters leave, and what it leaves on rows that its sizes have
  // not seen.
  void Score(Law& law) const {
    const Matrix columns = all_.Off(ColumnsOf(law));
    const Vector target = all_.targets().col(0);
    const Eigen::Index n = columns.cols();
    std::map<std::size_t, Matrix> of_group;
    Matrix whole = Matrix::Zero(n + 1, n + 1);
    for (Eigen::Index k = 0; k < target.size(); ++k) {
      Vector row(n + 1);
      row << columns.row(k).transpose(), target[k];
      const std::size_t group = rows_.groups()[static_cast<std::size_t>(k)];
      of_group.try_emplace(group, Matrix::Zero(n + 1, n + 1)).first->second +=
          row * row.transpose();
    }
    for (const auto& [group, gram] : of_group) whole += gram;
    double left = 0;
    for (const auto& [group, gram] : of_group) {
      const Matrix rest = whole - gram;
      Vector b = Vector::Zero(n + 1);
      if (of_group.size() > 1)
        b.head(n) =
            -rest.topLeftCorner(n, n).completeOrthogonalDecomposition().solve(rest.col(n).head(n));
      b[n] = 1;
      left += b.dot(gram * b);
    }
    law.left = whole(n, n) > 0 ? left / whole(n, n) : 1;
    law.amount = (columns * Solve(columns, target)).squaredNorm();
  }

  std::optional<Law> Extended(const Law& law) const {
    const Remainder rest(all_, ColumnsOf(law));
    std::vector<LawTerm> terms = places_[law.place].terms;
    if (HasHeat(law.terms.front().term)) std::erase_if(terms, HasHeat);  // it has one constant
    std::vector<Law> longer(terms.size(), law);
    ParallelFor(terms.size(), [&](std::size_t, std::size_t t) {
      const Best best = BestOnGrid(terms[t], law.place, rest);
      longer[t].terms.push_back({terms[t], best.shapes});
      longer[t].amount = best.amount;
    });
    std::stable_sort(longer.begin(), longer.end(),
                     [](const Law& a, const Law& b) { return a.amount > b.amount; });
    std::optional<Law> best;
    for (std::size_t i = 0; i < std::min(longer.size(), kSeconds); ++i) {
      if (NumbersOf(longer[i]) > kNumbers) continue;
      Refine(longer[i], rest);
      if (longer[i].left < kEarned * law.left && (!best || longer[i].left < best->left))
        best = std::move(longer[i]);
    }
    return best;
  }

  static bool IsPlain(const Law& law) {
    return std::all_of(law.terms.begin(), law.terms.end(),
                       [](const PlacedTerm& placed) { return placed.term.plain; });
  }

  static bool HasHeat(const LawTerm& term) {
    return std::any_of(term.shapes.begin(), term.shapes.end(),
                       [](const TermShape& shape) { return shape.name == Formula::kHeatTime; });
  }

  static std::size_t NumbersOf(const Law& law) {
    std::size_t n = 0;
    for (const PlacedTerm& term : law.terms) n += term.term.parts.size() + term.shapes.size();
    return n;
  }

  // Squares that are left on the folds, each number that it needs worth a few per cent of them.
  static void Sort(std::vector<Law>& laws) {
    constexpr double kNumber = 0.02;
    const auto key = [](const Law& law) {
      return law.left * (1 + kNumber * static_cast<double>(NumbersOf(law)));
    };
    std::stable_sort(laws.begin(), laws.end(),
                     [&](const Law& a, const Law& b) { return key(a) < key(b); });
  }

  // Without parts that do little beside the others of their term: a wave has a sine and a cosine.
  Law Plainer(Law law) const {
    constexpr double kLittle = 0.1;
    const Matrix columns = all_.Off(ColumnsOf(law));
    const Vector sizes = Solve(columns, all_.targets().leftCols(1));
    Eigen::Index at = 0;
    for (PlacedTerm& placed : law.terms) {
      std::vector<double> does;
      for (std::size_t p = 0; p < placed.term.parts.size(); ++p, ++at)
        does.push_back(columns.col(at).norm() * std::abs(sizes[at]));
      const double most = *std::max_element(does.begin(), does.end());
      std::size_t p = 0;
      std::erase_if(placed.term.parts, [&](const auto&) { return does[p++] < kLittle * most; });
    }
    return law;
  }

  // The best of one term first, which later need only come near; then as they are, few at a place.
  std::vector<SuggestedLaw> Few(const std::vector<Law>& laws, std::size_t most) const {
    std::vector<const Law*> chosen;
    const auto take = [&](std::size_t limit, const auto& may) {
      for (const Law& law : laws) {
        const bool there = std::find(chosen.begin(), chosen.end(), &law) != chosen.end();
        if (chosen.size() < limit && !there && may(law)) chosen.push_back(&law);
      }
    };
    const auto here = [&](const Law& law) {
      return static_cast<std::size_t>(
          std::count_if(chosen.begin(), chosen.end(),
                        [&](const Law* other) { return other->place == law.place; }));
    };
    take(kPlain, [](const Law& law) { return law.terms.size() == 1; });
    take(most, [&](const Law& law) { return here(law) < kAtOnePlace; });
    take(most, [](const Law&) { return true; });
    std::vector<SuggestedLaw> suggested;
    for (const Law* const law : chosen) suggested.push_back(Written(*law));
    return suggested;
  }

  SuggestedLaw Written(Law law) const {
    law = Plainer(std::move(law));
    SuggestedLaw out;
    for (const std::size_t j : places_[law.place].joints)
      out.joints.push_back(rows_.joints()[j].joint);
    out.share = law.amount / all_.targets().col(0).squaredNorm();
    const Vector sizes = Solve(all_.Off(ColumnsOf(law)), all_.targets().leftCols(1));
    Eigen::Index size = 0;
    int shapes = 0;
    for (const PlacedTerm& placed : law.terms) {
      std::vector<std::string> from, to;
      for (const TermShape& shape : placed.term.shapes) {
        const bool own = shape.name == Formula::kHeatTime;
        from.push_back(shape.name), to.push_back(own ? shape.name : fmt::format("s{}", ++shapes));
      }
      for (const LawTerm::Part& part : placed.term.parts) {
        const std::string name = fmt::format("a{}", size + 1);
        if (!out.law.formula.empty()) out.law.formula += " + ";
        out.law.formula += name + "*" + Expression::Renamed(part.text, from, to);
        const double value = sizes[size++];
        const double most = 20 * std::max(std::abs(value), 1e-9);
        AddParameter(out.law, name, part.unit, value, -most, most, 0);
      }
      for (std::size_t s = 0; s < placed.shapes.size(); ++s) {
        const TermShape& shape = placed.term.shapes[s];
        AddParameter(out.law, to[s], shape.unit, placed.shapes[s], shape.lower, shape.upper,
                     std::numeric_limits<double>::quiet_NaN());
      }
    }
    out.law.name = std::string(Formula::kName);
    return out;
  }

  static void AddParameter(WrittenLaw& law, const std::string& name, const std::string& unit,
                           double value, double lower, double upper, double null) {
    Parameter p;
    p.name = name, p.unit = unit, p.lower = lower, p.upper = upper;
    p.initial = std::clamp(value, lower, upper), p.has_initial = true;
    law.parameters.push_back(std::move(p));
    law.null.push_back(null);
  }

  const LawRows& rows_;
  Remainder all_;  // of what the fitted parameters leave: the missing force, and shifted ones
  std::vector<JointReach> reach_;
  std::vector<Where> places_;
  double by_chance_ = 0;
};

}  // namespace

std::vector<SuggestedLaw> SuggestLaws(const LawRows& rows, std::uint64_t seed, std::size_t most) {
  if (rows.size() == 0) return {};
  return LawSearch(rows, seed).Run(most);
}

}  // namespace continuum
