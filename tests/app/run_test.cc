#include <fcntl.h>
#include <sys/stat.h>

#include "bench.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Scratch;
using ::testing::StartsWith;

class RunCommand : public testing::AppBench {};

TEST_F(RunCommand, WritesTheSensorsAtTheRowsOfItsInput) {
  const auto f = Run({"run", "model.xml", "--input", "input.csv"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.out, StartsWith("time,angle,tip_pos[0],tip_pos[1],tip_pos[2]\n0.5,0,"));
  EXPECT_THAT(f.out, AllOf(HasSubstr("\n0.6,"), HasSubstr("\n0.7,")));
}

TEST_F(RunCommand, EndsAtUntilWhereTheInputIsHeld) {
  EXPECT_THAT(
      Run({"run", "model.xml", "--input", "input.csv", "--until", "0.9", "--every", "0.2"}).out,
      AllOf(HasSubstr("\n0.5,"), HasSubstr("\n0.7,"), HasSubstr("\n0.9,")));
  const auto one = Run({"run", "model.xml", "--input", "input.csv", "--until", "0.5"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("\n0.5,"));
}

TEST_F(RunCommand, RefusesToEndBeforeItBegins) {
  ExpectRefused({"run", "model.xml", "--input", "input.csv", "--until", "0.4"},
                {"--until", "0.5 s", "0.4 s"});
}

TEST_F(RunCommand, RefusesNumbersThatAreNoneOrNeverEnd) {
  for (const char* option : {"--until", "--every", "--timestep"}) {
    for (const char* value : {"nan", "inf", "1e-300", "1e300", "-1", "0", "1s", ""}) {
      SCOPED_TRACE(std::string(option) + " " + value);
      ExpectRefused({"run", "model.xml", option, value}, {option, std::string("'") + value + "'"});
    }
  }
}

TEST_F(RunCommand, BlamesTheOptionsThatMakeItTooLong) {
  const std::string rows = ": expected an end and a period that give at most 1e+07 rows";
  const std::string steps = ": expected at most 1e+09 time steps";
  const struct {
    std::vector<std::string> options;
    std::string blamed;
  } cases[] = {
      {{"--every", "1e-8"}, "--every" + rows},
      {{"--until", "1e6"}, "--until" + rows},
      {{"--until", "1e6", "--every", "1e-3"}, "--until and --every" + rows},
      {{"--timestep", "1e-7"}, "--timestep" + rows},
      {{"--until", "1e9", "--input", "input.csv"}, "--until" + steps},
      {{"--timestep", "1e-9", "--every", "1"}, "--timestep" + steps},
      {{"--timestep", "1e-9", "--every", "1", "--until", "10"}, "--until and --timestep" + steps},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments{"run", "model.xml"};
    arguments.insert(arguments.end(), c.options.begin(), c.options.end());
    ExpectRefused(arguments, {"continuum: " + c.blamed});
  }
}

TEST_F(RunCommand, NeedsNamesOnlyForActuatorsThatColumnsDrive) {
  Spoil("model.xml", R"(<motor name="motor")", "<motor");
  ExpectRefused({"run", "model.xml", "--input", "input.csv"}, {"model.xml", "name", "actuator 0"});
  EXPECT_EQ(Run({"run", "model.xml", "--until", "0.1"}).exit_code, 0);
}

TEST_F(RunCommand, WritesThroughSymbolicLinks) {
  fs::create_directory(files_ / "there");
  fs::create_symlink("there/real.csv", files_ / "link.csv");
  for (int k = 0; k < 2; ++k) {  // the target is new, then old
    EXPECT_EQ(Run({"run", "model.xml", "--until", "0.1", "--out", "link.csv"}).exit_code, 0);
    EXPECT_TRUE(fs::is_symlink(files_ / "link.csv"));
    EXPECT_THAT(Scratch::Text(files_ / "there/real.csv"), StartsWith("time,angle"));
  }
}

// Links of its own stand for /dev/stdout and /dev/null: should this fail, nothing of the machine is
// lost.
TEST_F(RunCommand, LeavesStandardOutputAndPipesWhatTheyAre) {
  fs::create_symlink("/proc/self/fd/1", files_ / "stdout");
  const auto out = Run({"run", "model.xml", "--until", "0.1", "--out", "stdout"});
  EXPECT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.out, StartsWith("time,angle"));
  EXPECT_TRUE(fs::is_symlink(files_ / "stdout"));

  const std::string pipe = files_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int end = open(pipe.c_str(), O_RDWR | O_NONBLOCK);
  EXPECT_EQ(Run({"run", "model.xml", "--until", "0.1", "--out", "pipe"}).exit_code, 0);
  char text[11] = "";
  EXPECT_EQ(read(end, text, 10), 10);
  EXPECT_STREQ(text, "time,angle");
  EXPECT_TRUE(fs::is_fifo(pipe));
  close(end);
}

TEST_F(RunCommand, TakesPathsWithSpacesAndUmlauts) {
  fs::create_directory(files_ / "mein Ordner – ü");
  for (const char* file : {"model.xml", "input.csv"})
    fs::rename(files_ / file, files_ / (std::string("mein Ordner – ü/") + file));
  const auto f = Run({"run", "mein Ordner – ü/model.xml", "--input", "mein Ordner – ü/input.csv",
                      "--out", "mein Ordner – ü/Ergebnis 1.csv"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(Scratch::Text(files_ / "mein Ordner – ü/Ergebnis 1.csv"), StartsWith("time,angle"));
}

constexpr char kControls[] = R"(<mujoco><option gravity="0 0 0"/><worldbody>
  <body><joint name="a" damping=".1"/><geom size=".1" pos=".1 0 0" contype="0" conaffinity="0"/></body>
  <body><joint name="b" damping=".1"/><geom size=".1" pos=".1 0 0" contype="0" conaffinity="0"/></body></worldbody>
  <actuator><pid name="servo" joint="a" kp="5" kv=".3"/><motor name="last" joint="b"/></actuator>
  <sensor><jointpos name="a" joint="a"/><jointpos name="b" joint="b"/></sensor>
  <keyframe><key name="bent" qpos=".5 -.25" ctrl=".5 0 0"/></keyframe></mujoco>)";

// MuJoCo's pid has two controls: a position and a speed.
TEST_F(RunCommand, DrivesTheControlThatAColumnNames) {
  files_.Write("two.xml", kControls);
  files_.Write("u.csv", "time,servo[0],servo[1],last\n0,0,0,.1\n1,0,0,.1\n");
  const auto f = Run({"run", "two.xml", "--input", "u.csv"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.out, HasSubstr("\n1,0,0."));  // joint b alone moves
  files_.Write("u.csv", "time,last\n0,.1\n1,.1\n");
  ExpectRefused({"run", "two.xml", "--input", "u.csv"},
                {"time, servo[0], servo[1], last", "actuator 'servo' has 2 controls"});
}

TEST_F(RunCommand, BeginsAtAKeyframeAndHoldsItsControls) {
  files_.Write("two.xml", kControls);
  const auto f = Run({"run", "two.xml", "--keyframe", "bent", "--until", "1", "--every", ".5"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.out, AllOf(HasSubstr("\n0,0.5,-0.25\n"), HasSubstr("\n1,0.5,-0.25\n")));
  ExpectRefused({"run", "two.xml", "--keyframe", "straight"}, {"--keyframe", "bent", "'straight'"});
}

// As `import mujoco` does.
TEST_F(RunCommand, LoadsThePluginsThatComeWithMujoco) {
  files_.Write("pid.xml", R"(<mujoco><extension><plugin plugin="mujoco.pid">
    <instance name="pid"><config key="kp" value="5"/></instance></plugin></extension>
    <worldbody><body><joint name="h"/><geom size=".1" pos=".1 0 0"/></body></worldbody>
    <actuator><plugin name="m" joint="h" plugin="mujoco.pid" instance="pid"/></actuator></mujoco>)");
  const auto f = Run({"run", "pid.xml", "--until", ".01"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
}

// Once, however often the model is built.
TEST_F(RunCommand, PrintsWhatEffectsWarnOf) {
  files_.Write("discrete.xml", R"(<mujoco><option integrator="discrete"/><extension>
    <plugin plugin="continuum.coulomb"><instance name="dry"><config key="joint" value="h"/>
    <config key="tau_c" value=".1"/></instance></plugin></extension>
    <worldbody><body><joint name="h"/><geom size=".1" pos=".1 0 0"/></body></worldbody></mujoco>)");
  const auto f = Run({"run", "discrete.xml", "--until", ".01"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.err, AllOf(StartsWith("warning: continuum.coulomb 'dry': "), HasSubstr("creeps")));
  EXPECT_EQ(std::count(f.err.begin(), f.err.end(), '\n'), 1) << f.err;
}

TEST_F(RunCommand, SaysWhichEffectsAnAttachedRobotLost) {
  const auto arm = [](const std::string& reference) {
    return R"(<mujoco><extension><plugin plugin="continuum.coulomb"><instance name="dry">
      <config key="joint" value="h"/><config key="tau_c" value=".1"/></instance></plugin></extension>
      <worldbody><body name="b">)" +
           reference +
           R"(<joint name="h"/><geom size=".1" pos=".1 0 0"/></body></worldbody></mujoco>)";
  };
  files_.Write("scene.xml", R"(<mujoco><asset><model name="arm" file="arm.xml"/></asset><worldbody>
    <attach model="arm" prefix="left_"/></worldbody></mujoco>)");
  files_.Write("arm.xml", arm(""));
  const auto lost = Run({"run", "scene.xml", "--until", ".01"});
  EXPECT_EQ(lost.exit_code, 0) << lost.err;
  EXPECT_THAT(lost.err, AllOf(StartsWith("warning: arm.xml: continuum.coulomb 'dry' is lost"),
                              HasSubstr("docs/cables.md")));
  const auto checked = Run({"check", "scene.xml"});
  EXPECT_EQ(checked.err, lost.err);
  EXPECT_EQ(checked.out, "scene.xml: 0 effects of continuum\n");
  files_.Write("arm.xml", arm(R"(<plugin plugin="continuum.coulomb" instance="dry"/>)"));
  EXPECT_EQ(Run({"run", "scene.xml", "--until", ".01"}).err, "");
  EXPECT_THAT(Run({"check", "scene.xml"}).out, HasSubstr("continuum.coulomb 'left_dry'"));
  ExpectRefused({"check", "scene.xml", "--json"}, {"--json", "an experiment"});
}

}  // namespace
}  // namespace continuum
