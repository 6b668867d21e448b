#include "sim/experiment/experiment.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "error.h"
#include "sim/io/decimal.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAreArray;

constexpr char kLog[] = "t,T1,on,q1\n0,1,1,10\n100,2,0,\n250,3,1,30\n400,4,0,40\n";
constexpr char kExperiment[] = R"(format: 1
model: m.xml
time: {column: t, unit: ms}
inputs: [{column: T1, unit: mN, actuator: cable1, enable: on}]
outputs: [{column: q1, unit: deg, sensor: bend1}]
logs: [{file: log.csv}]
)";

class ExperimentFile : public ::testing::Test {
 protected:
  ExperimentFile() {
    scratch_.Write("log.csv", kLog);
    scratch_.Write("m.xml", "<mujoco/>");
  }

  Experiment Read(const std::string& text) const {
    return Experiment::Read(scratch_.Write("e.yaml", text));
  }
  // The good file with one text replaced by another.
  Experiment With(const std::string& old, const std::string& by) const {
    std::string text = kExperiment;
    const std::size_t at = text.find(old);
    EXPECT_NE(at, text.npos) << old;
    return Read(text.replace(at, old.size(), by));
  }
  static std::string Message(const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      return e.what();
    } catch (const std::exception& e) {
      ADD_FAILURE() << "not a continuum::Error: " << e.what();
      return e.what();
    }
    return "no error";
  }
  std::string Wrong(const std::string& old, const std::string& by) const {
    return Message([&] { With(old, by); });
  }
  std::string Wrong(const std::string& log) const {
    scratch_.Write("log.csv", log);
    return Message([&] { Read(kExperiment); });
  }

  testing::Scratch scratch_;
};

TEST_F(ExperimentFile, IsReadInSi) {
  const Experiment e = Read(kExperiment);
  EXPECT_EQ(e.model, scratch_ / "m.xml");
  ASSERT_EQ(e.logs.size(), 1u);
  const Log& log = e.logs[0];
  EXPECT_THAT(log.time, ElementsAre(0, 0.1, 0.25, 0.4));
  EXPECT_THAT(log.input[0], ElementsAre(1e-3, 2e-3, 3e-3, 4e-3));
  EXPECT_THAT(log.enable[0], ElementsAre(true, false, true, false));
  EXPECT_DOUBLE_EQ(log.measured[0][2], std::numbers::pi / 6);
  EXPECT_TRUE(std::isnan(log.measured[0][1]));
  EXPECT_EQ(log.label, "log");
  EXPECT_EQ(log.trial, "log");
  EXPECT_TRUE(log.train && e.all_candidates);
  EXPECT_EQ(e.start, Experiment::Start::kRest);
}

TEST_F(ExperimentFile, CutsWindowsInSecondsOfTheLogAndThenSkewsTheClock) {
  std::string text = kExperiment;
  text.replace(text.find("unit: ms"), 8, "unit: ms, skew: 0.01");
  text.replace(text.find("[{file: log.csv}]"), 17,
               "\n  - {file: log.csv, window: [0, 0.1]}\n  - {file: log.csv, window: [0.25, 0.4]}");
  const Experiment e = Read(text);
  EXPECT_THAT(e.logs[0].time, ElementsAre(0, 0.1 * 1.01));
  EXPECT_THAT(e.logs[1].time, ElementsAre(0.25 * 1.01, 0.4 * 1.01));
  EXPECT_EQ(e.logs[1].Begin(), e.logs[0].time[0]);
  EXPECT_NE(e.logs[0].label, e.logs[1].label);
}

TEST_F(ExperimentFile, GivesEveryLogALabelOfItsOwn) {
  std::filesystem::create_directory(scratch_ / "other");
  scratch_.Write("other/log.csv", kLog);
  scratch_.Write("log_2.csv", kLog);
  const Experiment e =
      With("[{file: log.csv}]", "[{file: log.csv}, {file: other/log.csv}, {file: log_2.csv}]");
  EXPECT_NE(e.logs[0].label, e.logs[1].label);
  EXPECT_NE(e.logs[0].label, e.logs[2].label);
  EXPECT_NE(e.logs[1].label, e.logs[2].label);
}

