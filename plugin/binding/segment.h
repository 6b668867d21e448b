#pragma once

#include <algorithm>

#include "binding/bound_law.h"
#include "effects/pcc_kinematics.h"

namespace continuum {

/// The joints between two bodies as one segment of constant curvature:
///
///   (u, v, δL) = Σ_j (a_y, −a_x, s_z) q_j                                      (1)
///
/// a [1] is the axis of a hinge, s that of a slide, in the axes of BASE with all joints at rest: u
/// [rad] bends the tip toward +x, v toward +y. The map is constant, so that its transpose takes the
/// segment's forces to the joints without further terms. The bends add up exactly about one axis;
/// about two they differ from the tip's rotation vector by second order in the bend of one link.
class Chain {
 public:
  /// The chain named by body="BASE TIP". Throws Error when TIP is not beyond BASE along its z, or
  /// for joints that are not hinges across or slides along the arm.
  Chain(const mjModel& m, const Config& config);

  /// Throws Error unless a length [m] under the key is that of the chain at rest.
  void RequireLength(const Config& config, std::string_view key, double length) const;
  /// Throws Error when another instance of the same law has a joint of this chain.
  void RequireItsOwn(const mjModel& m, const Config& config) const;

  /// (reference u, reference v, δL) [m] and its rate [m/s].
  Vec<double, 3> Positions(const mjModel& m, const mjData& d, double reference) const;
  Vec<double, 3> Velocities(const mjData& d, double reference) const;
  /// Adds how the sums of the joints' positions and speeds, scratch numbers 0 to 5, follow them,
  /// and how the joints' forces follow those on the sums, 6 to 8: the arc lengths without
  /// reference.
  void PutSums(LawSlopes& slopes) const;
  void PutForces(LawSlopes& slopes) const;
  /// Adds what a force [N] on these coordinates does to the joints.
  void Add(const Vec<double, 3>& on, double reference, std::span<double> force) const;

  /// A body of the chain; the first is BASE.
  struct Link {
    int body;
    Vec<double, 3> x, y;  ///< axes of BASE in those of the body, at rest
    /// World place of a point (x, y) of the section through the body's origin.
    void Point(const mjData& d, const Vec<double, 2>& at, double* world) const;
  };
  const std::vector<Link>& links() const { return links_; }

 private:
  struct Joint {
    int qpos, dof;
    double u, v, l;  ///< (1)
  };
  void AddJoint(const mjModel& m, const Config& config, int id, const double* to_base);
  Vec<double, 3> Sum(const double* q, const double* rest, int Joint::*index, double ref) const;

  std::vector<Joint> joints_;
  std::vector<Link> links_;
  double length_ = 0;  ///< from BASE to TIP at rest [m]
};

/// The actuators of the three chambers, in the order of the key "actuator". Throws Error unless
/// they are three, act on nothing else (gear 0), what ranges they have are of finite pressures from
/// a vacuum on (suction is below 0), gain and lag are no less than zero, and the control is a
/// pressure (dyntype none or a filter).
Vec<int, 3> MatchChambers(const mjModel& m, const Config& config);

/// What is in a chamber [Pa]: the actuator's force within its range.
double ChamberPressure(const mjModel& m, const mjData& d, int actuator);

/// Draws a chamber of the area [m²] through the links, blue at 0 and red at its largest pressure.
void DrawChamber(const mjModel& m, const mjData& d, const Chain& chain, const Vec<double, 2>& at,
                 double area, int actuator, mjvScene& scene);

/// A Segment law on a chain of links: three actuators say the pressures, the joints between BASE
/// and TIP feel the forces.
///
/// The forces are explicit in position and velocity, also under implicit integrators. What they act
/// on is the motion of the whole segment, not of a link: with damping d and inertia m of a
/// coordinate δ that is stable while h d/m < 2 and h √(k/m) < 2. For the published actuator at
/// h = 2 ms these are 0.06 and 0.13. Where only the joints' own constraints make the links move
/// together, these must be stiff.
template <SegmentLaw E>
class BoundSegment : public BoundLaw {
 public:
  BoundSegment(const mjModel& m, const Config& config)
      : BoundLaw(ReadParams<E>(config)),
        choice_(ChoiceOf(config)),
        chain_(m, config),
        chambers_(MatchChambers(m, config)) {
    chain_.RequireItsOwn(m, config);
    if constexpr (requires { E::kRestLength; })
      chain_.RequireLength(config, E::kParams[E::kRestLength].name, p_[E::kRestLength]);
  }
  static int StateSize(const mjModel&, const Config&) { return 0; }

