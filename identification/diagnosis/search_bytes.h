#pragma once

#include "identification/diagnosis/equation_error.h"
#include "identification/diagnosis/result.h"

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

template <class A>
void Fields(A& a, Fit& f) {
  auto& [x, cost, iterations, evaluations, seconds, converged, anew, message, trace] = f;
  a(x, cost, iterations, evaluations, seconds, converged, anew, message, trace);
}

/// Of a fit before its sensitivities and folds, which it does not have yet.
template <class A>
void Fields(A& a, Fitted& f) {
  auto& [fit, residuals, error, cost, sensitivities, folds] = f;
  a(fit, residuals, error.train, error.validate, cost);
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

/// Of a candidate after CandidateSearch::ProbeOne and LookAtError.
template <class A>
void FieldsOfProbes(A& a, CandidateResult& c) {
  a(c.probes, c.explained, c.error_promise, c.error);
}

}  // namespace continuum
