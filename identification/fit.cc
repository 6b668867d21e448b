#include "identification/fit.h"

#include <chrono>
#include <cmath>
#include <limits>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <Eigen/Dense>
#include <boost/math/distributions/students_t.hpp>

#include "error.h"
#include "identification/parallel.h"
#include "sim/stop.h"

namespace continuum {
namespace {

using Vector = Problem::Vector;
using Matrix = Problem::Matrix;

// All residuals as one Ceres cost in the scaled parameters y = x/scale.
class Cost : public ceres::CostFunction {
 public:
  Cost(const Problem& problem, const std::vector<bool>& use, const FitOptions& options,
       const Whitening& whitening, Eigen::Index residuals)
      : problem_(problem), use_(use), options_(options), whitening_(whitening) {
    seam_rows_ = Seams({}, 0).rows();
    set_num_residuals(static_cast<int>(residuals + seam_rows_));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.parameters().size()));
  }

  // What is known at one x already.
  void Know(const Vector& x, std::vector<Vector> r, std::vector<Matrix> J) {
    x_ = x, r_ = std::move(r), J_ = std::move(J);
    derived_ = {x_, r_};
  }

  bool Evaluate(const double* const* y, double* residuals, double** jacobians) const override {
    const auto& parameters = problem_.parameters();
    Vector x(static_cast<Eigen::Index>(parameters.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = y[0][i] * parameters[i].scale;
    x = problem_.Clamp(x);
    if (x_.size() != x.size() || x != x_) r_ = problem_.Residuals(x, use_), x_ = x;
    const Vector all = whitening_.Stack(r_, use_);
    if (!all.allFinite()) return false;
    for (Eigen::Index k = 0; k < all.size(); ++k) residuals[k] = Soften(all[k]).first;
    const std::vector<Matrix> r(r_.begin(), r_.end());
    Eigen::Map<Vector>(residuals + all.size(), seam_rows_) = Seams(r, 1);
    if (!jacobians || !jacobians[0]) return true;
    Derive();
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> out(
        jacobians[0], num_residuals(), x.size());
    out.topRows(all.size()) = whitening_.Stack(J_, use_);
    for (Eigen::Index k = 0; k < all.size(); ++k) out.row(k) *= Soften(all[k]).second;
    out.bottomRows(seam_rows_) = Seams(J_, x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) out.col(i) *= parameters[i].scale;
    return out.allFinite();
  }

 private:
  // w with ½ w² = ρ(r), and dw/dr.
  std::pair<double, double> Soften(double r) const {
    const double soft = options_.soft;
    if (soft == 0) return {r, 1};
    const double root = std::sqrt(1 + r * r / (soft * soft));
    const double w = std::copysign(soft * std::sqrt(2 * (root - 1)), r);
    return {w, std::abs(w) > 1e-12 * soft ? r / (w * root) : 1};
  }

  // By how much residuals, or columns of their Jacobian, differ at the seams; all of one channel
  // follow each other in a log.
  Matrix Seams(const std::vector<Matrix>& of, Eigen::Index columns) const {
    const auto channels = static_cast<Eigen::Index>(problem_.channels().size());
    Eigen::Index rows = 0;
    for (const Seam& seam : options_.seams) rows += channels * seam.rows;
    Matrix all(rows, columns);
    if (columns == 0) return all;
    rows = 0;
    for (const Seam& seam : options_.seams) {
      const Matrix &before = of[seam.before], &after = of[seam.after];
      const Eigen::Index long_before = before.rows() / channels,
                         long_after = after.rows() / channels;
      for (Eigen::Index c = 0; c < channels; ++c) {
        all.middleRows(rows, seam.rows) =
            options_.seam_weight *
            (before.middleRows((c + 1) * long_before - seam.rows, seam.rows) -
             after.middleRows(c * long_after, seam.rows));
        rows += seam.rows;
      }
    }
    return all;
  }

  // J_ at x_: updated (Broyden) along the step from where it was known, if the residuals changed
  // almost as it said; as it was, if they hardly changed; else anew. By differences it is always
  // made anew: they see stick and slip.
  void Derive() const {
    if (!J_.empty() && derived_.x == x_) return;
    if (J_.empty() || problem_.path() == Path::kStepped || !Updated())
      J_ = problem_.Jacobian(x_, r_, use_, {}, true);
    derived_ = {x_, r_};
  }
  bool Updated() const {
    constexpr double kBent = 0.15, kNothing = 1e-3;  // of the change, of the residuals
    Vector step = x_ - derived_.x, scaled = step;
    for (Eigen::Index i = 0; i < step.size(); ++i) {
      scaled[i] /= std::pow(problem_.parameters()[i].scale, 2);
    }
    double bent = 0, change = 0, all = 0;
    std::vector<Vector> lack(J_.size());
    for (std::size_t l = 0; l < J_.size(); ++l) {
      if (!use_[l]) continue;
      const Vector difference = r_[l] - derived_.r[l];
      lack[l] = difference - J_[l] * step;
      bent += lack[l].squaredNorm(), change += difference.squaredNorm();
      all += r_[l].squaredNorm();
    }
    // A short step changes less than the simulation's own errors: nothing to learn from it.
    if (bent > kBent * kBent * change) return bent < kNothing * kNothing * all;
    for (std::size_t l = 0; l < J_.size(); ++l) {
      if (use_[l]) J_[l] += lack[l] * scaled.transpose() / scaled.dot(step);
    }
    return true;
  }

  const Problem& problem_;
  const std::vector<bool>& use_;
  const FitOptions& options_;
  const Whitening& whitening_;
  Eigen::Index seam_rows_;
  mutable Vector x_;
  mutable std::vector<Vector> r_;  // at x_
  mutable std::vector<Matrix> J_;
  struct Derived {
    Vector x;
    std::vector<Vector> r;
  };
  mutable Derived derived_;  // where J_ is known
};

class Watch : public ceres::IterationCallback {
 public:
  Watch(const Problem& problem, const FitOptions& options, Fit& fit)
      : problem_(problem), options_(options), fit_(fit) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    if (s.step_is_successful || s.iteration == 0) fit_.trace.push_back(s.cost);
    if (options_.progress) {
      options_.progress(fmt::format("iteration {:2}  cost {:.6g}  {} simulations", s.iteration,
                                    s.cost, problem_.evaluations()));
    }
    if (s.step_is_successful && s.iteration >= 2)
      lost_ = s.cost > options_.hopeless + kMore * s.cost_change ? lost_ + 1 : 0;
    settled_ = Settled(s);
    return StopRequested() || lost_ >= options_.patience || settled_
               ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
               : ceres::SOLVER_CONTINUE;
  }
  bool settled() const { return settled_; }

 private:
  // Whether a step failed from which little was expected: then the simulation's own errors decide.
  bool Settled(const ceres::IterationSummary& s) const {
    if (s.step_is_successful || !s.step_is_valid || !(s.relative_decrease < 0)) return false;
    return s.cost_change / s.relative_decrease < options_.tolerance * s.cost;
  }

  static constexpr double kMore = 4;  // steps as good as the last that a fit may still hope for

  const Problem& problem_;
  const FitOptions& options_;
  Fit& fit_;
  int lost_ = 0;  // steps in a row
  bool settled_ = false;
};

void RequireEffect(const Problem& problem, const Vector& x, const std::vector<Matrix>& J) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    double norm = 0;
    for (const Matrix& part : J) {
      if (part.size()) norm += part.col(i).squaredNorm();
    }
    if (norm * p.scale * p.scale > 0 || p.IsStart()) continue;  // of a log that is not in use
    throw Error::Input(
        "parameter '" + p.name + "' (" + p.change.target + ", " + p.change.attribute + ")",
        "an effect on some output at its start " + fmt::format("{:g}", x[i]), "none");
  }
}

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

