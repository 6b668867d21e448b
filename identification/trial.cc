#include "identification/trial.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/chi_squared.hpp>

#include "error.h"
#include "identification/placebo.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// p-value of what unsigned columns explain of white noise of size 1.
double ChiSquared(const Matrix& columns, const Vector& z, double inflation) {
  Probe probe{columns, std::vector<double>(columns.cols(), 0)};
  const double rank = static_cast<double>(
      std::min<Eigen::Index>(columns.cols(), (columns.colwise().norm().array() > 1e-9).count()));
  if (rank < 1) return 1;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(rank),
                                                  ExplainedBy(probe, z).amount / inflation));
}

// The value of a parameter that leaves the effect out: its null, or its bound toward one at
// infinity.
double Absent(const Hypothesis& h, std::size_t i) {
  return std::isinf(h.null[i]) ? h.extra[i].upper : h.null[i];
}

// What a coefficient of 1 stands for; a parameter that is absent at infinity has its start as 1.
double Size(const Hypothesis& h, const std::vector<double>& start, std::size_t i) {
  return std::isinf(h.null[i]) ? 1 : start[i] - h.null[i];
}

// Of each counted channel: a constant, and a shift in time.
Matrix ChannelColumns(const Problem& problem, const Trace& trace, const Log& log) {
  const auto rows = static_cast<Eigen::Index>(log.rows());
  const auto channels = static_cast<Eigen::Index>(problem.channels().size());
  Matrix columns = Matrix::Zero(rows * channels, 2 * channels);
  for (Eigen::Index c = 0; c < channels; ++c) {
    const auto& y = trace.channel[problem.channels()[c]];
    for (Eigen::Index k = 0; k < rows; ++k) {
      columns(c * rows + k, 2 * c) = 1;
      if (k == 0 || k + 1 == rows) continue;
      columns(c * rows + k, 2 * c + 1) =
          (y[k + 1] - y[k - 1]) / (log.time[k + 1] - log.time[k - 1]) / problem.scale(c);
    }
  }
  return columns;
}

}  // namespace

Vector Append(const Vector& known, const std::vector<double>& own) {
  Vector x(known.size() + static_cast<Eigen::Index>(own.size()));
  x.head(known.size()) = known;
  std::copy(own.begin(), own.end(), x.data() + known.size());
  return x;
}

Fitted Trials::Fit(const Problem& problem, const Vector& start, double rival) const {
  const auto train = TrainLogs(*experiment);
  auto validate = train;
  validate.flip();
  Fitted f;
  FitOptions options{iterations, 1e-4};  // first order does the rest
  options.whitening = &whitening;
  options.idle = true;
  options.hopeless = 1.1 * rival + 50;
  f.fit = FitParameters(problem, start, train, options);
  f.residuals = problem.Residuals(f.fit.x, problem.AllLogs());
  for (std::size_t l = 0; l < train.size(); ++l) {
    if (f.residuals[l].allFinite()) continue;
    throw Error::Job("the simulation of " + experiment->logs[l].label +
                     " diverges with the fitted parameters");
  }
  f.error = {problem.PooledRms(f.residuals, train), problem.PooledRms(f.residuals, validate)};
  f.cost = 2 * f.fit.cost;
  return f;
}

void Trials::Complete(const Problem& problem, Fitted& f) const {
  const auto train = TrainLogs(*experiment);
  f.jacobian = problem.Jacobian(f.fit.x, f.residuals, train);
  f.uncertainty = UncertaintyOf(problem, f.fit.x, f.residuals, f.jacobian, whitening);
  f.step = problem.StepEffects(f.fit.x, f.residuals, train);
  f.complete = true;
  if (!whitening.active()) return;
  const Remainder left = LeftBy(f);
  f.cost = left.cost();
  f.freedom = left.freedom();
}

Fitted Trials::FitAll(const Problem& problem, const Vector& start) const {
  Fitted f = Fit(problem, start);
  Complete(problem, f);
  return f;
}

void Trials::AddFolds(const Problem& problem, const std::vector<Fold>& folds,
                      Fitted& fitted) const {
  auto validate = TrainLogs(*experiment);
  validate.flip();
  auto J = problem.Jacobian(fitted.fit.x, fitted.residuals, validate);
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (!validate[l]) J[l] = fitted.jacobian[l];
  }
  fitted.jacobian = std::move(J);
  fitted.folds = CrossValidate(problem, fitted.fit.x, fitted.jacobian, folds);
}

Remainder Trials::LeftBy(const Fitted& fitted) const {
  return Remainder(whitening, TrainLogs(*experiment), fitted.residuals, fitted.jacobian,
                   fitted.uncertainty.at_bound, fitted.step);
}

