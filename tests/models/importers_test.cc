#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/process.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

const std::string kServo = "servo_pendulum", kArm = "tdcr_three_segment", kTrunk = "trunk";
const char* const kRobots[] = {"emps",       "servo_pendulum",     "so101",
                               "stiff_flop", "tdcr_three_segment", "trunk"};

class Importers : public ::testing::Test {
 protected:
  testing::Finished Import(const std::string& robot, std::vector<std::string> arguments) const {
    const std::string script = CONTINUUM_SOURCE "/models/" + robot + "/import.py";
    arguments.insert(arguments.begin(), {"/usr/bin/env", "python3", "-B", script});
    return testing::RunProcess(std::move(arguments), scratch_.folder());
  }
  // What it says of the folder "in": one line, exit 2, and nothing written.
  std::string Refusal(const std::string& robot,
                      const std::vector<std::string>& arguments = {"in", "out"}) const {
    const testing::Finished finished = Import(robot, arguments);
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_THAT(finished.err, ::testing::StartsWith("import.py: "));
    EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "out"));
    return finished.err;
  }
  void Source(const std::string& name, const std::string& content) const {
    std::filesystem::create_directory(scratch_ / "in");
    scratch_.Write("in/" + name, content);
  }

  static std::string Recording(int entries, const std::string& position = "0.1",
                               const std::string& kp = "400", const std::string& on = "true") {
    std::string all;
    for (int k = 0; k < entries; ++k) {
      all += std::string(k ? "," : "") + "{\"timestamp\": " + std::to_string(k) +
             ", \"position\": " + position +
             ", \"speed\": 0, \"goal_position\": 1, \"torque_enable\": " + on + "}";
    }
    return R"({"kp": )" + kp + R"(, "vin": 7.4, "trajectory": "sin", "entries": [)" + all + "]}";
  }
  static std::string Arm(const std::string& row) {
    return "timestamp,pattern_label,servo_4_mm,servo_3_mm,servo_9_mm,servo_5_mm,servo_2_mm,"
           "servo_8_mm,servo_6_mm,servo_1_mm,servo_7_mm,tip_x,tip_y,tip_z\n"
           "10,rep1_home,0,0,0,0,0,0,0,0,0,1,2,3\n" +
           row;
  }
  static std::string Trunk(const std::string& row) {
    return "ID,phi1,phi2,phi3,phi4,phi5,phi6,x1,y1,z1,x2,y2,z2,x3,y3,z3\n"
           "0,1,1,1,1,1,1,0,0,0,0,0,0,0,0,0\n" +
           row;
  }

  testing::Scratch scratch_;
};

TEST_F(Importers, AskForTwoFolders) {
  for (const std::string robot : kRobots) {
    EXPECT_THAT(Refusal(robot, {}), HasSubstr("EXPERIMENT_FOLDER")) << robot;
    EXPECT_THAT(Refusal(robot, {"in"}), HasSubstr("found 1 argument\n")) << robot;
    EXPECT_THAT(Refusal(robot, {"1", "2", "3", "4"}), HasSubstr("found 4 arguments\n")) << robot;
  }
}

TEST_F(Importers, ExplainThemselves) {
  for (const std::string robot : kRobots) {
    const auto help = Import(robot, {"--help"});
    EXPECT_EQ(help.exit_code, 0) << robot;
    EXPECT_THAT(help.out, HasSubstr("usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER")) << robot;
  }
}

TEST_F(Importers, NameASourceThatIsNotThere) {
  for (const std::string robot : kRobots) EXPECT_THAT(Refusal(robot), HasSubstr(": in")) << robot;
}

TEST_F(Importers, ARegressionNamesWhatItCannotRead) {
  const auto refusal = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command{"/usr/bin/env", "python3", "-B",
                                     CONTINUUM_SOURCE "/models/trunk/regression.py"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const testing::Finished finished = testing::RunProcess(command, scratch_.folder());
    EXPECT_EQ(finished.exit_code, 2) << finished.err;
    EXPECT_EQ(finished.out, "");
    return finished.err;
  };
  EXPECT_EQ(refusal({}), "regression.py: expected EXPERIMENT_FOLDER, found 0 arguments\n");
  EXPECT_THAT(refusal({"out"}), HasSubstr("out/observations_controlled_1.csv: No such file"));
  Source("observations_controlled_1.csv", "t,phi1\n0,1\n1,1\n");
  EXPECT_THAT(refusal({"in"}), HasSubstr(":1: expected a column 'phi2', found t, phi1"));
}

TEST_F(Importers, DoNotWriteOverAFileOrTheirSource) {
  Source("here", "");
  scratch_.Write("file", "kept");
  for (const std::string robot : kRobots) {
    EXPECT_THAT(Refusal(robot, {"in", "file"}), HasSubstr("expected a folder")) << robot;
    EXPECT_THAT(Refusal(robot, {"in", "./in/"}), HasSubstr("other than the source")) << robot;
  }
  EXPECT_EQ(testing::Scratch::Text(scratch_ / "file"), "kept");
}

