#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "models/annelida/annelida.h"
#include "models/annelida/constant_curvature.h"
#include "models/annelida/load.h"
#include "models/statics/rising_load.h"
#include "sim/numerics/solver.h"

namespace continuum {

/// The arm at rest, in the frame of AnnelidaLoad.
struct AnnelidaShape {
  numerics::Outcome outcome;
  statics::Stability stability;
  std::vector<Arc> sections;              ///< how far each has turned, and its length
  Eigen::VectorXd joints;                 ///< bend<i>_x, bend<i>_y (, twist<i>) of each [rad]
  std::vector<Eigen::Isometry3d> frames;  ///< of the base and of every module's end
  std::vector<std::vector<Eigen::Vector3d>> holes;  ///< that each cable passes
  Eigen::VectorXd length;                           ///< of every cable, base hole to its end [m]
  double mismatch = 0;      ///< of lengths that were given, from those of the shape [m]
  double largest_bend = 0;  ///< of a joint about one axis [rad]
};

/// What a cable has of free spans in a section of n modules that is an arc, eq. 4 [m].
double PassedLength(const AnnelidaParameters& p, int cable, int n, const Arc& arc);

/// Every section an arc of constant curvature (the comparator, eqs. 1-5), in balance:
///
///   K z/n + Σ_c T_c ∂ℓ_c/∂z = Σ_i m_i g ∂h_i/∂z + F ∂p/∂z,   z = (v, −u) of each section       (1)
///   ℓ_c = 2 n (b1 cos(θ/2n) − a (z · e_c)/θ sin(θ/2n)) over the n modules of a section, eq. 4
///
/// h_i: how low the centre of link i hangs on its arc. e_c: AnnelidaParameters::Direction. K/n: n
/// joints that turn alike. No friction and no torsion.
AnnelidaShape SolveArcs(const AnnelidaParameters& p, const AnnelidaLoad& load);

/// The same of cable lengths, from base hole to end [m]: eq. 5, section by section, after the
/// part of their way through the sections before. Two numbers answer to four lengths; `mismatch`
/// says how far they are from those of the arcs. Sums of lengths that are not above those of the
/// links are no lengths: `outcome` says so.
AnnelidaShape ArcsOfLengths(const AnnelidaParameters& p, const Eigen::VectorXd& length);

/// The arm as it is, link by link on universal joints:
///
///   K q + Σ_c T_c,i ∂ℓ_c,i/∂q = (Σ m g + F) ∂r/∂q                                             (2)
///
/// without friction of joints, and without the stops of the discs. ℓ_c,i is the free span of cable
/// c at joint i.
AnnelidaShape SolveChain(const AnnelidaParameters& p, const AnnelidaLoad& load, AnnelidaPull pull);

}  // namespace continuum
