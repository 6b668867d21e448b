#pragma once

#include <algorithm>
#include <cmath>

#include "binding/bound.h"
#include "binding/cable.h"

namespace continuum {

/// How a contact at rest keeps its tension ratio, and how fast it lets go.
///
/// The state of a contact is ρ = log(T_i/T_{i−1}), |ρ| ≤ band. In an evaluation at sliding speed v
///
///   ρ(v) = clamp(ρ − band (v/v_c + g(v)), ±band)                        (1)
///   ρ_next = clamp(ρ − β band (v/v_c + g(v)), ±band)                    (2)
///
/// (1) is a damper that reaches the band at v_c, (2) a spring behind it, so that a load is held
/// without creep. g rises to ±2 between 10 and 20 mm/s: beyond that a contact slides fully whatever
/// its memory. v_c is 5 mm/s, more where the step h could not carry that slope:
/// v_c = max(5 mm/s, 1.5 h · compliance · T · band). With h → 0 the contact becomes rigid.
///
/// A sharp bend holds ratios far beyond e, any ratio when it locks: at that band (1) and (2) are
/// stiffer than a step can carry. Above the ratio e the held tension T_i = T_{i−1} exp(ρ) therefore
/// changes no faster than by damper and spring at that limit, and the more ρ exceeds 1 (from 2 on
/// fully) the less it grows with T_{i−1}:
///
///   |T_i(v) − T_i| ≤ κ |v|/(h · compliance),   κ = 2/3                  (3)
///   |T_i,next − T_i| ≤ β κ |v|/(h · compliance)                         (4)
///
/// so that friction brakes a contact within a step or more and never throws it back. Ratios are all
/// the memory there is: a locked contact behind which the tension falls to nothing lets go.
struct Grip {
  static constexpr double kSlow = 5e-3, kRampBegin = 0.010, kRampEnd = 0.020, kSpring = 0.2,
                          kFree = 1, kBrake = 2.0 / 3;

  /// v_c [m/s].
  static double Slope(double band, double tension, double compliance, double h) {
    return std::max(kSlow, 1.5 * h * compliance * tension * band);
  }
  /// The argument of (1) and (2): v/v_c + g(v).
  static double Travel(double v, double v_c) {
    const double x = std::clamp((std::abs(v) - kRampBegin) / (kRampEnd - kRampBegin), 0.0, 1.0);
    return v / v_c + std::copysign(2 * x * x * (3 - 2 * x), v);
  }
  static double Held(double rho, double band, double travel) {
    return std::clamp(rho - band * travel, -band, band);
  }
  static double Next(double rho, double band, double travel) {
    const double all = Held(rho, band, travel);
    return std::abs(all) < band || std::abs(travel) < 1 ? Held(rho, band, kSpring * travel) : all;
  }
  /// Bound of (3) on the ratio T_i/T_{i−1}.
  static double Reach(double v, double tension, double compliance, double h) {
    const double stiff = h * compliance * tension;
    return stiff > 0 ? kBrake * std::abs(v) / stiff : kInfinity;
  }
  /// The wanted ρ as near as a change of the ratio by `reach` comes to it from rho.
  static double Within(double rho, double wanted, double reach) {
    if (std::max(rho, wanted) <= kFree) return wanted;
    const double ratio = std::exp(rho), free = std::exp(kFree);
    const double lowest = ratio - reach > free ? std::log(ratio - reach) : wanted;
    return std::min(std::max(wanted, lowest), std::log(std::max(ratio, free) + reach));
  }
  /// ρ > kFree of a contact whose T_{i−1} has become `now` since it was `before`: one far beyond
  /// kFree keeps its tension where one below keeps its ratio.
  static double Carried(double rho, double before, double now) {
    if (now <= before) return rho;
    return before > 0 ? rho + std::min(rho - kFree, 1.0) * std::log(before / now) : kFree;
  }
};

/// The spatial tendons of an instance, cut into cables.
std::vector<Cable> MatchCables(const mjModel& m, const Config& config);

/// Draws the cables' segments, coloured by tension: blue 0, red at full.
void DrawCables(const mjModel& m, const mjData& d, std::span<const Cable> cables,
                std::span<const double> tension, double full, mjvScene& scene);

/// A Path law on spatial tendons: the tension changes from contact to contact. The native tendon
/// carries the base tension T_0 all along; this adds −Σ_k (T_k − T_0) dL_k/dq.
template <PathLaw E>
class BoundPath : public Bound {
 public:
  BoundPath(const mjModel& m, const Config& config)
      : Bound(ReadParams<E>(config)),
        cables_(MatchCables(m, config)),
        geometry_(cables_.size()),
        wrenches_(m, cables_),
        law_(config.Read(E::kChoices[0])) {
    std::size_t segments = 0;
    for (const Cable& cable : cables_) segments += cable.segments();
    tension_.assign(segments, 0);
    contacts_.assign(segments, {});
  }

  // In nstate the tendons' paths are not known yet: the model's wrap points bound the contacts.
  static int StateSize(const mjModel& m, const Config&) { return static_cast<int>(m.nwrap); }

