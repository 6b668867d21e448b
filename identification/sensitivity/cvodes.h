#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "identification/sensitivity/solver_options.h"

namespace continuum {

/// An initial value problem with forward sensitivities:
///
///   ẏ = f(t, y),   ṡ_k = ∂f/∂y s_k + ∂f/∂p_k
///
/// for parameters p that are scaled to order 1. Callbacks may throw; a rate that is not finite
/// makes the solver try a shorter step.
struct Ode {
  using States = std::vector<double*>;
  std::size_t size = 0, parameters = 0;
  std::function<void(double t, const double* y, double* rate)> rate;
  /// rate [size] of y at t is known; writes those of all s_k.
  std::function<void(double t, const double* y, const double* rate, const States& s,
                     const States& rates)>
      sensitivity;
};

/// Integrates an Ode by SUNDIALS' CVODES, at variable order and step, sensitivities under error
/// control after each step (hindmarsh2005).
class Cvodes {
 public:
  Cvodes(const Ode& ode, const SolverOptions& how);
  ~Cvodes();

  /// Begins at t; s: [parameters × size], empty: zero.
  void Start(double t, std::span<const double> y, std::span<const double> s = {});
  /// Begins anew from where it is, at t, as the equation changes there.
  void Restart(double t);
  /// Goes on to a time; never beyond `stop`, where the equation may change. Returns false, with the
  /// solver's reason in failure(), when it cannot.
  bool Advance(double t, double stop);

  const double* y() const;
  const double* s(std::size_t k) const;
  const std::string& failure() const { return failure_; }
  /// Steps and evaluations of f since the solver was made.
  struct Work {
    long steps = 0, rates = 0, sensitivity_rates = 0;
    Work& operator+=(const Work& more);
  };
  Work work() const;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
  std::string failure_;
};

}  // namespace continuum
