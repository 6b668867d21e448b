#include "identification/diagnosis/candidate_fitter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <boost/math/distributions/chi_squared.hpp>

#include "error.h"
#include "identification/candidates/random_forces.h"
#include "identification/fit/intervals.h"
#include "identification/inverse_dynamics/equation_error_fit.h"
#include "sim/simulation/simulate.h"

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

// A probe that does this many times what is left shows its own curvature; one that does less by as
// much may be a direction that free parameters follow for as long as it is short.
constexpr double kFar = 5;
constexpr double kLeast = 20;  // of twice the log-likelihood: what is worth a look

// The share at which a parameter comes to its bound.
double MostShare(const Hypothesis& h, const std::vector<double>& start, std::size_t i) {
  const Parameter& p = h.extra[i];
  if (std::isinf(h.null[i])) return start[i] / p.lower;
  const double step = start[i] - h.null[i];
  return ((step > 0 ? p.upper : p.lower) - h.null[i]) / step;
}

// Tries the amplitudes of a candidate one by one, beside the fit without it.
struct Prober {
  const Hypothesis& h;
  const Problem& problem;
  const Fitted& null;
  const Remainder& left;
  std::vector<std::size_t> amplitudes = h.Amplitudes();
  bool calibrated;  // whether residuals are in units of the noise
  double wanted = calibrated ? std::sqrt(std::max(kLeast, left.cost() - left.freedom()))
                             : std::sqrt(0.5 * left.cost());
  /// Residuals by the values of extra: directions on top of others begin where those ended.
  mutable std::map<std::vector<double>, std::vector<Vector>> simulated = {};

  Probe AtStart(std::size_t start) const {
    Probe probe;
    probe.start = start, probe.share.assign(amplitudes.size(), 1);
    probe.columns.resize(left.residual().size(), static_cast<Eigen::Index>(amplitudes.size()));
    for (std::size_t a = 0; a < amplitudes.size(); ++a) {
      probe.columns.col(static_cast<Eigen::Index>(a)) = Direction(start, a, 1);
      const std::size_t i = amplitudes[a];
      const bool one_way = h.extra[i].lower >= h.null[i] || h.extra[i].upper <= h.null[i];
      probe.sign.push_back(one_way ? 1 : 0);
    }
    return probe;
  }

  // The shares at which amplitudes that do far too much do what is wanted.
  std::vector<double> Less(const Probe& whole) const {
    std::vector<double> share = whole.share;
    for (std::size_t a = 0; a < share.size(); ++a) {
      const double reach = Reach(whole, a);
      if (reach > kFar * wanted) share[a] = wanted / reach;
    }
    return share;
  }
  // And those that do far too little.
  std::vector<double> More(const Probe& whole) const {
    std::vector<double> share = whole.share;
    for (std::size_t a = 0; a < share.size(); ++a) {
      const double reach = Reach(whole, a);
      if (reach > 0 && kFar * reach < wanted)
        share[a] = std::min(wanted / reach, MostShare(h, h.starts[whole.start], amplitudes[a]));
    }
    return share;
  }

  // An amplitude that does nothing alone, as the excess of a friction that is not there, on top of
  // the others.
  Probe OnTop(Probe probe) const {
    probe.on_top.assign(amplitudes.size(), false);
    if (amplitudes.size() < 2) return probe;
    for (std::size_t a = 0; a < amplitudes.size(); ++a) {
      if (Reach(probe, a) > 0) continue;
      std::vector<double> others = probe.share;
      others[a] = 0;
      try {
        probe.columns.col(static_cast<Eigen::Index>(a)) = Between(
            Residuals(probe.start, others), Residuals(probe.start, probe.share), probe.share[a]);
        probe.on_top[a] = Reach(probe, a) > 0;
      } catch (const Error&) {
        continue;  // all of them are too much for the simulation
      }
    }
    return probe;
  }

  // The same probe at other shares; simulates only what is other.
  Probe At(const Probe& whole, const std::vector<double>& share) const {
    Probe probe = whole;
    for (std::size_t a = 0; a < share.size(); ++a) {
      if (share[a] == whole.share[a]) continue;
      probe.columns.col(static_cast<Eigen::Index>(a)) = Direction(whole.start, a, share[a]);
      probe.whole = whole.columns;
    }
    probe.share = share;
    return probe;
  }

 private:
  static double Reach(const Probe& probe, std::size_t a) {
    return probe.columns.col(static_cast<Eigen::Index>(a)).norm();
  }

