#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "effects/all.h"

namespace continuum::testing {

// ---- the effects of one kind, as a list of types -----------------------------------------------

template <class... Lists>
struct Joined;
template <class... A>
struct Joined<List<A...>> {
  using type = List<A...>;
};
template <class... A, class... B, class... Rest>
struct Joined<List<A...>, List<B...>, Rest...> : Joined<List<A..., B...>, Rest...> {};

/// Those of the effects E for which Is<E> holds, as a List.
template <template <class> class Is>
struct Where {
  template <class... E>
  using Of = typename Joined<List<>, std::conditional_t<Is<E>::value, List<E>, List<>>...>::type;
};

template <class E>
using IsForce = std::bool_constant<ForceLaw<E>>;
template <class E>
constexpr bool HasStates() {
  if constexpr (ForceLaw<E>) return E::kStates.size() > 0;
  return false;
}
template <class E>
using IsForceWithStates = std::bool_constant<HasStates<E>()>;
template <class E>
using IsFriction = std::bool_constant<FrictionLaw<E>>;
template <class E>
using IsBiasedFriction = std::bool_constant<BiasedFrictionLaw<E>>;
template <class E>
concept AboveCoulomb = FrictionLaw<E> && requires {
  E::kCoulombLevel;
};
template <class E>
using IsAboveCoulomb = std::bool_constant<AboveCoulomb<E>>;
template <class E>
using IsPath = std::bool_constant<PathLaw<E>>;
template <class E>
using IsSegment = std::bool_constant<SegmentLaw<E>>;
template <class E>
using IsGain = std::bool_constant<GainLaw<E>>;
template <class E>
using IsFilter = std::bool_constant<FilterLaw<E>>;
template <class E>
using IsPull = std::bool_constant<PullLaw<E>>;
template <class E>
using IsSupply = std::bool_constant<SupplyLaw<E>>;
template <class E>
using IsScalarMeasure = std::bool_constant<ScalarMeasureLaw<E>>;
template <class E>
using IsVectorMeasure = std::bool_constant<VectorMeasureLaw<E>>;
template <class E>
using IsEdit = std::bool_constant<EditLaw<E>>;
template <class E>
concept NativeEdit = EditLaw<E> && requires {
  E::kNative;
};
template <class E>
using IsNativeEdit = std::bool_constant<NativeEdit<E>>;

/// One list for each typed suite of tests/effects.
using Forces = All::Into<Where<IsForce>::Of>;
using ForcesWithStates = All::Into<Where<IsForceWithStates>::Of>;
using Frictions = All::Into<Where<IsFriction>::Of>;
using BiasedFrictions = All::Into<Where<IsBiasedFriction>::Of>;
using FrictionsAboveCoulomb = All::Into<Where<IsAboveCoulomb>::Of>;
using Paths = All::Into<Where<IsPath>::Of>;
using Segments = All::Into<Where<IsSegment>::Of>;
using Gains = All::Into<Where<IsGain>::Of>;
using Filters = All::Into<Where<IsFilter>::Of>;
using Pulls = All::Into<Where<IsPull>::Of>;
using Supplies = All::Into<Where<IsSupply>::Of>;
using ScalarMeasures = All::Into<Where<IsScalarMeasure>::Of>;
using VectorMeasures = All::Into<Where<IsVectorMeasure>::Of>;
using Edits = All::Into<Where<IsEdit>::Of>;
using NativeEdits = All::Into<Where<IsNativeEdit>::Of>;

/// For TYPED_TEST_SUITE(Suite, Forces::Into<Types>, EffectName).
template <class... E>
using Types = ::testing::Types<E...>;
struct EffectName {
  template <class E>
  static std::string GetName(int) {
    return std::string(E::kName);
  }
};

// ---- parameters --------------------------------------------------------------------------------

/// Values about the initial ones, within bounds.
template <class E>
ParamsOf<E, double> RandomParams(std::mt19937& rng) {
  std::normal_distribution<double> n;
  ParamsOf<E, double> p;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = std::clamp(E::kParams[i].initial * std::exp(0.3 * n(rng)), E::kParams[i].lower,
                      E::kParams[i].upper);
  }
  return p;
}

/// The same, with numbers of either sign for those that begin at zero: each parameter acts.
template <class E>
ParamsOf<E, double> ActingParams(std::mt19937& rng) {
  auto p = RandomParams<E>(rng);
  std::uniform_real_distribution<double> any(-1, 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] == 0) p[i] = std::clamp(any(rng), E::kParams[i].lower, E::kParams[i].upper);
  }
  return p;
}

