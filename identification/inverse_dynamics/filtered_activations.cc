#include "identification/inverse_dynamics/filtered_activations.h"

#include <algorithm>
#include <cmath>

#include "identification/inverse_dynamics/zero_phase_lowpass.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {
namespace {

constexpr int kParts = 8;  // of a row's period

bool IsLag(const mjModel& m, int actuator) {
  const int type = m.actuator_dyntype[actuator];
  return type == mjDYN_FILTER || type == mjDYN_FILTEREXACT;
}

double Clamped(const mjModel& m, int control, double u) {
  const bool limited = m.actuator_ctrllimited[control] && !(m.opt.disableflags & mjDSBL_CLAMPCTRL);
  const double* const range = m.actuator_ctrlrange + 2 * control;
  return limited ? std::clamp(u, range[0], range[1]) : u;
}

// The control of an actuator at the rows, and whether it is linear between them.
struct Signal {
  std::vector<double> u;
  bool linear = false;
};

Signal SignalAt(const Experiment& e, const mjModel& m, const Log& log, const Wiring& wiring,
                int control) {
  const auto input = std::find(wiring.control.begin(), wiring.control.end(), control);
  if (input == wiring.control.end()) return {std::vector<double>(log.rows(), 0.0)};
  const auto i = static_cast<std::size_t>(input - wiring.control.begin());
  Signal signal{log.input[i], e.inputs[i].linear};
  for (double& u : signal.u) u = Clamped(m, control, u);
  return signal;
}

std::vector<double> Lagged(const Signal& signal, const std::vector<double>& time, double lag) {
  double w = signal.u.front();
  std::vector<double> fine{w};
  for (std::size_t k = 0; k + 1 < time.size(); ++k) {
    const double h = (time[k + 1] - time[k]) / kParts, kept = std::exp(-h / lag);
    const double rise = signal.linear ? (signal.u[k + 1] - signal.u[k]) / kParts : 0;
    const double behind = rise / h * lag;  // of a ramp
    for (int part = 0; part < kParts; ++part) {
      const double from = signal.u[k] + part * rise;
      w = from + rise - behind + (w - from + behind) * kept;
      fine.push_back(w);
    }
  }
  return fine;
}

}  // namespace

std::string ActivationObstacle(const mjModel& m) {
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_delay[a] > 0)
      return "actuator " + Called(m, mjOBJ_ACTUATOR, a) + " with a delay";
    if (m.actuator_actadr[a] >= 0 && !IsLag(m, a))
      return "actuator " + Called(m, mjOBJ_ACTUATOR, a) +
             " with dynamics other than a first-order lag";
  }
  return "";
}

std::vector<std::vector<double>> FilteredActivations(const Experiment& e, const mjModel& m,
                                                     const Log& log, const Wiring& wiring,
                                                     double cutoff) {
  std::vector<std::vector<double>> all(m.na);
  for (int a = 0; a < m.nactuator; ++a) {
    const int adr = m.actuator_actadr[a];
    if (adr < 0) continue;
    const double lag = std::max(mjMINVAL, m.actuator_dynprm[mjNDYN * a]);
    const Signal signal = SignalAt(e, m, log, wiring, m.actuator_ctrladr[a]);
    const std::vector<double> fine = LowPass(Lagged(signal, log.time, lag), cutoff / kParts);
    for (std::size_t k = 0; k < fine.size(); k += kParts) all[adr].push_back(fine[k]);
  }
  return all;
}

}  // namespace continuum
