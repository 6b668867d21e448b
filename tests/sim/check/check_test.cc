#include "sim/check/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench.h"

namespace continuum {
namespace {

using namespace testing;  // the bench
using ::testing::HasSubstr;
using Severity = Finding::Severity;

TEST(Check, CleanLogsOfStepsAndSinesGiveNoWarning) {
  for (const double noise : {0.0, 1e-4, 1e-2}) {
    for (const double quantum : {0.0, 1e-3, 2e-2}) {
      const auto all = CheckLogs(With(Record({Steps, Sines, 1000, noise, quantum})));
      EXPECT_TRUE(Bad(all).empty()) << "noise " << noise << ", step " << quantum << "\n"
                                    << Report(all);
    }
  }
}

TEST(Check, TwentyRandomCleanLogsGiveNoWarning) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (unsigned trial = 0; trial < 20; ++trial) {
    Recipe recipe{RandomCommand(random), RandomCommand(random)};
    recipe.noise = trial % 2 ? 2e-3 * uniform(random) : 0;
    recipe.quantum = trial % 3 ? 0 : 1.5e-3;
    recipe.rows = static_cast<std::size_t>(400 + 1600 * uniform(random));
    recipe.seed = trial;
    const auto all = CheckLogs(With(Record(recipe)));
    EXPECT_TRUE(Bad(all).empty()) << "log " << trial << "\n" << Report(all);
  }
}

TEST(Check, HeavyTailedAndCorrelatedNoiseIsNoDefect) {
  std::mt19937 random(11);
  std::student_t_distribution<double> heavy(4);
  std::normal_distribution<double> normal;
  Log log = Record({Steps, Sines, 3000, 0});
  double state = 0;
  for (std::size_t k = 0; k < log.rows(); ++k) {
    state = 0.95 * state + 1e-3 * normal(random);
    log.measured[0][k] += 1e-3 * heavy(random);
    log.measured[1][k] += 1e-2 * heavy(random);
    log.measured[2][k] += state;
  }
  const auto all = CheckLogs(With(log));
  EXPECT_TRUE(Bad(all).empty()) << Report(all);
}

TEST(Check, ACommandHeldAtItsOwnRateIsNoDefect) {
  const Command held = [](double t) { return Sines(std::floor(t / 0.05 + 1e-9) * 0.05); };
  const auto all = CheckLogs(With(Record({held, Sines})));
  EXPECT_TRUE(Bad(all).empty()) << Report(all);
  ASSERT_NE(Find(all, "stale", "u1"), nullptr) << Report(all);
  EXPECT_THAT(Find(all, "stale", "u1")->text, HasSubstr("every 5.0 rows"));
}

TEST(Check, ClockJitterIsNamed) {
  Log log = Record({});
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.05 * kPeriod);
  for (double& t : log.time) t += noise(random);
  EXPECT_NEAR(Only(log, "clock_jitter").begin, 0, kPeriod);
}

TEST(Check, AGapIsLocated) {
  Log log = Record({});
  DropRows(log, 700, 720);
  const Finding f = Only(log, "gap");
  EXPECT_NEAR(f.begin, 6.99, 1e-9);
  EXPECT_NEAR(f.end, 7.20, 1e-9);
  EXPECT_THAT(f.text, HasSubstr("0.21 s after t = 6.99 s"));
}

TEST(Check, ATimeThatGoesBackIsAnError) {
  Log log = Record({});
  log.time[500] = log.time[498];
  const Finding* const f = Find(CheckLogs(With(log)), "clock");
  ASSERT_NE(f, nullptr);
  EXPECT_EQ(Find(Bad(CheckLogs(With(log))), "clock")->severity, Severity::kError);
}

TEST(Check, DuplicatedRowsAreLocated) {
  Log log = Record({});
  for (const std::size_t row : {300, 610}) {
    for (auto* columns : {&log.input, &log.measured}) {
      for (auto& column : *columns) column[row] = column[row - 1];
    }
  }
  const Finding f = Only(log, "duplicated_rows");
  EXPECT_THAT(f.text, HasSubstr("row 301 (t = 3 s), 611 (t = 6.1 s)"));
  EXPECT_NEAR(f.end, 6.1, 1e-9);
}

TEST(Check, AStaleChannelIsNamedWithItsInterval) {
  for (const double noise : {0.0, 1e-3}) {
    for (const double quantum : {0.0, 1e-3}) {
      Log log = Record({Sines, Sines, 1000, noise, quantum});
      log.input[1] = Record({Sines, [](double t) { return Sines(1.3 * t); }}).input[1];
      auto& q = Column(log, "q2");
      for (std::size_t k = 0; k < q.size(); ++k) q[k] = q[k - k % 5];
      EXPECT_THAT(Only(log, "stale", "q2").text, HasSubstr("every 5.0 rows")) << quantum;
    }
  }
}

