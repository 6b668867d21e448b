#pragma once

#include <span>
#include <string>
#include <vector>

#include "binding/cable_friction.h"
#include "identification/sensitivity/force_derivatives.h"
#include "identification/sensitivity/number_tangents.h"

namespace continuum {

/// Friction of cables over contacts (CableFriction), to first order. Which bends slide, and which
/// way, is taken from what the law found for the end of the step, so that by the implicit function
/// theorem the changes of its tensions t_g and of x = q̇⁺ − q̇ obey
///
///   (M − h D)/h dx + Σ_g a_g (dt_g − dt_0) = dF − Σ_g (t_g − t_0) da_g                    (1)
///   dt_g = r_g dt_{g−1} + t_{g−1} dr_g − dy_g v_g⁺ − y_g dv_g⁺                             (2)
///
/// A bend that turned within the step after its part τ = v/(v − v₁) has r_g = τ/r + (1 − τ) r, r of
/// its new side. v₁ is its speed at the end of the step had it kept its old side: (1) and (2) give
/// dv₁ for that solution too.
///
/// with a_g = dL_g/dq, F the other forces less what x takes, r_g the ratio exp(± band) of a bend
/// that slides (y_g = 0), or exp(memory) of one at rest, which yields by y_g.
class CableDerivatives {
 public:
  /// parts: of the forces, as the integrator takes them.
  CableDerivatives(const mjModel& m, const ForceDerivatives::Parts& parts);

  /// The law of a step that has been taken; its states before the step; where its states and
  /// parameters are among those of all effects.
  struct Law {
    const CableFriction* law;
    const double* state;
    int first_state, first_parameter;
  };
  /// At the start of the step. pull: along tendons, of what is not native [ntendon]; given: forces
  /// of actuators (ForceDerivatives::Give).
  void Begin(const mjModel& m, const mjData& d, const Law& law, std::span<const double> pull,
             const std::vector<double>& given);
  /// The same for the solution that v₁ comes from, before that; where the law has turned bends.
  void BeginTurn(const mjModel& m, const mjData& d, const Law& law, std::span<const double> pull,
                 const std::vector<double>& given);
  /// dτ; other: dF of all other forces.
  void FollowTurn(const mjModel& m, const mjData& d, const NumberTangents& numbers,
                  const Tangents& other);
  /// Whether forces matter: a bend is at rest.
  bool rests() const { return rests_; }
  /// F, at q̇⁺ and x/h: Differ gives dF at the same x.
  const ForceDerivatives& derivatives() const { return derivatives_; }
  /// d of the law's force [nv]; other: dF of all other forces, ignored where nothing rests.
  const Tangents& Follow(const mjModel& m, const mjData& d, const NumberTangents& numbers,
                         const Tangents& other);
  /// Adds what the law's next states follow; constraint: d qfrc_constraint [nv].
  void AddNext(const mjModel& m, const Tangents& constraint, NumberTangents& numbers) const;

 private:
  using RowVector = Eigen::RowVectorXd;
  void FollowBands(const mjModel& m, const mjData& d, const NumberTangents& numbers);
  void FollowBand(int segment, const RowVector& theta, const NumberTangents& numbers);
  void FollowBases(const mjModel& m, const mjData& d, const NumberTangents& numbers);
  static void FollowPassive(const mjModel& m, const mjData& d, int tendon,
                            const NumberTangents& numbers, Eigen::Ref<RowVector> tension);
  void FollowRatios(const NumberTangents& numbers);
  void Take(const mjModel& m, const mjData& d, std::span<const double> change,
            std::span<const double> pull, const std::vector<double>& given);
  void FollowSpeed(std::size_t g, const NumberTangents& numbers);
  RowVector SpeedChange(std::size_t g, const std::vector<double>& speeds,
                        const NumberTangents& numbers) const;
  void AddCurvatures(const mjModel& m);
  Tangents AllTangents(const mjModel& m, const mjData& d, const NumberTangents& numbers,
                       const Tangents& other);
  Tangents FollowTensions(const mjModel& m, const mjData& d, Tangents other);
  double TensionOf(std::size_t g) const;
  void FollowShares();
  void FollowFade(const mjModel& m, const mjData& d, int cable, const NumberTangents& numbers);
  RowVector SlipChange(const mjData& d, int cable, int segment,
                       const NumberTangents& numbers) const;
  /// Calls fn(dof, dL/dq) of the moving segment of a bend.
  template <class Fn>
  void ForEachArm(std::size_t g, Fn&& fn) const;
  bool First(std::size_t g) const;
  int Place(int segment, int cable) const { return segment - law_.law->geometry().first[cable]; }

  Law law_{};
  std::span<const Bend> bends_;  ///< of the solution that is followed
  double give_way_ = 0;
  bool rests_ = false;
  ForceDerivatives derivatives_;
  std::vector<double> after_, rate_;              ///< q̇ + x, x/h
  Tangents band_, memory_, base_;                 ///< [segment], [segment], [cable]
  std::vector<double> ratio_, yield_;             ///< r_g, y_g
  Tangents ratio_change_, yield_change_, speed_;  ///< [bend] dr_g, dy_g, dv_g⁺ at the same x
  std::vector<double> speed_after_;               ///< v_g⁺
  Eigen::MatrixXd pulled_;                        ///< [nv, bend] dv_g/dq̇
  Tangents turned_;                               ///< [bend] dτ
  Tangents tension_, rho_;                        ///< [bend], [segment]
  Eigen::MatrixXd curvature_;                     ///< −Σ (t_g − t_0) ∂²L_g
  Tangents force_;
};

}  // namespace continuum
