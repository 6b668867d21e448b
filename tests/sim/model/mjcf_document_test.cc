#include "sim/model/mjcf_document.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "sim/model/model_spec.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

constexpr char kBare[] =
    "<mujoco model=\"m\">\n"
    "  <compiler angle=\"radian\"/>\n"
    "\n"
    "  <worldbody/>\n"
    "</mujoco>\n";

constexpr char kWithEffect[] =
    "<mujoco model=\"m\">\n"
    "  <extension>\n"
    "    <plugin plugin=\"continuum.coulomb\">\n"
    "      <instance name=\"rub\">\n"
    "        <config key=\"joint\" value=\"q\"/>\n"
    "        <config key=\"tau_c\" value=\"0.1\"/>\n"
    "      </instance>\n"
    "    </plugin>\n"
    "  </extension>\n"
    "  <worldbody/>\n"
    "</mujoco>\n";

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(MjcfDocument, TextsOfTheRobotsAreKeptByteForByte) {
  int models = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(CONTINUUM_SOURCE "/models")) {
    if (entry.path().extension() != ".xml") continue;
    const std::string xml = ModelSpec::Load(entry.path()).Xml();
    EXPECT_TRUE(MjcfDocument(xml).Text() == xml) << entry.path();
    ++models;
  }
  EXPECT_GT(models, 5);
}

TEST(MjcfDocument, WhatIsNotEditedKeepsOrderCommentsQuotesAndEscapes) {
  const std::string xml =
      "<?xml version=\"1.0\"?>\n<!-- a < b & c -->\n"
      "<mujoco model=\"it&apos;s &quot;m&quot;\">\n"
      "  <extension>\n"
      "    <plugin plugin=\"continuum.coulomb\">\n"
      "      <!-- first -->\n"
      "      <instance name=\"rub\">\n"
      "        <config value=\"a&gt;b\" key=\"joint\"/>\n"
      "      </instance>\n"
      "    </plugin>\n"
      "  </extension>\n"
      "  <custom><text name=\"t\" data=\"x &#10; y\"/></custom>\r\n"
      "</mujoco>\n<!-- end -->\n";
  EXPECT_EQ(MjcfDocument(xml).Text(), xml);
}

TEST(MjcfDocument, AnInstanceGoesToTheEndOfTheExtension) {
  MjcfDocument document(kWithEffect);
  document.AddInstance({"viscous", "oil", {{"joint", "q"}, {"b", "2"}}});
  EXPECT_EQ(document.Text(), Replaced(kWithEffect, "  </extension>",
                                      "    <plugin plugin=\"continuum.viscous\">\n"
                                      "      <instance name=\"oil\">\n"
                                      "        <config key=\"joint\" value=\"q\"/>\n"
                                      "        <config key=\"b\" value=\"2\"/>\n"
                                      "      </instance>\n"
                                      "    </plugin>\n"
                                      "  </extension>"));
}

TEST(MjcfDocument, AModelWithoutEffectsGetsAnExtension) {
  MjcfDocument document(kBare);
  document.AddInstance({"viscous", "oil", {{"joint", "q"}}});
  EXPECT_EQ(document.Text(), Replaced(kBare, "  <compiler",
                                      "  <extension>\n"
                                      "    <plugin plugin=\"continuum.viscous\">\n"
                                      "      <instance name=\"oil\">\n"
                                      "        <config key=\"joint\" value=\"q\"/>\n"
                                      "      </instance>\n"
                                      "    </plugin>\n"
                                      "  </extension>\n"
                                      "\n"
                                      "  <compiler"));
}

TEST(MjcfDocument, AConfigIsReplacedOrAdded) {
  MjcfDocument document(kWithEffect);
  document.SetConfig("rub", "tau_c", "0.3");
  document.SetConfig("rub", "new", "1");
  EXPECT_EQ(document.Text(),
            Replaced(kWithEffect, "value=\"0.1\"/>\n",
                     "value=\"0.3\"/>\n        <config key=\"new\" value=\"1\"/>\n"));
  EXPECT_THROW(document.SetConfig("other", "tau_c", "1"), Error);
}

