#include "identification/diagnosis/screening.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/Dense>

#include "identification/diagnosis/plainest.h"
#include "identification/statistics/uncertainty.h"
#include "sim/numerics/portable_random.h"
#include "sim/numerics/shared_loop.h"

namespace continuum {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

constexpr int kDraws = 1999;  // of white noise

// How well a step's difference to a finer one predicts that to the limit, in units of itself:
// well where it is of first order, not at all where joints stick and slip.
double Spread(const Matrix& S, const Criteria& criteria) {
  const double effect = S.col(0).norm();
  if (!(effect > 0)) return criteria.step_most_spread;
  return std::clamp<double>(criteria.step_varies * S.col(2).norm() / effect,
                            criteria.step_least_spread, criteria.step_most_spread);
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
// Each subset of C's columns is decomposed once for any number of z: with an orthonormal basis Q of
// its span, a = −C⁺ Q (Qᵀ z) explains |Qᵀ z|².
class Explainer {
 public:
  explicit Explainer(Probe probe) : probe_(std::move(probe)) {}

  Explained operator()(const Eigen::Ref<const Vector>& z) {
    const Eigen::Index k = probe_.columns.cols();
    std::vector<bool> out(k, false);
    while (true) {
      const Subset& subset = Without(out);
      Explained e{0, Vector::Zero(k)};
      if (subset.in.empty()) return e;
      const Vector within = subset.basis.transpose() * z;
      const Vector a = -(subset.sizes * within);
      Eigen::Index worst = -1;
      for (std::size_t i = 0; i < subset.in.size(); ++i) {
        if (probe_.sign[subset.in[i]] * a[i] < 0) worst = subset.in[i];
        e.coefficients[subset.in[i]] = a[i];
      }
      if (worst < 0) {
        e.amount = within.squaredNorm();
        return e;
      }
      out[worst] = true;
    }
  }

 private:
  struct Subset {
    std::vector<Eigen::Index> in;
    Matrix basis, sizes;  // Q, C⁺ Q
  };

  const Subset& Without(const std::vector<bool>& out) {
    const auto [at, fresh] = subsets_.try_emplace(out);
    Subset& subset = at->second;
    if (!fresh) return subset;
    for (Eigen::Index i = 0; i < probe_.columns.cols(); ++i) {
      if (!out[i] && probe_.columns.col(i).squaredNorm() > 0) subset.in.push_back(i);
    }
    if (subset.in.empty()) return subset;
    const Matrix columns = probe_.columns(Eigen::all, subset.in);
    const Eigen::CompleteOrthogonalDecomposition<Matrix> solver(columns);
    subset.basis = solver.householderQ() * Matrix::Identity(columns.rows(), solver.rank());
    subset.sizes = solver.solve(subset.basis);
    return subset;
  }

  Probe probe_;
  std::map<std::vector<bool>, Subset> subsets_;
};

// A candidate in the few dimensions that any candidate reaches.
struct ReducedCandidate {
  std::vector<Explainer> probes;
  double Best(const Eigen::Ref<const Vector>& z, std::size_t* which = nullptr) {
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

// The columns of all probes beside each other.
Matrix AllColumns(const std::vector<std::vector<Probe>>& candidates, Eigen::Index rows) {
  Eigen::Index columns = 0;
  for (const auto& probes : candidates) {
    for (const Probe& p : probes) columns += p.columns.cols();
  }
  Matrix all(rows, columns);
  columns = 0;
  for (const auto& probes : candidates) {
    for (const Probe& p : probes) {
      all.middleCols(columns, p.columns.cols()) = p.columns;
      columns += p.columns.cols();
    }
  }
  return all;
}

// The few dimensions that any probe reaches.
class ProbeSpan {
 public:
  explicit ProbeSpan(const Matrix& all) : qr_(all), size_(std::min(all.rows(), all.cols())) {}

  Matrix Projected(const Matrix& any) const {
    return (qr_.householderQ().transpose() * any).topRows(size_);
  }
  std::vector<ReducedCandidate> Reduced(const std::vector<std::vector<Probe>>& candidates) const {
    const Matrix within = qr_.matrixQR().topRows(size_).template triangularView<Eigen::Upper>();
    std::vector<ReducedCandidate> reduced(candidates.size());
    Eigen::Index column = 0;
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      for (const Probe& p : candidates[c]) {
        reduced[c].probes.emplace_back(Probe{within.middleCols(column, p.columns.cols()), p.sign});
        column += p.columns.cols();
      }
    }
    return reduced;
  }
  Matrix WhiteNoise(int draws, std::uint64_t seed) const {
    Random random(seed);
    Matrix noise(size_, draws);
    for (double& v : noise.reshaped()) v = random.Normal();
    return noise;
  }

 private:
  Eigen::HouseholderQR<Matrix> qr_;
  Eigen::Index size_;
};

// [candidate, draw] how often noise explains as much as a candidate does of this draw; the last
// draw is the measurement, of which it explains so much.
Matrix TailProbabilities(std::vector<ReducedCandidate>& candidates, const Matrix& noise,
                         const std::vector<double>& explained) {
  Matrix p(static_cast<Eigen::Index>(candidates.size()), noise.cols() + 1);
  p.rightCols(1) = Eigen::Map<const Vector>(explained.data(), p.rows());
  const auto rank = [&](std::size_t, std::size_t c) {
    for (Eigen::Index d = 0; d < noise.cols(); ++d) p(c, d) = candidates[c].Best(noise.col(d));
    const Tail tail(p.row(c));
    for (double& amount : p.row(c)) amount = tail(amount);
  };
  ShareOut(candidates.size(), rank,
           [&](auto& archive, std::size_t c) { FieldsOfBlock(archive, p.row(c)); });
  return p;
}

// [candidate] the share of draws in which some candidate is as improbable as this one is with the
// measurement.
std::vector<double> FamilyWise(const Matrix& p) {
  const Eigen::Index draws = p.cols() - 1;
  std::vector<double> smallest;
  for (Eigen::Index d = 0; d < draws; ++d) smallest.push_back(p.col(d).minCoeff());
  std::sort(smallest.begin(), smallest.end());
  std::vector<double> family_wise;
  for (Eigen::Index c = 0; c < p.rows(); ++c) {
    const auto as_small =
        std::upper_bound(smallest.begin(), smallest.end(), p(c, draws)) - smallest.begin();
    family_wise.push_back((static_cast<double>(as_small) + 1) / static_cast<double>(draws + 1));
  }
  return family_wise;
}

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

ProjectedResidual::ProjectedResidual(const Whitening& whitening, const std::vector<bool>& use,
                                     const std::vector<Vector>& residuals,
                                     const std::vector<Matrix>& jacobian,
                                     const std::vector<bool>& fixed,
                                     const std::vector<Matrix>& step, const Criteria& criteria)
    : whitening_(&whitening), use_(use) {
  const Matrix J = whitening.Stack(jacobian, use);
  const Matrix S = whitening.Stack(step, use);
  Vector r = whitening.Stack(residuals, use);
  std::vector<double> spread;
  if (S.cols() > 0) {
    r -= kWholeStep * S.col(0);
    roughness_ = Spread(S, criteria);
    spread = {roughness_, criteria.late};
  }
  const auto n = r.size(), priors = static_cast<Eigen::Index>(spread.size());
  Matrix A = Matrix::Zero(n + priors, J.cols() + priors);  // the last rows are the priors of S
  Eigen::Index free = 0;
  std::vector<Eigen::Index> parameters;
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    if (!fixed[i]) A.col(free++).head(n) = J.col(i), parameters.push_back(i);
  }
  std::vector<double> most;
  for (Eigen::Index i = 0; i < priors; ++i) {
    A.col(free + i).head(n) = S.col(i);
    A(n + i, free + i) = 1 / spread[i];
    most.push_back(criteria.step_farthest * spread[i]);
  }
  Vector padded = Vector::Zero(n + priors);
  padded.head(n) = r;
  A.conservativeResize(Eigen::NoChange, free + priors);
  Limit(A, padded, free, std::move(most));
  basis_ = Basis(A);
  residual_ = Out(padded).col(0);
  shift_ = Vector::Zero(J.cols());
  if (free > 0) shift_(parameters) = -A.completeOrthogonalDecomposition().solve(padded).head(free);
  const double measured = static_cast<double>((r.array() != 0).count());
  freedom_ = measured - static_cast<double>(free);
}

ProjectedResidual::Matrix ProjectedResidual::Out(Matrix columns) const {
  columns -= basis_ * (basis_.transpose() * columns);
  return columns;
}

ProjectedResidual::Matrix ProjectedResidual::Project(const std::vector<Matrix>& columns) const {
  const Matrix stacked = whitening_->Stack(columns, use_);
  Matrix padded = Matrix::Zero(residual_.size(), stacked.cols());
  padded.topRows(stacked.rows()) = stacked;
  return Out(std::move(padded));
}

Explained ExplainedBy(const Probe& probe, const Vector& z) { return Explainer(probe)(z); }

Explained PlainlyExplainedBy(const Probe& probe, const Vector& z) {
  return PlainestOf(
      probe.columns,
      [&](const Matrix& some) {
        return ExplainedBy({some, probe.sign}, z);
      },
      [](const Explained& e) { return e.amount; });
}

Significance BestOfProbes(const std::vector<std::vector<Probe>>& candidates, const Vector& z) {
  Significance out;
  for (const auto& probes : candidates) {
    out.best.push_back(0);
    ReducedCandidate whole{{probes.begin(), probes.end()}};
    out.explained.push_back(whole.Best(z, &out.best.back()));
    out.p.push_back(1);
  }
  return out;
}

// Everything happens in the span of all probes: z and draws of noise are projected into it once.
Significance SignificanceOf(const std::vector<std::vector<Probe>>& candidates, const Vector& z,
                            std::uint64_t seed, const Matrix& given) {
  Significance out;
  out.explained.assign(candidates.size(), 0);
  out.best.assign(candidates.size(), 0);
  out.p.assign(candidates.size(), 1);
  const Matrix all = AllColumns(candidates, z.size());
  if (all.cols() == 0) return out;
  const ProbeSpan span(all);
  std::vector<ReducedCandidate> reduced = span.Reduced(candidates);
  const Vector here = span.Projected(z);
  for (std::size_t c = 0; c < reduced.size(); ++c)
    out.explained[c] = reduced[c].Best(here, &out.best[c]);
  const Matrix noise = given.cols() > 0 ? span.Projected(given) : span.WhiteNoise(kDraws, seed);
  out.p = FamilyWise(TailProbabilities(reduced, noise, out.explained));
  return out;
}

}  // namespace continuum