  // What one amplitude does to what is left, per share of its start.
  Vector Direction(std::size_t start, std::size_t one, double share) const {
    std::vector<double> shares(amplitudes.size(), 0);
    shares[one] = share;
    return Between(null.residuals, Residuals(start, shares), share);
  }

  const std::vector<Vector>& Residuals(std::size_t start, const std::vector<double>& share) const {
    std::vector<double> own = h.starts[start];
    for (std::size_t a = 0; a < amplitudes.size(); ++a)
      own[amplitudes[a]] = h.AtShare(amplitudes[a], own[amplitudes[a]], share[a]);
    const auto known = simulated.find(own);
    return known != simulated.end() ? known->second : simulated[own] = Simulate(own);
  }
  std::vector<Vector> Simulate(const std::vector<double>& own) const {
    const auto train = TrainLogs(problem.experiment());
    auto r = problem.Residuals(Append(null.fit.x, own), train);
    for (std::size_t l = 0; l < train.size(); ++l) {
      if (train[l] && !r[l].allFinite()) throw Error::Job("the simulation diverges at its start");
    }
    return r;
  }
  Vector Between(const std::vector<Vector>& from, const std::vector<Vector>& to,
                 double share) const {
    const auto train = TrainLogs(problem.experiment());
    std::vector<Matrix> column(train.size());
    for (std::size_t l = 0; l < train.size(); ++l) {
      if (train[l]) column[l] = (to[l] - from[l]) / share;
    }
    return left.Project(column);
  }
};

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

double Beyond(double error, double part) {
  return std::sqrt(std::max(0.0, error * error - part * part));
}

FitOptions CandidateFitter::Options() const {
  FitOptions options{iterations, 1e-4};  // first order does the rest
  options.whitening = &whitening;
  options.idle = true;
  return options;
}

// For fits that begin next to their end.
FitOptions CandidateFitter::FewSteps() const {
  FitOptions options = Options();
  options.iterations = 5;
  return options;
}

Fitted CandidateFitter::Fit(const Problem& problem, const Vector& start, double rival,
                            bool idle) const {
  const auto train = TrainLogs(*experiment);
  auto validate = train;
  validate.flip();
  Fitted f;
  FitOptions options = Options();
  options.hopeless = 1.1 * rival + 50;
  options.idle = idle;
  f.fit = FitParameters(problem, start, train, options);
  f.fit.x = FitStarts(problem, f.fit.x, validate);
  f.residuals = problem.Residuals(f.fit.x, problem.AllLogs());
  RequireFinite(problem, f.fit.x, f.residuals, problem.AllLogs(), "with the fitted parameters");
  f.error = {problem.PooledRms(f.residuals, train), problem.PooledRms(f.residuals, validate)};
  f.cost = 2 * f.fit.cost;
  return f;
}

Fitted CandidateFitter::FitNull(const Problem& problem) const {
  Fitted f = Fit(problem, problem.Start(), std::numeric_limits<double>::infinity(), false);
  FitOptions again = Options();
  again.iterations += f.fit.iterations;
  const auto found = FitByEquations(problem, f.fit, TrainLogs(*experiment), again);
  return found.cost < f.fit.cost ? Fit(problem, found.x) : f;
}

void CandidateFitter::Complete(const Problem& problem, Fitted& f) const {
  const auto train = TrainLogs(*experiment);
  f.jacobian = problem.Jacobian(f.fit.x, f.residuals, train);
  f.uncertainty = UncertaintyOf(problem, f.fit.x, f.residuals, f.jacobian, whitening);
  f.step = problem.StepEffects(f.fit.x, f.residuals, train);
  AllowForStep(problem, f.jacobian, f.step, whitening, f.uncertainty);
  f.complete = true;
  if (!whitening.active()) return;
  const Remainder left = LeftBy(f);
  f.cost = left.cost();
  f.freedom = left.freedom();
}

void CandidateFitter::FitFinely(const Problem& problem, Fitted& f) const {
  ReachByFineFit(problem, f.fit.x, f.residuals, f.jacobian, f.step, FewSteps(), f.uncertainty);
}

Fitted CandidateFitter::GoOn(const Problem& problem, const Fitted& before) const {
  const auto train = TrainLogs(*experiment);
  Fitted f = before;
  f.fit = FitParameters(problem, before.fit.x, train, FewSteps());
  f.residuals = problem.Residuals(f.fit.x, problem.AllLogs());
  f.error.train = problem.PooledRms(f.residuals, train);
  f.cost = 2 * f.fit.cost;
  Complete(problem, f);
  return f;
}

