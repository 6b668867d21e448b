#include "models/spa/fold.h"

#include <cmath>
#include <vector>

#include "error.h"
#include "models/spa/response.h"
#include "models/spa/statics.h"

namespace continuum {
namespace {

using Eigen::Vector3d;

// Between none and twice the closed form, to 1 Pa.
template <class Holds>
double Largest(const Spa<double>& spa, Holds&& holds) {
  double low = 0, high = 2 * SpaStraightFold(spa);
  while (high - low > 1) {
    const double middle = 0.5 * (low + high);
    bool held = true;
    try {
      holds(Vector3d::Constant(middle));
    } catch (const Error&) {
      held = false;
    }
    (held ? low : high) = middle;
  }
  return low;
}

}  // namespace

double SpaStraightFold(const Spa<double>& spa) {
  const SpaParameters<double>& p = spa.parameters();
  const double fold = std::sqrt(-p.k_dL1 / (3 * p.k_dL3));
  return (2 * p.k_dL1 * fold / 3 - 0.5 * p.m * spa.options().gravity.z()) / (3 * p.A);
}

double SpaLargestAtRest(const Spa<double>& spa) {
  return Largest(spa, [&](const Vector3d& pressure) { SpaEquilibrium(spa, pressure, {}); });
}

double SpaLargestStep(const Spa<double>& spa) {
  const SpaStart rest = SpaAtRest(spa, Vector3d::Zero(), {});
  return Largest(spa, [&](const Vector3d& pressure) {
    SpaRespond(spa, rest, std::vector<Vector3d>(3001, pressure), 1e-3,
               [](double) { return SpaBase<double>{}; });
  });
}

}  // namespace continuum
