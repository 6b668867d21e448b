#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace continuum {

class Mjcf;
struct EffectInstance;

inline constexpr int kAnnelidaLinks = 5;    ///< of the paper's arm
inline constexpr int kCablesOfSection = 4;  ///< 90 degrees apart

/// Torsion of a joint about its link's axis.
struct AnnelidaTorsion {
  double K, d;  ///< stiffness [N m/rad], damping [N m s/rad]
};

/// The snake arm's parameters (SI); sources and uncertainties: annelida.yaml.
struct AnnelidaParameters {
  double a;                      ///< radius of the holes
  double b1;                     ///< joint to the hole plane on either side
  double b2;                     ///< hole plane to hole plane through a link
  double m, I;                   ///< mass and principal moment of inertia of a link
  double m_last, I_last;         ///< of the last link
  double K;                      ///< stiffness of a joint in each direction
  double tau_mu, tau_c, S, v_d;  ///< Stribeck friction of a joint, eq. 7
  double mu;                     ///< capstan friction of a cable at a hole
  double R;                      ///< radius of the discs
  double lead;                   ///< straight lead-in of the cables before the base
  double tension;                ///< largest tension of a cable
  double gravity;
  std::vector<int> sections{kAnnelidaLinks};  ///< modules of each, base to tip
  std::optional<AnnelidaTorsion> torsion;     ///< none: joints do not twist

  int Links() const { return std::accumulate(sections.begin(), sections.end(), 0); }
  int Cables() const { return kCablesOfSection * static_cast<int>(sections.size()); }
  /// Modules that a cable passes, from the base on: it ends where its section ends.
  int LinksOf(int cable) const {
    return std::accumulate(sections.begin(), sections.begin() + 1 + cable / kCablesOfSection, 0);
  }
  /// Unit vector from the axis to a cable's holes. Cables of a section are 90 degrees apart, and
  /// those of S sections share the quarter evenly.
  std::array<double, 2> Direction(int cable) const;

  double Pitch() const { return 2 * b1 + b2; }  ///< joint to joint
  /// Angle at which the discs on either side of a joint touch.
  double Stop() const { return 2 * std::atan(b1 / R); }
  double Length() const { return Links() * Pitch(); }  ///< base plane to tip plane
};

/// Throws Error with file:line for missing and impossible values.
AnnelidaParameters ReadAnnelida(const std::filesystem::path& file);

/// The robot in the making, without a scene around it.
///
/// The arm hangs: frames of base and links have z down along the straight arm, x as the world's.
/// Link i turns at its origin about x (bend<i>_x), then y (bend<i>_y) and, with torsion, then z
/// (twist<i>). Cable j of the first section lies at azimuth (j − 1) 90°, so that cable1 makes
/// bend*_y positive and cable2 bend*_x negative. The next section has cables 5 to 8, and so on.
Mjcf AnnelidaArm(const AnnelidaParameters& p);
/// Its dry friction: joint_friction and cable_friction.
std::vector<EffectInstance> AnnelidaEffects(const AnnelidaParameters& p);

/// The robot's MJCF, hanging in a studio.
std::string AnnelidaMjcf(const AnnelidaParameters& p);

}  // namespace continuum
