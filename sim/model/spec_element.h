#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// One element of a model specification, with its numeric attributes by their MJCF names
/// ("damping", "gear[0]", "pos[2]"; SI and radians whatever the file uses). Some names stand for
/// what a user means by them:
///
///   body      mass (scales the inertia with it), point_mass (added at the body's origin), length
///             (Scale: stretches it along its axis, see body_length.h), turn[i] (Add: about an axis
///             of the parent through its joint, see body_turn.h)
///   body and site  force[i] (Add: a constant force in world axes, by an actuator of its own)
///   joint     gear_compliance (puts a spring between it and its motor, see elastic_gear.h),
///             gear_damping and gear_play of that; armature: of the motor, where there is one
///   tendon    springlength (without an index both ends of its range: the rest length; the length
///             at qpos0 where the model has none)
///   actuator  kp, kv (gain and bias), force_scale (gain, bias and force range), input (what it
///             receives: Scale, Add), delay (Add: on top of the present one), lag (first-order,
///             filterexact; Add is refused where there is one)
///
/// Satisfies the Element of effects/effect.h, so that native effects apply to it.
class SpecElement {
 public:
  /// compiled: the compiled model of the same specification; masses that come from geoms are read
  /// there.
  SpecElement(mjSpec* spec, mjsElement* element, const mjModel* compiled);

  double Get(std::string_view attribute) const;
  void Set(std::string_view attribute, double value);
  void Add(std::string_view attribute, double value);
  void Scale(std::string_view attribute, double factor);

  /// The element as it is now; Restore puts it back. One that was made since (created_in its
  /// specification) is deleted.
  struct Saved {
    void* address;
    std::vector<std::byte> bytes;
    mjSpec* created_in = nullptr;
    std::function<void()> undo = {};  ///< in place of both
    void Restore() const;
  };
  Saved Save() const;
  /// Other elements that edits of this one have made or changed.
  const std::vector<Saved>& others() const { return others_; }

  /// Gives a delayed actuator a history that reaches back over its delay at the model's time step,
  /// also where rows of a log shorten the steps to an eighth; one that is long enough stays.
  void CoverDelay();

  /// Throws Error (element, attribute, the other end) where an attribute is an end of a range and
  /// lies beyond the other one.
  void RequireOrder(std::string_view attribute) const;

  std::string Name() const;
  /// "joint 'q1'", for messages.
  std::string Who() const;

 private:
  double* Address(std::string_view attribute, double& unit) const;
  double RestLength(int end) const;
  void AddForce(std::string_view attribute, double newtons);
  bool SetGear(std::string_view attribute, double value);
  mjsActuator& Affine();

  mjSpec* spec_;
  mjsElement* element_;
  const mjModel* compiled_;
  std::vector<Saved> others_;
};

/// Every element of a kind, in the order of the model.
std::vector<SpecElement> Elements(mjSpec* spec, mjtObj kind, const mjModel* compiled);

/// The elements that a target "kind:glob" (or several globs, separated by spaces) names, in the
/// order of the model ("option" gives none: see OptionAttribute). Throws Error (where) when the
/// kind is unknown or nothing matches.
std::vector<SpecElement> MatchElements(mjSpec* spec, const mjModel* compiled,
                                       const std::string& target, const std::string& where);

/// The number behind an attribute of <option>: "gravity[2]", "timestep". Throws Error when unknown.
double& OptionAttribute(mjOption& option, std::string_view attribute, const std::string& where);

}  // namespace continuum
