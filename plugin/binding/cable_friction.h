#pragma once

#include "binding/bound.h"
#include "binding/cable.h"
#include "binding/sliding.h"

namespace continuum {

/// Spatial tendons whose tension changes from contact to contact. The native tendon carries the
/// base tension t_0 all along; this adds −Σ_k (t_k − t_0) dL_k/dq.
///
/// The friction is found once all other forces are known (kAnswer), for the end of the step; what
/// constraints do is taken from the last step. In kPassive, all that mj_inverse calls, every
/// contact keeps the ratio of the last answer.
///
/// States, as the last step left them: ρ = log(t_k/t_{k−1}) of the contact in front of each
/// segment, for the first segment of a cable t_0 instead; and the constraint forces. Several
/// instances see each other's states.
class CableFriction : public Bound {
 public:
  CableFriction(const mjModel& m, const Config& config, std::vector<double> parameters);

  // In nstate the tendons' paths are not known yet: the model's wrap points bound the contacts.
  static int StateSize(const mjModel& m, const Config&) {
    return static_cast<int>(m.nwrap) + static_cast<int>(m.nv);
  }

  bool GivesForce() const override { return true; }
  bool Answers() const override { return true; }
  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double> force) override;
  void Advance(const mjModel& m, const mjData& d, double* z) override;

  std::string_view SensorPlace(const mjModel&, mjtObj kind, int id) const override;
  void Sense(const mjModel&, const mjData&, int site, std::span<double> out) const override {
    out[0] = tension_[Index(site)];
  }
  void Visualize(const mjModel& m, const mjData& d, mjvScene& scene) const override;
  void CopyFrom(const Bound& other) override;

 protected:
  /// Largest |ρ| at a wrap angle.
  virtual double Band(double theta) const = 0;

 private:
  // Contacts [begin, end) of a cable, counted over all cables, that slide together.
  struct Group {
    int cable, segment, begin, end;
  };
  void Locate(const mjModel& m, const mjData& d);
  void Remember(const double* z);
  void Solve(const mjModel& m, mjData& d, const double* z);
  void Spread(const Group& group, double rho, const double* z);
  void Add(std::span<double> force);
  int Index(int site) const;

  std::vector<Cable> cables_;
  std::vector<int> first_;  ///< segment of each cable, counted over all cables
  std::vector<Group> groups_;
  Sliding sliding_;
  std::vector<CableGeometry> geometry_;
  std::vector<double> band_, rho_, ratio_, tension_;  ///< per segment: of its front contact; [N]
  std::vector<double> base_, last_;                   ///< t_0 of each cable, now and before [N]
  std::vector<double> force_;
  std::vector<Bend> bends_;
  std::vector<int> active_;  ///< group of each bend
};

}  // namespace continuum
