#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using testing::Scratch;

// A hand of a given inertia hangs below the link.
class Impossible : public testing::AppBench {
 protected:
  void SetUp() override {
    Spoil("model.xml", "<site name=\"tip\" pos=\"0 0 -0.3\"/>", R"(<site name="tip" pos="0 0 -0.3"/>
      <body name="hand" pos="0 0 -0.3"><joint name="wrist" axis="0 1 0" damping="0.02"/>
        <inertial pos="0 0 -0.1" mass="0.2" diaginertia="1e-3 1e-3 1e-3"/></body>)");
    std::string log = "t,u,q\n";
    for (int k = 0; k < 60; ++k)
      log += fmt::format("{},{:.3f},{:.4f}\n", 0.05 * k, 0.4 * std::sin(0.4 * k),
                         0.1 * std::sin(0.4 * k - 0.5));
    files_.Write("log.csv", log);
    files_.Write("other.csv", log);
    Spoil("experiment.yaml", "{file: log.csv}", "{file: log.csv}, {file: other.csv}");
  }
  void Free(const std::string& parameter) const {
    Spoil("experiment.yaml",
          "{name: b, target: \"joint:hinge\", attribute: damping, lower: 0.01, "
          "upper: 1}",
          parameter);
  }
  void ExpectRefusedAs(const std::vector<std::string>& words) const {
    for (const char* job : {"identify", "diagnose"})
      ExpectRefused({job, "experiment.yaml", "--out", "no"}, words);
  }
};

TEST_F(Impossible, MassAtTheStartIsNamedWithItsLineAndLog) {
  Free(
      "{name: m, target: \"body:hand\", attribute: mass, initial: 0, lower: 0, upper: 1}, "
      "{name: b, target: \"joint:hinge\", attribute: damping, lower: 0.01, upper: 1}");
  ExpectRefusedAs({"experiment.yaml: log 'log' with m = 0 (experiment.yaml:6: parameters[0]): ",
                   "model.xml", "'hand'"});
}

TEST_F(Impossible, AnInertiaAtTheStartThatExcludesTheOthersIsNamed) {
  Free(
      "{name: x, target: \"body:hand\", attribute: \"inertia[0]\", initial: 0.0025, lower: 1e-5, "
      "upper: 1}");
  ExpectRefusedAs({"with x = 0.0025 (experiment.yaml:6: parameters[0]): ", "A + B >= C"});
}

TEST_F(Impossible, ValuesThatExcludeEachOtherAreNamedTogether) {
  Free(
      "{name: x, target: \"body:hand\", attribute: \"inertia[0]\", initial: 0.0019, lower: 0, "
      "upper: 1}, {name: y, target: \"body:hand\", attribute: \"inertia[1]\", initial: 1e-4, "
      "lower: 0, upper: 1}");
  ExpectRefusedAs({"with x = 0.0019 (", "y = 0.0001 (", "A + B >= C"});
}

TEST_F(Impossible, AnEndOfARangeBeyondTheOtherIsNamedWithItsLine) {
  Spoil("model.xml", "<actuator>",
        "<tendon><fixed name=\"rope\" stiffness=\"1\" springlength=\"0 0.1\"><joint "
        "joint=\"hinge\" coef=\"1\"/></fixed></tendon><actuator>");
  Spoil("experiment.yaml", "{file: other.csv}",
        "{file: other.csv, set: {\"tendon:rope\": {\"springlength[0]\": 0.2}}}");
  ExpectRefusedAs({"experiment.yaml:7: logs[1].set (log 'other'): tendon 'rope': springlength[0]: ",
                   "a number below springlength[1] = 0.1, found 0.2"});
  Spoil("experiment.yaml", ", set: {\"tendon:rope\": {\"springlength[0]\": 0.2}}", "");
  Free(
      "{name: s, target: \"tendon:rope\", attribute: \"springlength[0]\", initial: 0.3, lower: 0, "
      "upper: 1}");
  ExpectRefusedAs({"experiment.yaml: log 'log' with s = 0.3 (experiment.yaml:6: parameters[0]): ",
                   "a number below springlength[1] = 0.1, found 0.3"});
}

TEST_F(Impossible, BoundsAreNamed) {
  Free(
      "{name: i, target: \"body:hand\", attribute: \"inertia[1]\", initial: 1e-3, lower: -1e-3, "
      "upper: 1}");
  ExpectRefusedAs({"experiment.yaml:6: parameters[0].lower", "a number >= 0 kg*m^2", "-0.001"});
}