/// Values at which the effect is absent. as_is: of parameters whose null is what the model has.
template <class E>
ParamsOf<E, double> NullParams(double as_is = kAsIs) {
  ParamsOf<E, double> p;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Param& param = E::kParams[i];
    p[i] = !std::isnan(param.null) ? param.null : std::isnan(as_is) ? param.initial : as_is;
  }
  return p;
}

/// The number of options of an effect's choice; 1 where it has none.
template <class E>
constexpr int OptionsOf() {
  if constexpr (requires { E::kChoices; }) return static_cast<int>(E::kChoices[0].options.size());
  return 1;
}

// ---- other units of mass, length and time ------------------------------------------------------

/// How many units of a system one SI unit is, and one unit of a model's inputs and outputs.
struct UnitSystem {
  double kg = 1, m = 1, s = 1, input = 1, output = 1;
};
inline constexpr UnitSystem kOtherUnits{1.7, 0.6, 2.3, 1.4, 0.7};

/// The factor that the number of a quantity takes in a system; angles have no unit.
inline double FactorOf(std::string_view unit, const UnitSystem& in) {
  double out = 1, sign = 1;
  for (std::size_t i = 0; i <= unit.size();) {
    const std::size_t j = std::min(unit.find_first_of("*/", i), unit.size());
    std::string_view u = unit.substr(i, j - i);
    double power = 1;
    if (const auto caret = u.find('^'); caret != u.npos) {
      power = u[caret + 1] - '0';
      u = u.substr(0, caret);
    }
    double f = 0;
    if (u == "1" || u == "rad") f = 1;
    if (u == "kg") f = in.kg;
    if (u == "m") f = in.m;
    if (u == "s") f = in.s;
    if (u == "N") f = in.kg * in.m / (in.s * in.s);
    if (u == "J") f = in.kg * in.m * in.m / (in.s * in.s);
    if (u == "input") f = in.input;
    if (u == "output") f = in.output;
    if (f == 0) ADD_FAILURE() << "unknown unit '" << u << "'";
    out *= std::pow(f, sign * power);
    if (j < unit.size()) sign = unit[j] == '/' ? -1 : 1;
    i = j + 1;
  }
  return out;
}

/// Draws quantities that are the same in every system of units: only their numbers differ.
class Quantities {
 public:
  Quantities(unsigned seed, const UnitSystem& system) : rng_(seed), system_(system) {}

  const UnitSystem& system() const { return system_; }
  /// The number, in this system, of a quantity of so many SI units.
  double In(double si, std::string_view unit) const { return si * FactorOf(unit, system_); }
  double Normal(double deviation, std::string_view unit) { return In(deviation * n_(rng_), unit); }
  double Uniform(double lower, double upper, std::string_view unit) {
    return In(std::uniform_real_distribution<double>(lower, upper)(rng_), unit);
  }

 private:
  std::mt19937 rng_;
  std::normal_distribution<double> n_;
  UnitSystem system_;
};

/// What a law says, and in which unit.
struct Answer {
  double value;
  std::string unit;
};

inline bool Same(double a, double b) { return std::abs(a - b) <= 1e-13 * std::abs(b) + 1e-15; }

/// Expects that a law gives the same quantities in other units of mass, length and time, and that
/// it would not if the unit of any of its parameters were another.
/// law(Quantities&, const ParamsOf<E, double>&) → std::vector<Answer>.
template <class E, class Law>
void ExpectConsistentUnits(const Law& law) {
  std::mt19937 rng{0};
  std::array<bool, kParamCount<E>> matters{};
  for (unsigned k = 0; k < 100; ++k) {
    const auto p = ActingParams<E>(rng);
    auto q = p;
    for (std::size_t i = 0; i < q.size(); ++i) q[i] *= FactorOf(E::kParams[i].unit, kOtherUnits);
    const auto asked = [&](const UnitSystem& system, const ParamsOf<E, double>& with) {
      Quantities quantities(k, system);
      return law(quantities, with);
    };
    std::vector<Answer> expected = asked({}, p);
    for (Answer& a : expected) a.value *= FactorOf(a.unit, kOtherUnits);
    const auto found = asked(kOtherUnits, q);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_TRUE(std::isfinite(found[i].value));
      ASSERT_PRED2(Same, found[i].value, expected[i].value) << "answer " << i << found[i].unit;
    }
    for (std::size_t j = 0; j < q.size(); ++j) {
      auto wrong = q;
      wrong[j] *= 1.5;
      const auto other = asked(kOtherUnits, wrong);
      for (std::size_t i = 0; i < other.size(); ++i)
        matters[j] |= !Same(other[i].value, expected[i].value);
    }
  }
  for (std::size_t j = 0; j < matters.size(); ++j)
    EXPECT_TRUE(matters[j]) << E::kParams[j].name << ": no answer depends on it";
}

}  // namespace continuum::testing
