#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "binding/config.h"
#include "binding/law_slopes.h"

namespace continuum {

/// When a law is evaluated: before the actuators (kPassive; actuator_force is the previous
/// evaluation's), after them (kActuator; actuator_force is current and not yet clamped), or after
/// all other forces (kAfterAll; qfrc_passive holds everything but what this law gives).
enum class Stage { kPassive, kActuator, kAfterAll };

/// A law bound to places of one model. The engine plugin and the identification both use it.
///
/// Parameters are values of the card, in its order; Set changes them while the model runs.
class BoundLaw {
 public:
  explicit BoundLaw(std::vector<double> p) : p_(std::move(p)) {}
  virtual ~BoundLaw() = default;

  const std::vector<double>& parameters() const { return p_; }
  void Set(std::vector<double> p) { p_ = std::move(p); }

  /// Whether Evaluate ever writes force, and whether the law is a row of the constraint solver.
  virtual bool GivesForce() const { return false; }
  virtual bool IsRow() const { return false; }

  /// Whether the law depends on all other forces. It is then evaluated in kAfterAll; in kActuator
  /// only where another such law has to know its force, which must follow from the states alone.
  virtual bool NeedsAllForces() const { return false; }

  /// Whether the law changes what actuators give. It is then evaluated before all others, which see
  /// the changed forces whatever the order of the instances.
  virtual bool IsSignal() const { return false; }

  /// Writes what MuJoCo must know before its first step (rows, native damping). Assigns constants
  /// only, so that repeating it changes nothing. Throws Error when the model contradicts it.
  virtual void Impose(mjModel&) const {}

  /// Evaluates at d; z: the states, unchanged. Returns true when it wrote force [nv], the
  /// generalized force that the model feels.
  virtual bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                        std::span<double> force) = 0;
  /// States after the step that d has just taken.
  virtual void Advance(const mjModel&, const mjData&, double*) {}
  /// Writes dz/dt at d, where the states follow a differential equation; false: they go in steps.
  virtual bool Rates(const mjModel&, const mjData&, const double* /*z*/, double* /*rate*/) const {
    return false;
  }
  /// Why a dry friction has no form as a differential equation ("it acts on a ball joint"); empty:
  /// Bristles is one.
  virtual std::string WhyNoBristles(const mjModel&) const { return "has dry friction"; }
  /// Its states that move as bristles [index of z].
  virtual std::vector<int> BristleStates() const { return {}; }
  /// At d, after a forward pass without rows: writes dz/dt of BristleStates, adds to force [nv]
  /// what the model feels (bristle.h).
  virtual void Bristles(const mjModel&, const mjData&, const double* /*z*/, double* /*rate*/,
                        std::span<double> /*force*/) const {}
  /// Why Differentiate knows nothing of this law in this model ("its geometry moves"); empty: it
  /// does.
  virtual std::string WhyNoSlopes(const mjModel&) const { return "its slopes are not known"; }
  /// Adds how force, rows and next states follow what they are made of, in the step that has been
  /// taken. d: after the step, but with the positions and speeds that it began with.
  virtual void Differentiate(const mjModel&, const mjData&, const StepTaken&, LawSlopes&) const {}
  /// States as if the present controls had been there for ever.
  virtual void Settle(const mjModel&, const mjData&, double*) const {}
  /// Why the law does nothing at some of its places; empty: it acts.
  virtual std::string WhyIdle(const mjModel&) const { return ""; }
  /// What a sensor of this effect must be on; "" when this object will do.
  virtual std::string_view SensorPlace(const mjModel&, mjtObj /*kind*/, int /*id*/) const {
    return "an effect that has sensors";
  }
  /// Writes the value of a sensor (its id) of this effect.
  virtual void Sense(const mjModel&, const mjData&, int /*sensor*/, std::span<double>) const {}
  /// Calls take(body, point, force) for what the law does to points of bodies, beyond what MuJoCo
  /// counts there: world coordinates, [N].
  using TakeForce = std::function<void(int body, const double* point, const double* force)>;
  virtual void PointForces(const mjModel&, const mjData&, const TakeForce&) const {}
  virtual void Visualize(const mjModel&, const mjData&, mjvScene&) const {}
  /// Largest tension of a cable now [N], of laws that draw cables from blue (0) to red.
  virtual double LargestTension() const { return 0; }
  /// Which tension Visualize draws red [N].
  virtual void DrawRedAt(double /*tension*/) {}
  /// Takes over what was computed (not configured) from another Bound of the same kind.
  virtual void CopyFrom(const BoundLaw&) {}

 protected:
  std::vector<double> p_;
};

}  // namespace continuum