// As replicates they would show a noise of zero.
TEST_F(ExperimentFile, RefusesTheSameRowsInTwoLogsAndNamesBoth) {
  const auto twice = [&](const std::string& first, const std::string& second) {
    return Wrong("logs: [{file: log.csv}]",
                 "logs:\n  - {file: log.csv" + first + "}\n  - {file: log.csv" + second + "}");
  };
  EXPECT_THAT(twice("", ""), AllOf(HasSubstr("e.yaml:8"), HasSubstr("logs[1]"), HasSubstr("as in "),
                                   HasSubstr("e.yaml:7: logs[0]")));
  EXPECT_THAT(twice(", trial: a", ", trial: b"), HasSubstr("no other log has"));
  EXPECT_THAT(twice(", condition: a", ", condition: b"), HasSubstr("no other log has"));
  EXPECT_THAT(twice("", ", use: validate"), HasSubstr("no other log has"));
  EXPECT_THAT(twice("", ", window: [0.1, 0.3]"), HasSubstr("window [0.1, 0.3]"));
  EXPECT_THAT(twice(", window: [0, 0.21]", ", window: [0.2, 0.4]"),
              HasSubstr("windows that do not overlap"));
  std::filesystem::create_symlink(scratch_ / "log.csv", scratch_ / "link.csv");
  EXPECT_THAT(Wrong("[{file: log.csv}]", "[{file: log.csv}, {file: link.csv}]"),
              HasSubstr("link.csv, as in "));
}

TEST_F(ExperimentFile, TakesWindowsOfOneFileThatTouch) {
  EXPECT_EQ(With("[{file: log.csv}]",
                 "[{file: log.csv, window: [0, 0.2]}, {file: log.csv, window: [0.2, 0.4]}]")
                .logs.size(),
            2u);
}

TEST_F(ExperimentFile, CountsAClockThatBeganLongAgoFromItsFirstRow) {
  for (const auto& [unit, first, second, last] :
       {std::array{"ns", "1714564800000000000", "1714564800010000000", "1714564800250000001"},
        std::array{"us", "1714564800000000", "1714564800010000", "1714564800250000.001"},
        std::array{"s", "1714564800.0", "1714564800.01", "1714564800.250000001"},
        std::array{"s", "2024-05-01T12:00:00Z", "2024-05-01T12:00:00.010Z",
                   "2024-05-01T14:00:00.250000001+02:00"},
        std::array{"ms", "12:00:00", "12:00:00.010", "12:00:00.250000001"}}) {
    scratch_.Write("log.csv", std::string("t,T1,on,q1\n") + first + ",1,1,10\n" + second +
                                  ",2,0,\n" + last + ",3,1,30\n");
    EXPECT_THAT(With("unit: ms", std::string("unit: ") + unit).logs[0].time,
                ElementsAre(0, 0.01, 0.250000001))
        << first;
  }
  scratch_.Write("log.csv",
                 "t,T1,on,q1\n1714564800,1,1,10\n1714564801,1,1,20\n1714564802,1,1,30\n");
  for (const char* window : {"[1, 2]", "[1714564801, 1714564802]"}) {
    std::string text = kExperiment;
    text.replace(text.find("unit: ms"), 8, "unit: s");
    text.replace(text.find("{file: log.csv}"), 15,
                 std::string("{file: log.csv, window: ") + window + "}");
    EXPECT_THAT(Read(text).logs[0].time, ElementsAre(1, 2)) << window;
  }
}

TEST_F(ExperimentFile, CountsTimesOfDayOnOverMidnight) {
  scratch_.Write("log.csv", "t,T1,on,q1\n23:59:59,1,1,1\n00:00:00.5,1,1,1\n00:00:01,1,1,1\n");
  EXPECT_THAT(Read(kExperiment).logs[0].time, ElementsAre(0, 1.5, 2));
  EXPECT_THAT(Wrong("t,T1,on,q1\n12:00:01,1,1,1\n12:00:00,1,1,1\n"), HasSubstr("increasing"));
}

