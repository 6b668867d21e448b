#include "identification/diagnosis/screening.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Dense>

#include "identification/statistics/uncertainty.h"
#include "sim/numerics/parallel.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

// Of steps by which a log may be early or late: when within a step a row was taken and an input
// came is a matter of convention.
constexpr double kLate = 0.15;
// Times its deviation: more is a cause, as a delay of several steps.
constexpr double kFarthest = 2;

// How well a step's difference to a finer one foretells that to the limit, in units of itself:
// well where it is of first order, not at all where joints stick and slip.
double Spread(const Matrix& S) {
  constexpr double kLeast = 0.1, kMost = 3, kOfDeviation = 4;  // second order leaves twice that
  const double effect = S.col(0).norm();
  if (!(effect > 0)) return kMost;
  return std::clamp(kOfDeviation * S.col(2).norm() / effect, kLeast, kMost);
}

// Takes columns that r wants more of than they can be, one after the other, out of A's last ones
// and as much as they can be out of r.
void Limit(Matrix& A, Vector& r, Eigen::Index free, std::vector<double> most) {
  while (!most.empty()) {
    const Vector wanted = -A.colPivHouseholderQr().solve(r);
    Eigen::Index worst = -1;
    double excess = 1;
    for (std::size_t i = 0; i < most.size(); ++i) {
      const double over = std::abs(wanted[free + static_cast<Eigen::Index>(i)]) / most[i];
      if (over > excess) excess = over, worst = static_cast<Eigen::Index>(i);
    }
    if (worst < 0) return;
    r += std::copysign(most[worst], wanted[free + worst]) * A.col(free + worst);
    Matrix kept(A.rows(), A.cols() - 1);
    kept << A.leftCols(free + worst), A.rightCols(A.cols() - free - worst - 1);
    A = std::move(kept);
    most.erase(most.begin() + worst);
  }
}

// Least squares of z + C a; coefficients of a forbidden sign are put to zero one after the other.
// What is left of C is decomposed once for any number of z.
class Explainer {
 public:
  explicit Explainer(Probe probe) : probe_(std::move(probe)) {}

  Explained operator()(const Vector& z) {
    const Eigen::Index k = probe_.columns.cols();
    std::vector<bool> out(k, false);
    while (true) {
      const Left& left = Without(out);
      Explained e{0, Vector::Zero(k)};
      if (left.in.empty()) return e;
      const Vector a = -left.solver.solve(z);
      Eigen::Index worst = -1;
      for (std::size_t i = 0; i < left.in.size(); ++i) {
        if (probe_.sign[left.in[i]] * a[i] < 0) worst = left.in[i];
        e.coefficients[left.in[i]] = a[i];
      }
      if (worst < 0) {
        e.amount = std::max(0.0, z.squaredNorm() - (z + left.columns * a).squaredNorm());
        return e;
      }
      out[worst] = true;
    }
  }

 private:
  struct Left {
    std::vector<Eigen::Index> in;
    Matrix columns;
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
  };

  const Left& Without(const std::vector<bool>& out) {
    const auto [at, fresh] = left_.try_emplace(out);
    Left& left = at->second;
    if (!fresh) return left;
    for (Eigen::Index i = 0; i < probe_.columns.cols(); ++i) {
      if (!out[i] && probe_.columns.col(i).squaredNorm() > 0) left.in.push_back(i);
    }
    left.columns = probe_.columns(Eigen::all, left.in);
    if (!left.in.empty()) left.solver.compute(left.columns);
    return left;
  }

  Probe probe_;
  std::map<std::vector<bool>, Left> left_;
};

// A candidate in the few dimensions that any candidate reaches.
struct Small {
  std::vector<Explainer> probes;
  double Best(const Vector& z, std::size_t* which = nullptr) {
    double best = 0;
    for (std::size_t i = 0; i < probes.size(); ++i) {
      const double amount = probes[i](z).amount;
      if (amount > best) {
        best = amount;
        if (which) *which = i;
      }
    }
    return best;
  }
};

// How often noise explains more than some amount: nothing at all in some draws, else as a gamma
// distribution does that has their mean and variance, by Wilson and Hilferty's cube root. Not by
// ranks: of many candidates one is likely to be beyond all its draws, where ranks do not tell how
// far. What is to be judged is one of the draws, so that all are treated alike; the largest of them
// says nothing of the distribution, as it may be no noise.
class Tail {
 public:
  explicit Tail(const Eigen::Ref<const Eigen::RowVectorXd>& draws) {
    Eigen::Index largest = 0;
    draws.maxCoeff(&largest);
    double count = 0, sum = 0, squares = 0;
    for (Eigen::Index i = 0; i < draws.size(); ++i) {
      const double v = draws[i];
      if (i != largest && v > 0) count += 1, sum += v, squares += v * v;
    }
    share_ = count / static_cast<double>(draws.size());
    if (count < 2) return;
    mean_ = sum / count;
    ninth_ = (squares / count / (mean_ * mean_) - 1) / 9;
  }

  double operator()(double amount) const {
    if (!(amount > 0)) return 1;
    if (!(ninth_ > 0)) return share_;
    const double z = (std::cbrt(amount / mean_) - (1 - ninth_)) / std::sqrt(ninth_);
    return share_ * 0.5 * std::erfc(z * std::numbers::sqrt2 / 2);
  }

 private:
  double share_ = 0, mean_ = 1, ninth_ = 0;  // of the positive ones, a ninth of 1/shape
};

}  // namespace