TEST(MjcfDocument, APluginGoesWithItsLastInstance) {
  MjcfDocument document(kBare);
  document.AddInstance({"viscous", "oil", {}});
  document.AddInstance({"viscous", "grease", {}});
  document.RemoveInstance("oil");
  EXPECT_THAT(document.Text(), ::testing::Not(HasSubstr("oil")));
  EXPECT_THAT(document.Text(), HasSubstr("grease"));
  document.RemoveInstance("grease");
  EXPECT_THAT(document.Text(), ::testing::Not(HasSubstr("<plugin")));
  EXPECT_THROW(document.RemoveInstance("oil"), Error);
}

// MuJoCo's attach keeps what bodies refer to, and refuses a reference to nothing.
TEST(MjcfDocument, BodiesReferToWhatTakesThePlaceOfAnInstance) {
  const auto referring = [&](const std::string& to) {
    return Replaced(kWithEffect, "<worldbody/>",
                    "<worldbody><body><body name=\"b\">" + to + "</body></body></worldbody>");
  };
  MjcfDocument document(referring("<plugin plugin=\"continuum.coulomb\" instance=\"rub\"/>"));
  document.ReplaceInstance("rub", {"viscous", "oil", {}});
  EXPECT_THAT(
      document.Text(),
      HasSubstr("<body name=\"b\"><plugin plugin=\"continuum.viscous\" instance=\"oil\"/>"));
  EXPECT_THAT(document.Text(), ::testing::Not(HasSubstr("rub")));
  document.RemoveInstance("oil");
  EXPECT_THAT(document.Text(), ::testing::Not(HasSubstr("<plugin")));
}

TEST(MjcfDocument, NamesAndValuesMayHoldCharactersOfXml) {
  const std::string joint = "q&<1>\"x\"'y'";
  const std::string arm =
      "<mujoco><worldbody><body><joint name=\"q&amp;&lt;1&gt;&quot;x&quot;&apos;y&apos;\"/>"
      "<geom size=\"0.1\"/></body></worldbody></mujoco>";
  const std::string name = "dry & \"cold\" <friction>";
  const ModelSpec plain = ModelSpec::Parse(arm);
  const EffectInstance effect{"coulomb", name, {{"joint", joint}, {"tau_c", "0.1"}}};
  const ModelSpec with = plain.With({}, {{effect}});
  EXPECT_EQ(with.Value("plugin:" + name, "tau_c"), 0.1);
  const ModelSpec changed = with.With({{{"plugin:" + name, "tau_c", 0.25}}}, {});
  EXPECT_EQ(changed.Value("plugin:" + name, "tau_c"), 0.25);
  const EffectInstance spring{"cubic_stiffness", name, {{"joint", joint}, {"k3", "3"}}};
  EXPECT_EQ(changed.Replacing(name, spring).Value("plugin:" + name, "k3"), 3);
}

TEST(MjcfDocument, TextThatIsNoMjcfIsRefused) {
  EXPECT_THROW(MjcfDocument("<mujoco>"), Error);
  EXPECT_THROW(MjcfDocument("<robot/>"), Error);
}

class EmptyConfig : public ::testing::Test {
 protected:
  static std::string Message(const std::string& xml) {
    try {
      RefuseEmptyConfig(xml, "arm.xml");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(EmptyConfig, IsRefusedWithItsLineAndKey) {
  EXPECT_EQ(Message("<mujoco>\n<!-- <config key=\"x\" value=\"\"/> -->\n <a>\n"
                    "<config key='a>b &amp; c'\n value = ''/></a></mujoco>"),
            "arm.xml:4: config 'a>b & c': expected a value, found ''");
}

TEST_F(EmptyConfig, OtherValuesPass) {
  EXPECT_EQ(Message("<mujoco><config key=\"a\" value=\"1\"/><config key=\"b\"/></mujoco>"), "");
  EXPECT_EQ(Message("no XML"), "");
}

}  // namespace
}  // namespace continuum