TEST(Check, AnIrregularlyRefreshedInputIsNamed) {
  Log log = Record({Sines, Sines});
  std::mt19937 random(5);
  auto& u = Column(log, "u2");
  for (std::size_t k = 1; k < u.size(); ++k) {
    if (random() % 5) u[k] = u[k - 1];
  }
  EXPECT_THAT(Only(log, "stale", "u2").text, HasSubstr("irregularly"));
}

TEST(Check, AChannelThatFreezesForAWhileIsLocated) {
  for (const std::size_t rows : {15, 40, 150}) {
    Log log = Record({});
    auto& q = Column(log, "q1");
    for (std::size_t k = 310; k < 310 + rows; ++k) q[k] = q[309];
    const auto bad = Bad(CheckLogs(With(log)));
    const Finding* const f = Find(bad, rows > 30 ? "stale" : "repeated", "q1");
    ASSERT_NE(f, nullptr) << Report(bad);
    EXPECT_THAT(f->text, HasSubstr(fmt::format("{} rows from t = 3.09 s", rows + 1)));
    EXPECT_NEAR(f->end, 3.09 + 0.01 * static_cast<double>(rows), 1e-9);
  }
}

TEST(Check, AChannelThatFreezesToTheEndOrWakesLateIsNamed) {
  for (const bool late : {false, true}) {
    Log log = Record({Sines, Sines});
    auto& q = Column(log, "q2");
    const auto half = q.begin() + 500;
    late ? std::fill(q.begin(), half, *half) : std::fill(half, q.end(), *half);
    const Finding f = Only(log, "stale", "q2");
    EXPECT_THAT(f.text, HasSubstr(late ? "up to t = 5 s, 501" : "from t = 5 s to the end, 500"));
  }
}

TEST(Check, ALogInMillisecondsAmongOthersIsNamed) {
  Experiment e = With(Record({Steps, Sines, 1000, 1e-3, 0, 1}, "a"));
  e.logs.push_back(Record({Steps, Sines, 1000, 1e-3, 0, 2}, "b"));
  e.logs.push_back(Record({Steps, Sines, 1000, 1e-3, 0, 3}, "c"));
  for (double& t : e.logs[1].time) t *= 1000;
  const auto all = CheckLogs(e);
  const Finding* const f = Find(all, "unit_suspect");
  ASSERT_NE(f, nullptr) << Report(all);
  EXPECT_EQ(f->log, "b");
  EXPECT_THAT(f->text, HasSubstr("10 s apart, 1000 times"));
}

TEST(Check, AThirdOfRepeatedSamplesIsNamed) {
  Log log = Record({Sines, Sines});
  std::mt19937 random(9);
  auto& q = Column(log, "q1");
  for (std::size_t k = 1; k < q.size(); ++k) {
    if (random() % 3 == 0) q[k] = q[k - 1];
  }
  const Finding f = Only(log, "repeated", "q1");
  EXPECT_THAT(f.text, HasSubstr("% of the samples in motion repeat the one before"));
}

TEST(Check, JumpingRowsAreListed) {
  Log log = Record({});
  for (const std::size_t row : {150, 420, 433, 801}) Column(log, "q2")[row] += 0.2;
  const Finding f = Only(log, "jump", "q2");
  EXPECT_THAT(f.text, HasSubstr("in 4 of 1000 rows"));
  EXPECT_THAT(f.text, HasSubstr("and 1 more"));
}

TEST(Check, AJumpThatLastsSomeRowsIsLocated) {
  Log log = Record({});
  for (std::size_t row = 600; row < 606; ++row) Column(log, "q2")[row] += 0.2;
  const Finding f = Only(log, "jump", "q2");
  EXPECT_THAT(f.text, HasSubstr("in 2 of 1000 rows"));
  EXPECT_NEAR(f.begin, 6.0, 0.07);
}

TEST(Check, AnAngleThatIsKeptWithinATurnIsNamedWithItsRemedy) {
  const double turn = 2 * std::numbers::pi;
  for (const double low : {0.0, -std::numbers::pi}) {
    Recipe recipe;
    recipe.u2 = [](double t) { return 2 * t; };  // three turns
    Log log = Record(recipe);
    for (double& q : Column(log, "q2")) q -= turn * std::floor((q - low) / turn);
    const Finding f = Only(log, "wrapped", "q2");
    EXPECT_THAT(f.text, HasSubstr("write `unwrap: true`"));
  }
}

TEST(Check, AConstantChannelIsNamed) {
  Log log = Record({});
  for (double& q : Column(log, "q2")) q = 0.3;
  Only(log, "no_variance", "q2");
}

