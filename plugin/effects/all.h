#pragma once

#include "effects/armature.h"
#include "effects/backlash.h"
#include "effects/bouc_wen.h"
#include "effects/braid.h"
#include "effects/capstan.h"
#include "effects/chamber_asymmetry.h"
#include "effects/clock_skew.h"
#include "effects/coulomb.h"
#include "effects/cubic_stiffness.h"
#include "effects/dahl.h"
#include "effects/dead_time.h"
#include "effects/directional_friction.h"
#include "effects/directional_viscous.h"
#include "effects/drum_radius.h"
#include "effects/elastic_gear.h"
#include "effects/external_force.h"
#include "effects/formula.h"
#include "effects/friction_drift.h"
#include "effects/gear_friction.h"
#include "effects/gravity_tilt.h"
#include "effects/input_gain.h"
#include "effects/input_offset.h"
#include "effects/link_length.h"
#include "effects/link_mass.h"
#include "effects/load_friction.h"
#include "effects/lugre.h"
#include "effects/maxwell.h"
#include "effects/misalignment.h"
#include "effects/mounting_angle.h"
#include "effects/payload.h"
#include "effects/pcc_segment.h"
#include "effects/position_friction.h"
#include "effects/pt1.h"
#include "effects/pt2.h"
#include "effects/sensor_bias.h"
#include "effects/sensor_delay.h"
#include "effects/sensor_drift.h"
#include "effects/sensor_eccentricity.h"
#include "effects/sensor_scale.h"
#include "effects/site_place.h"
#include "effects/slack.h"
#include "effects/stiffness.h"
#include "effects/stribeck.h"
#include "effects/supply_sag.h"
#include "effects/tendon_stretch.h"
#include "effects/torque_limit.h"
#include "effects/torque_ripple.h"
#include "effects/viscous.h"

namespace continuum {

template <Effect... E>
struct List {
  template <template <class...> class To>
  using Into = To<E...>;
  template <class Fn>
  static void ForEach(Fn&& fn) {
    (fn.template operator()<E>(), ...);
  }
};

/// Every effect the library knows. Adding one is one line here. Signals act in this order: input,
/// servo, cable, supply.
using All =
    List<Coulomb, Stribeck, LoadFriction, GearFriction, PositionFriction, DirectionalFriction,
         FrictionDrift, DirectionalViscous, Dahl, Lugre, BoucWen, CubicStiffness, TorqueRipple,
         Maxwell, Pt2, Backlash, Slack, TendonStretch, SupplySag, Capstan, PccSegmentLaw, Braid,
         ChamberAsymmetry, Viscous, Stiffness, Payload, LinkMass, LinkLength, MountingAngle,
         SitePlace, DrumRadius, Armature, ElasticGear, GravityTilt, ExternalForce, InputGain,
         InputOffset, TorqueLimit, DeadTime, Pt1, SensorBias, SensorScale, SensorDelay, SensorDrift,
         SensorEccentricity, Misalignment, ClockSkew>;

/// Effects whose law is not here but in the MJCF that has them. No candidates by themselves.
using FormulaLaws = List<Formula, FormulaFriction>;

}  // namespace continuum
