#pragma once

#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/model/model_spec.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {

using Point = std::array<double, 3>;  ///< [m] or a direction, in the frame of the parent body
using Colour = std::array<float, 4>;  ///< red, green, blue, opacity

/// How a hinge that stands for a piece of an elastic body moves. Armature and damping in the ratio
/// of the stiffnesses keep the shapes of the slow modes: a mode at w swings at
/// 1/sqrt(1/w² + 1/fastest²) instead, so an explicit step of a fraction of 1/fastest is stable
/// however light and stiff the pieces are, and statics are untouched.
struct ModalLimit {
  double fastest;  ///< no mode swings faster [rad/s]: armature k/fastest²
  double lag;      ///< of the material [s]: damping k · lag
};

/// A sensor of a plugin instance as a whole.
struct EffectSensor {
  std::string name, effect, instance;
};

/// A robot's MJCF in the making: what a generator says of it, through mjSpec.
///
/// Angles in rad. Geoms neither collide nor weigh: masses come from AddBody. Names that are empty
/// are left out. Pointers stay valid as long as this does.
class Mjcf {
 public:
  /// comment: stands at the top of the file.
  Mjcf(const std::string& model, const std::string& comment);

  mjSpec& spec() { return *spec_; }
  mjsBody* world();

  void AddMaterial(const std::string& name, const Colour& colour, float specular = 0.3F);
  /// Sky, light, a floor and a wall behind, all without reflections. floor: its z; wall: its y.
  void AddStudio(double floor, double wall);
  void AddCamera(const std::string& name, const Point& from, const Point& at, double fovy_degree);

  mjsBody* AddBody(mjsBody* parent, const std::string& name, const Point& pos);
  /// mass [kg] at centre with principal moments [kg m^2] about the body's axes.
  void SetInertia(mjsBody* body, double mass, const Point& centre, const Point& moments);
  /// The same of a body with joints, at least as much as MuJoCo takes for one that moves: 1e-15 kg
  /// and kg m^2, where the joints' armature decides.
  void SetMovingInertia(mjsBody* body, double mass, const Point& centre, const Point& moments);
  /// A hinge through the body's origin; stiffness [N m/rad], hard stops at ±stop [rad].
  void AddHinge(mjsBody* body, const std::string& name, const Point& axis, double stiffness,
                double stop);
  /// A hinge through the body's origin without stops; stiffness [N m/rad], damping [N m s/rad].
  void AddBend(mjsBody* body, const std::string& name, const Point& axis, double stiffness,
               double damping);
  /// A hinge without stops whose stiffness [N m/rad] is that of a piece of an elastic body.
  void AddElasticHinge(mjsBody* body, const std::string& name, const Point& axis, double stiffness,
                       const ModalLimit& pace, double rest = 0);
  /// A slide along z or a hinge through the body's origin, free of springs and stops; armature [kg]
  /// or [kg m^2].
  void AddFreeJoint(mjsBody* body, const std::string& name, mjtJoint type, const Point& axis,
                    double armature);
  /// Keeps joint = ratio * leader, as hard as the step allows.
  void AddCoupling(const std::string& joint, const std::string& leader, double ratio);
  /// A spring and a damper on Σ c q over joints and their factors c, at rest where the sum is zero.
  void AddSpring(const std::vector<std::pair<std::string, double>>& joints, double stiffness,
                 double damping);
  mjsSite* AddSite(mjsBody* body, const std::string& name, const Point& pos, double radius);
  void AddCylinder(mjsBody* body, const Point& from, const Point& to, double radius,
                   const std::string& material);
  void AddCapsule(mjsBody* body, const Point& from, const Point& to, double radius,
                  const std::string& material);
  mjsGeom* AddSphere(mjsBody* body, const Point& centre, double radius,
                     const std::string& material);
  /// A box with axes x, y [body's frame] and its half lengths along them and the third.
  mjsGeom* AddBox(mjsBody* body, const Point& centre, const Point& x, const Point& y,
                  const Point& half, const std::string& material);
  /// A spatial tendon through sites, actuator side first; width: radius it is drawn with [m].
  void AddCable(const std::string& name, const std::vector<std::string>& sites, double width,
                const Colour& colour);
  /// A motor on a tendon whose control is the tension [N], 0 .. largest.
  void AddTension(const std::string& name, const std::string& tendon, double largest);
  /// A drive that moves a tendon's end, through the tendon's own elasticity.
  ///
  ///   T = k (travel u + l − length) + c dl/dt + T_0,   smallest ≤ T ≤ largest
  ///
  /// u: control; travel [m per control]: how much tendon it takes in; l: path length [m]; length:
  /// that at which T = T_0 for u = 0; k: stiffness [N/m]; c: damping [N s/m]; T_0: pretension [N];
  /// smallest: 0 where a tendon goes slack, below 0 where T counts from the pretension of a pair.
  struct Drive {
    double travel, length, stiffness, damping, pretension, smallest, largest;
  };
  void AddDrive(const std::string& name, const std::string& tendon, const Drive& drive);
  /// Motors "<site>_fx", "<site>_fy", "<site>_fz": components [N] of a force at a site in the axes
  /// of the site `frame`, at most `largest`.
  void AddForce(const std::string& site, const std::string& frame, double largest);
  /// Motors "<site>_mx", "<site>_my", "<site>_mz": the same of a moment [N m].
  void AddMoment(const std::string& site, const std::string& frame, double largest);
  /// A site's position in the frame of another site.
  void AddPosition(const std::string& name, const std::string& site, const std::string& frame);
  /// An actuator whose force is the gauge pressure [Pa], 0 .. largest, that follows its control
  /// with a first-order lag [s]. It does nothing by itself; a joint must be named for it.
  void AddPressure(const std::string& name, const std::string& joint, double lag, double largest);
  mjsSensor* AddSensor(mjtSensor type, const std::string& name, mjtObj kind,
                       const std::string& object);

  /// The file, with plugin instances under <extension>, each referred to by a body, and sensors of
  /// them. Throws Error when it does not compile.
  std::string Text(std::span<const EffectInstance> effects,
                   std::span<const EffectSensor> sensors = {}) const;

 private:
  mjsJoint* AddJoint(mjsBody* body, const std::string& name, const Point& axis, double stiffness);
  void AddWrench(const std::string& site, const std::string& frame, char letter, int first,
                 double largest);
  mjsActuator* AddMotor(const std::string& name, double least, double largest);
  mjsGeom* AddGeom(mjsBody* body, mjtGeom type, const std::string& material);

  Owned<mjSpec> spec_;
};

}  // namespace continuum
