#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <span>
#include <string_view>

namespace continuum {

// Laws call these unqualified; for dual numbers argument-dependent lookup finds theirs.
using std::abs, std::cos, std::exp, std::log, std::sin, std::sqrt, std::tan, std::tanh;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kAsIs = std::numeric_limits<double>::quiet_NaN();

template <class T, std::size_t N>
using Vec = std::array<T, N>;

/// What an effect acts on.
enum class Place { kJoint, kTendon, kActuator, kBody, kSite, kSensor, kWorld };
inline constexpr std::array<std::string_view, 7> kPlaceNames{"joint", "tendon", "actuator", "body",
                                                             "site",  "sensor", "world"};
/// The name of a place, which is the MJCF key of a binding: joint="…".
constexpr std::string_view PlaceName(Place place) {
  return kPlaceNames[static_cast<std::size_t>(place)];
}

/// Joints that a law on joints takes: those of one coordinate and one direction (hinge, slide),
/// which is what a law takes unless its kJoints says more, or ball joints too, where only the speed
/// counts.
enum class Joints { kHingeSlide, kHingeSlideBall };

/// One parameter of a law. Units are those of a rotation (rad, N*m); on a slide joint or a tendon
/// read m for rad and N for N*m.
struct Param {
  std::string_view name, unit;
  double lower, upper;  ///< closed bounds; anything else is an error
  double initial;       ///< where a search starts
  double null;          ///< value at which the law does nothing; kAsIs: what the model has
  double held = kAsIs;  ///< where a search leaves it, as the others can say the same; kAsIs: free

