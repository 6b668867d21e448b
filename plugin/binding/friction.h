#pragma once

#include <algorithm>
#include <optional>

#include "binding/actuator_force.h"
#include "binding/bound_law.h"
#include "binding/bristle.h"
#include "binding/friction_row.h"
#include "binding/gear_load.h"
#include "binding/native_damping.h"
#include "mujoco_compat.h"

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
/// MuJoCo's default impedance get another one in each evaluation (efc_R, efc_D and efc_KBIP; under
/// the discrete integrator in the model), its own 0.9 to 0.95 would be ten times softer and let a
/// sudden load overshoot by 7 %. Held joints are springs, whose stiffness follows the inertia of
/// each joint by itself; the inertia that swings on n of them, one behind the other, grows with the
/// third power of n. So
///
///   1 − d = 0.01 min(1, (10/n)³), not less than 1e-5                        (4)
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
/// A law at its null on a joint with a native frictionloss leaves that row to MuJoCo, and so does a
/// formula where its level is 0.
///
/// A row that held in the last step has the level of v = 0, whatever the speed of its elastic
/// deflection: a sudden load breaks it away as a slow one does. The first step has none before it:
/// there the later stages of RK4 take a row for one at rest that is no faster than a free joint
/// from rest would be.
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
  /// When a law leaves native rows to MuJoCo: never, in this evaluation, or where its level is 0.
  enum class Absent { kNever, kNow, kAtZero };
  /// Calls level(row, v) → torque for each row that exists at d, and writes it. v: speed of
  /// sliding. give: by so much a row yields before it slides, where
  /// it is alone (0: by as little as it can).
  template <class Level>
  void Write(const mjModel& m, mjData& d, const double* z, Stage stage, Absent absent,
             Level&& level, double give = 0) const {
    int r = d.ne;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const FrictionRow& row = rows_[k];
      const bool native = IsNative(m, row);
      if ((native && absent == Absent::kNow) || !Find(d, row, r)) continue;
      const double off = OffAnchor(m, d, z + kStates * k, row);
      const Sliding sliding = SlidingOf(m, d, z + kStates * k, row);
      const double torque = sliding.share * level(row, sliding.v);
      if (native && absent == Absent::kAtZero && torque == 0) continue;
      WriteRow(m, d, off, stage, row, r, torque);
      if (give > 0 && row.alone && !IsDiscrete(m)) Soften(m, d, r, give);
      const bool last = stage == Stage::kActuator || IsUnactuated(m);
      if (last && row.joint && row.axis < 0 && !IsDiscrete(m))
        Foresee(d, z[kStates * k] == kHeld, row, r);
    }
  }
  void Advance(const mjModel& m, const mjData& d, double* z) const;

  /// Calls visit(row, r) for each row that exists and slides in the step that d has taken: it is
  /// constraint r.
  template <class Visit>
  void ForEachSaturated(const mjData& d, Visit&& visit) const {
    int r = d.ne;
    for (const FrictionRow& row : rows_) {
      if (Find(d, row, r) && Saturated(d, r)) visit(row, r);
    }
  }

  /// Why they hold less well than elsewhere: too many of them in a row, and as soft as the model
  /// says.
  std::string WhySoft(const mjModel& m) const;
  /// Throws Error where other dry friction acts on a row.
  void RequireAlone(const mjModel& m, const std::string& who) const;

  /// As a differential equation (BoundLaw::Bristles): calls level(row, v) → torque for each row.
  std::string WhyNoBristles() const;
  std::vector<int> BristleStates() const;
  template <class Level>
  void Bristles(const mjModel& m, const mjData& d, const double* z, double* rate,
                std::span<double> force, double give, Level&& level) const {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const std::size_t state = kStates * k + kBristle;
      const double v = Speed(d, rows_[k]);
      const Bristle bristle(z[state], v, give > 0 ? give : Bristle::kGive);
      rate[state] = bristle.rate;
      Oppose(m, d, rows_[k], bristle.u * level(rows_[k], v), force);
    }
  }

  /// Why Differentiate does not know these rows ("a ball joint"); empty: it does.
  std::string WhyNoSlopes(const mjModel& m) const;
  /// Adds the slopes of anchors, and calls level(row, r, v, moves) for each row that exists: it is
  /// constraint r, v: speed of sliding, which follows the state where it moves.
  template <class Level>
  void Differentiate(const mjModel& m, const mjData& d, const StepTaken& step, LawSlopes& slopes,
                     Level&& level) const {
    int r = d.ne;
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      if (!Find(d, rows_[k], r)) continue;
      const double* const z = step.z + kStates * k;
      DifferentiateAnchor(m, d, step, rows_[k], r, static_cast<int>(kStates * k), slopes);
      level(rows_[k], r, SlidingOf(m, d, z, rows_[k]).v, z[0] != kHeld);
    }
  }

  static constexpr std::size_t kStates = 3;   ///< of a row
  static constexpr std::size_t kBristle = 1;  ///< which of them is the deflection of a bristle

 private:
  /// Grasp: what a row did in the last step.
  static constexpr double kUnknown = 0, kHeld = 1, kSlid = 2;
  /// Speed of sliding, and the share of the level that falls to this row.
  struct Sliding {
    double v, share;
  };
  static double Speed(const mjData& d, const FrictionRow& row) {
    return row.joint ? d.qvel[row.index] : d.ten_velocity[row.index];
  }
  /// force [nv] −= f along a row.
  static void Oppose(const mjModel& m, const mjData& d, const FrictionRow& row, double f,
                     std::span<double> force);
  static Sliding SlidingOf(const mjModel& m, const mjData& d, const double* z,
                           const FrictionRow& row);
  /// Along a row, without constraints, of the last evaluation.
  static double FreeAcceleration(const mjModel& m, const mjData& d, const FrictionRow& row);
  /// Whether this is a stage of RK4's first step: what is no faster than a free joint from rest
  /// would be moves since this step.
  static bool MayHaveJustBegun(const mjModel& m, double grasp);

  /// Whether a constraint gives all that it can.
  static bool Saturated(const mjData& d, int r);
  /// Moves r (ascending over calls) to the row's constraint; false when it has none.
  static bool Find(const mjData& d, const FrictionRow& row, int& r);
  static void Foresee(mjData& d, bool held, const FrictionRow& row, int r);
  static void WriteRow(const mjModel& m, mjData& d, double off, Stage stage, const FrictionRow& row,
                       int r, double level);
  /// Makes a row yield by give under its level: R = K d give/level, of (2).
  static void Soften(const mjModel& m, mjData& d, int r, double give);
  /// Whether MuJoCo alone has friction there, if this law has none.
  static bool IsNative(const mjModel& m, const FrictionRow& row);
  /// As the row's impedance makes it, where the model has MuJoCo's default.
  static void Harden(const mjModel& m, mjData& d, const FrictionRow& row, int r);
  /// Whether a change of q − anchor since the end of the last step is none of a motion's at this
  /// speed.
  static bool IsAnotherPose(const mjModel& m, double speed, double change);
  /// q − anchor; 0 before the first step.
  static double OffAnchor(const mjModel& m, const mjData& d, const double* z,
                          const FrictionRow& row);
  /// first: number of the row's first state. A pose that is another one takes the anchor along,
  /// also where RK4 turns a motion around within a step.
  static void DifferentiateAnchor(const mjModel& m, const mjData& d, const StepTaken& step,
                                  const FrictionRow& row, int r, int first, LawSlopes& slopes);
  static void DifferentiateHeldAnchor(const mjModel& m, const mjData& d, const StepTaken& step,
                                      const FrictionRow& row, int first, LawSlopes& slopes);
  /// States of the row or of the three rows of a ball joint that begin at `rows`.
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