// The rows that were measured.
Scores Measured(const Scores& all) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index k = 0; k < all.r.size(); ++k) {
    if (all.r[k] != 0 || !all.J.row(k).isZero(0)) rows.push_back(k);
  }
  return {all.r(rows), all.J(rows, Eigen::all), all.curvature(rows)};
}

// Of a symmetric matrix whose rows have units of their own.
Matrix PseudoInverse(const Matrix& H) {
  const Vector scale =
      H.diagonal().unaryExpr([](double v) { return v > 0 ? 1 / std::sqrt(v) : 1; });
  const Matrix even = scale.asDiagonal() * H * scale.asDiagonal();
  const Matrix inverse = even.completeOrthogonalDecomposition().pseudoInverse();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

// Moves the ends of the intervals by low ≤ 0 and high ≥ 0, within the bounds.
void Reach(const Problem& problem, const Vector& low, const Vector& high, Uncertainty& u) {
  for (Eigen::Index i = 0; i < low.size(); ++i) {
    if (u.at_bound[i]) continue;
    const FreeParameter& p = problem.parameters()[i];
    u.lower[i] = std::max(p.lower, u.lower[i] + low[i]);
    u.upper[i] = std::min(p.upper, u.upper[i] + high[i]);
  }
}

// Whether first order said, to half of it, what a quarter of the step changes.
bool Foretold(const Uncertainty& u, const Vector& moved) {
  const Vector told = u.step / kWholeStep, wrong = moved - told;
  return wrong.dot(u.information * wrong) < 0.25 * told.dot(u.information * told);
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

// J times √ρ'' of the rows.
std::vector<Matrix> Weighted(std::vector<Matrix> J, double soft, const std::vector<Vector>& r) {
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (J[l].size() > 0) J[l].array().colwise() *= LossOf(soft, r[l]).curvature.array().sqrt();
  }
  return J;
}

}  // namespace

