#include "sim/model/model_spec.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using Operation = Change::Operation;

constexpr char kArm[] = R"(<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <body name="arm">
      <joint name="q" axis="0 1 0" damping="0.1"/>
      <inertial pos="0.1 0 0" mass="2" euler="0 0 30" diaginertia="0.01 0.02 0.025"/>
      <body name="ball" pos="0.3 0 0"><geom size="0.05" mass="1"/></body>
    </body>
  </worldbody>
  <actuator>
    <position name="servo" joint="q" kp="10"/>
    <general name="late" joint="q" delay="0.05" nsample="30" interp="linear"/>
    <general name="lagged" joint="q" dyntype="filterexact" dynprm="0.1"/>
  </actuator>
</mujoco>
)";

class Changed : public ::testing::Test {
 protected:
  ModelSpec Arm(std::string xml = kArm) const {
    return ModelSpec::Load(scratch_.Write("arm.xml", xml));
  }
  static double Mass(const ModelAndData& machine, const char* body) {
    return machine.model->body_mass[mj_name2id(machine.model.get(), mjOBJ_BODY, body)];
  }
  // R diag(I) Rᵀ of a body about its centre, in the body's axes.
  static std::vector<double> Inertia(const mjModel& m, const char* body) {
    const int b = mj_name2id(&m, mjOBJ_BODY, body);
    double R[9];
    mju_quat2Mat(R, m.body_iquat + 4 * b);
    std::vector<double> I(9);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k)
          I[3 * i + j] += R[3 * i + k] * m.body_inertia[3 * b + k] * R[3 * j + k];
      }
    }
    return I;
  }

  testing::Scratch scratch_;
};

TEST_F(Changed, InertiaIsWhatWasGivenWhereverAMassStands) {
  const ModelSpec arm = Arm();
  const Change mass{"body:arm", "mass", 4}, inertia{"body:arm", "inertia[1]", 0.035};
  for (const auto& changes : {std::vector{mass, inertia}, std::vector{inertia, mass}}) {
    const ModelAndData machine = arm.Build(changes);
    EXPECT_EQ(Mass(machine, "arm"), 4);
    std::vector<double> moments(machine.model->body_inertia + 3, machine.model->body_inertia + 6);
    std::sort(moments.begin(), moments.end());
    EXPECT_NEAR(moments[0], 2 * 0.01, 1e-12);  // the others grow with the mass
    EXPECT_NEAR(moments[1], 0.035, 1e-12);
    EXPECT_NEAR(moments[2], 2 * 0.025, 1e-12);
  }
}

TEST_F(Changed, SystemsAreAsBeforeAfterAChangeThatFails) {
  const ModelSpec arm = Arm();
  const std::vector<Change> half{{"joint:q", "damping", 5}, {"joint:q", "no_such", 1}};
  EXPECT_THROW(arm.Build(half), Error);
  EXPECT_EQ(arm.Build().model->dof_damping[0], 0.1);
}

// Models with the same changes are copies of one that was compiled; what is done to one of them, or
// to its plugins, is not done to the next.
TEST_F(Changed, ModelsThatAreBuiltAgainAreFresh) {
  const ModelSpec arm = Arm().With({}, {{{"coulomb", "rub", {{"joint", "q"}, {"tau_c", "0.1"}}}}});
  const std::vector<Change> damped{{"joint:q", "damping", 5}};
  const std::vector<Change> rubbing{{"joint:q", "damping", 5}, {"plugin:rub", "tau_c", 30}};
  arm.Build(damped).model->dof_damping[0] = 7;
  ModelAndData with = arm.Build(rubbing), without = arm.Build(damped);
  const auto push = [](ModelAndData& machine) {
    machine.data->qfrc_applied[0] = 1;
    mj_step(machine.model.get(), machine.data.get());
    return std::abs(machine.data->qvel[0]);
  };
  EXPECT_EQ(without.model->dof_damping[0], 5);
  EXPECT_LT(push(with), 0.1 * push(without));
  EXPECT_EQ(arm.Build().model->dof_damping[0], 0.1);
}

TEST_F(Changed, MassesFollowOneAnother) {
  const ModelSpec arm = Arm();
  for (const std::string body : {"arm", "ball"}) {
    const ModelAndData machine = arm.Build({{{"body:" + body, "mass", 2, Operation::kSet},
                                             {"body:" + body, "mass", 3, Operation::kScale},
                                             {"body:" + body, "mass", 0.5, Operation::kAdd}}});
    EXPECT_DOUBLE_EQ(Mass(machine, body.c_str()), 6.5) << body;
  }
}

