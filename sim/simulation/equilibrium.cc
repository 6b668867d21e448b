#include "sim/simulation/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "engine.h"
#include "error.h"
#include "sim/io/interrupt.h"
#include "sim/model/effect_kind.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

// Takes dry friction and that of cables away while it lives.
class WithoutFriction {
 public:
  explicit WithoutFriction(ModelAndData& machine)
      : m_(*machine.model), d_(*machine.data), flags_(m_.opt.disableflags), cables_(m_.nplugin) {
    m_.opt.disableflags |= mjDSBL_FRICTIONLOSS;
    for (int i = 0; i < m_.nplugin; ++i) {
      const std::vector<double> none = FrictionlessPath(m_, i);
      if (none.empty()) continue;
      cables_[i] = BoundOf(m_, d_, i).parameters();
      SetParameters(m_, d_, i, none);
    }
  }
  WithoutFriction(const WithoutFriction&) = delete;
  ~WithoutFriction() {
    for (int i = 0; i < m_.nplugin; ++i) {
      if (!cables_[i].empty()) SetParameters(m_, d_, i, cables_[i]);
    }
    m_.opt.disableflags = flags_;
  }

 private:
  mjModel& m_;
  mjData& d_;
  int flags_;
  std::vector<std::vector<double>> cables_;  // [plugin instance] parameters of a path law
};

// Newton's method on the forces that are not balanced, by differences and with a line search.
class Balance {
 public:
  Balance(ModelAndData& machine, const Experiment& e, const Log& log)
      : m_(*machine.model),
        d_(*machine.data),
        log_(log),
        wiring_(e, m_),
        inputs_(m_, e, log, wiring_) {
    mj_resetData(&m_, &d_);
    inputs_.AtRow(d_, 0);
  }

  // Whether there is rest under a share of the first inputs, near the present positions.
  bool Find(double load) {
    const double nv = static_cast<double>(m_.nv);
    Eigen::VectorXd r = Residual(load);
    for (int iteration = 0; iteration < 60; ++iteration) {
      StopIfRequested();
      const std::vector<double> q(d_.qpos, d_.qpos + m_.nq);
      const Eigen::VectorXd full = -Jacobian(load, q, r).fullPivLu().solve(r);
      double share = 1;
      Eigen::VectorXd next;
      for (; share > 1e-4; share /= 2) {
        Move(q, share * full);
        next = Residual(load);
        if (next.allFinite() && next.norm() < (1 - 0.1 * share) * r.norm() + 1e-13) break;
      }
      r = next;
      if (share * full.norm() < 1e-10 * (1 + std::sqrt(nv)) || r.norm() < 1e-13) return IsSmall(r);
      if (share <= 1e-4) return false;
    }
    return false;
  }

  // Lets the model move from where it was made to where it rests, or nearly: whenever it slows down
  // it stops there, so that it loses energy where it has no damper.
  void Relax() {
    constexpr int kMost = 20000;  // steps
    constexpr double kSlow = 1e-9;
    mj_resetData(&m_, &d_);
    inputs_.AtRow(d_, 0);
    double before = 0, most = 0;  // kinetic energy [J]
    for (int step = 0; step < kMost; ++step) {
      StopIfRequested();
      mj_step(&m_, &d_);
      mj_energyVel(&m_, &d_);
      const double now = d_.energy[1];
      if (!std::isfinite(now) || (step > 100 && now < kSlow * most)) break;
      most = std::max(most, now);
      if (now < before) std::fill(d_.qvel, d_.qvel + m_.nv, 0.0);
      before = now < before ? 0 : now;
    }
    std::fill(d_.qvel, d_.qvel + m_.nv, 0.0);
  }

  void EnableAll() { inputs_.EnableAll(); }

 private:
  // Beside the forces that act: where nothing holds a joint, as when all cables are slack, no step
  // helps, and that is no rest.
  bool IsSmall(const Eigen::VectorXd& r) const {
    constexpr double kBalanced = 1e-6;
    using Forces = Eigen::Map<const Eigen::VectorXd>;
    const double act = Forces(d_.qfrc_bias, m_.nv).norm() + Forces(d_.qfrc_passive, m_.nv).norm() +
                       Forces(d_.qfrc_actuator, m_.nv).norm() +
                       Forces(d_.qfrc_constraint, m_.nv).norm();
    return r.norm() <= kBalanced * act + 1e-13;
  }
  // M·qacc: what is not balanced.
  Eigen::VectorXd Residual(double load) {
    for (std::size_t i = 0; i < wiring_.actuator.size(); ++i)
      d_.ctrl[wiring_.control[i]] = load * log_.input[i][0];
    Settle(m_, d_);
    mj_forward(&m_, &d_);
    Eigen::VectorXd r(m_.nv);
    mj_mulM(&m_, &d_, r.data(), d_.qacc);
    return r;
  }
  Eigen::MatrixXd Jacobian(double load, const std::vector<double>& q, const Eigen::VectorXd& r) {
    constexpr double kStep = 1e-7;  // rad or m
    Eigen::MatrixXd J(m_.nv, m_.nv);
    for (Eigen::Index i = 0; i < m_.nv; ++i) {
      Move(q, kStep * Eigen::VectorXd::Unit(m_.nv, i));
      J.col(i) = (Residual(load) - r) / kStep;
    }
    return J;
  }
  void Move(const std::vector<double>& q, const Eigen::VectorXd& step) {
    std::copy(q.begin(), q.end(), d_.qpos);
    mj_integratePos(&m_, d_.qpos, step.data(), 1);
  }

  mjModel& m_;
  mjData& d_;
  const Log& log_;
  const Wiring wiring_;
  Inputs inputs_;
};

}  // namespace

InitialState Equilibrium(ModelAndData& machine, const Experiment& e, const Log& log) {
  const mjModel& m = *machine.model;
  const WithoutFriction frictionless(machine);
  Balance balance(machine, e, log);
  bool balanced = false;
  for (const double load : {0.25, 0.5, 0.75, 1.0}) balanced = balance.Find(load);
  if (!balanced) {
    balance.Relax();
    balanced = balance.Find(1);
  }
  balance.EnableAll();
  if (!balanced)
    throw Error::Job(log.label + ": no static equilibrium was found under the first inputs");
  const mjData& d = *machine.data;
  return {{d.qpos, d.qpos + m.nq}, std::vector<double>(m.nv, 0)};
}

}  // namespace continuum