  bool GivesForce() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double*, Stage stage,
                std::span<double> force) override {
    Vec<double, 3> pressure;
    for (int i = 0; i < 3; ++i) pressure[i] = ChamberPressure(m, d, chambers_[i]);
    if (stage == Stage::kActuator) {
      const int off = mjDSBL_SPRING | mjDSBL_DAMPER;
      if (pressure == pressure_ || (m.opt.disableflags & off) == off) return false;
    }
    pressure_ = pressure;
    const auto p = AsParams<E>(p_);
    std::fill(force.begin(), force.end(), 0.0);
    chain_.Add(E::template Eval<double>(chain_.Positions(m, d, Reference()),
                                        chain_.Velocities(d, Reference()), pressure, choice_, p),
               Reference(), force);
    return true;
  }

  std::string WhyNoSlopes(const mjModel&) const override { return ""; }

  // The joints' forces are a reference's, too, by which bends are arc lengths.
  void Differentiate(const mjModel& m, const mjData& d, const StepTaken& step,
                     LawSlopes& slopes) const override {
    using Kind = Number::Kind;
    constexpr std::size_t kN = 9 + kParamCount<E>;
    using T = Dual<kN>;
    const auto p = DualParams<kN>(AsParams<E>(p_), 9);
    const T reference = E::template Segment<T>(p).d;
    const auto bends = chain_.Positions(m, d, 1), rates = chain_.Velocities(d, 1);
    Vec<T, 3> delta, rate, pressure;
    Vec<Number, kN> by;
    for (std::size_t i = 0; i < 3; ++i) {
      delta[i] = (i < 2 ? reference : T(1)) * T(bends[i], i);
      rate[i] = (i < 2 ? reference : T(1)) * T(rates[i], 3 + i);
      pressure[i] = T(step.force[chambers_[i]], 6 + i);
      by[i] = {Kind::kScratch, static_cast<int>(i)};
      by[3 + i] = {Kind::kScratch, 3 + static_cast<int>(i)};
      by[6 + i] = {Kind::kActuator, chambers_[i]};
    }
    for (std::size_t i = 0; i < kParamCount<E>; ++i)
      by[9 + i] = {Kind::kParameter, static_cast<int>(i)};
    const Vec<T, 3> force = E::template Eval<T>(delta, rate, pressure, choice_, p);
    chain_.PutSums(slopes);
    for (std::size_t i = 0; i < 3; ++i) {
      const T on = (i < 2 ? reference : T(1)) * force[i];
      Put(slopes.forces, {Kind::kScratch, 6 + static_cast<int>(i)}, on, by);
    }
    chain_.PutForces(slopes);
    slopes.scratch = 9;
  }

  std::string_view SensorPlace(const mjModel&, mjtObj kind, int) const override {
    return kind == mjOBJ_UNKNOWN ? "" : "no object";
  }
  void Sense(const mjModel& m, const mjData& d, int, std::span<double> out) const override {
    const auto delta = chain_.Positions(m, d, Reference());
    std::copy(delta.begin(), delta.end(), out.begin());
  }

  void Visualize(const mjModel& m, const mjData& d, mjvScene& scene) const override {
    if constexpr (requires { E::template Chambers<double>(AsParams<E>(p_)); }) {
      const auto chambers = E::template Chambers<double>(AsParams<E>(p_));
      for (int i = 0; i < 3; ++i) {
        DrawChamber(m, d, chain_, PccChamber(chambers, i), chambers.A, chambers_[i], scene);
      }
    }
  }
  void CopyFrom(const BoundLaw& other) override {
    pressure_ = static_cast<const BoundSegment&>(other).pressure_;
  }

 private:
  static int ChoiceOf(const Config& config) {
    return ChoicesOf<E>().empty() ? 0 : config.Read(ChoicesOf<E>()[0]);
  }
  double Reference() const { return E::template Segment<double>(AsParams<E>(p_)).d; }

  int choice_;
  Chain chain_;
  Vec<int, 3> chambers_;
  Vec<double, 3> pressure_{};  ///< at the last evaluation
};

}  // namespace continuum
