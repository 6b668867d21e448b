// How an instance names the objects that it acts on, whatever characters their names have.
#include <fmt/format.h>

#include "binding/config.h"
#include "support/engine.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Names : public testing::Engine {
 protected:
  // Dry friction on the joints of a key, of these two joints; returns their levels, or the error.
  static std::string On(const std::string& key, const std::string& a, const std::string& b) {
    const std::string config =
        fmt::format(R"(<config key="joint" value="{}"/><config key="tau_c" value="1"/>)", key);
    const auto joint = [](const std::string& name) {
      return fmt::format(R"(<body><joint axis="0 1 0" {}/><geom size=".1" pos=".1 0 0"/></body>)",
                         name.empty() ? "" : "name=\"" + name + "\"");
    };
    const auto [m, error] = Compile("<mujoco>" + Instance("coulomb", config) + "<worldbody>" +
                                    joint(a) + joint(b) + "</worldbody></mujoco>");
    if (!m) return error;
    std::string on;
    for (int i = 0; i < 2; ++i) on += m->dof_frictionloss[i] > 0 ? "1" : "0";
    return on;
  }
};

TEST_F(Names, AreTakenAsTheyAreWhereTheyAreTheWholeKey) {
  for (const std::string name : {"2nd Joint", "joint[0]", "*", "what?", "back\\slash", "[", "a b "})
    EXPECT_EQ(On(name, name, "other"), "10") << name;
  EXPECT_EQ(On("joint[0]", "joint0", "joint[0]"), "01");
}

TEST_F(Names, AreGlobsWhereTheyAreNone) {
  EXPECT_EQ(On("joint[0]", "joint0", "joint1"), "10");
  EXPECT_EQ(On("joint?", "joint0", "joint1"), "11");
  EXPECT_EQ(On("joint0 joint1", "joint0", "joint1"), "11");
}

TEST_F(Names, OfAListHaveABackslashBeforeASpaceAndBeforeCharactersOfAGlob) {
  EXPECT_EQ(On(R"(2nd\ Joint a)", "2nd Joint", "a"), "11");
  EXPECT_EQ(On(R"(joint\[0] a*)", "joint[0]", "ab"), "11");
  EXPECT_EQ(On(R"(\*)", "x", "*"), "01");
}

TEST_F(Names, ThatAreNotFoundAreFollowedByWhatToWrite) {
  EXPECT_THAT(On("2nd Join", "2nd Joint", "a"),
              HasSubstr(R"(no joint '2nd' in the model; a space in a name is written '\ ')"));
  EXPECT_THAT(On("*", "", ""), HasSubstr("no joint '*' in the model; give it a name"));
}

TEST_F(Names, ThatAreEscapedMatchThemselvesAlone) {
  const std::vector<std::string> names{"a", "a b", "a*", "a[0]", "a0", "a?", "\\a", "a\\", " "};
  for (const std::string& name : names) {
    EXPECT_THAT(Words("x " + Escaped(name)), ElementsAre("x", Escaped(name)));
    EXPECT_EQ(Unescaped(Escaped(name)), name);
    for (const std::string& other : names)
      EXPECT_EQ(AnyGlobMatches(Escaped(name), other), name == other) << name << " " << other;
  }
}

}  // namespace
}  // namespace continuum
