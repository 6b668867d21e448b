#include "identification/trade_off.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <Eigen/Dense>

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

constexpr double kPoor = 0.01;   // of an eigenvalue
constexpr double kNone = 1e-12;  // below this, rounding decides
constexpr double kTakesPart = 0.05, kAlike = 0.1;

constexpr std::size_t kMostNames = 6;  // of those that move most, that anybody reads

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

// What stays the same when parameters move by these shares of their values, the first one by 1.
std::string Constant(const std::vector<std::string>& names, const Vector& move) {
  if (move.size() == 2) {
    if (std::abs(move[0] - move[1]) < kAlike) return "only " + names[0] + "/" + names[1];
    if (std::abs(move[0] + move[1]) < kAlike) return "only " + names[0] + "*" + names[1];
    return "only one combination of them";
  }
  return (move.array() - move[0]).abs().maxCoeff() < kAlike
             ? "only their ratios are"
             : "only " + std::to_string(move.size() - 1) + " combinations of them are";
}

std::string Sentence(const std::vector<std::string>& names, const Vector& move, bool relative,
                     double freedom) {
  std::vector<std::string> shown(names.begin(), names.begin() + std::min(names.size(), kMostNames));
  std::string moves;
  for (Eigen::Index i = 0; i < std::ssize(shown); ++i) {
    moves += fmt::format("{}{} {:+.3g}{}", i ? ", " : "", names[i], move[i], relative ? " %" : "");
  }
  if (names.size() > kMostNames)
    shown.push_back(fmt::format("{} others", names.size() - kMostNames));
  std::string text = Joined(shown) + " trade off: ";
  text += std::isinf(freedom)
              ? "changes of " + moves + " leave everything as it is"
              : fmt::format("changes of {} show {:.0f} times less than one alone", moves, freedom);
  if (!relative) return text;
  const std::string constant = Constant(names, move);
  return text + "; " + constant + (constant.ends_with(" are") ? " " : " is ") +
         (std::isinf(freedom) ? "determined" : "well determined");
}

}  // namespace

std::vector<TradeOff> TradeOffsOf(const Problem& problem, const Vector& x, const Uncertainty& u) {
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!u.at_bound[i] && u.information(i, i) > 0) inside.push_back(i);
  }
  if (inside.size() < 2) return {};
  const Matrix H = u.information(inside, inside);
  const Vector size = H.diagonal().cwiseSqrt();
  const Vector one = size.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Matrix> modes(one.asDiagonal() * H * one.asDiagonal());
  std::vector<TradeOff> all;
  for (Eigen::Index k = 0; k < modes.eigenvalues().size(); ++k) {
    const double value = modes.eigenvalues()[k];
    if (value >= kPoor) break;
    const Vector v = modes.eigenvectors().col(k);
    TradeOff found;
    std::vector<Eigen::Index> part, whose;  // of inside, of all parameters
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (std::abs(v[i]) < kTakesPart * v.cwiseAbs().maxCoeff()) continue;
      part.push_back(i);
    }
    const auto is_start = [&](auto i) { return problem.parameters()[inside[i]].IsStart(); };
    if (part.size() < 2 || std::all_of(part.begin(), part.end(), is_start)) continue;
    if (part.size() > kMostNames) {
      std::stable_sort(part.begin(), part.end(),
                       [&](auto a, auto b) { return std::abs(v[a]) > std::abs(v[b]); });
    }
    for (const Eigen::Index i : part) {
      whose.push_back(inside[i]);
      found.names.push_back(problem.parameters()[inside[i]].name);
    }
    const Vector values = x(whose);
    const bool relative = (values.array() != 0).all();
    Vector shown = v.cwiseProduct(one)(part);
    if (relative) shown = shown.cwiseQuotient(values);
    shown /= shown[0];
    found.freedom = value < kNone ? std::numeric_limits<double>::infinity() : 1 / std::sqrt(value);
    found.text = Sentence(found.names, shown, relative, found.freedom);
    all.push_back(std::move(found));
  }
  return all;
}

}  // namespace continuum
