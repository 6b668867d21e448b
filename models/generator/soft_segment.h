#pragma once

#include <string>

#include "effects/pcc_segment.h"
#include "models/generator/mjcf.h"

namespace continuum {

/// A soft segment with three chambers in numbers.
struct SoftSegment {
  PccSegmentLaw::Params<double> law;
  std::string actuation;  ///< one of the law's
  double mass;            ///< spread along it [kg]
  double lag;             ///< T_PT1 of the chambers [s]
  double supply;          ///< largest pressure [Pa]
  int links;              ///< N, even
  double rim, fibre;      ///< half thickness of the end plates and rings, only drawn [m]

  double length() const { return law[0]; }
  double radius() const { return law[1]; }  ///< drawn, the law's d
};

/// A soft segment as a chain of N links that share the bend and the stretch evenly.
///
/// Nodes k = 0 .. N lie at the fraction k/N of the length. Link k stretches by δL/N along its
/// parent's z (stretch<k>) and bends at its node by 1/N of the angle, half of that at both ends
/// (bend<k>_x, bend<k>_y, taken in turns first). The nodes of such a chain lie on one circle, at
/// N chords of length (L0 + δL)/N: on the arc itself up to (θ/2N)²/6. The mass is at the nodes with
/// Simpson's weights, m/(3N) (1, 4, 2, .., 4, 1), so that a straight chain has the mass, centre and
/// stretching inertia of a uniform line, and its bending inertia m L²/20 up to 0.7/N⁴. Hinges have
/// the armature (m/N)(L0/N)²/12, which adds 1.7/N⁴ to it; without any, links of point masses could
/// turn freely. Linear joint equalities keep the shares equal.
///
/// Names begin with the prefix: link<k>, p1 .. p3, tip (a site at the end), tip_pos (sensor).
class SoftChain {
 public:
  SoftChain(Mjcf& mjcf, const SoftSegment& segment, std::string prefix = "")
      : mjcf_(mjcf), s_(segment), n_(segment.links), prefix_(std::move(prefix)) {}

  /// From `base` on; its last link is returned.
  mjsBody* Add(mjsBody* base, const std::string& base_name);
  /// Sensors base_force and base_torque of what the mount exerts, at a site `base`.
  void AddWrench(mjsBody* base);

  EffectInstance Effect() const;
  EffectSensor Delta() const;
  std::string TipName() const { return Named("link", n_); }

 private:
  std::string Named(const std::string& stem, int i, const std::string& end = "") const {
    return prefix_ + stem + std::to_string(i) + end;
  }
  bool AtEnd(int k) const { return k == 0 || k == n_; }
  double Mass(int k) const { return s_.mass / (3 * n_) * (AtEnd(k) ? 1 : k % 2 == 1 ? 4 : 2); }
  mjsBody* AddLink(mjsBody* parent, int k);
  void Draw(mjsBody* link, int k, double pitch);
  void Couple();

  Mjcf& mjcf_;
  const SoftSegment& s_;
  int n_;
  std::string prefix_, base_;
};

/// Materials plate, fibre and silicone.
void AddSoftMaterials(Mjcf& mjcf);

}  // namespace continuum
