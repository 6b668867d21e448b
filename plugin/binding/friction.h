#pragma once

#include <algorithm>
#include <optional>

#include "binding/bound_law.h"
#include "binding/friction_row.h"
#include "binding/gear_load.h"
#include "binding/native_damping.h"

namespace continuum {

/// Friction rows that hold.
///
/// MuJoCo makes a row where frictionloss > 0. A row of ours gets kRowMarker there (once, in Impose;
/// a saved model prints it as 0) and in each evaluation its level; on top the position anchor that
/// stops the solver's creep:
///
///   efc_aref = −B v − K (q − anchor),   K = 1/(2h)², B = 1/h                (1)
///
/// It gives way by h² (1 − d) (1 + 4/d²) τ/I under a load τ on an inertia I. Rows with
/// MuJoCo's default impedance get d = 0.99 in each evaluation (efc_R, efc_D and efc_KBIP; under the
/// discrete integrator in the model), its own 0.9 to 0.95 would be ten times softer and let a
/// sudden load overshoot by 7 %.
///
/// While |efc_force| has reached the level the anchor moves with q, at the distance at which the
/// row would hold that force at rest:
///
///   anchor = q − x,   x = −R efc_force/(K d)                                (2)
///
/// (K, d, R: stiffness, impedance, regularization of the row), so that a joint that comes to rest
/// under load stays there. Source: MuJoCo's constraint model.
///
/// Who writes another pose (a slider of a viewer, a reset) takes the anchor along: friction starts
/// no motion. A pose is another one where q − anchor has changed since the end of the last step by
/// more than 2 h |v| + 1e-5 rad or m.
///
/// A law at its null on a joint with a native frictionloss leaves that row to MuJoCo.
///
/// A row that held in the last step has the level of v = 0, whatever the speed of its elastic
/// deflection: a sudden load breaks it away as a slow one does.
///
/// The three rows of a ball joint share one level. While it slides they split it by the direction
/// of ω. While it rests each of them can take a share of it that follows, within a few hundredths
/// of a second,
///
///   max |f_i|/|f|  where |f| > level,  else 1                                 (3)
///
/// so that a load breaks it away at the same torque in all directions. The three states of a row
/// are {Grasp, anchor, q − anchor as the step ended}; a ball joint has nine numbers, {Grasp,
/// quaternion, share, rotation from the anchor as the step ended}.
class FrictionRows {
 public:
  /// Joints or tendons named in config.
  FrictionRows(const mjModel& m, const Config& config, Joints types, int instance);
  static int StateSize(const mjModel& m, const Config& config, Joints types);

  const std::vector<FrictionRow>& rows() const { return rows_; }
  void Impose(mjModel& m) const;
  /// Calls level(row, v) → torque for each row that exists at d, and writes it. v: speed of
  /// sliding. null: the law is at its null.
  template <class Level>
  void Write(const mjModel& m, mjData& d, const double* z, Stage stage, bool null,
             Level&& level) const {
    int r = d.ne;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const FrictionRow& row = rows_[k];
      if ((null && IsNative(m, row)) || !Find(d, row, r)) continue;
      const double off = OffAnchor(m, d, z + kStates * k, row);
      const Sliding sliding = SlidingOf(d, z + kStates * k, row);
      WriteRow(m, d, off, stage, row, r, sliding.share * level(row, sliding.v));
    }
  }
  void Advance(const mjModel& m, const mjData& d, double* z) const;

