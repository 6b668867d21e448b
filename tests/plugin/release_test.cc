// What is said of a release of MuJoCo.
#include <string>

#include "support/engine.h"

namespace continuum {
namespace {

class Release : public testing::Engine {
 protected:
  // A warning is said once of a name.
  static constexpr char kFriction[] =
      "<extension><plugin plugin=\"continuum.coulomb\"><instance name=\"of this release\">"
      "<config key=\"joint\" value=\"last\"/><config key=\"tau_c\" value=\"0.1\"/>"
      "</instance></plugin></extension>";

  // Warnings of a chain of so many joints, the last one with friction.
  static std::string WarningsOf(int joints) {
    static std::string warnings;
    warnings.clear();
    mju_user_warning = [](const char* text) { warnings += text; };
    std::string bodies, ends;
    for (int k = 0; k < joints; ++k) {
      const std::string name = k + 1 == joints ? "last" : "q" + std::to_string(k);
      bodies +=
          "<body pos=\"0 0 -.1\"><joint name=\"" + name + "\" axis=\"0 1 0\"/><geom size=\".02\"/>";
      ends += "</body>";
    }
    const auto m = Model(std::string("<mujoco>") + kFriction + "<worldbody>" + bodies + ends +
                         "</worldbody></mujoco>");
    const auto d = Data(m);
    mju_user_warning = [](const char*) {};
    return warnings;
  }
};

TEST_F(Release, FaultOfMujoco400IsSaidForLargeModelsAlone) {
  EXPECT_EQ(WarningsOf(59).find("wrong accelerations"), std::string::npos);
  const bool said = WarningsOf(60).find("wrong accelerations") != std::string::npos;
  EXPECT_EQ(said, mjVERSION_HEADER == 4000000);
}

}  // namespace
}  // namespace continuum
