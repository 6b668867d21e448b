#pragma once

#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/result.h"
#include "identification/result/fit_bytes.h"

/// What the tasks of a search find, for BytesOut and BytesIn (sim/numerics/bytes.h).
namespace continuum {

template <class A>
void Fields(A& a, Probe& p) {
  auto& [columns, sign, share, start, whole, on_top] = p;
  a(columns, sign, share, start, whole, on_top);
}

template <class A>
void Fields(A& a, EquationStart& s) {
  auto& [start, share, x, together] = s;
  a(start, share, x, together);
}

/// Of a fit before its sensitivities and folds, which it does not have yet.
template <class A>
void Fields(A& a, Fitted& f) {
  auto& [fit, residuals, error, cost, sensitivities, folds] = f;
  a(fit, residuals, error.train, error.validate, cost);
}

template <class A>
void Fields(A& a, Uncertainty& u) {
  auto& [standard_error, lower, upper, step, by_numbers, correlation, information, at_bound,
         lacks] = u;
  a(standard_error, lower, upper, step, by_numbers, correlation, information, at_bound, lacks);
}

template <class A>
void Fields(A& a, Sensitivities& s) {
  auto& [jacobian, step, uncertainty, freedom, simulated] = s;
  a(jacobian, step, uncertainty, freedom, simulated.here, simulated.there);
}

template <class A>
void Fields(A& a, ByEquation& b) {
  auto& [share, before, after] = b;
  a(share, before, after);
}

/// Of a candidate after CandidateSearch::FitOne, which may have widened its ranges.
template <class A>
void FieldsOfFit(A& a, CandidateResult& c) {
  a(c.fitted, c.was_fitted, c.error);
  for (Parameter& p : c.hypothesis.extra) a(p.lower, p.upper);
}

/// Of a candidate after CandidateSearch::FitAlone.
template <class A>
void FieldsOfFitAlone(A& a, CandidateResult& c) {
  FieldsOfFit(a, c);
  a(c.fitted.sensitivities, c.likelihood);
}

/// Of a candidate after CandidateSearch::ProbeOne and LookAtError.
template <class A>
void FieldsOfProbes(A& a, CandidateResult& c) {
  a(c.probes, c.explained, c.error_promise, c.error);
}

}  // namespace continuum
