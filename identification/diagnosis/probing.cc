#include "identification/diagnosis/probing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/QR>

#include "error.h"
#include "identification/diagnosis/search_rules.h"
#include "sim/model/elastic_gear.h"
#include "sim/model/native_effect.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// The share at which a parameter comes to its bound.
double MostShare(const Hypothesis& h, const std::vector<double>& start, std::size_t i) {
  const Parameter& p = h.extra[i];
  if (std::isinf(h.null[i])) return start[i] / p.lower;
  const double step = start[i] - h.null[i];
  return ((step > 0 ? p.upper : p.lower) - h.null[i]) / step;
}

// How far rows are apart, in the median [s]; 0 where they know no time.
double RowInterval(const Problem& problem) {
  std::vector<double> intervals;
  for (const Log& log : problem.experiment().logs) {
    for (std::size_t row = 1; row < log.rows(); ++row)
      intervals.push_back(log.time[row] - log.time[row - 1]);
  }
  if (intervals.empty() || problem.experiment().quasi_static) return 0;
  const auto middle = intervals.begin() + std::ssize(intervals) / 2;
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

// At least so long, and no longer than the rows are apart [s].
double CoarseStep(double interval, double least) {
  return interval / std::ceil(interval / least - 1e-6);
}

// Whether what a coarse step changes is little beside the residuals r.
bool IsAlike(const Problem& problem, const std::vector<Vector>& r,
             const std::vector<Vector>& coarse) {
  constexpr double kLittle = 0.1;
  const std::vector<bool> train = problem.TrainLogs();
  std::vector<Vector> change(r.size());
  for (std::size_t l = 0; l < r.size(); ++l)
    if (train[l]) change[l] = coarse[l] - r[l];
  return problem.PooledRms(change, train) <= kLittle * problem.PooledRms(r, train);
}

// Tries the amplitudes of a candidate one by one, beside the fit without it.
class Prober {
 public:
  Prober(const Hypothesis& h, const Problem& problem, const ProbeBase& base,
         const ProjectedResidual& residual, bool calibrated, const Criteria& criteria)
      : h_(h),
        problem_(problem),
        base_(base),
        residual_(residual),
        criteria_(criteria),
        amplitudes_(h.Amplitudes()),
        target_(ProbeTarget(residual.cost(), residual.freedom(), calibrated, criteria)) {}

  Probe AtStart(std::size_t start) const {
    Probe probe;
    probe.start = start, probe.share.assign(amplitudes_.size(), 1);
    probe.columns.resize(residual_.vector().size(), static_cast<Eigen::Index>(amplitudes_.size()));
    for (std::size_t a = 0; a < amplitudes_.size(); ++a) {
      probe.columns.col(static_cast<Eigen::Index>(a)) = Direction(start, a, 1);
      const std::size_t i = amplitudes_[a];
      probe.sign.push_back(h_.OneSign(i) ? 1 : 0);
    }
    return probe;
  }

  // The shares at which amplitudes that do far too much do what is wanted: such a probe shows its
  // own curvature.
  std::vector<double> Less(const Probe& whole) const {
    std::vector<double> share;
    for (std::size_t a = 0; a < amplitudes_.size(); ++a)
      share.push_back(SmallerShare(Norm(whole, a), target_, criteria_));
    return share;
  }
  // And those that do far too little: a direction that free parameters may follow for as long as it
  // is short.
  std::vector<double> More(const Probe& whole) const {
    std::vector<double> share;
    for (std::size_t a = 0; a < amplitudes_.size(); ++a) {
      const double most = MostShare(h_, h_.starts[whole.start], amplitudes_[a]);
      share.push_back(LargerShare(Norm(whole, a), target_, most, criteria_));
    }
    return share;
  }

  // An amplitude that does nothing alone, as the excess of a friction that is not there, on top of
  // the others.
  Probe OnTop(Probe probe) const {
    probe.on_top.assign(amplitudes_.size(), false);
    if (amplitudes_.size() < 2) return probe;
    for (std::size_t a = 0; a < amplitudes_.size(); ++a) {
      if (Norm(probe, a) > 0) continue;
      std::vector<double> others = probe.share;
      others[a] = 0;
      try {
        probe.columns.col(static_cast<Eigen::Index>(a)) = Difference(
            Residuals(probe.start, others), Residuals(probe.start, probe.share), probe.share[a]);
        probe.on_top[a] = Norm(probe, a) > 0;
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
  static double Norm(const Probe& probe, std::size_t a) {
    return probe.columns.col(static_cast<Eigen::Index>(a)).norm();
  }

  // What one amplitude does to the residual, per share of its start.
  Vector Direction(std::size_t start, std::size_t one, double share) const {
    std::vector<double> shares(amplitudes_.size(), 0);
    shares[one] = share;
    return Difference(base_.residuals, Residuals(start, shares), share);
  }

  const std::vector<Vector>& Residuals(std::size_t start, const std::vector<double>& share) const {
    std::vector<double> own = h_.starts[start];
    for (std::size_t a = 0; a < amplitudes_.size(); ++a)
      own[amplitudes_[a]] = h_.AtShare(amplitudes_[a], own[amplitudes_[a]], share[a]);
    const auto known = simulated_.find(own);
    return known != simulated_.end() ? known->second : simulated_[own] = Simulate(own);
  }
  std::vector<Vector> Simulate(const std::vector<double>& own) const {
    const auto& use = residual_.use();
    auto r = problem_.Residuals(Append(base_.x, own), use);
    for (std::size_t l = 0; l < use.size(); ++l) {
      if (use[l] && !r[l].allFinite()) throw Error::Job("the simulation diverges at its start");
    }
    return r;
  }
  Vector Difference(const std::vector<Vector>& from, const std::vector<Vector>& to,
                    double share) const {
    const auto& use = residual_.use();
    std::vector<Matrix> column(use.size());
    for (std::size_t l = 0; l < use.size(); ++l) {
      if (use[l]) column[l] = (to[l] - from[l]) / share;
    }
    return residual_.Project(column);
  }

  const Hypothesis& h_;
  const Problem& problem_;
  const ProbeBase& base_;
  const ProjectedResidual& residual_;
  const Criteria& criteria_;
  std::vector<std::size_t> amplitudes_;
  double target_;  // norm of a probe that does what is to be explained
  /// Residuals by the values of extra: directions on top of others begin where those ended.
  mutable std::map<std::vector<double>, std::vector<Vector>> simulated_ = {};
};

}  // namespace

Vector Append(const Vector& known, const std::vector<double>& own) {
  Vector x(known.size() + static_cast<Eigen::Index>(own.size()));
  x.head(known.size()) = known;
  std::copy(own.begin(), own.end(), x.data() + known.size());
  return x;
}

bool NeedsOwnStep(const Problem& problem) {
  const auto& parameters = problem.parameters();
  return GearMotors(problem.system().model()) > 0 ||
         std::any_of(parameters.begin(), parameters.end(), [](const FreeParameter& p) {
           return p.change.attribute == "delay" ||
                  (IsNativeEffect(p.change) && NativeEffectNeedsOwnStep(p.change.attribute));
         });
}

std::optional<std::vector<Vector>> StepCoarsely(Problem& problem, const Vector& x,
                                                const std::vector<Vector>& r) {
  constexpr std::array kSteps{10.0, 5.0, 2.5};
  const double own = problem.step(), interval = RowInterval(problem);
  if (!(interval > own) || NeedsOwnStep(problem)) return {};
  const double least = CoarseStep(interval, kSteps.back() * own);  // taken whatever it changes
  double tried = own;
  for (const double steps : kSteps) {
    const double step = CoarseStep(interval, steps * own);
    if (!(step > own) || step == tried) continue;
    problem.StepBy(tried = step);
    auto residuals = problem.Residuals(x, problem.TrainLogs());
    const bool finite = std::all_of(residuals.begin(), residuals.end(),
                                    [](const Vector& part) { return part.allFinite(); });
    if (finite && (step <= least || IsAlike(problem, r, residuals))) return residuals;
    problem.StepBy(own);
  }
  return {};
}

std::vector<Probe> ProbesOf(const Hypothesis& h, const Problem& problem, const ProbeBase& base,
                            const ProjectedResidual& residual, bool calibrated,
                            const std::vector<std::size_t>& starts, const Criteria& criteria) {
  const Prober prober(h, problem, base, residual, calibrated, criteria);
  std::vector<Probe> probes;
  for (const std::size_t start : starts) {
    const Probe whole = prober.AtStart(start);
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

double PlainShare(const Hypothesis& h, const Problem& problem, const ProbeBase& base,
                  const std::vector<bool>& use) {
  const Whitening plain;
  const Vector r = plain.Stack(base.residuals, use);
  const auto amplitudes = h.Amplitudes();
  Matrix columns(r.size(), std::ssize(amplitudes));
  for (std::size_t a = 0; a < amplitudes.size(); ++a) {
    std::vector<double> own = h.starts.front();
    for (const std::size_t other : amplitudes)
      own[other] = h.AtShare(other, own[other], other == amplitudes[a] ? 1 : 0);
    columns.col(static_cast<Eigen::Index>(a)) =
        plain.Stack(problem.Residuals(Append(base.x, own), use), use) - r;
  }
  return 1 - (r - columns * columns.colPivHouseholderQr().solve(r)).squaredNorm() / r.squaredNorm();
}

Vector StartFrom(const Hypothesis& h, const Fitted& null, const Probe& probe,
                 const Explained& explained, double excess, const Criteria& criteria) {
  const auto amplitudes = h.Amplitudes();
  const std::vector<double>& start = h.starts[probe.start];
  std::vector<double> own = start;
  for (std::size_t a = 0; a < amplitudes.size(); ++a) {
    const auto k = static_cast<Eigen::Index>(a);
    double share = 0;  // of one that does nothing
    if (probe.columns.col(k).squaredNorm() > 0) {
      share = probe.on_top[a] ? excess * probe.share[a]
                              : StartShare(explained.coefficients[k], probe.share[a], criteria);
    }
    own[amplitudes[a]] = h.AtShare(amplitudes[a], start[amplitudes[a]], share);
  }
  for (std::size_t i = 0; i < own.size(); ++i)
    own[i] = std::clamp(own[i], h.extra[i].lower, h.extra[i].upper);
  return Append(null.fit.x, own);
}

}  // namespace continuum