  /// Why Differentiate does not know these rows ("a ball joint"); empty: it does.
  std::string WhyNoSlopes(const mjModel& m) const;
  /// Adds the slopes of anchors, and calls level(row, r, v, moves) for each row that exists: it is
  /// constraint r, v: speed of sliding, which follows the state where it moves.
  template <class Level>
  void Differentiate(const mjData& d, const StepTaken& step, LawSlopes& slopes,
                     Level&& level) const {
    int r = d.ne;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (!Find(d, rows_[k], r)) continue;
      const double* const z = step.z + kStates * k;
      DifferentiateAnchor(d, rows_[k], r, z[0], static_cast<int>(kStates * k + 1), slopes);
      level(rows_[k], r, SlidingOf(d, z, rows_[k]).v, z[0] != kHeld);
    }
  }

 private:
  static constexpr std::size_t kStates = 3;  ///< of a row
  /// Grasp: what a row did in the last step.
  static constexpr double kUnknown = 0, kHeld = 1, kSlid = 2;
  /// Speed of sliding, and the share of the level that falls to this row.
  struct Sliding {
    double v, share;
  };
  static double Speed(const mjData& d, const FrictionRow& row) {
    return row.joint ? d.qvel[row.index] : d.ten_velocity[row.index];
  }
  static Sliding SlidingOf(const mjData& d, const double* z, const FrictionRow& row);

  /// Moves r (ascending over calls) to the row's constraint; false when it has none.
  static bool Find(const mjData& d, const FrictionRow& row, int& r);
  static void WriteRow(const mjModel& m, mjData& d, double off, Stage stage, const FrictionRow& row,
                       int r, double level);
  /// Whether MuJoCo alone has friction there, if this law has none.
  static bool IsNative(const mjModel& m, const FrictionRow& row);
  /// As an impedance of kImpedance makes it, where the model has MuJoCo's default.
  static void Harden(const mjModel& m, mjData& d, const FrictionRow& row, int r);
  /// Whether a change of q − anchor since the end of the last step is none of the motion's.
  static bool IsAnotherPose(const mjModel& m, const mjData& d, const FrictionRow& row,
                            double change);
  /// q − anchor; 0 before the first step.
  static double OffAnchor(const mjModel& m, const mjData& d, const double* z,
                          const FrictionRow& row);
  /// States of the row or of the three rows of a ball joint that begin at `rows`.
  /// state: number of the anchor; grasp: of the last step.
  static void DifferentiateAnchor(const mjData& d, const FrictionRow& row, int r, double grasp,
                                  int state, LawSlopes& slopes);
  static void AdvanceLine(const mjModel& m, const mjData& d, const FrictionRow& row, double* z,
                          int& r);
  static void AdvanceBall(const mjModel& m, const mjData& d, const FrictionRow* rows, double* z,
                          int& r);

  std::vector<FrictionRow> rows_;
};

/// Position of a row's joint or tendon.
inline double PositionOf(const mjModel& m, const mjData& d, const FrictionRow& row) {
  return row.joint ? d.qpos[m.jnt_qposadr[row.id]] : d.ten_length[row.index];
}

/// What the level of a row follows: position, speed, torque of the load, P parameters.
template <std::size_t P>
std::array<Number, 3 + P> NumbersOf(const FrictionRow& row, int load) {
  using Kind = Number::Kind;
  std::array<Number, 3 + P> numbers;
  numbers[0] = {row.joint ? Kind::kPosition : Kind::kLength, row.index};
  numbers[1] = {row.joint ? Kind::kSpeed : Kind::kRate, row.index};
  numbers[2] = {load == 0 ? Kind::kTorqueTransmitted : Kind::kTorqueActuator, row.index};
  for (std::size_t i = 0; i < P; ++i) numbers[3 + i] = {Kind::kParameter, static_cast<int>(i)};
  return numbers;
}

/// A Friction law on joints or tendons, as rows.
template <FrictionLaw E>
class BoundFriction : public BoundLaw {
 public:
  BoundFriction(const mjModel& m, const Config& config, int instance)
      : BoundLaw(ReadParams<E>(config)), rows_(m, config, JointsOf<E>(), instance) {
    if constexpr (kLoaded) load_ = config.Read(E::kChoices[0]);
    if constexpr (kDamped) {
      damping_.emplace(PluginName(E::kName), E::kParams[E::kDamping].name, p_[E::kDamping]);
    }
    if constexpr (requires { E::kLiteral; }) {
      const std::string name(E::kParams[E::kLiteral].name);
      if (!config.Get(name).empty()) idle_ = name + " does nothing: a row holds at rest";
    }
  }
  static int StateSize(const mjModel& m, const Config& config) {
    return FrictionRows::StateSize(m, config, JointsOf<E>());
  }