TEST_F(ExperimentFile, FillsGapsOfInputsAsTheyInterpolate) {
  scratch_.Write("log.csv", "t,T1,on,q1\n0,1,1,1\n1,,1,2\n3,4,1,3\n4,,1,4\n");
  EXPECT_THAT(With("unit: mN", "unit: mN, interpolate: hold").logs[0].input[0],
              ElementsAre(1e-3, 1e-3, 4e-3, 4e-3));
  EXPECT_THAT(With("unit: mN", "unit: mN, interpolate: linear").logs[0].input[0],
              ElementsAre(1e-3, 2e-3, 4e-3, 4e-3));
  EXPECT_THAT(Message([&] { Read(kExperiment); }),
              AllOf(HasSubstr("log.csv:3, column 'T1'"), HasSubstr("`interpolate: hold` keeps")));
  scratch_.Write("log.csv", "t,T1,on,q1\n0,,1,1\n1,1,1,2\n");
  EXPECT_THAT(Wrong("unit: mN", "unit: mN, interpolate: hold"),
              AllOf(HasSubstr("log.csv:2, column 'T1'"), HasSubstr("`window`")));
}

TEST_F(ExperimentFile, AsksForTheUnitOfTimesThatNoClockHas) {
  scratch_.Write("log.csv", "t,T1,on,q1\n1714564800000000000,1,1,10\n1714564801000000000,1,1,20\n");
  EXPECT_THAT(Wrong("unit: ms", "unit: s"),
              AllOf(HasSubstr("log.csv:2, column 't'"), HasSubstr("write time: {unit: ns}")));
  scratch_.Write("log.csv", "t,T1,on,q1\n12:00:00,1,1,10\n13,1,1,20\n");
  EXPECT_THAT(Wrong("unit: ms", "unit: s"), AllOf(HasSubstr("log.csv:3"), HasSubstr("a date")));
}

TEST_F(ExperimentFile, PutsBackFullTurnsThatAnAngleLost) {
  const auto log = [&](const char* rows) {
    scratch_.Write("log.csv", std::string("t,T1,on,q1\n") + rows);
    return With("unit: deg", "unit: deg, unwrap: true").logs[0].measured[0];
  };
  const double degree = std::numbers::pi / 180;
  const auto values = log("0,1,1,170\n1,1,1,-175\n2,1,1,\n3,1,1,-5\n4,1,1,150\n5,1,1,-170\n");
  const double expected[] = {170, 185, NAN, 355, 510, 550};
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (k == 2) continue;  // not measured
    EXPECT_NEAR(values[k], expected[k] * degree, 1e-12) << k;
  }
  EXPECT_NEAR(log("0,1,1,5\n1,1,1,355\n2,1,1,10\n")[1], -5 * degree, 1e-12);
  EXPECT_THAT(Wrong("unit: deg", "unit: deg/s, unwrap: true"),
              AllOf(HasSubstr("unwrap"), HasSubstr("the unit of an angle")));
  EXPECT_THAT(Wrong("unit: mN", "unit: mN, unwrap: true"), HasSubstr("the unit of an angle"));
}

TEST_F(ExperimentFile, TakesMatlabFilesByTheirFirstBytesAndNamesOtherFormats) {
  EXPECT_THAT(Wrong("MATLAB 5.0 MAT-file, Platform: GLNXA64"),
              HasSubstr("a MATLAB file of version"));
  EXPECT_THAT(Wrong(std::string("PAR1\x15\0", 6)), HasSubstr("a Parquet file"));
}

TEST_F(ExperimentFile, KeepsColumnNamesAsTheyAreWritten) {
  scratch_.Write("log.csv", "t,T1,on,1\n0,1,1,10\n100,2,0,20\n");
  EXPECT_EQ(With("column: q1", "column: 1").channels[0].name, "1");
}

TEST_F(ExperimentFile, ReadsKnownValuesParametersAndCandidates) {
  const Experiment e =
      With("logs: [{file: log.csv}]", R"(candidates: [{effect: payload, where: "body:tip",
    per: condition}, dead_time]
