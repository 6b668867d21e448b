#include "models/spa/identify.h"

#include <functional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/particle_swarm.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Columns = Eigen::Matrix<double, 3, 6>;

double Mass(const Spa<double>& spa, const std::vector<SpaRecordedTrial>& trials) {
  const SpaBase<double> base = SpaBase<double>::Hanging();
  double product = 0, square = 0;
  for (const auto& [recording, motion] : trials) {
    for (std::size_t k = 0; k < motion.state.size(); ++k) {
      const double psi = spa.Regressor(motion.state[k], motion.acceleration[k], base)(2, 0);
      product += psi * motion.wrench[k][2];
      square += psi * psi;
    }
  }
  return product / square;
}

// Linear least squares inside the swarm. Its matrix does not depend on the swarm's parameters, only
// the right side, the actuation of chambers of unit area, does.
class Inner {
 public:
  Inner(const SpaParameters<double>& known, const SpaOptions& options,
        const std::vector<SpaRecordedTrial>& trials, double mass, const SpaFilter& filter)
      : known_(known), options_(options), trials_(trials), filter_(filter) {
    known_.A = 1;
    const Spa<double> spa(known_, options_);
    const SpaBase<double> base = SpaBase<double>::Hanging();
    Matrix6 gram = Matrix6::Zero();
    for (const auto& [recording, motion] : trials) {
      std::vector<Columns>& columns = columns_.emplace_back();
      for (std::size_t k = 0; k < motion.state.size(); ++k) {
        const Eigen::Matrix<double, 3, Spa<double>::kLinear> psi =
            spa.Regressor(motion.state[k], motion.acceleration[k], base).bottomRows<3>();
        Columns c;
        c << mass * psi.col(0) + known_.k_theta3 * psi.col(4), psi.col(1), psi.col(2), psi.col(3),
            psi.col(5), psi.col(6);
        gram += c.transpose() * c;
        columns.push_back(c);
      }
    }
    scale_ = gram.diagonal().cwiseSqrt().cwiseInverse();
    const Matrix6 scaled = scale_.asDiagonal() * gram * scale_.asDiagonal();
    // Columns that agree to a millionth leave no digit above the filter's own error.
    if (!scaled.allFinite() ||
        Eigen::SelfAdjointEigenSolver<Matrix6>(scaled).eigenvalues()[0] < 1e-12) {
      throw Error::Job("soft actuator: the responses do not excite all parameters");
    }
    factor_.compute(scaled);
  }

  struct Solution {
    Vector6 beta;
    double cost;
  };

  Solution Solve(const Eigen::Vector3d& p) const {
    SpaParameters<double> parameters = known_;
    parameters.x_m = p[0];
    parameters.y_m = p[1];
    const Spa<double> spa(parameters, options_);
    Vector6 right = Vector6::Zero();
    double square = 0;
    for (std::size_t i = 0; i < trials_.size(); ++i) {
      const auto pressure = SpaChamberPressure(trials_[i].recording, p[2], filter_);
      for (std::size_t k = 0; k < columns_[i].size(); ++k) {
        const Eigen::Vector3d force = spa.Actuation(trials_[i].motion.state[k].delta, pressure[k]);
        right += columns_[i][k].transpose() * force;
        square += force.squaredNorm();
      }
    }
    const Vector6 scaled = scale_.cwiseProduct(right), solution = factor_.solve(scaled);
    return {scale_.cwiseProduct(solution), square - scaled.dot(solution)};
  }

  // More than any fit can cost: the actuation itself is explained not at all, ten times.
  double Penalty() const {
    double square = 0;
    const Spa<double> spa(known_, options_);
    for (const auto& [recording, motion] : trials_) {
      for (const auto& p : recording.pressure) {
        square += spa.Actuation(Eigen::Vector3d::Zero(), p).squaredNorm();
      }
    }
    return 10 * square;
  }

 private:
  SpaParameters<double> known_;
  SpaOptions options_;
  const std::vector<SpaRecordedTrial>& trials_;
  SpaFilter filter_;
  std::vector<std::vector<Columns>> columns_;
  Vector6 scale_;
  Eigen::LLT<Matrix6> factor_;
};

// The best place within the box after all iterations of a swarm.
Eigen::Vector3d Minimise(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper,
                         const std::function<double(const Eigen::Vector3d&)>& cost,
                         const SpaSwarm& options) {
  SwarmOptions standard;
  standard.uniform = [random = Random32(options.seed)]() mutable { return random.Uniform(); };
  ParticleSwarm swarm(lower, upper, std::move(standard));
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    swarm.Evaluate([&](const Eigen::VectorXd& p) { return cost(p); });
    StopIfRequested();
    swarm.Move();
    options.progress(iteration + 1, options.iterations);
  }
  if (swarm.best().size() == 0) throw Error::Job("soft actuator: no finite cost found");
  return swarm.best();
}

bool Feasible(const Vector6& beta) { return beta.head<5>().minCoeff() > 0; }

}  // namespace

SpaParameters<double> SpaIdentify(const SpaParameters<double>& known, const SpaOptions& options,
                                  const std::vector<SpaRecordedTrial>& trials,
                                  const SpaFilter& filter, const SpaSwarm& swarm) {
  SpaParameters<double> found = known;
  found.m = Mass(Spa<double>(known, options), trials);  // step 1

  const Inner inner(known, options, trials, found.m, filter);
  const double penalty = inner.Penalty();
  const Eigen::Vector3d best = Minimise(  // step 2
      {-5e-3, -5e-3, 0}, {5e-3, 5e-3, 30e-3},
      [&](const Eigen::Vector3d& p) {
        const auto [beta, cost] = inner.Solve(p);
        return Feasible(beta) ? cost : cost + penalty;
      },
      swarm);
  const Vector6 beta = inner.Solve(best).beta;
  if (!Feasible(beta)) throw Error::Job("soft actuator: no feasible parameters found");

  found.x_m = best[0];  // step 3
  found.y_m = best[1];
  found.T_PT1 = best[2];
  found.A = 1 / beta[0];
  found.d_theta = beta[1] * found.A;
  found.d_dL = beta[2] * found.A;
  found.k_theta = beta[3] * found.A;
  found.k_dL1 = beta[4] * found.A;
  found.k_dL3 = beta[5] * found.A;
  return found;
}

}  // namespace continuum