Fit FitParameters(const Problem& problem, const Vector& x, const std::vector<bool>& use,
                  const FitOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t before = problem.evaluations();
  Fit fit;
  const auto& parameters = problem.parameters();
  Vector y = problem.Clamp(x);  // scaled, as Ceres sees them
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] /= parameters[i].scale;
  const auto unscaled = [&] {
    Vector values(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) values[i] = y[i] * parameters[i].scale;
    return problem.Clamp(values);
  };
  fit.x = unscaled();
  auto r = problem.Residuals(fit.x, use);
  const Whitening none;
  const Whitening& whitening = options.whitening ? *options.whitening : none;
  const Vector all = whitening.Stack(r, use);
  if (!all.allFinite()) throw Error::Job("the simulation diverges at the start of the fit");
  if (x.size() == 0) {
    fit.cost = 0.5 * all.squaredNorm();
    fit.converged = true;
    return fit;
  }
  auto J = problem.Jacobian(fit.x, r, use, {}, true);
  for (const Matrix& part : J) {
    if (!part.allFinite()) throw Error::Job("the simulation diverges next to the start of the fit");
  }
  if (!options.idle) RequireEffect(problem, fit.x, J);

  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  Cost cost(problem, use, options, whitening, all.size());
  cost.Know(fit.x, std::move(r), std::move(J));
  ceres::Problem ceres(ownership);
  ceres.AddResidualBlock(&cost, nullptr, y.data());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = parameters[i];
    if (std::isfinite(p.lower))
      ceres.SetParameterLowerBound(y.data(), static_cast<int>(i), p.lower / p.scale);
    if (std::isfinite(p.upper))
      ceres.SetParameterUpperBound(y.data(), static_cast<int>(i), p.upper / p.scale);
  }
  Watch watch(problem, options, fit);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = 1e-7;
  solver.initial_trust_region_radius = 1e3;
  solver.max_num_consecutive_invalid_steps = 12;
  // Steps that a bound cuts short are searched by values alone: a gradient is a Jacobian here.
  solver.line_search_interpolation_type = ceres::BISECTION;
  solver.max_num_line_search_step_size_iterations = 3;
  solver.logging_type = ceres::SILENT;
  solver.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres, &summary);
  fit.iterations = static_cast<int>(summary.iterations.size()) - 1;
  fit.x = unscaled();
  fit.cost = summary.final_cost;
  fit.converged = summary.termination_type == ceres::CONVERGENCE || watch.settled();
  fit.message = summary.message;
  if (watch.settled()) {
    fit.message = "a further step gains less than the errors of the simulation";
  } else if (summary.termination_type == ceres::USER_SUCCESS) {
    fit.message = StopRequested() ? "interrupted" : "given up: it cannot come near a better one";
  }
  fit.evaluations = problem.evaluations() - before;
  fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return fit;
}

