#pragma once

#include <functional>
#include <vector>

#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

namespace continuum {

/// Integrates y' = rates(y, t) while input[k] is held from k·period to (k + 1)·period, by
/// Runge-Kutta-Fehlberg of order 8 with this tolerance of each step.
///
/// rates has the input, and the time and chamber pressures at the beginning of a period: `input`,
/// `begin`, `pressure`, and Pressure(t) within it. see(t) before each period, check(t) at its end,
/// which may throw.
template <class Rates, class Input, class See, class Check>
void FollowInputs(Rates& rates, std::vector<double>& y, const std::vector<Input>& input,
                  double period, double tolerance, const See& see, const Check& check) {
  namespace odeint = boost::numeric::odeint;
  auto stepper = odeint::make_controlled<odeint::runge_kutta_fehlberg78<std::vector<double>>>(
      tolerance, tolerance);
  for (std::size_t k = 0; k < input.size(); ++k) {
    const double begin = double(k) * period, end = double(k + 1) * period;
    rates.begin = begin;
    rates.input = input[k];
    see(begin);
    if (k + 1 == input.size()) break;
    odeint::integrate_adaptive(std::ref(stepper), std::cref(rates), y, begin, end, period);
    check(end);
    rates.pressure = rates.Pressure(end);
  }
}

}  // namespace continuum
