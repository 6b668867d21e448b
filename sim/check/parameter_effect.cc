#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "error.h"
#include "sim/check/against_model.h"
#include "sim/experiment/measurement_model.h"
#include "sim/io/interrupt.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

constexpr double kShare = 0.05;     // of a parameter's bounds, by which it is changed
constexpr double kRounding = 1e-9;  // of a channel's size: no more than this is no effect
constexpr int kSimulations = 100;   // of one experiment at most
constexpr double kAllSteps = 1e6;   // of all these simulations together

class EffectSearch {
 public:
  EffectSearch(const Experiment& e, const ModelSpec& system) : e_(e), system_(system) {
    for (const Parameter& p : e.parameters) start_.push_back(StartOf(p));
    plain_.resize(e.logs.size());
  }

  void Run(Findings& out) {
    for (std::size_t i = 0; i < e_.parameters.size(); ++i) {
      const Parameter& p = e_.parameters[i];
      if (p.frozen || IsMeasurement(p.target, p.attribute)) continue;
      const double other = start_[i] + (start_[i] + Step(p) <= p.upper ? Step(p) : -Step(p));
      if (!LacksEffect(i, other)) continue;
      out.Add(Finding::Severity::kWarning, "", "no_effect",
              fmt::format(
                  "parameter '{}' ({} {}) changes no output of any log, from {:.4g} to {:.4g}: no "
                  "fit can find it{}; leave it out or write `frozen: true`",
                  p.name, p.target, p.attribute, start_[i], other, Reason(p)));
    }
  }

 private:
  static double Step(const Parameter& p) { return kShare * (p.upper - p.lower); }

  double StartOf(const Parameter& p) const {
    if (IsMeasurement(p.target, p.attribute)) return 0;  // it is not changed here
    return p.Start([&] { return system_.Value(p.target, p.attribute); });
  }

  // Whether every log was simulated and none felt the change.
  bool LacksEffect(std::size_t parameter, double other) {
    for (std::size_t l = 0; l < e_.logs.size(); ++l) {
      if (plain_[l].channel.empty() && !Simulated(l, start_, plain_[l])) return false;
      std::vector<double> values = start_;
      values[parameter] = other;
      Trace changed;
      if (!Simulated(l, values, changed) || Differ(plain_[l], changed)) return false;
    }
    return true;
  }

  // False when that fails or took too long in all.
  bool Simulated(std::size_t l, const std::vector<double>& values, Trace& trace) {
    const Log& log = e_.logs[l];
    steps_ += (log.time.back() - log.time.front()) / system_.model().opt.timestep;
    if (++simulations_ > kSimulations || steps_ > kAllSteps || e_.quasi_static) return false;
    std::vector<Change> changes = SettingsOfModel(log);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Parameter& p = e_.parameters[i];
      if (!IsMeasurement(p.target, p.attribute))
        changes.push_back({p.target, p.attribute, values[i], p.operation});
    }
    try {
      ModelAndData machine = system_.Build(changes);
      trace = Simulate(machine, e_, log, {}, Hooks::Stoppable());
    } catch (const Error&) {
      if (StopRequested()) throw;
      return false;
    }
    return !trace.diverged;
  }

  bool Differ(const Trace& a, const Trace& b) const {
    for (std::size_t c = 0; c < a.channel.size(); ++c) {
      if (e_.outputs[e_.channels[c].output].weight == 0) continue;
      double size = 0, most = 0;
      for (std::size_t k = 0; k < a.channel[c].size(); ++k) {
        size = std::max(size, std::abs(a.channel[c][k]));
        most = std::max(most, std::abs(a.channel[c][k] - b.channel[c][k]));
      }
      if (most > kRounding * size) return true;
    }
    return false;
  }

  // The place of a body that its joint moves along the same axis.
  std::string Reason(const Parameter& p) const {
    if (!p.target.starts_with("body:") || !p.attribute.starts_with("pos[")) return "";
    const mjModel& m = system_.model();
    const std::string name = p.target.substr(5);
    const int axis = p.attribute[4] - '0', body = mj_name2id(&m, mjOBJ_BODY, name.c_str());
    for (int j = 0; body >= 0 && j < m.body_jntnum[body]; ++j) {
      const int joint = m.body_jntadr[body] + j;
      const bool slides = m.jnt_type[joint] == mjJNT_SLIDE;
      if (m.jnt_type[joint] == mjJNT_FREE ||
          (slides && std::abs(m.jnt_axis[3 * joint + axis]) > 0.999))
        return fmt::format(", as a {} joint of body '{}' moves along it", slides ? "slide" : "free",
                           name);
    }
    return "";
  }

  const Experiment& e_;
  const ModelSpec& system_;
  std::vector<double> start_;
  std::vector<Trace> plain_;  // [log] at the starts, as they are needed
  int simulations_ = 0;
  double steps_ = 0;
};

}  // namespace

void CheckParameterEffects(const Experiment& e, const ModelSpec& system, Findings& out) {
  EffectSearch(e, system).Run(out);
}

}  // namespace continuum