  /// Value when the MJCF gives none: the null, so that what is not written does not act. initial,
  /// where no finite value is one.
  constexpr double Omitted() const {
    return null > -kInfinity && null < kInfinity ? null : initial;
  }
};

/// A text parameter with a few allowed values; the first is the default.
struct Choice {
  std::string_view name;
  std::span<const std::string_view> options;
};

struct Units {
  std::string_view x, force;
};

/// Laws that one log seldom tells apart, as they are the same physics in other words: a family. Of
/// those that do as well the plainest speaks for all (depth 0; deeper ones say more).
struct Kinship {
  std::string_view family;
  int depth = 0;
};
inline constexpr std::string_view kDryFriction = "dry friction", kLateness = "lateness",
                                  kInertia = "mass";
struct State {
  std::string_view name, unit;
};

constexpr Param Positive(std::string_view name, std::string_view unit, double initial) {
  return {name, unit, std::numeric_limits<double>::min(), kInfinity, initial, kAsIs};
}
/// A magnitude that is zero when the law does nothing.
constexpr Param Magnitude(std::string_view name, std::string_view unit, double initial) {
  return {name, unit, 0, kInfinity, initial, 0};
}
/// A damping that the joints' own can say as well: a search leaves it at 0.
constexpr Param SpareDamping(std::string_view name, double initial) {
  return {name, "N*m*s/rad", 0, kInfinity, initial, 0, 0};
}
/// A signed quantity that is zero when the law does nothing.
constexpr Param Signed(std::string_view name, std::string_view unit, double initial) {
  return {name, unit, -kInfinity, kInfinity, initial, 0};
}

/// What every effect says of itself. kKin, where the card has it, is its Kinship. kOnlyListed,
/// where it is true: the diagnosis tries it only where the experiment lists it by name.
template <class E>
concept Card = requires {
  std::string_view{E::kName};
  std::string_view{E::kSummary};
  std::string_view{E::kSource};
  std::span<const Place>{E::kPlaces};
  std::span<const Param>{E::kParams};
};

template <class E>
constexpr Joints JointsOf() {
  if constexpr (requires { E::kJoints; }) {
    return E::kJoints;
  } else {
    return Joints::kHingeSlide;
  }
}

template <class E>
inline constexpr std::size_t kParamCount = E::kParams.size();
template <class E, class T>
using ParamsOf = Vec<T, kParamCount<E>>;

// ---- the kinds of laws -------------------------------------------------------------------------

/// Displacement and flow of a joint or a tendon.
template <class T>
struct Port {
  T x, v;
};

/// Answer of a Force law. force·v is power *into* the effect, so the model feels −force.
template <class T, std::size_t N>
struct Reply {
  T force;
  std::array<T, N> zdot;  ///< rates of the law's states
  T stored;               ///< stored energy [J]
};

/// Force: Eval(port, z, p) → Reply, Step(z, port, h, p) → z after h at constant v, exactly.
template <class E>
concept ForceLaw = Card<E> &&
    requires(Port<double> q, Vec<double, E::kStates.size()> z, ParamsOf<E, double> p) {
  Units{E::kPort};
  std::span<const State>{E::kStates};
  { E::template Eval<double>(q, z, p) } -> std::same_as<Reply<double, E::kStates.size()>>;
  { E::template Step<double>(z, q, 0.001, p) } -> std::same_as<Vec<double, E::kStates.size()>>;
};

/// What the level of a dry friction may depend on: position, velocity, the load ≥ 0 [N*m]; and of
/// cards that ask for it (FrictionLaw) what the load is made of, time and work.
template <class T>
struct FrictionState {
  T q, v, load;
  T motor = T(0), others = T(0);  ///< torques of the actuators, and of all others [N*m]
  T time = T(0), work = T(0);     ///< from the beginning [s], and dissipated till now [J]
};

/// Friction: Level(state, p) ≥ 0, the largest torque that dry friction can take. It becomes a row
/// of MuJoCo's constraint solver (which holds, and slides at this level). A card may say of a
/// parameter, by its index, that
///   kCoulombLevel  alone, the others null, it is Coulomb's constant level
///   kDamping       it is the native damping of the joints
///   kLiteral       only Literal(v, p), the equation as printed, reads it
///   kGive          deflection at which the level is reached, before sliding; 0: the row's own
/// and of itself that kReadsTorques (motor, others) or kReadsWork (time, work).
template <class E>
concept FrictionLaw = Card<E> && requires(FrictionState<double> r, ParamsOf<E, double> p) {
  { E::template Level<double>(r, p) } -> std::same_as<double>;
};

/// Friction of joints that takes more in one direction than in the other: its torque is Bias(p)
/// beside a row, within Bias ± Level. A row has one level, whatever way it is pushed.
template <class E>
concept BiasedFrictionLaw = FrictionLaw<E> && requires(ParamsOf<E, double> p) {
  { E::template Bias<double>(p) } -> std::same_as<double>;
};

/// Path: friction of a cable that slides over contacts. Band(theta, choice, p) ≥ 0 is the logarithm
/// of the largest tension ratio that a contact with wrap angle theta can hold. kGive, where the
/// card has it, is the index of the sliding over which friction builds up; 0: the solver's own.
template <class E>
concept PathLaw = Card<E> && requires(ParamsOf<E, double> p) {
  { E::template Band<double>(0.1, 0, p) } -> std::same_as<double>;
};

/// Segment: three coordinates of a soft segment, their rates and three pressures → the three forces
/// that drive the coordinates, Eval(x, v, pressure, choice, p). Segment(p).d is the distance at
/// which the first two are arc lengths, and its parameter kArcRadius. Chambers(p), of a law that
/// stands for the whole segment, says where the pressures are; laws without it act beside such a
/// one. kRestLength, where the card has it, is the index of the segment's length at rest.
template <class E>
concept SegmentLaw = Card<E> && requires(Vec<double, 3> x, ParamsOf<E, double> p) {
  { E::template Eval<double>(x, x, x, 0, p) } -> std::same_as<Vec<double, 3>>;
  { E::template Segment<double>(p).d } -> std::convertible_to<double>;
};

/// Where a Signal law is inserted: the input of an actuator, the error of a position servo, between
/// position servos and the tendon that they pull, or the supply that actuators share.
enum class Tap { kInput, kServoError, kTendon, kSupply };

/// What position servos do to a tendon: the tension they would give without the law [N], and their
/// stiffness along the tendon [N/m].
template <class T>
struct Pull {
  T tension, stiffness;
};

/// Signal without memory: what is felt instead of u, Eval(u, p) → y.
template <class E>
concept GainLaw = Card<E> && requires(ParamsOf<E, double> p) {
  Tap{E::kTap};
  { E::template Eval<double>(0.1, p) } -> std::same_as<double>;
};
/// Signal with states: Eval(u, z, p) → y, Step(z, u, h, p) → z after h at constant u, exactly.
template <class E>
concept FilterLaw = Card<E> && requires(Vec<double, E::kStates.size()> z, ParamsOf<E, double> p) {
  Tap{E::kTap};
  std::span<const State>{E::kStates};
  { E::template Eval<double>(0.1, z, p) } -> std::same_as<double>;
  { E::template Step<double>(z, 0.1, 0.001, p) } -> std::same_as<Vec<double, E::kStates.size()>>;
};
/// Signal at a tendon: Eval(pull, p) → tension.
template <class E>
concept PullLaw = Card<E> && requires(Pull<double> pull, ParamsOf<E, double> p) {
  Tap{E::kTap};
  { E::template Eval<double>(pull, p) } -> std::same_as<double>;
};
/// Signal at a supply: Share(load, p) → the part of its force that each actuator on it gives. load:
/// the sum of what all would give by themselves, without sign [N*m].
template <class E>
concept SupplyLaw = Card<E> && requires(ParamsOf<E, double> p) {
  Tap{E::kTap};
  { E::template Share<double>(0.1, p) } -> std::same_as<double>;
};
template <class E>
concept SignalLaw = GainLaw<E> || FilterLaw<E> || PullLaw<E> || SupplyLaw<E>;

/// A signal of time, of one number or of a vector.
struct AnySignal {
  double operator()(double) const;
};
struct AnyVectorSignal {
  Vec<double, 3> operator()(double) const;
};

/// Measure: what a sensor reports at the time t of a signal y, Eval(y, t, p). y is a function of
/// time; t is counted from the beginning of the log [s].
template <class E>
concept ScalarMeasureLaw = Card<E> && requires(AnySignal y, ParamsOf<E, double> p) {
  { E::template Eval<double>(y, 0.1, p) } -> std::same_as<double>;
};
template <class E>
concept VectorMeasureLaw = Card<E> && requires(AnyVectorSignal y, ParamsOf<E, double> p) {
  { E::template Eval<double>(y, 0.1, p) } -> std::same_as<Vec<double, 3>>;
};
template <class E>
concept MeasureLaw = ScalarMeasureLaw<E> || VectorMeasureLaw<E>;

/// Edit: a native attribute of MuJoCo as an effect. Apply(element, p) edits one element of a model
/// through Element's Get, Set, Add, Scale (names and units of MJCF). kNative, where the card has
/// it, is the attribute that an experiment may fit in the effect's place. kOwnStep, where it is
/// true: what it adds moves as fast as the model's time step allows; no coarser one shows it.
struct AnyElement {
  double Get(std::string_view) const;
  void Set(std::string_view, double);
  void Add(std::string_view, double);
  void Scale(std::string_view, double);
};
template <class E>
concept EditLaw = Card<E> && requires(AnyElement& e, ParamsOf<E, double> p) {
  E::Apply(e, p);
};

/// Formula: the equation is the user's, a text of kVariables and the parameters under the key
/// kText.
template <class E>
concept FormulaLaw = Card<E> && requires {
  std::string_view{E::kText};
  std::span<const std::string_view>{E::kVariables};
};

template <class E>
concept Effect = ForceLaw<E> || FrictionLaw<E> || PathLaw<E> || SegmentLaw<E> || SignalLaw<E> ||
    MeasureLaw<E> || EditLaw<E> || FormulaLaw<E>;

}  // namespace continuum
