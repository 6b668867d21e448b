#pragma once

#include <limits>
#include <string>

#include "effects/pcc_segment.h"
#include "models/mjcf/mjcf_builder.h"

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
  /// s: how many times the body's own stiffness keeps the shares equal; infinite: they are equal.
  double evenness = std::numeric_limits<double>::infinity();

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
/// turn freely.
///
/// Constant curvature is enforced, s = ∞: linear joint equalities keep the shares equal. Or it is
/// free, s > 0: with the share w_k of link k in the sum X = Σ x_k of a coordinate (u, v or δL),
///
///   V = V_law(X) + s (k/2) Σ_k (x_k − w_k X)²/w_k,   damping alike with d, Σ_k w_k = 1         (1)
///
/// by fixed tendons over the joints; k, d: the law's k_theta d², d_theta d² or k_dL1, d_dL. Equal
/// shares cost nothing, so that s leaves the law alone. Because Σ x_k²/w_k = X² + Σ (x_k − w_k
/// X)²/w_k, s = 1 is the uniform elastic body: springs k/w_k in a row. The law's own cubic terms
/// stay on X. Uneven shares have the body's lag d/k at any s, and implicitfast takes dampers of
/// tendons implicitly: it is stable up to steps near 2 d/k, for s = 1 and many links somewhat
/// below.
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
  void Spread();
  void Spread(const std::string& stem, const std::string& axis, int first, double stiffness,
              double damping);

  Mjcf& mjcf_;
  const SoftSegment& s_;
  int n_;
  std::string prefix_, base_;
};

/// Materials plate, fibre and silicone.
void AddSoftMaterials(Mjcf& mjcf);

}  // namespace continuum