Vector RefitByChords(const Problem& problem, const Vector& x, std::vector<Vector> r,
                     const std::vector<Matrix>& J, const std::vector<bool>& use, int iterations) {
  const Eigen::Index n = x.size();
  Matrix H = Matrix::Zero(n, n);
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (use[l]) H += J[l].transpose() * J[l];
  }
  Vector best = x;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) r[l].resize(0);
  }
  double cost = SumOfSquares(r);
  for (int k = 0; k < iterations && !StopRequested(); ++k) {
    Vector g = Vector::Zero(n);
    for (std::size_t l = 0; l < use.size(); ++l) {
      if (use[l]) g += J[l].transpose() * r[l];
    }
    // Parameters that a bound stops do not move; the others solve without them.
    std::vector<bool> fixed(n, false);
    Vector step;
    for (bool again = true; again;) {
      again = false;
      Matrix A = H;
      Vector b = -g;
      for (Eigen::Index i = 0; i < n; ++i) {
        A(i, i) += 1e-9 * (H(i, i) + 1e-300);
        if (!fixed[i]) continue;
        A.row(i).setZero(), A.col(i).setZero();
        A(i, i) = 1, b[i] = 0;
      }
      step = A.ldlt().solve(b);
      for (Eigen::Index i = 0; i < n; ++i) {
        const FreeParameter& p = problem.parameters()[i];
        const bool stopped =
            (best[i] <= p.lower && step[i] < 0) || (best[i] >= p.upper && step[i] > 0);
        if (!fixed[i] && stopped) fixed[i] = again = true;
      }
    }
    bool lower = false;
    for (double share = 1; share > 0.2 && !lower; share /= 2) {
      const Vector next = problem.Clamp(best + share * step);
      auto there = problem.Residuals(next, use);
      const double value = SumOfSquares(there);
      if (!(value < cost)) continue;
      lower = true;
      const bool done = value > cost * (1 - 1e-4);
      best = next, r = std::move(there), cost = value;
      if (done) return best;
    }
    if (!lower) break;
  }
  return best;
}

Vector FitStarts(const Problem& problem, const Vector& x, const std::vector<bool>& use) {
  if (problem.experiment().start != Experiment::Start::kEstimate) return x;
  const auto r = problem.Residuals(x, use);
  return RefitByChords(problem, x, r, problem.StartJacobian(x, r, use), use);
}

Uncertainty UncertaintyOf(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                          const std::vector<Matrix>& J, const Whitening& whitening, double soft) {
  std::vector<Scores> blocks;
  const auto channels = static_cast<Eigen::Index>(problem.channels().size());
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (!J[l].size()) continue;
    const Eigen::Index rows = r[l].size() / channels;
    const Vector white = whitening.Apply(l, r[l]).col(0);
    const Matrix columns = whitening.Apply(l, J[l]);
    for (Eigen::Index c = 0; c < channels; ++c) {
      const Loss loss = LossOf(soft, white.segment(c * rows, rows));
      blocks.push_back({loss.slope, columns.middleRows(c * rows, rows), loss.curvature});
    }
  }
  return UncertaintyFrom(problem, x, blocks);
}

Uncertainty UncertaintyFrom(const Problem& problem, const Vector& x,
                            const std::vector<Scores>& blocks) {
  const Eigen::Index n = x.size();
  Uncertainty u;
  u.standard_error = Vector::Constant(n, std::numeric_limits<double>::quiet_NaN());
  u.lower = u.upper = x;
  u.correlation = Matrix::Identity(n, n);
  u.information = Matrix::Zero(n, n);
  std::vector<Eigen::Index> inside;
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeParameter& p = problem.parameters()[i];
    const double edge = 1e-6 * p.scale;
    u.at_bound.push_back(x[i] <= p.lower + edge || x[i] >= p.upper - edge);
    if (!u.at_bound.back()) inside.push_back(i);
  }
  const auto k = static_cast<Eigen::Index>(inside.size());
  if (k == 0) return u;
  Matrix H = Matrix::Zero(k, k), S = H, modelled = H;
  double independent = 0;  // rows, for the quantile
  Eigen::Index rows = 0;
  for (const Scores& all : blocks) {
    Scores block = Measured(all);
    block.J = Matrix(block.J(Eigen::all, inside));
    const Matrix scores = block.r.asDiagonal() * block.J;
    const double bandwidth = Bandwidth(scores);
    H += block.J.transpose() * block.curvature.asDiagonal() * block.J;
    S += LongRunCovariance(scores, bandwidth);
    modelled += ModelledCovariance(block);
    independent += static_cast<double>(block.r.size()) / bandwidth;
    rows += block.r.size();
  }
  u.information(inside, inside) = H;
  if (rows <= k) {
    for (const Eigen::Index i : inside)
      u.lower[i] = problem.parameters()[i].lower, u.upper[i] = problem.parameters()[i].upper;
    return u;
  }
  const double freedom = std::max(2.0, independent - static_cast<double>(k));
  const Matrix Hi = PseudoInverse(H);
  const double few = std::max(1.0, independent / freedom);
  const Matrix cov = few * Hi * modelled * Hi, robust = few * Hi * S * Hi;
  const double t = boost::math::quantile(boost::math::students_t(freedom), 0.975);
  for (Eigen::Index a = 0; a < k; ++a) {
    const Eigen::Index i = inside[a];
    const FreeParameter& p = problem.parameters()[i];
    if (!(H(a, a) > 0)) {
      u.lower[i] = p.lower, u.upper[i] = p.upper;
      continue;
    }
    u.standard_error[i] = std::sqrt(std::max({0.0, cov(a, a), robust(a, a)}));
    u.lower[i] = std::max(p.lower, x[i] - t * u.standard_error[i]);
    u.upper[i] = std::min(p.upper, x[i] + t * u.standard_error[i]);
    for (Eigen::Index b = 0; b < k; ++b) {
      const double size = std::sqrt(cov(a, a) * cov(b, b));
      u.correlation(i, inside[b]) = size > 0 ? cov(a, b) / size : (a == b ? 1 : 0);
    }
  }
  return u;
}

