#include "identification/statistics/uncertainty.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>

#include "identification/statistics/information_modes.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// Σ_t s_t s_tᵀ with Bartlett-weighted lags up to the bandwidth.
Matrix LongRunCovariance(const Matrix& scores, double bandwidth) {
  const Eigen::Index n = scores.rows();
  Matrix S = scores.transpose() * scores;
  for (Eigen::Index lag = 1; lag < n && static_cast<double>(lag) < bandwidth; ++lag) {
    const double w = 1 - static_cast<double>(lag) / bandwidth;
    const Matrix G = scores.topRows(n - lag).transpose() * scores.bottomRows(n - lag);
    S += w * (G + G.transpose());
  }
  return S;
}

// Andrews' plug-in for the Bartlett kernel with AR(1) scores, averaged over parameters.
double Bandwidth(const Matrix& scores) {
  const Eigen::Index n = scores.rows();
  if (n < 2) return 1;
  double top = 0, bottom = 0;
  for (Eigen::Index i = 0; i < scores.cols(); ++i) {
    const auto s = scores.col(i);
    const double power = s.head(n - 1).squaredNorm();
    if (!(power > 0)) continue;
    const double rho = std::clamp(s.head(n - 1).dot(s.tail(n - 1)) / power, -0.99, 0.99);
    top += 4 * rho * rho / (std::pow(1 - rho, 6) * std::pow(1 + rho, 2));
    bottom += 1 / std::pow(1 - rho, 4);
  }
  if (!(bottom > 0)) return 1;
  return std::min(1.1447 * std::cbrt(top / bottom * static_cast<double>(n)) + 1,
                  static_cast<double>(n) / 3);
}

// Jᵀ Cov(r) J of residuals r with the covariance of their autoregressive model: σ² YᵀY, where
// y_t = j_t + Σ a_i y_{t+i}.
Matrix ModelledCovariance(const Scores& block) {
  const ChannelNoise noise = NoiseFrom({{block.r.begin(), block.r.end()}});
  Matrix y = block.J;
  const auto order = static_cast<Eigen::Index>(noise.ar.size());
  for (Eigen::Index t = y.rows() - 1; t >= 0; --t) {
    for (Eigen::Index i = 0; i < order && t + 1 + i < y.rows(); ++i)
      y.row(t) += noise.ar[i] * y.row(t + 1 + i);
  }
  return noise.innovation * noise.innovation * y.transpose() * y;
}

// [row] measured.
std::vector<Eigen::Index> MeasuredRows(const Scores& block) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < block.r.size(); ++k) {
    if (block.r[k] != 0 || !block.J.row(k).isZero(0)) rows.push_back(k);
  }
  return rows;
}

Scores Measured(const Scores& all) {
  const auto rows = MeasuredRows(all);
  return {all.r(rows), all.J(rows, Eigen::all), all.curvature(rows)};
}

// [row measured by any block × parameters] s_t.
Matrix SummedScores(const std::vector<Scores>& motion) {
  Matrix sum = Matrix::Zero(motion.front().J.rows(), motion.front().J.cols());
  std::vector<bool> any(sum.rows(), false);
  for (const Scores& block : motion) {
    sum += block.r.asDiagonal() * block.J;
    for (const Eigen::Index k : MeasuredRows(block)) any[k] = true;
  }
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < sum.rows(); ++k) {
    if (any[k]) rows.push_back(k);
  }
  return sum(rows, Eigen::all);
}

// Replicates of one channel as their mean and their differences.
std::vector<Scores> MeanAndDifferences(const std::vector<Scores>& replicates) {
  std::vector<Scores> out;
  Scores sum = replicates.front();
  for (std::size_t j = 1; j < replicates.size(); ++j) {
    const auto before = static_cast<double>(j);
    const double scale = 1 / std::sqrt(before * (before + 1));
    const Scores& next = replicates[j];
    out.push_back(
        {scale * (sum.r - before * next.r), scale * (sum.J - before * next.J), next.curvature});
    sum.r += next.r, sum.J += next.J, sum.curvature += next.curvature;
  }
  const auto m = static_cast<double>(replicates.size());
  out.push_back({sum.r / std::sqrt(m), sum.J / std::sqrt(m), sum.curvature / m});
  for (Scores& block : out) block.curvature = out.back().curvature;
  return out;
}

// ρ' and ρ'' of the robust loss at residuals r.
struct Loss {
  Vector slope, curvature;
};
Loss LossOf(double soft, const Vector& r) {
  if (soft == 0) return {r, Vector::Ones(r.size())};
  const Eigen::ArrayXd spread = 1 + (r.array() / soft).square();
  return {r.array() * spread.pow(-0.5), spread.pow(-1.5)};
}

}  // namespace

