#include "sim/model/actuator_edit.h"

#include <algorithm>
#include <string>

#include "binding/actuator_type.h"
#include "error.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

std::string Who(const mjsActuator& a) {
  return std::string("actuator '") + mjs_getString(mjs_getName(a.element)) + "'";
}

}  // namespace

void MakeAffine(mjsActuator& a) {
  if (a.gaintype != mjGAIN_FIXED || (a.biastype != mjBIAS_NONE && a.biastype != mjBIAS_AFFINE)) {
    throw Error::Input(Who(a), "an actuator with a fixed gain and an affine bias",
                       ActuatorType(a.gaintype, a.biastype, a.dyntype));
  }
  a.type = mjACTUATOR_GENERAL;
  if (a.biastype == mjBIAS_NONE) {
    a.biastype = mjBIAS_AFFINE;
    for (double& b : a.biasprm) b = 0;
  }
}

void SetLag(mjsActuator& a, double lag) {
  const bool lagged = a.dyntype == mjDYN_FILTER || a.dyntype == mjDYN_FILTEREXACT;
  if (a.dyntype != mjDYN_NONE && !lagged) {
    throw Error::Input(Who(a), "an actuator without dynamics or with a first-order lag",
                       ActuatorType(a.gaintype, a.biastype, a.dyntype));
  }
  a.type = mjACTUATOR_GENERAL;
  if (lag <= 0) {
    a.dyntype = mjDYN_NONE, a.actdim = -1;
    return;
  }
  if (!lagged) a.actearly = 1;  // else it would be a step late however short
  a.dyntype = mjDYN_FILTEREXACT;
  a.dynprm[0] = lag;
}

void SetDelay(mjsActuator& a, double delay) {
  if (delay < 0) throw Error::Input(Who(a) + ": delay", "a number >= 0", std::to_string(delay));
  a.delay = delay;
  if (delay == 0) a.nsample = 0;
  if (delay > 0 && a.nsample == 0) a.interp = 1;
}

void LimitForce(mjsActuator& a, double limit) {
  double* const range = a.forcerange;
  const bool limited = a.forcelimited == mjLIMITED_TRUE ||
                       (a.forcelimited == mjLIMITED_AUTO && (range[0] != 0 || range[1] != 0));
  const double lower = limited ? std::max(range[0], -limit) : -limit,
               upper = limited ? std::min(range[1], limit) : limit;
  if (!(limit > 0))
    throw Error::Input(Who(a) + ": force_limit", "a positive number", Decimal(limit));
  if (!(lower < upper))
    throw Error::Input(
        Who(a) + ": force_limit",
        "one within its forcerange, " + Decimal(range[0]) + " to " + Decimal(range[1]),
        Decimal(limit));
  range[0] = lower, range[1] = upper;
  a.forcelimited = mjLIMITED_TRUE;
}

void CoverDelay(mjsActuator& a, double timestep) {
  if (a.delay <= 0) return;
  const double samples = 8 * (a.delay / timestep + 4);
  a.nsample = std::max(a.nsample, static_cast<int>(std::min(samples, 1e6)));
}

}  // namespace continuum