Problem AtQuarter(const Problem& problem) {
  Problem fine = problem;
  fine.StepBy(problem.step() / 4);
  return fine;
}

void ReachOver(const Problem& problem, const Vector& quarter, Uncertainty& u) {
  u.step = kWholeStep * quarter;
  Reach(problem, u.step.cwiseMin(0), u.step.cwiseMax(0), u);
}

void AllowForStep(const Problem& problem, const std::vector<Matrix>& J,
                  const std::vector<Matrix>& step, const Whitening& whitening, Uncertainty& u) {
  if (u.information.size() == 0) return;
  Vector pull = Vector::Zero(u.information.rows());
  for (std::size_t l = 0; l < J.size(); ++l) {
    if (!J[l].size()) continue;
    pull += whitening.Apply(l, J[l]).transpose() * whitening.Apply(l, Matrix(step[l].col(0)));
  }
  ReachOver(problem, PseudoInverse(u.information) * pull, u);
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
  return secants;
}

void ReachFurther(const Problem& problem, const Vector& x, const std::vector<Matrix>& J,
                  const std::vector<Matrix>& step, const Whitening& whitening, Uncertainty& u) {
  std::vector<Vector> effect(step.size());
  for (std::size_t l = 0; l < step.size(); ++l) {
    if (step[l].size()) effect[l] = kWholeStep * step[l].col(0);
  }
  const Uncertainty by = UncertaintyOf(problem, x, effect, J, whitening);
  Reach(problem, by.lower - x, by.upper - x, u);
}

void ReachByFineFit(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                    const std::vector<Matrix>& J, const std::vector<Matrix>& step,
                    const FitOptions& options, Uncertainty& u) {
  if (u.step.size() == 0 || !(u.step.array().abs() > u.standard_error.array()).any()) return;
  std::vector<bool> use;
  for (const Matrix& columns : J) use.push_back(columns.size() > 0);
  Vector moved;
  try {
    moved = FitParameters(AtQuarter(problem), x, use, options).x - x;
  } catch (const Error&) {
    return;  // it diverges at the finer step: first order has to do
  }
  if (StopRequested()) return;  // before the end
  const Whitening none;
  const Whitening& whitening = options.whitening ? *options.whitening : none;
  const bool foretold = Foretold(u, moved);
  const auto slopes = foretold ? J : Secants(problem, x, r, J, step, whitening);
  u = UncertaintyOf(problem, x, r, slopes, whitening, options.soft);
  ReachOver(problem, moved, u);
  if (!foretold) ReachFurther(problem, x, slopes, step, whitening, u);
}

Uncertainty IntervalsOf(const Problem& problem, const Vector& x, const std::vector<Vector>& r,
                        const std::function<void(const std::string&)>& progress) {
  const auto train = problem.TrainLogs();
  Problem centered = problem;
  centered.Center();
  const auto J = centered.Jacobian(x, r, train);
  const double soft = problem.experiment().soft;
  Uncertainty u = UncertaintyOf(problem, x, r, J, {}, soft);
  if (problem.path() != Path::kStepped) return u;
  const auto step = problem.StepEffects(x, r, train);
  AllowForStep(problem, Weighted(J, soft, r), Weighted(step, soft, r), {}, u);
  if (!StopRequested()) {
    FitOptions few{.iterations = 5, .tolerance = 1e-4, .soft = soft, .idle = true};
    if (progress)
      few.progress = [&](const std::string& line) { progress("at a fine step: " + line); };
    ReachByFineFit(centered, x, r, J, step, few, u);
  }
  return u;
}

}  // namespace continuum