std::vector<bool> AtBounds(const Problem& problem, const Vector& x) {
  std::vector<bool> at;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    const double edge = 1e-6 * p.scale;
    at.push_back(x[i] <= p.lower + edge || x[i] >= p.upper - edge);
  }
  return at;
}

std::vector<Matrix> WeightedByCurvature(std::vector<Matrix> J, double soft,
                                        const std::vector<Vector>& r) {
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (J[l].size() > 0) J[l].array().colwise() *= LossOf(soft, r[l]).curvature.array().sqrt();
  }
  return J;
}

void Widen(const Problem& problem, const Vector& low, const Vector& high, Uncertainty& u) {
  for (Eigen::Index i = 0; i < low.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    u.lower[i] = std::max(p.lower, u.lower[i] + low[i]);
    u.upper[i] = std::min(p.upper, u.upper[i] + high[i]);
  }
}

Uncertainty UncertaintyOf(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                          const std::vector<Matrix>& J, const Whitening& whitening, double soft) {
  std::vector<bool> use;
  for (const Matrix& columns : J) use.push_back(columns.size() > 0);
  std::vector<std::vector<Scores>> motions;
  const auto channels = static_cast<Eigen::Index>(problem.channels().size());
  for (const auto& logs : problem.Motions(use)) {
    std::vector<std::vector<Scores>> replicates(channels);
    for (const std::size_t l : logs) {
      const Eigen::Index rows = r[l].size() / channels;
      const Vector white = whitening.Apply(l, r[l]).col(0);
      const Matrix columns = whitening.Apply(l, J[l]);
      for (Eigen::Index c = 0; c < channels; ++c) {
        const Loss loss = LossOf(soft, white.segment(c * rows, rows));
        replicates[c].push_back({loss.slope, columns.middleRows(c * rows, rows), loss.curvature});
      }
    }
    std::vector<Scores>& motion = motions.emplace_back();
    for (const auto& of_channel : replicates) {
      for (Scores& block : MeanAndDifferences(of_channel)) motion.push_back(std::move(block));
    }
  }
  return UncertaintyFrom(problem, x, motions);
}

namespace {

// What all motions together say of n parameters.
struct Evidence {
  explicit Evidence(Eigen::Index n) : H(Matrix::Zero(n, n)), S(H), modelled(H) {}

  void Add(const std::vector<Scores>& motion) {
    const Matrix scores = SummedScores(motion);
    const double bandwidth = Bandwidth(scores);
    S += LongRunCovariance(scores, bandwidth);
    for (const Scores& all : motion) {
      const Scores block = Measured(all);
      H += block.J.transpose() * block.curvature.asDiagonal() * block.J;
      modelled += ModelledCovariance(block);
      independent += static_cast<double>(block.r.size()) / bandwidth;
      rows += block.r.size();
    }
  }
  Eigen::Index determined() const { return (H.diagonal().array() > 0).count(); }
  // Whether it says anything of one parameter.
  bool Sees(Eigen::Index a) const { return rows > determined() && H(a, a) > 0; }

  Matrix H, S, modelled;
  double independent = 0;  // rows
  Eigen::Index rows = 0;
};

Matrix InformationInside(Matrix H, const std::vector<bool>& at_bound) {
  for (Eigen::Index i = 0; i < H.rows(); ++i) {
    if (at_bound[i]) H.row(i).setZero(), H.col(i).setZero();
  }
  return H;
}

}  // namespace

Uncertainty UncertaintyFrom(const Problem& problem, const Vector& x,
                            const std::vector<std::vector<Scores>>& motions) {
  const Eigen::Index n = x.size();
  Uncertainty u;
  u.standard_error.resize(n), u.lower.resize(n), u.upper.resize(n);
  u.correlation = Matrix::Identity(n, n);
  if (n == 0) return u;
  Evidence all(n);
  for (const auto& motion : motions) all.Add(motion);
  u.at_bound = AtBounds(problem, x);
  u.information = InformationInside(all.H, u.at_bound);
  const double freedom = std::max(2.0, all.independent - static_cast<double>(all.determined()));
  const InformationModes modes(all.H);
  const Matrix Hi = modes.Inverse(), along = modes.AlongInvariances();
  const double few = std::max(1.0, all.independent / freedom);
  const Matrix cov = few * Hi * all.modelled * Hi + along, robust = few * Hi * all.S * Hi + along;
  const double t = boost::math::quantile(boost::math::students_t(freedom), 0.975);
  for (Eigen::Index a = 0; a < n; ++a) {
    const FreeParameter& p = problem.parameters()[a];
    const double unknown = (p.upper - p.lower) / std::sqrt(12.0);
    if (!all.Sees(a)) {
      u.standard_error[a] = unknown;
      u.lower[a] = p.lower, u.upper[a] = p.upper;
      continue;
    }
    const double error = std::sqrt(std::max({0.0, cov(a, a), robust(a, a)}));
    u.standard_error[a] = along(a, a) > 0 ? std::min(error, unknown) : error;
    u.lower[a] = std::max(p.lower, x[a] - t * error);
    u.upper[a] = std::min(p.upper, x[a] + t * error);
    for (Eigen::Index b = 0; b < n; ++b) {
      const double size = std::sqrt(cov(a, a) * cov(b, b));
      u.correlation(a, b) = size > 0 ? cov(a, b) / size : (a == b ? 1 : 0);
    }
  }
  return u;
}