Fitted CandidateFitter::FitAll(const Problem& problem, const Vector& start) const {
  Fitted f = Fit(problem, start);
  Complete(problem, f);
  return f;
}

void CandidateFitter::AddFolds(const Problem& problem, const std::vector<Fold>& folds,
                               Fitted& fitted) const {
  auto validate = TrainLogs(*experiment);
  validate.flip();
  auto J = problem.Jacobian(fitted.fit.x, fitted.residuals, validate);
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (!validate[l]) J[l] = fitted.jacobian[l];
  }
  fitted.jacobian = std::move(J);
  fitted.folds = CrossValidate(problem, fitted.fit.x, fitted.residuals, fitted.jacobian, folds);
}

Remainder CandidateFitter::LeftBy(const Fitted& fitted) const {
  return Remainder(whitening, TrainLogs(*experiment), fitted.residuals, fitted.jacobian,
                   fitted.uncertainty.at_bound, fitted.step);
}

std::vector<Probe> CandidateFitter::Probes(const Hypothesis& h, const Problem& problem,
                                           const Fitted& null, const Remainder& left) const {
  const Prober prober{h, problem, null, left, h.Amplitudes(), whitening.active()};
  std::vector<Probe> probes;
  for (std::size_t start = 0; start < h.starts.size(); ++start) {
    Probe whole = prober.AtStart(start);
    const std::vector<double> less = prober.Less(whole), more = prober.More(whole);
    probes.push_back(prober.OnTop(prober.At(whole, less)));
    if (more == whole.share) continue;
    try {
      probes.push_back(prober.OnTop(prober.At(whole, more)));
    } catch (const Error&) {
      continue;  // too much for the simulation
    }
  }
  return probes;
}

Vector CandidateFitter::StartFrom(const Hypothesis& h, const Fitted& null, const Probe& probe,
                                  const Explained& explained, double excess) const {
  const auto amplitudes = h.Amplitudes();
  const std::vector<double>& start = h.starts[probe.start];
  std::vector<double> own = start;
  for (std::size_t a = 0; a < amplitudes.size(); ++a) {
    const auto k = static_cast<Eigen::Index>(a);
    const bool idle = !(probe.columns.col(k).squaredNorm() > 0);
    // Off the null, where a bound or a kink hides the slope.
    const double least = 0.05 * probe.share[a];
    const double wanted = explained.coefficients[k];
    const double share = idle                       ? 0
                         : probe.on_top[a]          ? excess * probe.share[a]
                         : std::abs(wanted) > least ? wanted
                                                    : least;
    own[amplitudes[a]] = h.AtShare(amplitudes[a], start[amplitudes[a]], share);
  }
  for (std::size_t i = 0; i < own.size(); ++i)
    own[i] = std::clamp(own[i], h.extra[i].lower, h.extra[i].upper);
  return Append(null.fit.x, own);
}

std::vector<Vector> CandidateFitter::StepColumn(const Fitted& fitted) const {
  const auto train = TrainLogs(*experiment);
  std::vector<Vector> column(train.size());
  for (std::size_t l = 0; l < column.size(); ++l) {
    if (train[l]) column[l] = fitted.step[l].col(0);
  }
  return column;
}

double CandidateFitter::StepEffect(const Problem& problem, const Fitted& fitted) const {
  return problem.PooledRms(StepColumn(fitted), TrainLogs(*experiment));
}

bool CandidateFitter::WithinStep(const Fitted& fitted) const {
  constexpr double kSeen = 15;  // twice the log-likelihood: less could not be told from noise
  constexpr double kMore = 1.25 * 1.25;  // first order is that rough
  const double step = whitening.Stack(StepColumn(fitted), TrainLogs(*experiment)).squaredNorm();
  return step > kSeen && 2 * fitted.fit.cost - fitted.freedom <= kMore * step;
}

LackOfFit CandidateFitter::LackIn(const Problem& without, const std::vector<Parameter>& extra,
                                  const Fitted& fitted, const Sizes& sizes, double inflation,
                                  std::uint64_t seed) const {
  const auto train = TrainLogs(*experiment);
  const ForceTerms terms = RandomForce(12, true, sizes, seed);
  Problem problem(*experiment, without.system(), extra, terms);
  problem.StepBy(without.step());
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
