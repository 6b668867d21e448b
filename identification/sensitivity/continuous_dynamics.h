#pragma once

#include <string>
#include <vector>

#include "sim/model/joint_equalities.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/input_signals.h"
#include "sim/simulation/output_recorder.h"
#include "sim/simulation/wiring.h"

namespace continuum {

/// Whether an input of a log jumps or bends at a row.
bool BreaksAt(const Experiment& e, const Log& log, std::size_t row);

/// A machine under the inputs of one log as a differential equation,
///
///   d/dt (q, v, a, z) = (v, M⁻¹(q) (τ − c), ȧ, ż)                              (1)
///
/// with τ all forces and c the bias of MuJoCo's forward dynamics, a the activations of actuators
/// and z the states of our laws. The state y holds qpos (a quaternion p moves by ½ p ω), qvel, act
/// and plugin_state, in SI. Dry friction of effects is a bristle (binding/bristle.h), whose
/// deflection is a state. Joints that linear equalities tie to others are taken out of q and v
/// (Ties). No other constraint acts: a model that needs one is refused by Obstacle. Friction of
/// cables without bristles (BoundLaw::WhyNoBristles) is left out: whoever asks has to see that none
/// of them is under tension.
class ContinuousDynamics {
 public:
  /// What keeps a model from being such an equation ("joint 'j1' has dry friction"); empty: nothing
  /// does.
  static std::string Obstacle(const mjModel& m, const mjData& d);

  /// Throws Error for names that the model lacks, and when the start cannot be found.
  ContinuousDynamics(ModelAndData machine, const Experiment& e, const Log& log);
  ContinuousDynamics(const ContinuousDynamics&) = delete;

  std::size_t size() const { return start_.size(); }
  /// y at the first row.
  const std::vector<double>& start() const { return start_; }
  const Wiring& wiring() const { return wiring_; }
  const mjModel& model() const { return *machine_.model; }
  /// As Rate or Observe has left it.
  mjData& data() { return *machine_.data; }
  /// Whether some joints are tied to others, so that y lacks them.
  bool tied() const { return !ties_.none(); }
  /// Whether dry friction acts, which makes the equation stiff.
  bool rubs() const { return rubs_; }
  /// From here to the next row the inputs are those of this one.
  void Hold(std::size_t row);
  /// dy/dt [size] at the time t of the log and y.
  void Rate(double t, const double* y, double* rate);
  /// Lets a recorder see the row that is held, at y.
  void Observe(const double* y, Recorder& recorder);
  /// Lets it see the row that is held, with the data as they are.
  void Record(Recorder& recorder) const { recorder.Take(*machine_.data, row_); }

 private:
  enum class Needs { kState, kFrames, kPosition, kAll };  // what the outputs are made of
  static Needs NeedsOf(const mjModel& m, int sensor);
  void Load(const double* y);
  void FindStates();
  void TakeCables(const Experiment& e);
  void AddCables();
  void SenseCables();
  void Complete();

  ModelAndData machine_;
  const Log& log_;
  Wiring wiring_;
  JointEqualities ties_;
  Inputs inputs_;
  std::vector<double> start_, moving_;  // moving_: rate of qpos
  Needs needs_ = Needs::kState;
  struct CableLaw {
    int instance;
    std::vector<double> parameters;
  };
  std::vector<CableLaw> cables_;  // whose friction is bristles; in mjData they have none
  std::vector<int> states_;       // of effects, those that move [index of plugin_state]
  std::vector<double> state_rate_, friction_, friction_rate_;  // [npluginstate], [nv], [nv]
  bool rubs_ = false;
  bool linear_ = false;
  std::size_t row_ = 0;
};

}  // namespace continuum