Problem AtQuarter(const Problem& problem) {
  Problem fine = problem;
  fine.StepBy(problem.step() / 4);
  return fine;
}

void WidenByStep(const Problem& problem, const Vector& quarter, Uncertainty& u) {
  u.step = kWholeStep * quarter;
  Widen(problem, u.step.cwiseMin(0), u.step.cwiseMax(0), u);
}

namespace {

// What moves of the parameters where the residuals have this column of step added.
Vector MovedBy(Eigen::Index column, const std::vector<Matrix>& J, const std::vector<Matrix>& step,
               const Whitening& whitening, const Uncertainty& u) {
  Vector pull = Vector::Zero(u.information.rows());
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (!J[l].size()) continue;
    pull += whitening.Apply(l, J[l]).transpose() * whitening.Apply(l, Matrix(step[l].col(column)));
  }
  return InformationModes(u.information).Inverse() * pull;
}

}  // namespace

void AllowForStep(const Problem& problem, const std::vector<Matrix>& J,
                  const std::vector<Matrix>& step, const Whitening& whitening, Uncertainty& u) {
  if (u.information.size() == 0) return;
  WidenByStep(problem, MovedBy(0, J, step, whitening, u), u);
}

void AllowForSecondOrder(const Problem& problem, const std::vector<Matrix>& J,
                         const std::vector<Matrix>& step, const Whitening& whitening,
                         Uncertainty& u) {
  constexpr double kOff = 2;  // times what is not of first order
  if (u.information.size() == 0) return;
  const Vector off = kOff * MovedBy(2, J, step, whitening, u).cwiseAbs();
  Widen(problem, -off, off, u);
}

void LeaveOutStep(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                  const std::vector<Matrix>& J, const std::vector<Matrix>& step,
                  const Whitening& whitening, double soft, Uncertainty& u) {
  if (u.step.size() == 0) return;
  std::vector<bool> use;
  std::vector<Vector> fine = r;
  for (std::size_t l = 0; l < J.size(); ++l) {
    use.push_back(J[l].size() > 0);
    if (use[l]) fine[l] += J[l] * u.step - kWholeStep * step[l].col(0);
  }
  if (!(whitening.Stack(fine, use).squaredNorm() < whitening.Stack(r, use).squaredNorm())) return;
  const Vector quarter = u.step / kWholeStep;
  u = UncertaintyOf(problem, x, fine, J, whitening, soft);
  WidenByStep(problem, quarter, u);
}

std::vector<Matrix> Secants(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                            const std::vector<Matrix>& J, const std::vector<Matrix>& step,
                            const Whitening& whitening) {
  std::vector<bool> use;
  for (const Matrix& columns : J) use.push_back(columns.size() > 0);
  const Matrix slopes = whitening.Stack(J, use);
  const double wanted = kWholeStep * whitening.Stack(step, use).col(0).norm();
  std::vector<Matrix> secants = J;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    const bool up = p.upper - x[i] > x[i] - p.lower;
    const double room = up ? p.upper - x[i] : x[i] - p.lower, slope = slopes.col(i).norm();
    double reached = 0;
    for (double d = wanted / slope; reached < wanted && d < room; d *= 2) {
      Vector there = x;
      there[i] += up ? d : -d;
      auto change = problem.Residuals(there, use);
      for (std::size_t l = 0; l < use.size(); ++l) {
        if (use[l]) change[l] = (change[l] - r[l]) / (there[i] - x[i]);
      }
      reached = d * whitening.Stack(change, use).norm();
      if (!std::isfinite(reached)) break;
      for (std::size_t l = 0; l < use.size(); ++l) {
        if (use[l]) secants[l].col(i) = change[l];
      }
    }
  }
  InformationModes(InformationIn(J))
      .TakeOutOf(secants);  // what no slope shows is no secant's either
  return secants;
}

void WidenByStepSize(const Problem& problem, const Vector& x, const std::vector<Matrix>& J,
                     const std::vector<Matrix>& step, const Whitening& whitening, Uncertainty& u) {
  std::vector<Vector> effect(step.size());
  for (std::size_t l = 0; l < step.size(); ++l) {
    if (step[l].size()) effect[l] = kWholeStep * step[l].col(0);
  }
  const Uncertainty by = UncertaintyOf(problem, x, effect, J, whitening);
  Widen(problem, by.lower - x, by.upper - x, u);
}

}  // namespace continuum