folds: [trial, window]
parameters:
  - {name: k, target: "joint:bend*", attribute: stiffness, initial: 1, lower: 0.1, upper: 10, per: log,
     operation: scale, frozen: true}
logs: [{file: log.csv, use: validate, trial: a, condition: b, set: {"body:tip": {mass: 0.1}, option: {timestep: 1e-3}}}])");
  ASSERT_EQ(e.candidates.size(), 2u);
  EXPECT_TRUE(e.candidates[0].per_condition && !e.candidates[1].per_condition);
  EXPECT_EQ(e.parameters[0].operation, Change::Operation::kScale);
  EXPECT_EQ(e.parameters[0].per, Parameter::Per::kLog);
  EXPECT_FALSE(e.logs[0].train);
  EXPECT_EQ(e.logs[0].set.size(), 2u);
  EXPECT_EQ(e.folds.size(), 2u);
}

TEST_F(ExperimentFile, ErrorsNameLineAndKey) {
  EXPECT_THAT(Wrong("format: 1", "format: 2"), HasSubstr("e.yaml:1: format"));
  EXPECT_THAT(Wrong("model: m.xml", "modle: m.xml"),
              AllOf(HasSubstr("e.yaml:2"), HasSubstr("modle")));
  EXPECT_THAT(Wrong("model: m.xml\n", ""), HasSubstr("'model'"));
  EXPECT_THAT(Wrong("unit: ms", "unit: fortnight"),
              AllOf(HasSubstr("e.yaml:3"), HasSubstr("fortnight")));
  EXPECT_THAT(Wrong("column: T1", "column: [T1]"),
              AllOf(HasSubstr("e.yaml:4"), HasSubstr("a list")));
  EXPECT_THAT(Wrong("actuator: cable1, ", ""),
              AllOf(HasSubstr("e.yaml:4"), HasSubstr("'actuator'")));
  EXPECT_THAT(Wrong("[{column: q1, unit: deg, sensor: bend1}]", "[]"),
              HasSubstr("at least one output"));
  EXPECT_THAT(Wrong("sensor: bend1", "sensor: bend1, actuator: a"), HasSubstr("both"));
  EXPECT_THAT(Wrong("sensor: bend1", "sensor: bend1, sigma: -1"), HasSubstr("sigma"));
  EXPECT_THAT(Wrong("sensor: bend1", "sensor: bend1, weight: .nan"), HasSubstr("weight"));
  EXPECT_THAT(Wrong("sensor: bend1", "sensor: bend1, weight: 0"), HasSubstr("weight above 0"));
  EXPECT_THAT(Wrong("sensor: bend1", "sensor: bend1, delay: -1"), HasSubstr("delay"));
  EXPECT_THAT(Wrong("sensor: bend1", "sensor: bend1, scale: two"), HasSubstr("'two'"));
  EXPECT_THAT(Wrong("column: q1,", "columns: [a, b, c],"), HasSubstr("quaternion"));
  EXPECT_THAT(Wrong("[{file: log.csv}]", "[]"), HasSubstr("at least one log"));
  EXPECT_THAT(Wrong("file: log.csv", "file: none.csv"),
              AllOf(HasSubstr("e.yaml:6"), HasSubstr("none.csv")));
  EXPECT_THAT(Wrong("file: log.csv", "file: log.csv, use: test"), HasSubstr("train | validate"));
  EXPECT_THAT(Wrong("file: log.csv", "file: log.csv, window: [1, 0]"), HasSubstr("window"));
  EXPECT_THAT(Wrong("file: log.csv", "file: log.csv, window: [0, 0.05]"),
              HasSubstr("two rows, found 1"));
  EXPECT_THAT(
      Wrong("file: log.csv", "file: log.csv, window: [5, 9]"),
      HasSubstr("window, [5, 9] s: expected at least two rows, found none: it ends at 0.4"));
  scratch_.Write("log.csv", "t,T1,on,q1\n0,1,1,10\n100,2,0,20\n0,1,1,10\n");
  EXPECT_THAT(Message([&] { Read(kExperiment); }),
              HasSubstr("found 0 after 100, as in " + (scratch_ / "log.csv").string() + ":2"));
  scratch_.Write("log.csv", kLog);
  EXPECT_THAT(Wrong("format: 1", "format: 1\nformat: 1"), HasSubstr("'format' twice"));
  EXPECT_THAT(Wrong("format: 1", "format: 1\nstart: warm"), HasSubstr("'warm'"));
  EXPECT_THAT(Wrong("format: 1", "format: 1\ncandidates: [ghosts]"), HasSubstr("'ghosts'"));
  EXPECT_THAT(Wrong("format: 1", "format: 1\ncandidates: [dahl, lugre, dahl]"),
              AllOf(HasSubstr("e.yaml:2: candidates[2]"), HasSubstr("'dahl' again, as in")));
  const std::string law =
      "{effect: formula, name: drag, parameters: [{name: b, initial: 1, lower: 0, upper: 2, "
      "absent: "
      "0}], force: ";
  EXPECT_THAT(Wrong("format: 1", "format: 1\ncandidates:\n  - " + law + "b*v}\n  - " + law +
                                     "b*v*abs(v), where: 'joint:other'}"),
              AllOf(HasSubstr("e.yaml:4: candidates[1]"), HasSubstr("'drag' again, as in"),
                    HasSubstr("e.yaml:3")));
  std::string wider = law;
  wider.replace(wider.find("upper: 2"), 8, "upper: 3");
  EXPECT_THAT(Wrong("format: 1", "format: 1\ncandidates:\n  - " + law + "b*v}\n  - " + wider +
                                     "b*v, where: 'joint:other'}"),
              AllOf(HasSubstr("e.yaml:4: candidates[1]"), HasSubstr("'drag' again, as in")));
  EXPECT_THAT(Wrong("format: 1", "format: [1"), HasSubstr("e.yaml:"));
  EXPECT_THAT(Wrong("inputs: [{", "inputs: [{column: T1, actuator: cable1}, {"),
              HasSubstr("'cable1' twice"));
  EXPECT_THAT(Wrong("outputs: [{", "outputs: [{column: q1, sensor: other}, {"),
              HasSubstr("'q1' twice"));
}