std::vector<Probe> Trials::Probes(const Hypothesis& h, const Problem& problem, const Fitted& null,
                                  const Remainder& left) const {
  const auto train = TrainLogs(*experiment);
  const auto known = null.fit.x.size();
  const auto amplitudes = h.Amplitudes();
  std::vector<Probe> probes;
  for (const auto& start : h.starts) {
    std::vector<Matrix> columns(train.size());
    for (std::size_t l = 0; l < train.size(); ++l) {
      columns[l] =
          Matrix::Zero(null.residuals[l].size(), static_cast<Eigen::Index>(amplitudes.size()));
    }
    Probe probe;
    for (std::size_t a = 0; a < amplitudes.size(); ++a) {
      Vector x = Append(null.fit.x, start);
      for (const std::size_t i : amplitudes) x[known + static_cast<Eigen::Index>(i)] = Absent(h, i);
      const std::size_t i = amplitudes[a];
      x[known + static_cast<Eigen::Index>(i)] = start[i];
      const auto r = problem.Residuals(x, train);
      for (std::size_t l = 0; l < train.size(); ++l) {
        if (!train[l]) continue;
        if (!r[l].allFinite()) throw Error::Job("the simulation diverges at its start");
        columns[l].col(static_cast<Eigen::Index>(a)) =
            (r[l] - null.residuals[l]) / Size(h, start, i);
      }
      const bool above = h.extra[i].lower >= h.null[i] || std::isinf(h.null[i]);
      const bool below = h.extra[i].upper <= h.null[i] && !std::isinf(h.null[i]);
      probe.sign.push_back(above ? 1 : below ? -1 : 0);
    }
    probe.columns = left.Project(columns);
    probes.push_back(std::move(probe));
  }
  return probes;
}

Vector Trials::StartFrom(const Hypothesis& h, const Fitted& null, std::size_t start,
                         const Probe& probe, const Explained& explained) const {
  const auto known = null.fit.x.size();
  const auto amplitudes = h.Amplitudes();
  Vector x = Append(null.fit.x, h.starts[start]);
  for (std::size_t a = 0; a < amplitudes.size(); ++a) {
    const std::size_t i = amplitudes[a];
    if (std::isinf(h.null[i])) continue;  // its start is as good as any
    if (!(probe.columns.col(static_cast<Eigen::Index>(a)).squaredNorm() > 0)) {  // idle
      x[known + static_cast<Eigen::Index>(i)] = h.null[i];
      continue;
    }
    const double size = Size(h, h.starts[start], i);
    const double wanted = explained.coefficients[static_cast<Eigen::Index>(a)];
    // Off the null, where a bound or a kink hides the slope.
    const double least = 0.05 * std::abs(size);
    const double moved = std::abs(wanted) > least ? wanted : std::copysign(least, size);
    x[known + static_cast<Eigen::Index>(i)] = h.null[i] + moved;
  }
  for (std::size_t i = 0; i < h.extra.size(); ++i) {
    double& value = x[known + static_cast<Eigen::Index>(i)];
    value = std::clamp(value, h.extra[i].lower, h.extra[i].upper);
  }
  return x;
}

double Trials::StepEffect(const Problem& problem, const Fitted& fitted) const {
  const auto train = TrainLogs(*experiment);
  std::vector<Vector> column(train.size());
  for (std::size_t l = 0; l < column.size(); ++l) {
    if (train[l]) column[l] = fitted.step[l].col(0);
  }
  return problem.PooledRms(column, train);
}

bool Trials::WithinStep(const Problem& problem, const Fitted& fitted, const Noise& noise) const {
  const double left = fitted.error.train;
  const double excess = std::sqrt(std::max(0.0, left * left - noise.rms * noise.rms));
  return excess <= 1.25 * StepEffect(problem, fitted);
}

LackOfFit Trials::LackIn(const System& system, const std::vector<Parameter>& extra,
                         const Fitted& fitted, const Sizes& sizes, double inflation,
                         std::uint64_t seed) const {
  const auto train = TrainLogs(*experiment);
  const ForceTerms terms = RandomForce(12, true, sizes, seed);
  const Problem problem(*experiment, system, extra, terms);
  const Vector x = Append(fitted.fit.x, std::vector<double>(terms.count, 0.0));
  const Remainder left = LeftBy(fitted);
  LackOfFit lack;
  auto J = problem.Jacobian(x, fitted.residuals, train, fitted.jacobian);
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (train[l]) J[l] = Matrix(J[l].rightCols(static_cast<Eigen::Index>(terms.count)));
  }
  lack.force = ChiSquared(left.Project(J), left.residual(), inflation);
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (train[l]) J[l] = ChannelColumns(problem, problem.Predict(x, l), experiment->logs[l]);
  }
  lack.channel = ChiSquared(left.Project(J), left.residual(), inflation);
  return lack;
}

}  // namespace continuum