TEST_F(Changed, AnInertialWithAnglesTakesAPointMass) {
  const ModelSpec arm = Arm();
  const ModelAndData plain = arm.Build();
  const ModelAndData loaded = arm.Build({{{"body:arm", "effect:payload", 0.5}}});
  EXPECT_DOUBLE_EQ(Mass(loaded, "arm"), 2.5);
  const int b = mj_name2id(loaded.model.get(), mjOBJ_BODY, "arm");
  EXPECT_NEAR(loaded.model->body_ipos[3 * b], 0.1 * 2 / 2.5, 1e-12);
  // Two points a distance 0.1 apart: reduced mass 2·0.5/2.5 about y and z.
  auto expected = Inertia(*plain.model, "arm");
  expected[4] += 0.4 * 0.01, expected[8] += 0.4 * 0.01;
  const auto found = Inertia(*loaded.model, "arm");
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << i;
}

TEST_F(Changed, APointMassMayBeAsSmallAsADifferenceTakesIt) {
  std::string xml = kArm;
  xml.insert(xml.find("</body>"), "<body name=\"tip\"><inertial pos=\"0 0 0\" mass=\"0\"/></body>");
  for (const double mass : {1e-12, 1e-8, 1e-4}) {
    const ModelAndData loaded = Arm(xml).Build({{{"body:tip", "effect:payload", mass}}});
    EXPECT_DOUBLE_EQ(Mass(loaded, "tip"), mass);
  }
}

TEST_F(Changed, AMassThatTheCompilerOverridesIsRefused) {
  std::string xml = kArm;
  xml.insert(xml.find("<option"), "<compiler settotalmass=\"5\"/>");
  EXPECT_THROW(
      {
        try {
          Arm(xml).Build({{{"body:arm", "mass", 1}}});
        } catch (const Error& e) {
          EXPECT_THAT(e.what(), HasSubstr("settotalmass"));
          throw;
        }
      },
      Error);
}

TEST_F(Changed, NothingIsNoDelayAndNoLagEvenWhereTheModelHasOne) {
  const ModelSpec arm = Arm();
  const std::vector<Change> nothing{{"actuator:late", "effect:dead_time", 0},
                                    {"actuator:lagged", "effect:pt1", 0}};
  const ModelAndData machine = arm.Build(nothing);
  EXPECT_EQ(machine.model->actuator_delay[1], 0.05);
  EXPECT_EQ(machine.model->actuator_dyntype[2], mjDYN_FILTEREXACT);
  EXPECT_EQ(machine.model->actuator_dynprm[mjNDYN * 2], 0.1);
}

// Else it would be a step late, however short, and no fit could start from none.
TEST_F(Changed, TheRestLengthOfATendonIsBothEndsOfItsRange) {
  std::string xml = kArm;
  xml.insert(xml.find("<body name=\"arm\">"), "<site name=\"wall\" pos=\"0 0 0.4\"/>");
  xml.insert(xml.find("<body name=\"ball\""), "<site name=\"hook\" pos=\"0.3 0 0\"/>");
  xml.insert(xml.find("  <actuator>"),
             "<tendon><spatial name=\"rope\" stiffness=\"9\"><site site=\"wall\"/>"
             "<site site=\"hook\"/></spatial></tendon>");
  const ModelSpec arm = Arm(xml);
  EXPECT_NEAR(arm.Value("tendon:rope", "springlength"), 0.5, 1e-12);  // as long as at qpos0
  const std::vector<Change> shorter{{"tendon:rope", "springlength", 0.8, Operation::kScale}};
  const ModelAndData machine = arm.Build(shorter);
  EXPECT_NEAR(machine.model->tendon_lengthspring[0], 0.4, 1e-12);
  EXPECT_NEAR(machine.model->tendon_lengthspring[1], 0.4, 1e-12);
}