TEST_F(ExperimentFile, RefusesATurnWithoutADirectionOrWithoutAVector) {
  EXPECT_THAT(Wrong("sensor: bend1", "sensor: \"tip[0]\", angle: 0.1, axis: [0, 0, 0]"),
              HasSubstr("axis"));
}

TEST_F(ExperimentFile, ErrorsOfALogNameItsLineAndColumn) {
  EXPECT_THAT(Wrong("t,T1,on,q1\n0,1,1,1\n0,1,1,1\n"),
              AllOf(HasSubstr("log.csv:3"), HasSubstr("increasing")));
  EXPECT_THAT(Wrong("t,T1,on,q1\n0,1,1,1\n1,nan,1,1\n"),
              AllOf(HasSubstr("log.csv:3"), HasSubstr("'T1'")));
  EXPECT_THAT(Wrong("t,T1,on,q1\n0,1,1,1\n1,1,maybe,1\n"),
              AllOf(HasSubstr("log.csv:3"), HasSubstr("'on'")));
  EXPECT_THAT(Wrong("t,T1,on,q1\n0,1,1,1\n1,1,1,inf\n"),
              AllOf(HasSubstr("log.csv:3"), HasSubstr("'q1'")));
  EXPECT_THAT(Wrong("t,T1,on\n0,1,1\n1,1,1\n"), AllOf(HasSubstr("log.csv:1"), HasSubstr("'q1'")));
  EXPECT_THAT(Wrong("t,T1,on,q1\n0,1,1,\n1,1,1,nan\n"),
              AllOf(HasSubstr("'q1'"), HasSubstr("at least one")));
  EXPECT_THAT(Wrong("t,T1,on,q1\n0,1,1,1\n"), HasSubstr("two rows"));
  EXPECT_THAT(Wrong(""), HasSubstr("header"));
}