TEST(Check, MissingValuesAreCountedAndLocated) {
  Log log = Record({});
  for (std::size_t k = 200; k < 260; ++k) Column(log, "q2")[k] = NAN;
  const Finding f = Only(log, "nan", "q2");
  EXPECT_THAT(f.text, HasSubstr("6 % of the values are missing (60 of 1000 rows)"));
  EXPECT_NEAR(f.begin, 2.0, 1e-9);
  EXPECT_NEAR(f.end, 2.59, 1e-9);
}

TEST(Check, ColumnsThatMissTheSameRowsAreToldAtOnce) {
  Log log = Record({});
  for (const char* const column : {"q1", "v1"}) {
    for (std::size_t k = 200; k < 260; ++k) Column(log, column)[k] = NAN;
  }
  EXPECT_THAT(Only(log, "nan", "q1").text, HasSubstr("from t = 2 s; so it is with v1"));
  Column(log, "v1")[500] = NAN;
  const auto all = CheckLogs(With(log));
  EXPECT_NE(Find(all, "nan", "q1"), nullptr);
  EXPECT_NE(Find(all, "nan", "v1"), nullptr);
}

TEST(Check, QuantisationGivesTheNoiseFloor) {
  const auto all = CheckLogs(With(Record({Steps, Sines, 1000, 0, 0.00153})));
  const Finding* const f = Find(all, "quantisation", "q1");
  ASSERT_NE(f, nullptr) << Report(all);
  EXPECT_THAT(f->text, HasSubstr("steps of 0.00153 rad"));
  EXPECT_THAT(f->text, HasSubstr("0.000442 rad rms"));  // step/√12
}

TEST(Check, AVelocityThatIsLateByThreeRowsIsNamed) {
  Log log = Record({});
  auto& v = Column(log, "v1");
  v.insert(v.begin(), 3, v.front());
  v.resize(log.rows());
  EXPECT_THAT(Only(log, "lag", "v1").text, HasSubstr("(3.0 rows)"));
}

TEST(Check, AVelocityShiftedByOneRowIsNamed) {
  Log log = Record({});
  auto& v = Column(log, "v1");
  v.erase(v.begin());
  v.push_back(v.back());
  EXPECT_THAT(Only(log, "lag", "v1").text,
              ::testing::ContainsRegex("leads the derivative of 'q1' by .* \\(1\\.0 rows\\)"));
}

TEST(Check, AVelocityInAnotherUnitScaleOrSignIsNamed) {
  const auto scaled = [](double factor) {
    Log log = Record({});
    for (double& v : Column(log, "v1")) v *= factor;
    return log;
  };
  EXPECT_THAT(Only(scaled(1 / kDegree), "unit_suspect", "v1").text,
              HasSubstr("degrees for radians"));
  EXPECT_THAT(Only(scaled(0.8), "derivative", "v1").text,
              ::testing::ContainsRegex("is 0\\.(80?|79.) times"));
  Only(scaled(-1), "sign_suspect", "v1");
}

TEST(Check, AVelocityOfSomethingElseIsNamed) {
  Log log = Record({});
  auto& v = Column(log, "v1");
  std::mt19937 random(4);
  std::normal_distribution<double> noise;
  for (double& x : v) x = noise(random);
  Experiment e = With(log);
  e.channels.pop_back(), e.outputs.pop_back(), e.logs[0].measured.pop_back();
  const auto bad = Bad(CheckLogs(e));
  ASSERT_EQ(bad.size(), 1u) << Report(bad);
  EXPECT_EQ(bad[0].what, "derivative");
}

TEST(Check, ACopiedColumnIsNamed) {
  Log log = Record({});
  Column(log, "q2") = Column(log, "q1");
  EXPECT_THAT(Only(log, "copied", "q2").text, HasSubstr("'q1'"));
}

TEST(Check, AColumnThatDrivesTwoActuatorsIsToldOnce) {
  Experiment e = With(Record({}));
  e.inputs[1].column = "u1";  // the second of an antagonistic pair
  e.logs[0].input[1] = e.logs[0].input[0];
  const auto all = CheckLogs(e);
  EXPECT_EQ(Find(all, "copied", "u1"), nullptr) << Report(all);
  EXPECT_EQ(
      std::count_if(all.begin(), all.end(),
                    [](const Finding& f) { return f.what == "excitation" && f.channel == "u1"; }),
      1)
      << Report(all);
}