TEST_F(Importers, NameAMatlabFileThatIsAnother) {
  const std::string head(128, ' ');
  for (const std::string& content :
       {std::string(), std::string("t,qg\n0,1\n"), head,
        head + std::string("\x0f\0\0\0\x08\0\0\0\x78\x9cgarbage", 17),
        head + std::string("\x0e\0\0\0\x10\0\0\0\x06\0\0\0\x08\0\0\0", 16)}) {
    Source("DATA_EMPS.mat", content);
    EXPECT_THAT(Refusal("emps"), HasSubstr("in/DATA_EMPS.mat: expected a MATLAB file (version 5)"));
  }
}

TEST_F(Importers, NameTheRecordingOfAServoThatTheyCannotRead) {
  Source("a.json", "");
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/a.json: expected a recording"));
  Source("a.json", Recording(3).substr(0, 100));
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/a.json: expected a recording"));
  Source("a.json", "[1, 2]");
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/a.json: expected a recording"));
  Source("a.json", Recording(3, "NaN"));
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/a.json: entries[0].position: expected a finite"));
  Source("a.json", Recording(1));
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/a.json: entries: expected at least 2, found 1"));
  Source("a.json", Recording(3));
  Source("b.json", Recording(3));
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/b.json: expected one recording for each gain"));
  Source("b.json", std::string(100000, '['));
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/b.json: expected a recording"));
}

TEST_F(Importers, NameTheServoThatCannotBe) {
  for (const std::string kp : {"0", "-400", "1e300", "Infinity"}) {
    Source("a.json", Recording(3, "0.1", kp));
    EXPECT_THAT(Refusal(kServo), HasSubstr("in/a.json: ")) << kp;
  }
  Source("a.json", Recording(3, "0.1", "0"));
  EXPECT_THAT(Refusal(kServo), HasSubstr("a.json: kp: expected a gain of 1 to 16383, found 0"));
  Source("a.json", Recording(3, "0.1", "400", "0.5"));
  EXPECT_THAT(Refusal(kServo),
              HasSubstr("a.json: entries[0].torque_enable: expected 0 or 1, found 0.5"));
}

TEST_F(Importers, NameANumberThatNoMachineHas) {
  Source("a.json", Recording(3, "1e300"));
  EXPECT_THAT(Refusal(kServo), HasSubstr("in/a.json: entries[0].position: expected a number of "
                                         "-1000 to 1000 rad, found 1e+300"));
  std::string log = Recording(3);
  Source("a.json", log.replace(log.find("7.4"), 3, "1e300"));
  EXPECT_THAT(Refusal(kServo), HasSubstr("a.json: vin: expected a number of -100 to 100 V, found"));
  Source("one_train.csv", Arm("11,rep1_home,0,0,0,0,0,0,0,0,0,1,2,-1e300\n"));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv:3, column 'tip_z': expected a number of "
                                       "-10000 to 10000 mm, found -1e300"));
  Source("observations_controlled_1.csv", Trunk("1,1,1,1,1,1,1,0,0,0,0,0,0,0,0,11\n"));
  EXPECT_THAT(Refusal(kTrunk), HasSubstr("1.csv:3, column 'z3': expected a number of -10 to 10 m, "
                                         "found 11"));
}

TEST_F(Importers, KeepAServosTrajectoryForValidation) {
  std::string other = Recording(3);
  other.replace(other.find("\"sin\""), 5, "\"hold\"");
  Source("a.json", Recording(3));
  EXPECT_THAT(Refusal(kServo), HasSubstr("in: expected recordings of two trajectories or more, one "
                                         "of them to validate, found only 'sin'"));
  Source("b.json", other);
  EXPECT_EQ(Import(kServo, {"in", "out"}).out,
            "2 logs, sin for validation, and experiment.yaml in out\n");
  EXPECT_THAT(testing::Scratch::Text(scratch_ / "out/experiment.yaml"),
              ::testing::AllOf(HasSubstr("trial: hold, use: train"),
                               HasSubstr("trial: sin, use: validate")));
}

TEST_F(Importers, NameATimeThatDoesNotRise) {
  Source("one_train.csv", Arm("10,rep1_home,0,0,0,0,0,0,0,0,0,1,2,3\n"));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv:3, column 'timestamp': expected a time after "
                                       "10, found 10"));
  Source("observations_controlled_1.csv", Trunk("-1,1,1,1,1,1,1,0,0,0,0,0,0,0,0,0\n"));
  EXPECT_THAT(Refusal(kTrunk), HasSubstr("1.csv:3, column 'ID': expected a time after 0"));
  std::string log = Recording(3);
  Source("a.json", log.replace(log.find("\"timestamp\": 1"), 14, "\"timestamp\": 9"));
  EXPECT_THAT(Refusal(kServo),
              HasSubstr("in/a.json: entries[2].timestamp: expected a time after 9, found 2"));
}