TEST_F(Impossible, StartsAreNamed) {
  Free("{name: a, target: \"joint:hinge\", attribute: armature, initial: -1, lower: -2, upper: 1}");
  ExpectRefusedAs({"experiment.yaml:6: parameters[0].initial", "a number >= 0", "-1"});
}

TEST_F(Impossible, ParametersWithoutEffectAreNamedBeforeTheFit) {
  Free(
      "{name: b, target: \"joint:hinge\", attribute: damping, lower: 0.01, upper: 1}, "
      "{name: rough, target: \"geom:rod\", attribute: \"friction[0]\", lower: 0.1, upper: 2}");
  ExpectRefusedAs({"experiment.yaml:6: parameters[1]: parameter 'rough' (geom:rod, friction[0])",
                   "an effect on some output at its start 1"});
}

TEST_F(Impossible, IsWhatDivergesAtTheStart) {
  Free(
      "{name: k, target: \"joint:hinge\", attribute: stiffness, initial: -1e9, lower: -2e9, "
      "upper: 1}");
  const auto f = Run({"identify", "experiment.yaml", "--path", "stepped", "--out", "no"});
  EXPECT_EQ(f.exit_code, 1);
  for (const char* words : {"log.csv, log 'log', at the start of the fit: ", "diverges at ",
                            "with k = -1e+09 (experiment.yaml:6: parameters[0])"})
    EXPECT_THAT(f.err, HasSubstr(words));
}

TEST_F(Impossible, IsWhatALogSets) {
  const std::string set =
      "{file: other.csv, use: validate, set: {\"joint:hinge\": {stiffness: -1e9}}}";
  Spoil("experiment.yaml", "{file: other.csv}", set);
  auto f = Run({"identify", "experiment.yaml", "--path", "stepped", "--out", "out"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.out, HasSubstr("log 'other' (other.csv) has no error, with the fitted parameters: "
                               "the simulation diverges at "));
  Spoil("experiment.yaml", "use: validate, ", "");
  f = Run({"identify", "experiment.yaml", "--path", "stepped", "--out", "no"});
  EXPECT_EQ(f.exit_code, 1);
  EXPECT_THAT(f.err, HasSubstr("other.csv, log 'other', at the start of the fit: "));
  EXPECT_THAT(f.err, HasSubstr(" with its `set`"));
}

// The log is one of a heavy hand, whose inertia alone MuJoCo does not compile.
TEST_F(Impossible, IsARejectedStepInsideAFit) {
  std::string heavy = Scratch::Text(files_ / "model.xml"), input = "time,motor\n";
  const std::string moments = "1e-3 1e-3 1e-3";
  files_.Write("heavy.xml", heavy.replace(heavy.find(moments), moments.size(), "3e-3 4e-3 3e-3"));
  const auto torque = [](int k) { return 0.4 * std::sin(0.5 * k) + 0.2 * std::sin(1.3 * k); };
  for (int k = 0; k < 100; ++k) input += fmt::format("{:.2f},{:.6f}\n", 0.05 * k, torque(k));
  files_.Write("input.csv", input);
  ASSERT_EQ(Run({"run", "heavy.xml", "--input", "input.csv", "--out", "rows.csv"}).exit_code, 0);
  std::istringstream rows(Scratch::Text(files_ / "rows.csv"));
  std::string log, row;
  for (int k = -1; std::getline(rows, row); ++k)
    log += row + (k < 0 ? ",u" : fmt::format(",{:.6f}", torque(k))) + "\n";
  files_.Write("log.csv", log), files_.Write("other.csv", log);
  Spoil("experiment.yaml", "column: t,", "column: time,");
  Spoil("experiment.yaml", "column: q,", "column: angle,");
  Free(
      "{name: i, target: \"body:hand\", attribute: \"inertia[1]\", initial: 1e-3, lower: 1e-4, "
      "upper: 1}");
  const auto f = Run({"identify", "experiment.yaml", "--path", "stepped", "--out", "out"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  const auto fit = nlohmann::json::parse(Scratch::Text(files_ / "out/fit.json"));
  const double inertia = fit["parameters"][0]["value"];
  EXPECT_GT(inertia, 1.95e-3);
  EXPECT_LE(inertia, 2e-3 * (1 + 1e-9));  // what the others allow
}

}  // namespace
}  // namespace continuum
