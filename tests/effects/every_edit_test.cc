// What every effect that is an attribute of MuJoCo promises.
#include <map>

#include "support/law_suite.h"

namespace continuum {
namespace {

using namespace testing;  // NOLINT: the lists of a typed suite

constexpr double kValue = 0.37;

// Attributes that effects edit, and their units. An index ("gravity[2]") does not count.
std::string UnitOf(std::string_view attribute) {
  static const std::map<std::string, std::string, std::less<>> units{{"armature", "kg*m^2"},
                                                                     {"damping", "N*m*s/rad"},
                                                                     {"delay", "s"},
                                                                     {"force", "N"},
                                                                     {"force_limit", "N*m"},
                                                                     {"gear", "1"},
                                                                     {"gear_compliance", "rad/N/m"},
                                                                     {"gear_damping", "N*m*s/rad"},
                                                                     {"gear_play", "rad"},
                                                                     {"gravity", "m/s^2"},
                                                                     {"input", "input"},
                                                                     {"lag", "s"},
                                                                     {"length", "m"},
                                                                     {"mass", "kg"},
                                                                     {"point_mass", "kg"},
                                                                     {"pos", "m"},
                                                                     {"stiffness", "N*m/rad"},
                                                                     {"turn", "rad"}};
  const auto found = units.find(attribute.substr(0, attribute.find('[')));
  if (found != units.end()) return found->second;
  ADD_FAILURE() << "attribute '" << attribute << "': its unit is not listed in this test";
  return "1";
}

// An element whose attributes are all 0.37 SI units.
class Element {
 public:
  explicit Element(const UnitSystem& system) : system_(system) {}

  double Get(std::string_view name) { return At(name); }
  void Set(std::string_view name, double value) { At(name) = value; }
  void Add(std::string_view name, double value) { At(name) += value; }
  void Scale(std::string_view name, double factor) { At(name) *= factor; }

  std::vector<std::string> Names() const {
    std::vector<std::string> all;
    for (const auto& [name, value] : values_) all.push_back(name);
    return all;
  }
  std::vector<Answer> Attributes() const {
    std::vector<Answer> all;
    for (const auto& [name, value] : values_) all.push_back({value, UnitOf(name)});
    return all;
  }

 private:
  double& At(std::string_view name) {
    const double value = kValue * FactorOf(UnitOf(name), system_);
    return values_.try_emplace(std::string(name), value).first->second;
  }

  UnitSystem system_;
  std::map<std::string, double, std::less<>> values_;
};

template <class E>
std::vector<Answer> Edited(const UnitSystem& system, const ParamsOf<E, double>& p) {
  Element element(system);
  E::Apply(element, p);
  return element.Attributes();
}

template <class E>
struct EveryEdit : ::testing::Test {};
TYPED_TEST_SUITE(EveryEdit, Edits::Into<Types>, EffectName);

TYPED_TEST(EveryEdit, IsConsistentInItsUnits) {
  using E = TypeParam;
  ExpectConsistentUnits<E>(
      [](Quantities& in, const ParamsOf<E, double>& p) { return Edited<E>(in.system(), p); });
}

TYPED_TEST(EveryEdit, DoesNothingAtItsNullAndSomethingElsewhere) {
  using E = TypeParam;
  for (const Answer& a : Edited<E>({}, NullParams<E>(kValue))) EXPECT_EQ(a.value, kValue);
  std::mt19937 rng{0};
  bool changed = false;
  for (const Answer& a : Edited<E>({}, ActingParams<E>(rng))) changed |= a.value != kValue;
  EXPECT_TRUE(changed);
}

TYPED_TEST(EveryEdit, NamesTheAttributeWhoseValueItReplaces) {
  using E = TypeParam;
  const bool replaces = std::any_of(E::kParams.begin(), E::kParams.end(),
                                    [](const Param& p) { return std::isnan(p.null); });
  EXPECT_TRUE(!replaces || IsNativeEdit<E>::value);
}

template <class E>
struct EveryNativeEdit : ::testing::Test {};
TYPED_TEST_SUITE(EveryNativeEdit, NativeEdits::Into<Types>, EffectName);

TYPED_TEST(EveryNativeEdit, EditsTheAttributeOnItsCard) {
  using E = TypeParam;
  std::mt19937 rng{0};
  Element element({});
  E::Apply(element, ActingParams<E>(rng));
  EXPECT_EQ(element.Names(), std::vector<std::string>{std::string(E::kNative)});
}

}  // namespace
}  // namespace continuum
