#include "identification/statistics/identifiability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "sim/numerics/decompositions.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kPoor = 0.01;          // of an eigenvalue
constexpr double kUnobservable = 1e-8;  // nobody sees a difference
constexpr double kNone = 1e-12;         // below this, rounding decides
constexpr double kTakesPart = 0.05, kAlike = 0.1;
constexpr double kTied = kTakesPart * kTakesPart;  // of a projector

constexpr std::size_t kMostNames = 6;  // of those that move most, that anybody reads

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string Combinations(std::size_t count) {
  return count == 1 ? "only one combination of them is"
                    : fmt::format("only {} combinations of them are", count);
}

// What stays the same when parameters move by these shares of their values, the first one by 1.
std::string WellDetermined(const std::vector<std::string>& names, const Vector& move) {
  if (move.size() == 2) {
    if (std::abs(move[0] - move[1]) < kAlike) return "only " + names[0] + "/" + names[1] + " is";
    if (std::abs(move[0] + move[1]) < kAlike) return "only " + names[0] + "*" + names[1] + " is";
  }
  const bool alike = move.size() > 2 && (move.array() - move[0]).abs().maxCoeff() < kAlike;
  return alike ? "only their ratios are" : Combinations(names.size() - 1);
}

// The first names, and how many others there are.
std::string Listed(const std::vector<std::string>& names) {
  std::vector<std::string> listed(names.begin(),
                                  names.begin() + std::min(names.size(), kMostNames));
  if (names.size() > kMostNames)
    listed.push_back(fmt::format("{} more", names.size() - kMostNames));
  return Joined(listed);
}

std::string Sentence(const std::vector<std::string>& names, const std::string& changes,
                     double freedom, const std::string& constant) {
  const bool exact = std::isinf(freedom);
  std::string text = Listed(names) + " trade off: " + changes +
                     (exact ? " change nothing that is measured"
                            : fmt::format(" show {:.0f} times less than one alone", freedom));
  if (!constant.empty()) text += "; " + constant + (exact ? " determined" : " well determined");
  return text;
}

// "changes of mass +1 %, gain -1 %".
std::string Changes(const std::vector<std::string>& names, const Vector& move, bool relative) {
  std::string moves;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) {
    moves += fmt::format("{}{} {:+.3g}{}", i ? ", " : "changes of ", names[i],
                         move[static_cast<Eigen::Index>(i)], relative ? " %" : "");
  }
  return moves;
}

// Parameters that move together, in directions that show little or nothing.
struct Group {
  std::vector<Eigen::Index> part;
  Matrix directions;  // [parameter][direction]
  double freedom;
  std::size_t within = 0;  // directions of other groups, of some of these parameters
};

double FreedomOf(double eigenvalue) {
  return eigenvalue < kNone ? std::numeric_limits<double>::infinity() : 1 / std::sqrt(eigenvalue);
}

Group SingleDirection(const Vector& direction, double eigenvalue) {
  Group group{{}, direction, FreedomOf(eigenvalue)};
  const double least = kTakesPart * direction.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < direction.size(); ++i)
    if (std::abs(direction[i]) >= least) group.part.push_back(i);
  return group;
}

// All that is tied to one parameter by a projector P, directly or through others.
std::vector<Eigen::Index> TiedTo(Eigen::Index first, const Matrix& P) {
  std::vector<Eigen::Index> tied{first};
  for (std::size_t k = 0; k < tied.size(); ++k) {
    for (Eigen::Index j = 0; j < P.rows(); ++j) {
      const bool known = std::find(tied.begin(), tied.end(), j) != tied.end();
      if (!known && std::abs(P(tied[k], j)) > kTied) tied.push_back(j);
    }
  }
  std::sort(tied.begin(), tied.end());
  return tied;
}