TEST_F(Changed, AnEndOfARangeKeepsTheOtherOneAndMayNotPassIt) {
  std::string xml = kArm;
  xml.insert(xml.find("<body name=\"arm\">"), "<site name=\"wall\" pos=\"0 0 0.4\"/>");
  xml.insert(xml.find("<body name=\"ball\""), "<site name=\"hook\" pos=\"0.3 0 0\"/>");
  xml.insert(
      xml.find("  <actuator>"),
      "<tendon><spatial name=\"rope\" stiffness=\"9\" limited=\"true\" range=\"0.1 0.6\"><site "
      "site=\"wall\"/><site site=\"hook\"/></spatial></tendon>");
  const ModelSpec arm = Arm(xml);
  EXPECT_NEAR(arm.Value("tendon:rope", "springlength[1]"), 0.5, 1e-12);
  const ModelAndData slack = arm.Build({{{"tendon:rope", "springlength[0]", 0.3}}});
  EXPECT_NEAR(slack.model->tendon_lengthspring[0], 0.3, 1e-12);
  EXPECT_NEAR(slack.model->tendon_lengthspring[1], 0.5, 1e-12);  // as at qpos0
  const auto message = [&](const std::string& attribute, double value) -> std::string {
    try {
      arm.Build({{{"tendon:rope", attribute, value}}});
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(message("springlength[0]", 0.7),
              HasSubstr("tendon 'rope': springlength[0]: expected a number below springlength[1] = "
                        "0.5"));
  EXPECT_THAT(message("springlength[1]", 0.2), HasSubstr("a number above springlength[0] = 0.5"));
  EXPECT_EQ(message("range[0]", 0.7),
            "tendon 'rope': range[0]: expected a number below range[1] = 0.6, found 0.7");
}

// A model that is drawn as it weighs: its only geom does not collide.
TEST_F(Changed, ABodyKeepsTheInertiaOfAGeomThatIsOnlySeen) {
  std::string xml = kArm;
  const std::string solid = "<geom size=\"0.05\" mass=\"1\"/>";
  xml.replace(xml.find(solid), solid.size(),
              "<joint name='spin'/><geom name='seen' size='0.05' mass='1' contype='0' "
              "conaffinity='0'/>");
  ModelSpec arm = Arm(xml);
  arm.DropVisuals();
  EXPECT_NEAR(Mass(arm.Build({{{"body:ball", "mass", 3}}}), "ball"), 3, 1e-12);
  const ModelSpec copy = arm;  // after a model was compiled
  EXPECT_NEAR(Mass(copy.Build(), "ball"), 1, 1e-12);
  EXPECT_NEAR(Inertia(*copy.Build().model, "ball")[0], 0.4 * 0.05 * 0.05, 1e-12);
  EXPECT_THAT(copy.Named("geom:seen"), ::testing::ElementsAre(HasSubstr("seen")));
}

// Textures are painted for whoever looks at them, not for names.
TEST_F(Changed, PaintedTexturesKeepTheirSizes) {
  std::string xml = kArm;
  xml.insert(xml.find("<worldbody>"),
             "<asset><texture name='sky' type='skybox' builtin='gradient' width='64' height='64'/>"
             "<texture name='chess' type='2d' builtin='checker' width='32' height='16'/></asset>");
  const ModelSpec arm = Arm(xml);
  const ModelSpec copy = arm;
  for (const ModelSpec* const spec : {&arm, &copy}) {
    const ModelAndData machine = spec->Build();
    EXPECT_EQ(machine.model->tex_width[0], 64);
    EXPECT_EQ(machine.model->tex_height[0], 6 * 64);
    EXPECT_EQ(machine.model->tex_width[1], 32);
    EXPECT_EQ(machine.model->tex_height[1], 16);
    EXPECT_THAT(spec->Xml(), HasSubstr("width=\"32\" height=\"16\""));
  }
}

// MuJoCo deletes them as it compiles: nothing may be written to them then.
TEST_F(Changed, PaintedTexturesMayBeLeftOut) {
  std::string xml = kArm, textures;
  for (int i = 0; i < 20; ++i) {
    textures += "<texture name='chess" + std::to_string(i) +
                "' type='2d' builtin='checker' width='32' height='16'/>";
  }
  xml.insert(xml.find("<worldbody>"),
             "<compiler discardvisual='true'/><asset>" + textures + "</asset>");
  const ModelSpec arm = Arm(xml);
  const ModelSpec copy = arm;
  EXPECT_EQ(copy.Build().model->ntex, 0);
  ModelSpec later = Arm();
  later.DropVisuals();
  EXPECT_EQ(later.Build().model->nbody, Arm().Build().model->nbody);
}

TEST_F(Changed, AShortLagIsNearlyNone) {
  const ModelSpec arm = Arm();
  for (const double lag : {0.0, 1e-9}) {
    const ModelAndData machine = arm.Build({{{"actuator:servo", "effect:pt1", lag}}});
    machine.data->ctrl[0] = 0.3;
    mj_step(machine.model.get(), machine.data.get());
    EXPECT_DOUBLE_EQ(machine.data->actuator_force[0], 3) << lag;
  }
}

TEST_F(Changed, DelaysAddAndSoDoLags) {
  const ModelSpec arm = Arm();
  EXPECT_DOUBLE_EQ(
      arm.Build({{{"actuator:late", "effect:dead_time", 0.03}}}).model->actuator_delay[1], 0.08);
  for (const double more : {0.03, -0.03}) {
    const ModelAndData machine = arm.Build({{{"actuator:lagged", "effect:pt1", more}}});
    EXPECT_DOUBLE_EQ(machine.model->actuator_dynprm[mjNDYN * 2], 0.1 + more);
  }
}

TEST_F(Changed, AHistoryCoversItsDelayAtTheStepThatIsUsed) {
  const ModelSpec arm = Arm();
  const ModelAndData machine =
      arm.Build({{{"actuator:servo", "effect:dead_time", 0.05}, {"option", "timestep", 2e-4}}});
  EXPECT_GE(machine.model->actuator_history[0], 250);
}

}  // namespace
}  // namespace continuum
