#include "sim/simulation/input_signals.h"

#include <algorithm>

#include "engine.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

double Within(double value, bool limited, const double range[2]) {
  return limited ? std::clamp(value, range[0], range[1]) : value;
}

}  // namespace

Gate::Gate(mjModel& m, int actuator) : m_(&m), a_(actuator) {
  gain_.assign(Gain(), Gain() + mjNGAIN);
  bias_.assign(Bias(), Bias() + mjNBIAS);
}

void Gate::Switch(bool on) {
  for (int i = 0; i < mjNGAIN; ++i) Gain()[i] = on ? gain_[i] : 0;
  for (int i = 0; i < mjNBIAS; ++i) Bias()[i] = on ? bias_[i] : 0;
}

Inputs::Inputs(mjModel& m, const Experiment& e, const Log& log, const Wiring& wiring)
    : experiment_(e), log_(log), wiring_(wiring) {
  for (std::size_t i = 0; i < wiring.actuator.size(); ++i)
    gates_.emplace_back(m, wiring.actuator[i]);
}

void Inputs::AtRow(mjData& d, std::size_t row) {
  for (std::size_t i = 0; i < gates_.size(); ++i) d.ctrl[wiring_.control[i]] = log_.input[i][row];
  Switch(row);
}

void Inputs::Switch(std::size_t row) {
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    if (wiring_.gated[i]) gates_[i].Switch(log_.enable[i][row]);
  }
}

void Inputs::Interpolate(mjData& d, std::size_t row, double t) const {
  const double share = (t - log_.time[row]) / (log_.time[row + 1] - log_.time[row]);
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    if (!experiment_.inputs[i].linear) continue;
    const auto& u = log_.input[i];
    d.ctrl[wiring_.control[i]] = u[row] + share * (u[row + 1] - u[row]);
  }
}

void Inputs::Blend(mjData& d, const std::vector<double>& from, std::size_t to, double share) const {
  for (std::size_t i = 0; i < gates_.size(); ++i)
    d.ctrl[wiring_.control[i]] = from[i] + share * (log_.input[i][to] - from[i]);
}

void Inputs::EnableAll() {
  for (Gate& gate : gates_) gate.Switch(true);
}

void Settle(const mjModel& m, mjData& d) {
  const bool clamped = !(m.opt.disableflags & mjDSBL_CLAMPCTRL);
  for (int a = 0; a < m.nactuator; ++a) {
    const int adr = m.actuator_actadr[a], u = m.actuator_ctrladr[a];
    const bool lagged =
        m.actuator_dyntype[a] == mjDYN_FILTER || m.actuator_dyntype[a] == mjDYN_FILTEREXACT;
    if (adr >= 0 && lagged) {
      const double control =
          Within(d.ctrl[u], clamped && m.actuator_ctrllimited[u], m.actuator_ctrlrange + 2 * u);
      d.act[adr] = Within(control, m.actuator_actlimited[a], m.actuator_actrange + 2 * a);
    }
    const int samples = m.actuator_history[2 * a];
    if (samples > 0) {
      std::vector<double> past;
      for (int k = 0; k < samples; ++k)
        past.insert(past.end(), d.ctrl + u, d.ctrl + u + m.actuator_ctrlnum[a]);
      mj_initCtrlHistory(&m, &d, a, nullptr, past.data());
    }
  }
  SettleEffects(m, d);
}

}  // namespace continuum