// Directions that show nothing mix with each other at will. Their projector does not: what it
// leaves unconnected has nothing to do with each other.
std::vector<Group> ConnectedGroups(const Matrix& directions, double eigenvalue) {
  const Matrix P = directions * directions.transpose();
  std::vector<bool> done(P.rows(), false);
  std::vector<Group> groups;
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    if (done[i] || P(i, i) <= kTied) continue;
    const auto part = TiedTo(i, P);
    Matrix own = Matrix::Zero(P.rows(), P.cols());
    own(part, part) = P(part, part);
    for (const Eigen::Index j : part) done[j] = true;
    const Eigen::SelfAdjointEigenSolver<Matrix> modes(own);
    const Eigen::Index count = (modes.eigenvalues().array() > 0.5).count();
    const Matrix moves = modes.eigenvectors().rightCols(count);
    groups.push_back(count == 1 ? SingleDirection(moves, eigenvalue)
                                : Group{part, moves, FreedomOf(eigenvalue)});
  }
  return groups;
}

std::vector<Group> GroupsOf(const Vector& values, const Matrix& vectors) {
  const Eigen::Index nothing = (values.array() < kUnobservable).count();
  std::vector<Group> groups;
  if (nothing > 0) groups = ConnectedGroups(vectors.leftCols(nothing), values[nothing - 1]);
  const std::size_t unseen = groups.size();
  for (Eigen::Index k = nothing; k < values.size() && values[k] < kPoor; ++k)
    groups.push_back(SingleDirection(vectors.col(k), values[k]));
  for (std::size_t i = unseen; i < groups.size(); ++i) {
    for (std::size_t j = 0; j < groups.size(); ++j) {
      const auto &whole = groups[i].part, &some = groups[j].part;
      if (i != j && std::includes(whole.begin(), whole.end(), some.begin(), some.end()))
        groups[i].within += static_cast<std::size_t>(groups[j].directions.cols());
    }
  }
  return groups;
}

// one: moves of each parameter that show as much as each other's.
Confounding ConfoundingOf(const Problem& problem, const Vector& x, const Vector& one,
                          const std::vector<Eigen::Index>& inside, const Group& group) {
  Confounding found{{}, group.freedom, ""};
  std::vector<Eigen::Index> members;  // of all parameters
  for (const Eigen::Index i : group.part) {
    members.push_back(inside[i]);
    found.names.push_back(problem.parameters()[inside[i]].name);
  }
  const auto moves = static_cast<std::size_t>(group.directions.cols());
  const std::string combinations = Combinations(members.size() - moves - group.within);
  if (moves > 1) {
    found.text = Sentence(found.names, fmt::format("{} independent changes of them", moves),
                          group.freedom, combinations);
    return found;
  }
  const Vector values = x(members);
  const bool relative = (values.array() != 0).all();
  Vector move = group.directions.col(0).cwiseProduct(one)(group.part);
  if (relative) move = move.cwiseQuotient(values);
  move /= move[0];
  const std::string constant = !relative          ? ""
                               : group.within > 0 ? combinations
                                                  : WellDetermined(found.names, move);
  found.text = Sentence(found.names, Changes(found.names, move, relative), group.freedom, constant);
  return found;
}

}  // namespace

std::vector<Confounding> ConfoundingsOf(const Problem& problem, const Vector& x,
                                        const Uncertainty& u) {
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!u.at_bound[i] && u.information(i, i) > 0) inside.push_back(i);
  }
  if (inside.size() < 2) return {};
  const Matrix H = u.information(inside, inside);
  const Vector one = H.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(
      Matrix(one.asDiagonal() * H * one.asDiagonal()));
  const auto is_start = [&](auto i) { return problem.parameters()[inside[i]].IsStart(); };
  std::vector<Confounding> all;
  for (Group& group : GroupsOf(modes.eigenvalues(), modes.eigenvectors())) {
    auto& part = group.part;
    if (part.size() < 2 || std::all_of(part.begin(), part.end(), is_start)) continue;
    if (part.size() > kMostNames) {
      const Vector far = group.directions.rowwise().norm();
      std::stable_sort(part.begin(), part.end(), [&](auto a, auto b) { return far[a] > far[b]; });
    }
    all.push_back(ConfoundingOf(problem, x, one, inside, group));
  }
  return all;
}

}  // namespace continuum