TEST_F(Importers, ReadPastAByteOrderMarkAndFindAColumnThatIsThereTwice) {
  const std::string rows = Arm("11,rep1_home,0,0,0,0,0,0,0,0,0,1,2,3\n");
  Source("one_train.csv", "\xef\xbb\xbf" + rows);
  EXPECT_EQ(Import(kArm, {"in", "out"}).exit_code, 0);
  std::filesystem::remove_all(scratch_ / "out");
  std::string twice = rows;
  Source("one_train.csv", twice.replace(twice.find("tip_z"), 5, "tip_y"));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv:1: expected a column 'tip_y', found two"));
}

TEST_F(Importers, NameTheRowOfATableThatTheyCannotRead) {
  Source("one_train.csv", "");
  EXPECT_THAT(Refusal(kArm),
              HasSubstr("one_train.csv:1: expected a column 'timestamp', found not"));
  Source("one_train.csv", Arm(""));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv: expected at least 2 rows, found 1"));
  Source("one_train.csv", Arm("11,rep1_home,0,0,0\n"));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv:3: expected 14 cells, found 5"));
  Source("one_train.csv", Arm("11,rep1_home,0,0,0,0,0,0,0,0,x,1,2,3\n"));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv:3, column 'servo_7_mm': expected a finite"));
  Source("one_train.csv", Arm("11,../home_x,0,0,0,0,0,0,0,0,0,1,2,3\n"));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv:3, column 'pattern_label': expected rep"));
  Source("one_train.csv", Arm("11,rep1_\xff,0,0,0,0,0,0,0,0,0,1,2,3\n"));
  EXPECT_THAT(Refusal(kArm), HasSubstr("one_train.csv: expected a table as CSV"));
}

TEST_F(Importers, ReadAnArmsMotionsWithTheJawAsAnAngle) {
  std::string header = "t", row = "0.5";
  for (const std::string kind : {"goal_", "q_"}) {
    for (const std::string joint : {"pan", "lift", "elbow", "wrist_flex", "wrist_roll", "gripper"})
      header += "," + kind + joint, row += ",0.25";
  }
  std::filesystem::create_directories(scratch_ / "in/logs");
  for (const std::string name : {"a", "b", "c"}) Source("logs/" + name + ".csv", header + "\n");
  EXPECT_THAT(Refusal("so101"), HasSubstr("in: expected at least 4 motions"));
  Source("logs/d.csv", header + "\n" + row + "\n");
  EXPECT_THAT(Refusal("so101"), HasSubstr("a.csv: expected at least 2 rows, found 0"));
  for (const std::string name : {"a", "b", "c", "d"})
    Source("logs/" + name + ".csv", header + "\n" + row + "\n" + row + "\n");
  EXPECT_THAT(Refusal("so101"), HasSubstr("a.csv:3, column 't': expected a time after 0.5"));
  for (const std::string name : {"a", "b", "c", "d"})
    Source("logs/" + name + ".csv", header + "\n" + row + "\n1" + row + "\n");
  EXPECT_EQ(Import("so101", {"in", "out"}).out, "4 motions and 5 experiments in out\n");
  EXPECT_THAT(testing::Scratch::Text(scratch_ / "out/a.csv"), HasSubstr(",0.25,0.31000\n"));
}

TEST_F(Importers, ReadAllSourcesBeforeTheyWrite) {
  Source("observations_controlled_1.csv", Trunk("1,1,1,1,1,1,1,0,0,0,0,0,0,0,0,0\n"));
  EXPECT_THAT(Refusal(kTrunk), HasSubstr("in/observations_controlled_1_100g.csv: No such file"));
  Source("observations_controlled_1_100g.csv", Trunk("one,1,1,1,1,1,1,0,0,0,0,0,0,0,0,0\n"));
  EXPECT_THAT(Refusal(kTrunk), HasSubstr("1_100g.csv:3, column 'ID': expected a finite number"));
}

TEST_F(Importers, LeaveAWholeFolder) {
  Source("one_train.csv", Arm("11,rep1_pair12_same_hold,0,0,0,0,0,0,0,0,0,1,2,3\n"));
  EXPECT_THAT(Refusal(kArm, {"in", "out", "0"}), HasSubstr("EVERY: expected a number of rows"));
  EXPECT_THAT(Refusal("so101", {"in", "out", "0"}),
              HasSubstr("SECONDS: expected a positive number, found 0"));
  const auto done = Import(kArm, {"in", "out"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "2 logs, experiment.yaml and places.yaml in out\n");
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(scratch_ / "out"))
    names.push_back(file.path().filename());
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("home.csv", "pair12_same.csv",
                                                     "experiment.yaml", "places.yaml"));
}

}  // namespace
}  // namespace continuum
