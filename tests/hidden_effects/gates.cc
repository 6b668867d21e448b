#include "hidden_effects/gates.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "hidden_effects/outside/cases.h"

namespace continuum::hidden {
namespace {

using Record = std::vector<Asked>;

constexpr std::size_t kFew = 4;  // names: more than that tell nothing

bool IsFound(const Asked& one) {
  return InSet(one.c, one.a) && one.a.named.size() + one.a.partner.size() <= kFew;
}
bool IsNamed(const Asked& one) { return InSet(one.c, one.a) && Unique(one.a); }
bool IsNamedWithItsSize(const Asked& one) {
  return IsNamed(one) && one.a.low <= one.a.truth && one.a.truth <= one.a.high;
}
bool HasNoOtherName(const Asked& one) {
  if (one.a.verdict == "unexplained") return true;
  return Sibling(one.c, one.a) && one.a.named.size() <= kFew;
}
bool HasNoName(const Asked& one) { return !Unique(one.a); }

template <bool (*holds)(const Asked&)>
bool All(const Record& asked) {
  return std::all_of(asked.begin(), asked.end(), holds);
}

// At a level of 5 %, more than two alarms in four have a probability of 0.05 %.
bool IsQuiet(const Record& asked) {
  return std::count_if(asked.begin(), asked.end(),
                       [](const Asked& one) { return one.a.verdict != "adequate"; }) <= 2;
}

// All in the set, two of three alone, none by another name.
bool AreClear(const Record& asked) {
  const auto alone = std::count_if(asked.begin(), asked.end(), IsNamed);
  return All<IsFound>(asked) && 3 * alone >= 2 * std::ssize(asked) &&
         std::none_of(asked.begin(), asked.end(),
                      [](const Asked& one) { return Unique(one.a) && !InSet(one.c, one.a); });
}

Case White(const std::string& robot, const std::string& effect, double factor, std::uint64_t seed,
           std::vector<std::string> among = {}) {
  Case c{{effect}, factor, NoiseKind::kWhite, seed, true, false, robot};
  c.among = std::move(among);
  return c;
}

Case Background(const std::vector<std::string>& effects, std::uint64_t seed) {
  Case c{effects, 1, NoiseKind::kWhite, seed};
  c.background = true;
  return c;
}

// One of each for one kind of noise.
void AddForNoise(NoiseKind noise, std::vector<Gate>& gates) {
  std::string kind(kNoiseNames[static_cast<int>(noise)]);
  std::erase_if(kind, [](unsigned char c) { return !std::isalnum(c); });
  const bool is_long = noise != NoiseKind::kWhite;  // one kind stands for all
  std::vector<Case> none;
  for (std::uint64_t seed = 1001; seed <= 1004; ++seed) none.push_back({{}, 1, noise, seed});
  gates.push_back({"NothingIsNamedWhereNothingIsHidden_" + kind, false, none, IsQuiet, is_long});
  // These logs tell them from all others; at twice a moderate size they are well above slow noise.
  gates.push_back({"ClearOnesAreNamed_" + kind,
                   true,
                   {{{"payload"}, 2, noise, 2001},
                    {{"cubic_stiffness"}, 2, noise, 2002},
                    {{"sensor_scale"}, 2, noise, 2003}},
                   AreClear,
                   is_long});
  gates.push_back({"WithoutACandidateItGetsNoOtherName_" + kind,
                   true,
                   {{{"payload"}, 4, noise, 3001, false}},
                   All<HasNoOtherName>,
                   is_long});
}

void AddForArm(std::vector<Gate>& gates) {
  // No single candidate leaves noise: both are found.
  gates.push_back({"TwoTogetherAreBothNamed",
                   true,
                   {{{"gravity_tilt", "armature"}, 2, NoiseKind::kWhite, 4001},
                    {{"payload", "sensor_delay"}, 2, NoiseKind::kOffset, 4002}},
                   All<IsFound>});
  // What is hidden does less than a time step: neither is it taken for a delay, nor does a lag that
  // makes up for the step crowd it out.
  gates.push_back({"SmallOnesKeepTheirName",
                   true,
                   {{{"armature"}, 0.125, NoiseKind::kWhite, 5001},
                    {{"armature"}, 0.5, NoiseKind::kOffset, 5002}},
                   All<IsNamed>});
  // They do less than the time step where their logs are left out, but help beside what that does.
  // Cases of the large suite.
  gates.push_back({"SmallOnesHelpWhereTheyAreLeftOut",
                   true,
                   {{{"cubic_stiffness"}, 0.5, NoiseKind::kQuantised, 94},
                    {{"gravity_tilt"}, 0.25, NoiseKind::kQuantised, 114}},
                   All<IsFound>});
  // The second does no more than the time step may, but explains all of what the first leaves. A
  // case of the large suite, where nine of nine of its kind are found.
  gates.push_back({"ASecondOneIsFoundWhereTheTimeStepWouldExcuseIt",
                   true,
                   {{{"cubic_stiffness", "sensor_scale"}, 2, NoiseKind::kSlow, 22}},
                   All<IsFound>});
  // Pairs that are found in searches of their own are compared in one unit of rounded values. A
  // case of the large suite.
  gates.push_back({"PairsOfSeveralSearchesCompare",
                   true,
                   {{{"gravity_tilt", "armature"}, 2, NoiseKind::kQuantised, 24}},
                   All<IsFound>});
  // What a large first cause leaves by the time step is no second one. A case of the large suite.
  gates.push_back({"ALargeOneStaysAlone",
                   true,
                   {{{"sensor_delay"}, 4, NoiseKind::kWhite, 146}},
                   All<IsNamedWithItsSize>});
  // Next to the fit of another law (Bouc-Wen) the simulation diverges. A case of the large suite.
  gates.push_back({"ALawThatDivergesIsNoRival",
                   true,
                   {{{"load_friction"}, 0.5, NoiseKind::kSlow, 52}},
                   All<IsNamed>});
  // Much is a little wrong, and one thing more so. Of eighteen effects the large run says how many.
  gates.push_back(
      {"OneCauseStandsOutOfMuchThatIsWrong", true, {Background({"armature"}, 6001)}, All<IsFound>});
  gates.push_back(
      {"MuchThatIsWrongIsNoCause", false, {Background({}, 6002)}, All<HasNoName>, true});
}

void AddForOthers(std::vector<Gate>& gates) {
  // The equation of the published benchmark at values of its kind, from a linear null model.
  gates.push_back({"TheSilverboxIsACubicSpring",
                   true,
                   {White("silverbox", "cubic_stiffness", 1, 3)},
                   All<IsNamedWithItsSize>});
  // The published loop stiffens, and half of the model's stiffness belongs to it: the way there is
  // longer than the first iterations of a fit.
  gates.push_back(
      {"TheBoucWenBenchmarkIsItsLoop",
       true,
       {White("bouc_wen", "bouc_wen", 1, 3, {"bouc_wen", "cubic_stiffness", "maxwell"})},
       All<IsNamed>});
  // The payload of the tip puts the swing out of phase, so that its fit begins far behind that of
  // an inertia of the joints.
  gates.push_back({"APayloadIsFoundWhereAnotherLeadsAtFirst",
                   true,
                   {White("spa", "payload", 2, 4, {"payload", "armature"})},
                   All<IsNamed>,
                   true});
  // A Stribeck excess does nothing without its Coulomb level, and its speed nothing without it:
  // from one start the fit ends far off, and a second cause is called in.
  gates.push_back(
      {"AServoShowsItsStribeckFriction", true, {White("servo", "stribeck", 1, 5)}, All<IsNamed>});
  gates.push_back({"AServoShowsItsBacklash",
                   true,
                   {White("servo", "backlash", 1, 13)},
                   All<IsNamedWithItsSize>});
  // From rest a late input and a late sensor show the same; what tells them apart here is the time
  // step alone.
  gates.push_back(
      {"ALateInputIsNotOnlyALateSensor", true, {White("servo", "dead_time", 2, 16)}, All<IsFound>});
}

// The case of the quick outside suite whose name begins like this.
Case Outside(std::string_view name) {
  const std::vector<Case> all = OutsideCases(true);
  return *std::find_if(all.begin(), all.end(),
                       [&](const Case& c) { return c.Name().starts_with(name); });
}

// Machines by other equations, with masses and lengths 1 % off, friction by other laws; every
// effect of the catalog is a candidate.
void AddForOutside(std::vector<Gate>& gates) {
  gates.push_back({"AValveThatIsSlowerIsOfFirstOrder", true, {Outside("valve pt1")}, All<IsNamed>});
  gates.push_back({"FrictionOfASmoothLawIsNotOneOfTheLoad",
                   true,
                   {Outside("pendulum coulomb tanh")},
                   All<IsNamed>});
  gates.push_back({"FrictionAndASlowValveAreBothNamed",
                   true,
                   {Outside("valve coulomb+pt1 tanh")},
                   All<IsFound>});
}

}  // namespace

const std::vector<Gate>& Gates() {
  static const std::vector<Gate> all = [] {
    std::vector<Gate> gates;
    for (const NoiseKind noise : {NoiseKind::kWhite, NoiseKind::kSlow, NoiseKind::kOffset,
                                  NoiseKind::kQuantised, NoiseKind::kHeavy})
      AddForNoise(noise, gates);
    AddForArm(gates);
    AddForOthers(gates);
    AddForOutside(gates);
    return gates;
  }();
  return all;
}

}  // namespace continuum::hidden
