#pragma once

#include <algorithm>
#include <cmath>

#include "models/stiff_flop/body.h"
#include "models/stiff_flop/case.h"
#include "models/stiff_flop/chamber.h"

namespace continuum::stiff_flop {

/// r_od = r_o/sqrt(lambda) [m]; the body law `fixed` moves nothing.
template <class T>
T TubeDistance(const Module& module, BodyLaw law, const T& lambda) {
  using std::sqrt;
  return law == BodyLaw::kFixed ? T(module.r_o) : module.r_o / sqrt(lambda);
}

/// 1 - t_i of line i (4), t_i = kappa r_od cos(psi_i - phi): its length over that of the axis.
template <class T>
T RelativeLength(const Module& module, const Axis<T>& axis, const T& r_od, std::size_t line) {
  return 1.0 - r_od * (axis.k_1 * module.lines[line][0] + axis.k_2 * module.lines[line][1]);
}

/// lambda_ci = lambda (1 - t_i), kappa_ci = kappa/(1 - t_i): the same angle of bending.
template <class T>
Bend<T> TubeBend(const Module& module, const Axis<T>& axis, const T& r_od, std::size_t line) {
  const T length = RelativeLength(module, axis, r_od, line);
  const Bend<T> bend = axis.bend();
  return {bend.lambda * length, bend.kappa / length};
}

template <class T>
Chamber<T> Tube(const Module& module, ChamberLaw law, const T& gamma, const Bend<T>& bend) {
  return {law, gamma, module.r_c1, module.r_c2, bend};
}

/// How far the section is from where a law ends, 1 or less, negative beyond.
double Margin(const Module& module, const Method& method, const Axis<double>& axis);

/// The columns of the results that describe the section. `axis` is inside the domain.
BaseSection Describe(const Module& module, const Method& method, const Axis<double>& axis);

}  // namespace continuum::stiff_flop