/// What the level of a row follows: position, speed, torque of the load, P parameters, and more
/// numbers of the caller's.
template <std::size_t P, std::size_t More = 0>
std::array<Number, 3 + P + More> NumbersOf(const FrictionRow& row, int load) {
  using Kind = Number::Kind;
  std::array<Number, 3 + P + More> numbers{};
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
    const int rows = static_cast<int>(FrictionRowsOf(m, config, JointsOf<E>()).size());
    return FrictionRows::StateSize(m, config, JointsOf<E>()) + (kWorks ? rows : 0);
  }

  bool IsRow() const override { return true; }
  bool GivesForce() const override { return kBiased; }
  std::string WhyIdle(const mjModel& m) const override {
    if (Give() > 0 && IsDiscrete(m)) return "give does nothing under this integrator";
    return idle_.empty() ? rows_.WhySoft(m) : idle_;
  }

  void Impose(mjModel& m) const override {
    rows_.Impose(m);
    if constexpr (kDamped) damping_->Impose(m, rows_.rows(), p_[E::kDamping]);
    if (Give() > 0) rows_.RequireAlone(m, PluginName(E::kName));
  }

  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double> force) override {
    if constexpr (kBiased) std::fill(force.begin(), force.end(), 0.0);
    const GearTorques gears = Gears(m, d);
    rows_.Write(
        m, d, z, stage, IsNull() ? FrictionRows::Absent::kNow : FrictionRows::Absent::kNever,
        [&](const FrictionRow& row, double v) {
          if constexpr (kBiased) force[row.index] = E::template Bias<double>(AsParams<E>(p_));
          return LevelAt(m, d, z, gears, row, v);
        },
        Give());
    return kBiased;
  }

  std::string WhyNoBristles(const mjModel&) const override {
    return kWorks ? "its level follows the work that is dissipated" : rows_.WhyNoBristles();
  }
  std::vector<int> BristleStates() const override { return rows_.BristleStates(); }
  void Bristles(const mjModel& m, const mjData& d, const double* z, double* rate,
                std::span<double> force) const override {
    const GearTorques gears = Gears(m, d);
    rows_.Bristles(m, d, z, rate, force, Give(), [&](const FrictionRow& row, double v) {
      if constexpr (kBiased) force[row.index] += E::template Bias<double>(AsParams<E>(p_));
      return LevelAt(m, d, z, gears, row, v);
    });
  }

  void Advance(const mjModel& m, const mjData& d, double* z) override {
    rows_.Advance(m, d, z);
    if constexpr (kWorks) {
      rows_.ForEachSaturated(d, [&](const FrictionRow& row, int r) {
        z[WorkOf(row)] += m.opt.timestep * d.efc_frictionloss[r] * std::abs(d.qvel[row.index]);
      });
    }
  }

  std::string WhyNoSlopes(const mjModel& m) const override {
    return Give() > 0 ? "it gives before it slides" : rows_.WhyNoSlopes(m);
  }

  void Differentiate(const mjModel& m, const mjData& d, const StepTaken& step,
                     LawSlopes& slopes) const override {
    constexpr std::size_t kLast = 3 + kParamCount<E>, kN = kLast + kMore;
    using T = Dual<kN>;
    const auto p = DualParams<kN>(AsParams<E>(p_), 3);
    const GearTorques gears = Gears(m, d);
    rows_.Differentiate(
        m, d, step, slopes, [&](const FrictionRow& row, int r, double v, bool moves) {
          FrictionState<T> at{T(PositionOf(m, d, row), 0), moves ? T(v, 1) : T(v), T(0)};
          auto by = NumbersOf<kParamCount<E>, kMore>(row, load_);
          double sign = 1;
          if constexpr (kLoaded) {
            const double torque = gears.At(m, d, row.index, load_);
            at.load = T(LoadOf(torque, load_), 2), sign = (torque < 0 ? -1 : 1) * LoadOf(1, load_);
          }
          if constexpr (kTorques) {
            at.motor = T(gears.At(m, d, row.index, 1), kLast);
            at.others = at.motor - T(gears.At(m, d, row.index, 0), 2);
            by[kLast] = {Number::Kind::kTorqueActuator, row.index};
          }
          if constexpr (kWorks) {
            at.time = T(d.time - m.opt.timestep), at.work = T(step.z[WorkOf(row)], kLast);
            by[kLast] = {Number::Kind::kState, static_cast<int>(WorkOf(row))};
          }
          Dual<kN> level = E::template Level<T>(at, p);
          level.d[2] *= sign;
          Put(slopes.levels, {Number::Kind::kLevel, r}, level, by);
          if constexpr (kBiased)
            Put(slopes.forces, {Number::Kind::kForce, row.index}, E::template Bias<T>(p), by);
        });
    if constexpr (kWorks) DifferentiateWork(m, d, step, slopes);
  }

 private:
  static constexpr bool kLoaded = ChoicesOf<E>().size() > 0;
  static constexpr bool kTorques = requires { E::kReadsTorques; };
  static constexpr bool kWorks = requires { E::kReadsWork; };
  static constexpr std::size_t kMore = kTorques || kWorks ? 1 : 0;  // numbers beside those of all
  static constexpr bool kDamped = requires { E::kDamping; };
  static constexpr bool kBiased = BiasedFrictionLaw<E>;
  static_assert(!kBiased || (E::kPlaces.size() == 1 && E::kPlaces[0] == Place::kJoint));

  static_assert(!(kTorques || kWorks) || E::kPlaces.size() == 1);  // joints of one direction

  static GearTorques Gears(const mjModel& m, const mjData& d) {
    if constexpr (kLoaded || kTorques) return {m, d};
    return {};
  }

  double LevelAt(const mjModel& m, const mjData& d, const double* z, const GearTorques& gears,
                 const FrictionRow& row, double v) const {
    FrictionState<double> r{0, v, 0};
    if (!row.joint) r.q = d.ten_length[row.index];
    if (row.joint && row.axis < 0) r.q = d.qpos[m.jnt_qposadr[row.id]];
    if constexpr (kLoaded) r.load = LoadOf(gears.At(m, d, row.index, load_), load_);
    if constexpr (kTorques) {
      r.motor = gears.At(m, d, row.index, 1);
      r.others = r.motor - gears.At(m, d, row.index, 0);
    }
    if constexpr (kWorks) r.time = d.time, r.work = z[WorkOf(row)];
    return E::template Level<double>(r, AsParams<E>(p_));
  }

  double Give() const {
    if constexpr (requires { E::kGive; }) return p_[E::kGive];
    return 0;
  }

  // Index of the state that is the work dissipated on a row.
  std::size_t WorkOf(const FrictionRow& row) const {
    const std::size_t rows = rows_.rows().size();
    return FrictionRows::kStates * rows + static_cast<std::size_t>(&row - rows_.rows().data());
  }

  // W + h level |v| where the row slid, with the speed at the end of the step.
  void DifferentiateWork(const mjModel& m, const mjData& d, const StepTaken& step,
                         LawSlopes& slopes) const {
    using Kind = Number::Kind;
    for (const FrictionRow& row : rows_.rows()) {
      const Number work{Kind::kState, static_cast<int>(WorkOf(row))};
      slopes.next.push_back({{Kind::kNext, work.index}, work, 1});
    }
    rows_.ForEachSaturated(d, [&](const FrictionRow& row, int r) {
      const Number next{Kind::kNext, static_cast<int>(WorkOf(row))};
      const double h = m.opt.timestep, v = step.qvel[row.index];
      slopes.next.push_back({next, {Kind::kLevel, r}, h * std::abs(v)});
      const double side = v < 0 ? -1 : 1;
      slopes.next.push_back(
          {next, {Kind::kSpeedAfter, row.index}, h * d.efc_frictionloss[r] * side});
    });
  }

  // Whether the law does nothing: no level in any direction, at any load, all around a turn, ever.
  bool IsNull() const {
    const auto p = AsParams<E>(p_);
    if constexpr (kWorks) {
      constexpr double kEver = 1e12;  // [s], [J]
      for (const auto& [time, work] : {std::pair{kEver, 0.0}, {0.0, kEver}})
        if (E::template Level<double>({0, 0, 0, 0, 0, time, work}, p) != 0) return false;
    }
    if constexpr (kTorques) {
      for (const auto& [motor, others] :
           {std::pair{1.0, 0.0}, {0.0, 1.0}, {1.0, -0.5}, {0.5, -1.0}})
        if (E::template Level<double>({0, 0, 0, motor, others}, p) != 0) return false;
    }
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
