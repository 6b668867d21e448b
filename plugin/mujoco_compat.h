#pragma once

#include <mujoco/mujoco.h>

namespace continuum {

/// What differs between the releases of MuJoCo that the plugin is built for, 3.11.0 to 4.0.1:
/// nothing else asks for a release.

/// Whether a model is stepped by the integrator `discrete`, which MuJoCo has since 3.13.
inline bool IsDiscrete(const mjModel& m) {
#if mjVERSION_HEADER >= 3013000
  return m.opt.integrator == mjINT_DISCRETE;
#else
  return m.opt.integrator < 0;  // never
#endif
}

/// The control of an actuator with one, as it acts at d.time: behind its delay, not yet clamped.
inline double ReadControl(const mjModel& m, const mjData& d, int actuator) {
#if mjVERSION_HEADER >= 3014000
  double value = 0;
  const double* const read = mj_readCtrl(&m, &d, actuator, d.time, &value, -1);
  return read ? *read : value;
#else
  return mj_readCtrl(&m, &d, actuator, d.time, -1);
#endif
}

/// By how much the rest length of a tendon has yielded [m]; tendons yield since 4.0.
inline double PlasticSet([[maybe_unused]] const mjModel& m, [[maybe_unused]] const mjData& d,
                         [[maybe_unused]] int tendon) {
#if mjVERSION_HEADER >= 4000000
  const int at = m.tendon_plasticadr[tendon];
  return at >= 0 ? d.plastic[at] : 0;
#else
  return 0;
#endif
}

/// Whether the spring of a tendon can yield.
inline bool Yields([[maybe_unused]] const mjModel& m, [[maybe_unused]] int tendon) {
#if mjVERSION_HEADER >= 4000000
  return m.tendon_plasticadr[tendon] >= 0;
#else
  return false;
#endif
}

/// A fault of this release that a model meets, in words; null: none. 4.0.0 factors the inertia of
/// large models wrongly.
inline const char* FaultOfRelease(const mjModel& m) {
  constexpr int kLarge = 60;  // degrees of freedom from which on it takes the faulty way
  if (mjVERSION_HEADER != 4000000 || m.nv < kLarge) return nullptr;
  return "MuJoCo 4.0.0 computes wrong accelerations for models with 60 degrees of freedom or more; "
         "4.0.1 mends it";
}

}  // namespace continuum
