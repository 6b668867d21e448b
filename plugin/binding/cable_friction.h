#pragma once

#include "binding/bound.h"
#include "binding/cable_geometry.h"
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
  /// Largest |ρ| at each wrap angle.
  virtual void Bands(std::span<const double> theta, std::span<double> band) const = 0;

 private:
  // Contacts [begin, end) of a cable that slide together, as segment end − 1 does.
  struct Group {
    int cable, begin, end;
  };
  void Remember(const double* z);
  void Solve(const mjModel& m, mjData& d, const double* z);
  bool Collect(const double* z);
  void Share(const double* z);
  void Spread(const Group& group, double rho, const double* z);
  void Add(std::span<double> force);
  int Index(int site) const;

  std::vector<Cable> cables_;
  CableGeometry geometry_;
  std::vector<Group> groups_;
  Sliding sliding_;
  std::vector<double> band_, grown_;           ///< per segment: of its front contact, and exp of it
  std::vector<double> rho_, ratio_, tension_;  ///< ρ, exp of it; behind the contact [N]
  std::vector<double> base_, last_;            ///< t_0 of each cable, now and before [N]
  std::vector<double> force_;
  std::vector<Bend> bends_;  ///< [groups], of which the first count_ are those of tight cables
  std::vector<int> active_;  ///< [groups] group of each bend
  std::size_t count_ = 0;
};

}  // namespace continuum
