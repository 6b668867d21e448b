#include "hidden_effects/outside/cases.h"

#include <cstdint>

namespace continuum::hidden {
namespace {

constexpr double kSmall = 0.25, kModerate = 1, kLarge = 4;

// Stands for a text in every build alike.
std::uint64_t SeedOf(const std::string& text) {
  std::uint64_t hash = 1469598103934665603u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return 1 + hash % 100'000;
}

class List {
 public:
  explicit List(std::string robot) : robot_(std::move(robot)) {}

  // Whatever follows is quick, or not.
  List& Quick(bool quick = true) {
    quick_ = quick;
    return *this;
  }
  List& None(int times) {
    for (int n = 0; n < times; ++n) Add({}, 1);
    return *this;
  }
  List& Add(std::vector<std::string> effects, double factor, Law law = Law::kStick) {
    Case c = Next(std::move(effects), factor);
    c.law = law;
    return Keep(c);
  }
  List& AtOneJoint(const std::string& effect, double factor, Law law) {
    Case c = Next({effect}, factor);
    c.law = law, c.one_joint = true;
    return Keep(c);
  }
  List& Unlisted(const std::string& effect, double factor) {
    Case c = Next({effect}, factor);
    c.listed = false;
    return Keep(c);
  }
  List& Spoilt(const std::string& how) {
    Case c = Next({}, 1);
    c.spoilt = how;
    return Keep(c);
  }

  void Append(bool quick, std::vector<Case>& all) const {
    for (const auto& [c, is_quick] : cases_) {
      if (is_quick || !quick) all.push_back(c);
    }
  }

 private:
  Case Next(std::vector<std::string> effects, double factor) {
    Case c;
    c.effects = std::move(effects), c.factor = factor, c.robot = robot_;
    c.noise = static_cast<NoiseKind>(turn_++ % 5);
    return c;
  }
  List& Keep(Case c) {
    c.seed = 0;
    c.seed = SeedOf(c.Name());
    cases_.emplace_back(std::move(c), quick_);
    return *this;
  }

