#pragma once

#include "binding/bound_law.h"
#include "binding/cable_geometry.h"
#include "binding/cable_sliding.h"
#include "binding/tension_row.h"

namespace continuum {

/// Spatial tendons whose tension changes from contact to contact. The native tendon carries the
/// base tension t_0 all along; this adds −Σ_k (t_k − t_0) dL_k/dq. Contacts are interior sites and
/// wrapped geoms; behind a pulley t_0 is the tendon's tension by the divisor, and each branch is a
/// cable of its own.
///
/// t_0 is all that pulls the tendon: actuators, spring and damper, and length limits and equalities
/// (TensionRows), which are solved together with the friction. It is the tension at the first site,
/// the last (key driven="last"), or at both ends ("both"): such a cable runs along itself until
/// friction leaves it there.
///
/// The friction is found once all other forces are known (kAfterAll), for the end of the step. In
/// kPassive, all that mj_inverse calls, every contact keeps the ratio of the last answer.
///
/// Contacts are solved together with the friction too: all rows of pyramidal and frictionless ones,
/// the normal force of elliptic ones. MuJoCo finds the forces of all other rows (joint limits, dry
/// friction, closed loops, the tangential forces of elliptic contacts) afterwards, so those of the
/// last step stand in for them. This costs where they change at once: contacts of a cable at rest
/// may give way for that step. At 2 ms, 10 g to 1 kg pressed against a joint's stop with 3 to 15 N
/// more or less of load moved by less than 1e-6 m; at 0.5 and 1 ms some of these changes broke
/// contacts away, by 1e-5 m and once by 1.2e-3 m (10 g). An arm of ten links of 5 g pulled against
/// its joint limits is 3.5e-4 rad (rms) off at 2 ms against 50 us; 1.6e-4 without limits, 1.2e-4
/// without friction, and all shrink with the step.
///
/// The order of RK4 is lost with cable friction: the answer for the end of a step, also in its
/// stages, is of first order in the step. Against small steps of the five-link snake arm its rms
/// error is 0.05 to 1.2 times that of implicitfast in six motions (releases, steps, a ramp, a sine;
/// 0.25 to 2 ms), without joint friction up to 2.8 times in a slow ramp at 0.5 ms. Keeping the
/// first stage's answer in the others does not mend it (2.6).
///
/// States, as the last step left them: ρ = log(t_k/t_{k−1}) of the contact in front of each
/// segment, for the first segment of a cable t_0 instead; and the forces of the other rows. A slack
/// cable keeps them while it lies still, so that a step without tension forgets nothing. As it runs
/// past a contact its |ρ| falls, to 0 where what is remembered would have built up again (give).
/// Several instances see each other's states.
class CableFriction : public BoundLaw {
 public:
  CableFriction(const mjModel& m, const Config& config, std::vector<double> parameters);

  // In nstate the tendons' paths are not known yet: the model's wrap points bound the contacts.
  static int StateSize(const mjModel& m, const Config&) {
    return static_cast<int>(m.nwrap) + static_cast<int>(m.nv);
  }

  bool GivesForce() const override { return true; }
  bool NeedsAllForces() const override { return true; }
  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double> force) override;
  void Advance(const mjModel& m, const mjData& d, double* z) override;

  /// As a differential equation each contact is a bristle (bristle.h) over the sliding of the
  /// cable, and hands on t_k = t_{k−1} exp(−band u): it gives by `give`, else by Bristle::kGive,
  /// before it slides. The states of contacts are deflections then, and Evaluate must not add
  /// friction of its own: whoever integrates sets its parameters to their null in between.
  std::string WhyNoBristles(const mjModel&) const override;
  std::vector<int> BristleStates() const override;
  void Bristles(const mjModel&, const mjData&, const double* z, double* rate,
                std::span<double> force) const override;

  std::string_view SensorPlace(const mjModel&, mjtObj kind, int id) const override;
  void Sense(const mjModel& m, const mjData&, int sensor, std::span<double> out) const override {
    out[0] = tension_[Index(static_cast<mjtObj>(m.sensor_objtype[sensor]), m.sensor_objid[sensor])];
  }
  std::string WhyIdle(const mjModel& m) const override;
  void PointForces(const mjModel&, const mjData& d, const TakeForce& take) const override;
  /// Red is DrawRedAt's tension, without it the largest one since the law was bound.
  void Visualize(const mjModel& m, const mjData& d, mjvScene& scene) const override;
  double LargestTension() const override;
  void DrawRedAt(double tension) override { red_at_ = tension; }
  void CopyFrom(const BoundLaw& other) override;

  /// Contacts [begin, end) of a cable that slide together, as segment end − 1 does.
  struct Group {
    int cable, begin, end;
  };
  // What the last evaluation found.
  std::string WhyNoSlopes(const mjModel&) const override;
  const std::vector<Cable>& cables() const { return cables_; }
  const CableGeometry& geometry() const { return geometry_; }
  const CableSliding& sliding() const { return sliding_; }
  /// Of tight cables, in their order, and their contacts.
  std::span<const Bend> bends() const { return {bends_.data(), count_}; }
  const Group& group(std::size_t bend) const { return groups_[active_[bend]]; }
  /// Largest |ρ| at the contact in front of each segment.
  const std::vector<double>& band() const { return band_; }
  /// Tension of each cable at its base [N].
  const std::vector<double>& base() const { return base_; }
  /// Which parameter is the sliding over which friction builds up [m]; −1: none.
  virtual int GiveParameter() const { return -1; }
  double Give() const { return GiveParameter() < 0 ? 0 : p_[GiveParameter()]; }
  /// How a band follows the wrap angle and the parameters.
  virtual void BandSlopes(double theta, double& by_theta, std::span<double> by_parameter) const = 0;

 protected:
  /// Largest |ρ| at each wrap angle.
  virtual void Bands(std::span<const double> theta, std::span<double> band) const = 0;

 private:
  void RunAlong(std::span<double> slip) const;
  void Remember(const double* z);
  void Solve(const mjModel& m, mjData& d, const double* z);
  bool Collect(const double* z);
  void Share(const double* z);
  void Fade(const mjModel& m, int cable, double* z) const;
  void Spread(const Group& group, double rho, const double* z);
  void Add(std::span<double> force);
  int Index(mjtObj kind, int id) const;
  void FindRows(const mjModel& m, mjData& d, const double* z, Stage stage);

  std::vector<Cable> cables_;
  std::string doubts_;  ///< what the user should know of the routes
  TensionRows tension_rows_;
  CableGeometry geometry_;
  std::vector<Group> groups_;
  CableSliding sliding_;
  std::vector<bool> trees_;              ///< [ntree] that a cable moves
  std::vector<double> band_, grown_;     ///< per segment: of its front contact, and exp of it
  std::vector<double> rho_, ratio_;      ///< ρ, exp of it
  mutable std::vector<double> tension_;  ///< behind the contact [N]; of Bristles too
  std::vector<double> native_;           ///< t_0 of each cable but for constraints [N]
  std::vector<double> base_, last_;      ///< t_0 of each cable, now and before [N]
  std::vector<double> answer_;           ///< base_ as last solved for; −1: never
  SolvedRows rows_;
  std::vector<double> force_;
  std::vector<Bend> bends_;  ///< [groups], of which the first count_ are those of tight cables
  std::vector<int> active_;  ///< [groups] group of each bend
  std::size_t count_ = 0;
  double red_at_ = 0, largest_ = 0;  ///< tension drawn red, 0: the largest so far [N]
};

}  // namespace continuum