Matrix Basis(const Matrix& A) {
  if (A.cols() == 0) return Matrix(A.rows(), 0);
  Matrix scaled = A;
  for (Eigen::Index i = 0; i < A.cols(); ++i) {
    const double norm = A.col(i).norm();
    if (norm > 0) scaled.col(i) /= norm;
  }
  Eigen::ColPivHouseholderQR<Matrix> qr(scaled);
  qr.setThreshold(1e-9);
  return qr.householderQ() * Matrix::Identity(A.rows(), qr.rank());
}

Remainder::Remainder(const Whitening& whitening, const std::vector<bool>& use,
                     const std::vector<Vector>& residuals, const std::vector<Matrix>& jacobian,
                     const std::vector<bool>& fixed, const std::vector<Matrix>& step)
    : whitening_(&whitening), use_(use) {
  const Matrix J = whitening.Stack(jacobian, use);
  const Matrix S = whitening.Stack(step, use);
  Vector r = whitening.Stack(residuals, use);
  std::vector<double> spread;
  if (S.cols() > 0) {
    r -= kWholeStep * S.col(0);
    roughness_ = Spread(S);
    spread = {roughness_, kLate};
  }
  const auto n = r.size(), priors = static_cast<Eigen::Index>(spread.size());
  Matrix A = Matrix::Zero(n + priors, J.cols() + priors);  // the last rows are the priors of S
  Eigen::Index free = 0;
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    if (!fixed[i]) A.col(free++).head(n) = J.col(i);
  }
  std::vector<double> most;
  for (Eigen::Index i = 0; i < priors; ++i) {
    A.col(free + i).head(n) = S.col(i);
    A(n + i, free + i) = 1 / spread[i];
    most.push_back(kFarthest * spread[i]);
  }
  Vector padded = Vector::Zero(n + priors);
  padded.head(n) = r;
  A.conservativeResize(Eigen::NoChange, free + priors);
  Limit(A, padded, free, std::move(most));
  basis_ = Basis(A);
  residual_ = Out(padded).col(0);
  const double measured = static_cast<double>((r.array() != 0).count());
  freedom_ = measured - static_cast<double>(free);
}

Remainder::Matrix Remainder::Out(Matrix columns) const {
  columns -= basis_ * (basis_.transpose() * columns);
  return columns;
}

Remainder::Matrix Remainder::Project(const std::vector<Matrix>& columns) const {
  const Matrix stacked = whitening_->Stack(columns, use_);
  Matrix padded = Matrix::Zero(residual_.size(), stacked.cols());
  padded.topRows(stacked.rows()) = stacked;
  return Out(std::move(padded));
}

Explained ExplainedBy(const Probe& probe, const Vector& z) { return Explainer(probe)(z); }

Significance BestOfProbes(const std::vector<std::vector<Probe>>& candidates, const Vector& z) {
  Significance out;
  for (const auto& probes : candidates) {
    out.best.push_back(0);
    Small whole{{probes.begin(), probes.end()}};
    out.explained.push_back(whole.Best(z, &out.best.back()));
    out.p.push_back(1);
  }
  return out;
}

// Everything happens in the span of all probes: z and draws of noise are projected into it once.
Significance SignificanceOf(const std::vector<std::vector<Probe>>& candidates, const Vector& z,
                            std::uint64_t seed, const Matrix& given) {
  const int count = given.cols() > 0 ? static_cast<int>(given.cols()) : 1999;
  Significance out;
  out.explained.assign(candidates.size(), 0);
  out.best.assign(candidates.size(), 0);
  out.p.assign(candidates.size(), 1);
  Eigen::Index columns = 0;
  for (const auto& probes : candidates) {
    for (const Probe& p : probes) columns += p.columns.cols();
  }
  if (columns == 0) return out;
  Matrix all(z.size(), columns);
  columns = 0;
  for (const auto& probes : candidates) {
    for (const Probe& p : probes) {
      all.middleCols(columns, p.columns.cols()) = p.columns;
      columns += p.columns.cols();
    }
  }
  const Eigen::HouseholderQR<Matrix> qr(all);
  const Eigen::Index span = std::min(all.rows(), all.cols());
  const auto projected = [&](const Matrix& any) -> Matrix {
    return (qr.householderQ().transpose() * any).topRows(span);
  };
  const Matrix within = qr.matrixQR().topRows(span).template triangularView<Eigen::Upper>();
  std::vector<Small> small(candidates.size());
  columns = 0;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    for (const Probe& p : candidates[c]) {
      small[c].probes.emplace_back(Probe{within.middleCols(columns, p.columns.cols()), p.sign});
      columns += p.columns.cols();
    }
  }
  const Vector here = projected(z);
  for (std::size_t c = 0; c < small.size(); ++c)
    out.explained[c] = small[c].Best(here, &out.best[c]);

  Random random(seed);
  Matrix noise(span, count);
  if (given.cols() > 0) {
    noise = projected(given);
  } else {
    for (double& v : noise.reshaped()) v = random.Normal();
  }
  Matrix draws(static_cast<Eigen::Index>(small.size()), count + 1);  // z itself is the last
  draws.rightCols(1) = Eigen::Map<const Vector>(out.explained.data(), draws.rows());
  ParallelFor(small.size(), [&](std::size_t, std::size_t c) {
    for (int d = 0; d < count; ++d) draws(c, d) = small[c].Best(noise.col(d));
    const Tail tail(draws.row(c));
    for (double& amount : draws.row(c)) amount = tail(amount);
  });
  std::vector<double> smallest;
  for (int d = 0; d < count; ++d) smallest.push_back(draws.col(d).minCoeff());
  std::sort(smallest.begin(), smallest.end());
  for (std::size_t c = 0; c < small.size(); ++c) {
    const auto as_small =
        std::upper_bound(smallest.begin(), smallest.end(), draws(c, count)) - smallest.begin();
    out.p[c] = (static_cast<double>(as_small) + 1) / (count + 1);
  }
  return out;
}

}  // namespace continuum