TEST(Check, TheLagBehindAnInputIsTold) {
  Recipe recipe;
  recipe.u1 = [](double t) { return std::sin(2.1 * t); };
  recipe.rows = 6000;
  const auto all = CheckLogs(With(Record(recipe)));
  const Finding* const f = Find(all, "lag", "q1");
  ASSERT_NE(f, nullptr) << Report(all);
  EXPECT_EQ(f->severity, Severity::kInfo);
  // The mass delays this sine by atan(2 d w ω / (w² − ω²)) / ω = 51 ms, holding by half a
  // row; the parabola finds that to a third of a row.
  EXPECT_THAT(f->text, ::testing::ContainsRegex("follows input 'u1' by 5[4-9](\\.[0-9])? ms"));
}

TEST(Check, ExcitationAndWhatItCannotShowAreTold) {
  const auto steps = CheckLogs(With(Record({})));
  EXPECT_THAT(Find(steps, "excitation", "u1")->text,
              HasSubstr("between -0.5 rad and 1 rad with 2 reversals; its longest rest is 5 s"));
  const auto sines = CheckLogs(With(Record({Sines, Sines})));
  EXPECT_THAT(Report(sines), HasSubstr("static friction and a bias cannot be distinguished"));
}

TEST(Check, TheExperimentsLimitsAreTold) {
  Experiment e = With(Record({}));
  EXPECT_THAT(Report(CheckLogs(e)),
              HasSubstr("without replicates \"unexplained\" cannot be concluded"));
  EXPECT_THAT(Report(CheckLogs(e)), HasSubstr("only ratios of mass, stiffness and friction"));
  e.logs[0].set.push_back({"body:tip", "mass", 0.1});
  e.logs.push_back(Record({Steps, Sines, 1000, 1e-3, 0, 2}, "again"));
  e.logs[1].trial = e.logs[0].trial;
  const std::string text = Report(CheckLogs(e));
  EXPECT_THAT(text, HasSubstr("1 trial was recorded more than once"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("only ratios")));
  e.logs[1].condition = "loaded";  // another condition is no replicate
  EXPECT_THAT(Report(CheckLogs(e)), HasSubstr("no trial was recorded twice"));
  e.logs[1].condition = e.logs[0].condition;
  e.logs[1].train = false;
  EXPECT_NE(Find(Bad(CheckLogs(e)), "split"), nullptr);
  EXPECT_EQ(Find(Bad(CheckLogs(e)), "trial"), nullptr);
  e.logs[1].input[0][500] += 0.1;  // as of another logger
  EXPECT_EQ(Find(Bad(CheckLogs(e)), "trial"), nullptr);
  EXPECT_THAT(Report(CheckLogs(e)), HasSubstr("differ a little in clock or input"));
  for (double& u : e.logs[1].input[0]) u = -u;  // another motion under the same name
  EXPECT_THAT(Find(Bad(CheckLogs(e)), "trial")->text,
              HasSubstr("'bench' and 'again' have one trial name"));
  EXPECT_THAT(Report(CheckLogs(e)), HasSubstr("no trial was recorded twice"));
  e.logs[1] = e.logs[0];
  EXPECT_NE(Find(Bad(CheckLogs(e)), "duplicate_log"), nullptr);
}

TEST(Check, AForceWrittenAsAMassIsNamed) {
  Experiment e = Bench();
  e.logs = {Record({})};
  e.inputs[0].unit = "kg.cm";
  const auto found = CheckLogs(e);
  ASSERT_NE(Find(found, "unit_suspect", "u1"), nullptr) << Report(found);
  EXPECT_THAT(Find(found, "unit_suspect", "u1")->text,
              HasSubstr("'kg.cm' is a mass times a length; a torque is meant? Write kgf"));
  e.inputs[0].unit = "kgf.cm";
  EXPECT_EQ(Find(CheckLogs(e), "unit_suspect", "u1"), nullptr);
}

TEST(Check, TheShortestLogsAreTaken) {
  for (const std::size_t rows : {2, 3, 5, 12, 30}) {
    const auto all = CheckLogs(With(Record({Steps, Sines, rows})));
    for (const Finding& f : Bad(all)) EXPECT_EQ(f.what, "no_variance") << f.text;
    Log empty = Record({Steps, Sines, rows});
    for (double& q : Column(empty, "q2")) q = NAN;
    EXPECT_NE(Find(CheckLogs(With(empty)), "nan", "q2"), nullptr);
  }
}

TEST(Check, TheReportIsGroupedByLogWithASummaryFirst) {
  Log log = Record({});
  Column(log, "q2")[400] += 0.5;
  const auto all = CheckLogs(With(log));
  const std::string text = Report(all);
  EXPECT_THAT(text, ::testing::StartsWith("0 errors, 1 warning, "));
  EXPECT_LT(text.find("experiment\n"), text.find("log bench\n  warning jump"));
  const auto json = ToJson(all);
  ASSERT_EQ(json.size(), all.size());
  EXPECT_EQ(json[0]["severity"], "info");
}

}  // namespace
}  // namespace continuum