  bool GivesForce() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double> force) override {
    if (stage == Stage::kPassive) {
      for (std::size_t c = 0; c < cables_.size(); ++c) geometry_[c].Update(m, d, cables_[c]);
    } else if ((m.opt.disableflags & mjDSBL_SPRING) && (m.opt.disableflags & mjDSBL_DAMPER)) {
      return false;  // MuJoCo applies no passive forces then
    }
    const auto p = AsParams<E>(p_);
    int s = 0;
    bool changed = stage == Stage::kPassive;
    for (std::size_t c = 0; c < cables_.size(); ++c) {
      const double base = std::max(0.0, BaseTension(m, d, cables_[c]));
      changed |= base != tension_[s];
      Tensions(m, cables_[c], geometry_[c], base, z + s, s, stage, p);
      s += cables_[c].segments();
    }
    if (!changed) return false;
    s = 0;
    for (std::size_t c = 0; c < cables_.size(); ++c) {
      if (tension_[s] > 0) wrenches_.Add(m, cables_[c], geometry_[c], tension_.data() + s);
      s += cables_[c].segments();
    }
    wrenches_.Collect(m, d, force);
    return true;
  }

  // The states of a cable: its base tension, then ρ of every contact.
  void Advance(const mjModel&, const mjData&, double* z) override {
    int s = 0;
    for (const Cable& cable : cables_) {
      z[s] = tension_[s];
      for (int k = s + 1; k < s + cable.segments(); ++k) {
        const Contact& c = contacts_[k];
        const double next = Grip::Next(c.rho, c.band, c.travel);
        z[k] = Grip::Within(c.rho, next, Grip::kSpring * c.reach);
      }
      s += cable.segments();
    }
  }

  std::string_view SensorPlace(const mjModel&, mjtObj kind, int id) const override {
    const bool known = kind == mjOBJ_SITE && Index(id) >= 0;
    return known ? "" : "objtype=\"site\" and a site of the tendons";
  }
  void Sense(const mjModel&, const mjData&, int site, std::span<double> out) const override {
    out[0] = tension_[Index(site)];
  }
  void Visualize(const mjModel& m, const mjData& d, mjvScene& scene) const override {
    DrawCables(m, d, cables_, tension_, full_, scene);
  }
  void CopyFrom(const Bound& other) override {
    const auto& from = static_cast<const BoundPath&>(other);
    geometry_ = from.geometry_;
    tension_ = from.tension_, contacts_ = from.contacts_;
  }
  /// Tension [N] of every segment, cable after cable, at the last evaluation.
  const std::vector<double>& tension() const { return tension_; }

 private:
  // What is known of the site in front of a segment.
  struct Contact {
    double band = 0, v_c = 0, travel = 0, rho = 0, reach = 0, ratio = 1;
  };

  // Tensions of one cable from its base on; slack cables carry none. Within one evaluation only the
  // base tension changes, and what does not depend on it is kept.
  void Tensions(const mjModel& m, const Cable& cable, const CableGeometry& at, double base,
                const double* z, int s, Stage stage, const ParamsOf<E, double>& p) {
    tension_[s] = base;
    double grown = 0;  // logarithm of (tension before the contact)/(base tension), as remembered
    for (int i = 1; i < cable.segments(); ++i) {
      Contact& c = contacts_[s + i];
      if (stage == Stage::kPassive) c.band = E::template Band<double>(at.theta[i], law_, p);
      const double v_c = Grip::Slope(c.band, base, cable.compliance, m.opt.timestep);
      if (stage == Stage::kPassive || v_c != c.v_c || c.band > Grip::kFree) {
        const double tension = tension_[s + i - 1];
        c.v_c = v_c;
        c.travel = Grip::Travel(at.slip[i], v_c);
        c.rho = z[i];
        if (z[i] > Grip::kFree) c.rho = Grip::Carried(z[i], z[0] * std::exp(grown), tension);
        c.reach = Grip::Reach(at.slip[i], tension, cable.compliance, m.opt.timestep);
        const double held = Grip::Held(c.rho, c.band, c.travel);
        c.ratio = c.band > 0 ? std::exp(Grip::Within(c.rho, held, c.reach)) : 1;
      }
      tension_[s + i] = tension_[s + i - 1] * c.ratio;
      grown += z[i];
    }
  }

  // The segment just distal of a site; the last one for the end of a cable.
  int Index(int site) const {
    int s = 0;
    for (const Cable& cable : cables_) {
      for (int k = 0; k <= cable.segments(); ++k) {
        if (cable.sites[k] == site) return s + std::min(k, cable.segments() - 1);
      }
      s += cable.segments();
    }
    return -1;
  }

  std::vector<Cable> cables_;
  std::vector<CableGeometry> geometry_;
  BodyWrenches wrenches_;
  int law_;
  double full_ = 20;
  std::vector<double> tension_;    ///< per segment [N]
  std::vector<Contact> contacts_;  ///< per segment, of its first site
};

}  // namespace continuum