  std::string robot_;
  int turn_ = 0;
  bool quick_ = false;
  std::vector<std::pair<Case, bool>> cases_;
};

List PendulumCases() {
  List list("pendulum");
  list.Quick().None(1).Add({"payload"}, kLarge).Add({"coulomb"}, kModerate, Law::kTanh);
  list.Quick(false).None(2).Add({"payload"}, kModerate).Add({"payload"}, kSmall);
  list.Add({"coulomb"}, kModerate, Law::kBristles).Add({"coulomb"}, kModerate, Law::kStick);
  list.Add({"coulomb"}, kModerate, Law::kNative).Add({"coulomb"}, kLarge, Law::kTanh);
  list.Add({"coulomb"}, kLarge, Law::kNative).Add({"coulomb"}, kSmall, Law::kBristles);
  list.Add({"stribeck"}, kModerate, Law::kBristles).Add({"load_friction"}, kModerate, Law::kTanh);
  list.Add({"input_offset"}, kModerate).Add({"dead_time"}, kModerate).Add({"pt1"}, kModerate);
  list.Add({"armature"}, kModerate).Add({"sensor_bias"}, kModerate);
  list.Add({"payload", "coulomb"}, kModerate, Law::kBristles);
  list.Add({"coulomb", "input_offset"}, kModerate, Law::kTanh);
  list.Unlisted("coulomb", kModerate).Unlisted("payload", kLarge).Spoilt("flipped");
  return list;
}

List ValveCases() {
  List list("valve");
  list.Quick().Add({"pt1"}, kLarge).Add({"coulomb"}, kModerate, Law::kBristles);
  list.Quick(false).None(3).Add({"pt1"}, kModerate).Add({"pt1"}, kSmall);
  list.Add({"dead_time"}, kModerate).Add({"dead_time"}, kLarge);
  list.Add({"coulomb"}, kModerate, Law::kTanh).Add({"coulomb"}, kLarge, Law::kNative);
  list.Add({"coulomb"}, kLarge, Law::kStick).Add({"stribeck"}, kModerate, Law::kBristles);
  list.Add({"cubic_stiffness"}, kModerate).Add({"maxwell"}, kModerate);
  list.Add({"input_gain"}, kModerate).Add({"sensor_drift"}, kModerate);
  list.Quick().Add({"coulomb", "pt1"}, kModerate, Law::kTanh);
  list.Quick(false).Add({"payload", "pt1"}, kModerate);
  list.Add({"coulomb", "input_offset"}, kModerate, Law::kBristles);
  list.Add({"coulomb", "payload"}, kModerate, Law::kStick);
  list.Unlisted("pt1", kLarge).Quick().Spoilt("exchanged");
  return list;
}

List TwoLinkCases() {
  List list("two_link");
  list.Quick().Add({"directional_friction"}, kModerate, Law::kBristles);
  list.AtOneJoint("coulomb", kModerate, Law::kTanh).Add({"backlash"}, kModerate);
  list.Quick(false).None(2).Add({"directional_friction"}, kLarge, Law::kTanh);
  list.AtOneJoint("coulomb", kLarge, Law::kBristles).Add({"coulomb"}, kModerate, Law::kStick);
  list.Add({"coulomb"}, kModerate, Law::kNative).Add({"coulomb"}, kLarge, Law::kNative);
  list.Add({"payload"}, kSmall).Add({"payload"}, kModerate).Add({"payload"}, kLarge);
  list.Add({"load_friction"}, kModerate, Law::kBristles).Add({"load_friction"}, kLarge, Law::kTanh);
  list.Add({"backlash"}, kLarge).Add({"armature"}, kModerate).Add({"sensor_bias"}, kModerate);
  list.Add({"dead_time"}, kModerate).Add({"pt1"}, kModerate);
  list.Add({"payload", "coulomb"}, kModerate, Law::kBristles);
  list.Add({"coulomb", "dead_time"}, kModerate, Law::kTanh);
  list.Unlisted("backlash", kLarge).Unlisted("payload", kLarge).Spoilt("flipped");
  return list;
}

List SnakeCases() {
  List list("snake");
  list.Quick().Add({"capstan"}, kModerate);
  list.Quick(false).None(2).Add({"capstan"}, 2).Add({"capstan"}, kSmall);
  list.Add({"coulomb"}, kModerate, Law::kTanh).Add({"coulomb"}, kModerate, Law::kBristles);
  list.Add({"payload"}, kModerate).Add({"payload"}, kLarge).Add({"cubic_stiffness"}, kModerate);
  list.Add({"input_gain"}, kModerate).Add({"capstan", "payload"}, kModerate);
  list.Unlisted("capstan", kModerate).Spoilt("exchanged");
  return list;
}

List WinchCases() {
  List list("winch_snake");
  list.Quick().Add({"tendon_stretch"}, kModerate);
  list.Quick(false).None(1).Add({"tendon_stretch"}, kLarge).Add({"slack"}, kModerate);
  list.Add({"slack"}, kSmall).Add({"capstan"}, kModerate).Add({"dead_time"}, kLarge);
  return list;
}

List SoftCases() {
  List list("soft");
  list.Quick().None(1).Add({"maxwell"}, kModerate).Add({"chamber_asymmetry"}, kModerate);
  list.Quick(false).None(1).Add({"maxwell"}, kSmall).Add({"chamber_asymmetry"}, kLarge);
  list.Add({"dead_time"}, kModerate).Add({"cubic_stiffness"}, kModerate).Add({"dahl"}, kModerate);
  list.Add({"dahl"}, kLarge).Add({"payload"}, kModerate);
  list.Add({"maxwell", "dead_time"}, kModerate);
  list.Unlisted("maxwell", kModerate).Spoilt("exchanged");
  return list;
}

}  // namespace

std::vector<Case> OutsideCases(bool quick) {
  std::vector<Case> all;
  for (const List& list :
       {PendulumCases(), ValveCases(), TwoLinkCases(), SnakeCases(), WinchCases(), SoftCases()})
    list.Append(quick, all);
  return all;
}

}  // namespace continuum::hidden