TEST_F(ExperimentFile, SurvivesPathsThatNoFileSystemTakes) {
  const std::string name(5000, 'a');
  EXPECT_THAT(Wrong("file: log.csv", "file: " + name), HasSubstr("e.yaml:6"));
  EXPECT_THAT(Wrong("file: log.csv", "file: \"a\\0b\""), HasSubstr("e.yaml:6"));
  EXPECT_THAT(Wrong("file: log.csv", "file: ."), HasSubstr("a folder"));
  EXPECT_THAT(Wrong("model: m.xml", "model: nix.xml"),
              AllOf(HasSubstr("e.yaml:2: model"), HasSubstr("nix.xml")));
  EXPECT_THAT(Message([&] { Experiment::Read(scratch_ / name); }), HasSubstr("readable"));
}

TEST_F(ExperimentFile, SurvivesDeepAndCircularYaml) {
  EXPECT_NE(Message([&] { Read(std::string(100000, '[')); }), "no error");
  EXPECT_NE(Message([&] { Read(std::string(100000, '{')); }), "no error");
  EXPECT_NE(
      Message([&] { Read("format: 1\nlogs: &a [*a]\noutputs: &b {column: *b}\nmodel: x\n"); }),
      "no error");
}

std::string Arbitrary(const std::string& good, std::size_t from, std::size_t count,
                      const std::string& by) {
  std::string text = good;
  from %= text.size();
  return text.replace(from, std::min(count, text.size() - from), by);
}

void ExpectErrorOrNothing(const testing::Scratch& scratch) {
  try {
    Experiment::Read(scratch / "e.yaml");
  } catch (const Error&) {
  }
}

RC_GTEST_PROP(ExperimentBytes, NeverFailExceptWithAnError, (const std::string& bytes)) {
  const testing::Scratch scratch;
  scratch.Write("m.xml", "<mujoco/>");
  scratch.Write("log.csv", kLog);
  scratch.Write("e.yaml", bytes);
  ExpectErrorOrNothing(scratch);
}

RC_GTEST_PROP(ExperimentBytes, NeverFailWhenAGoodFileIsDamagedExceptWithAnError,
              (std::size_t from, std::uint8_t count)) {
  const auto by = *rc::gen::container<std::string>(
      rc::gen::element('{', '}', '[', ']', ':', ',', '-', '&', '*', '"', '\n', ' ', 'a', '1', '.',
                       '~', '!', '?', '|', '<', '\xFF', '\0'));
  const bool log = *rc::gen::arbitrary<bool>();
  const testing::Scratch scratch;
  scratch.Write("m.xml", "<mujoco/>");
  scratch.Write("log.csv", log ? Arbitrary(kLog, from, count % 8, by) : kLog);
  scratch.Write("e.yaml", log ? kExperiment : Arbitrary(kExperiment, from, count % 8, by));
  ExpectErrorOrNothing(scratch);
}

RC_GTEST_PROP(ExperimentLog, RoundTripsIncreasingTimesAndNumbers, ()) {
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 1000000));
  RC_PRE(steps.size() >= 2u);
  std::string text = "t,T1,on,q1\n";
  std::vector<double> time, value;
  double t = *rc::gen::inRange(-1000, 1000);
  for (const int step : steps) {
    t += step * 1e-3;
    time.push_back(t * 1e-3);
    value.push_back(*rc::gen::arbitrary<double>() * 1e-3);
    text += Decimal(t) + ",0,1," + Decimal(value.back()) + "\n";
  }
  const testing::Scratch scratch;
  scratch.Write("m.xml", "<mujoco/>");
  scratch.Write("log.csv", text);
  std::string good = kExperiment;
  const Experiment e =
      Experiment::Read(scratch.Write("e.yaml", good.replace(good.find("deg"), 3, "rad")));
  RC_ASSERT(e.logs[0].time == time);
  RC_ASSERT(e.logs[0].measured[0] == value);
}

}  // namespace
}  // namespace continuum