  bool IsRow() const override { return true; }
  bool GivesForce() const override { return kBiased; }
  std::string WhyIdle(const mjModel&) const override { return idle_; }

  void Impose(mjModel& m) const override {
    rows_.Impose(m);
    if constexpr (kDamped) damping_->Impose(m, rows_.rows(), p_[E::kDamping]);
  }

  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double> force) override {
    const auto p = AsParams<E>(p_);
    if constexpr (kBiased) std::fill(force.begin(), force.end(), 0.0);
    rows_.Write(m, d, z, stage, IsNull(), [&](const FrictionRow& row, double v) {
      FrictionState<double> r{0, v, 0};
      if (!row.joint) r.q = d.ten_length[row.index];
      if (row.joint && row.axis < 0) r.q = d.qpos[m.jnt_qposadr[row.id]];
      if constexpr (kLoaded) r.load = GearLoad(m, d, row.index, load_);
      if constexpr (kBiased) force[row.index] = E::template Bias<double>(p);
      return E::template Level<double>(r, p);
    });
    return kBiased;
  }

  void Advance(const mjModel& m, const mjData& d, double* z) override { rows_.Advance(m, d, z); }

  std::string WhyNoSlopes(const mjModel& m) const override { return rows_.WhyNoSlopes(m); }

  void Differentiate(const mjModel& m, const mjData& d, const StepTaken& step,
                     LawSlopes& slopes) const override {
    constexpr std::size_t kN = 3 + kParamCount<E>;
    using T = Dual<kN>;
    const auto p = DualParams<kN>(AsParams<E>(p_), 3);
    rows_.Differentiate(d, step, slopes, [&](const FrictionRow& row, int r, double v, bool moves) {
      FrictionState<T> at{T(PositionOf(m, d, row), 0), moves ? T(v, 1) : T(v), T(0)};
      double sign = 1;
      if constexpr (kLoaded) {
        const double torque = GearTorque(m, d, row.index, load_);
        at.load = T(LoadOf(torque, load_), 2), sign = torque < 0 ? -1 : 1;
      }
      auto by = NumbersOf<kParamCount<E>>(row, load_);
      Dual<kN> level = E::template Level<T>(at, p);
      level.d[2] *= sign * LoadOf(1, load_);
      Put(slopes.levels, {Number::Kind::kLevel, r}, level, by);
      if constexpr (kBiased)
        Put(slopes.forces, {Number::Kind::kForce, row.index}, E::template Bias<T>(p), by);
    });
  }

 private:
  static constexpr bool kLoaded = ChoicesOf<E>().size() > 0;
  static constexpr bool kDamped = requires { E::kDamping; };
  static constexpr bool kBiased = BiasedFrictionLaw<E>;
  static_assert(!kBiased || (E::kPlaces.size() == 1 && E::kPlaces[0] == Place::kJoint));

  // Whether the law does nothing: no level in any direction, at any load, all around a turn.
  bool IsNull() const {
    const auto p = AsParams<E>(p_);
    if constexpr (kBiased) {
      if (E::template Bias<double>(p) != 0) return false;
    }
    for (const double q : {0.0, 2.0, -2.0}) {
      for (const double v : {0.0, 1.0, -1.0}) {
        for (const double load : {0.0, 1.0}) {
          if (E::template Level<double>({q, v, load}, p) != 0) return false;
        }
      }
    }
    return true;
  }

  FrictionRows rows_;
  int load_ = 0;
  std::string idle_;  ///< which parameter of the MJCF does not act
  std::optional<NativeDamping> damping_;
};

}  // namespace continuum
