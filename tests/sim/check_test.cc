#include "sim/check.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sim/file.h"
#include "sim/simulate.h"
#include "sim/table.h"
#include "support/recordings.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Severity = Finding::Severity;

constexpr double kPeriod = 0.01;  // [s]
constexpr double kDegree = std::numbers::pi / 180;

// q'' = w² (u − q) − 2 d w q', u held between rows, integrated in 20 substeps.
struct Mass {
  double w = 12, d = 0.3, q = 0, v = 0;
  void Advance(double u) {
    constexpr int kSubsteps = 20;
    const double h = kPeriod / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {
      v += h * (w * w * (u - q) - 2 * d * w * v);
      q += h * v;
    }
  }
};

using Command = std::function<double(double)>;
double Steps(double t) { return t < 1 ? 0 : t < 3 ? 1 : t < 5 ? -0.5 : 0.25; }
double Sines(double t) { return 0.8 * std::sin(2.1 * t) + 0.3 * std::sin(5.3 * t); }

// One input [rad], the angle of one mass [rad], its speed [rad/s], and a slower mass's angle.
struct Recipe {
  Command u1 = Steps, u2 = Sines;
  std::size_t rows = 1000;
  double noise = 1e-3, quantum = 0;
  unsigned seed = 1;
};

Experiment Bench() {
  Experiment e;
  e.inputs = {{"u1", "rad", "m1", "", false, ""}, {"u2", "rad", "m2", "", false, ""}};
  for (const auto& [column, unit] :
       {std::pair{"q1", "rad"}, std::pair{"v1", "rad/s"}, std::pair{"q2", "rad"}}) {
    Output out;
    out.columns = {column};
    out.unit = unit;
    out.source = column;
    e.channels.push_back({column, unit, e.outputs.size(), 0, 1});
    e.outputs.push_back(out);
  }
  return e;
}

Log Record(const Recipe& recipe, const std::string& label = "bench") {
  Log log;
  log.label = log.trial = label;
  log.input.resize(2);
  log.enable.resize(2);
  log.measured.resize(3);
  std::mt19937 random(recipe.seed);
  std::normal_distribution<double> noise;
  const auto round = [&](double x) {
    return recipe.quantum > 0 ? recipe.quantum * std::round(x / recipe.quantum) : x;
  };
  Mass first, second{6, 0.5};
  for (std::size_t k = 0; k < recipe.rows; ++k) {
    const double t = kPeriod * static_cast<double>(k);
    log.time.push_back(t);
    log.input[0].push_back(recipe.u1(t));
    log.input[1].push_back(recipe.u2(t));
    log.measured[0].push_back(round(first.q + recipe.noise * noise(random)));
    log.measured[1].push_back(first.v + 10 * recipe.noise * noise(random));
    log.measured[2].push_back(round(second.q + recipe.noise * noise(random)));
    first.Advance(log.input[0].back());
    second.Advance(log.input[1].back());
  }
  return log;
}

Experiment With(Log log) {
  Experiment e = Bench();
  e.logs.push_back(std::move(log));
  return e;
}

std::vector<Finding> Bad(const std::vector<Finding>& all) {
  std::vector<Finding> bad;
  for (const Finding& f : all) {
    if (f.severity != Severity::kInfo) bad.push_back(f);
  }
  return bad;
}

const Finding* Find(const std::vector<Finding>& all, const std::string& what,
                    const std::string& channel = "") {
  for (const Finding& f : all) {
    if (f.what == what && f.channel == channel) return &f;
  }
  return nullptr;
}

// One warning of this kind, on this channel, and no other.
Finding Only(const Log& log, const std::string& what, const std::string& channel = "") {
  const auto all = CheckLogs(With(log));
  const auto bad = Bad(all);
  EXPECT_EQ(bad.size(), 1u) << Report(all);
  const Finding* const found = Find(bad, what, channel);
  EXPECT_NE(found, nullptr) << what << " " << channel << "\n" << Report(all);
  return found ? *found : Finding{};
}

std::vector<double>& Column(Log& log, const std::string& name) {
  if (name[0] == 'u') return log.input[name == "u2"];
  return log.measured[name == "q1" ? 0 : name == "v1" ? 1 : 2];
}

void DropRows(Log& log, std::size_t from, std::size_t to) {
  const auto cut = [&](auto& v) {
    v.erase(v.begin() + static_cast<std::ptrdiff_t>(from),
            v.begin() + static_cast<std::ptrdiff_t>(to));
  };
  cut(log.time);
  for (auto& column : log.input) cut(column);
  for (auto& column : log.measured) cut(column);
}

TEST(Check, CleanLogsOfStepsAndSinesGiveNoWarning) {
  for (const double noise : {0.0, 1e-4, 1e-2}) {
    for (const double quantum : {0.0, 1e-3, 2e-2}) {
      const auto all = CheckLogs(With(Record({Steps, Sines, 1000, noise, quantum})));
      EXPECT_TRUE(Bad(all).empty()) << "noise " << noise << ", step " << quantum << "\n"
                                    << Report(all);
    }
  }
}

// A chirp, a square wave, a triangle or a ramp that holds.
Command RandomCommand(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double size = 0.2 + uniform(random), f = 0.2 + 2 * uniform(random), at = uniform(random);
  const auto kind = static_cast<int>(4 * uniform(random));
  return [=](double t) {
    const double phase = f * (t - at) - std::floor(f * (t - at));
    if (kind == 0) return size * std::sin(2 * std::numbers::pi * f * t * (1 + 0.1 * t));
    if (kind == 1) return phase < 0.5 ? size : -size;
    if (kind == 2) return size * (std::abs(4 * phase - 2) - 1);
    return t < at ? 0 : size * std::min(1.0, 2 * (t - at));
  };
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

TEST(Check, SaturationIsNamed) {
  Log log = Record({Sines, Sines});
  for (double& q : Column(log, "q2")) q = std::min(q, 0.5);
  const Finding f = Only(log, "saturation", "q2");
  EXPECT_THAT(f.text, HasSubstr("largest value 0.5 rad"));
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
  EXPECT_THAT(Report(sines), HasSubstr("static friction and a bias cannot be told apart"));
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
  e.logs[1] = e.logs[0];
  EXPECT_NE(Find(Bad(CheckLogs(e)), "duplicate_log"), nullptr);
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

// Two pendulums on their own servos; what the model simulates is taken for measured.
class CheckModel : public ::testing::Test {
 protected:
  void SetUp() override {
    system_.emplace(System::Parse(R"(<mujoco><option timestep="0.002" integrator="implicitfast"/>
      <worldbody>
        <body><joint name="a" axis="0 1 0" damping="0.02"/><geom type="capsule" size=".01" fromto="0 0 0 0 0 -.2" mass=".3"/></body>
        <body pos="1 0 0"><joint name="b" axis="0 1 0" damping="0.05"/><geom type="capsule" size=".01" fromto="0 0 0 0 0 -.3" mass=".4"/></body>
      </worldbody>
      <actuator><position name="m1" joint="a" kp="1"/><position name="m2" joint="b" kp="3"/></actuator>
      <sensor><jointpos name="q1" joint="a"/><jointvel name="v1" joint="a"/><jointpos name="q2" joint="b"/></sensor>
    </mujoco>)"));
    RecordFrom({});
  }

  // What the model does, with noise, is what was measured.
  void RecordFrom(const Recipe& recipe) {
    experiment_ = With(Record(recipe));
    Machine machine = system_->Build();
    log().measured = Simulate(machine, experiment_, log()).channel;
    std::mt19937 random(recipe.seed);
    std::normal_distribution<double> noise(0, 5e-4);
    for (auto& channel : log().measured) {
      for (double& value : channel) value += noise(random);
    }
  }
  Log& log() { return experiment_.logs[0]; }
  std::vector<Finding> Bad() const {
    return continuum::Bad(CheckAgainstModel(experiment_, *system_));
  }
  void ExpectOnly(const std::string& what, const std::string& channel) const {
    const auto bad = Bad();
    ASSERT_EQ(bad.size(), 1u) << Report(bad);
    EXPECT_EQ(bad[0].what, what) << Report(bad);
    EXPECT_EQ(bad[0].channel, channel) << Report(bad);
  }

  std::optional<System> system_;
  Experiment experiment_;
};

TEST_F(CheckModel, ACleanLogGivesNoWarning) { EXPECT_TRUE(Bad().empty()) << Report(Bad()); }

TEST_F(CheckModel, TwentyRandomCleanLogsGiveNoWarning) {
  std::mt19937 random(13);
  for (unsigned trial = 0; trial < 20; ++trial) {
    Recipe recipe{RandomCommand(random), RandomCommand(random)};
    recipe.rows = 600;
    recipe.seed = trial;
    RecordFrom(recipe);
    EXPECT_TRUE(Bad().empty()) << "log " << trial << "\n" << Report(Bad());
  }
}

TEST_F(CheckModel, AModelWithWrongDampingAndMassIsNoDefectOfTheLog) {
  const Change changes[]{{"joint:a", "damping", 0.03}, {"joint:b", "damping", 0.03}};
  experiment_.logs[0].set.assign(std::begin(changes), std::end(changes));
  EXPECT_TRUE(Bad().empty()) << Report(Bad());
}

TEST_F(CheckModel, MillimetresForMetresAndDegreesForRadiansAreNamed) {
  for (double& q : Column(log(), "q2")) q *= 1000;
  ExpectOnly("unit_suspect", "q2");
  for (double& q : Column(log(), "q2")) q *= 1e-3 / kDegree;
  ExpectOnly("unit_suspect", "q2");
}

TEST_F(CheckModel, AWrongSignIsNamed) {
  for (double& q : Column(log(), "q2")) q = -q;
  // With one output per input, a wrong sign of either looks the same: both are told.
  const auto bad = Bad();
  EXPECT_NE(Find(bad, "sign_suspect", "q2"), nullptr) << Report(bad);
  EXPECT_EQ(Find(bad, "sign_suspect", "q1"), nullptr) << Report(bad);
}

TEST_F(CheckModel, SwappedColumnsAreNamed) {
  std::swap(Column(log(), "q1"), Column(log(), "q2"));
  const auto bad = Bad();
  const Finding* const f = Find(bad, "swapped", "q1");
  ASSERT_NE(f, nullptr) << Report(bad);
  EXPECT_THAT(f->text, HasSubstr("'q1' and 'q2' look swapped"));
}

TEST_F(CheckModel, SwappedInputsAreNamed) {
  std::swap(log().input[0], log().input[1]);
  EXPECT_NE(Find(Bad(), "swapped", "u1"), nullptr) << Report(Bad());
}

TEST_F(CheckModel, AnInputInAnotherUnitOrSignIsNamed) {
  const auto original = log().input[1];
  for (double& u : log().input[1]) u /= kDegree;
  EXPECT_NE(Find(Bad(), "unit_suspect", "u2"), nullptr) << Report(Bad());
  log().input[1] = original;
  for (double& u : log().input[1]) u = -u;
  EXPECT_NE(Find(Bad(), "sign_suspect", "u2"), nullptr) << Report(Bad());
}

TEST_F(CheckModel, AMistakeInAnInputThatMovesLateInALongLogIsNamed) {
  Recipe recipe;
  recipe.rows = 12000;
  recipe.u2 = [](double t) { return t < 9 ? 0 : 0.5 * std::sin(4 * (t - 9)); };
  RecordFrom(recipe);
  experiment_.start = Experiment::Start::kEquilibrium;
  for (double& u : log().input[1]) u = -u;
  EXPECT_NE(Find(Bad(), "sign_suspect", "u2"), nullptr) << Report(Bad());
}

TEST_F(CheckModel, AColumnShiftedByOneRowIsNamed) {
  auto& q = Column(log(), "q2");
  q.insert(q.begin(), q.front());
  q.pop_back();
  ExpectOnly("lag", "q2");
  EXPECT_THAT(Bad()[0].text, HasSubstr("late against the simulation by 10"));
}

TEST_F(CheckModel, AClockShiftOfAllOutputsIsNamed) {
  for (auto& q : log().measured) {
    q.insert(q.begin(), 4, q.front());
    q.resize(log().rows());
  }
  ExpectOnly("clock_shift", "");
}

TEST_F(CheckModel, AnOffsetAtRestIsNamed) {
  RecordFrom({Steps, [](double t) { return t < 5 ? 0.5 * Steps(t) : 0.1; }});
  for (double& q : Column(log(), "q1")) q += 0.1;
  ExpectOnly("offset_at_rest", "q1");
}

TEST_F(CheckModel, ASimulationThatDivergesIsTold) {
  log().set.push_back({"joint:a", "stiffness", -1e9});
  log().set.push_back({"joint:a", "damping", 0});
  EXPECT_NE(Find(Bad(), "diverged"), nullptr) << Report(Bad());
}

// The logs of real machines, where they are at hand.
class CheckReal : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(data_)) GTEST_SKIP() << "no recordings at " << data_;
  }

  // logs, time, inputs, outputs of an experiment file.
  std::vector<Finding> Check(const std::string& yaml) const {
    return CheckLogs(
        Experiment::Read(scratch_.Write("experiment.yaml", "format: 1\nmodel: none.xml\n" + yaml)));
  }

  const fs::path data_ = testing::Recordings("");
  const testing::Scratch scratch_;
};

TEST_F(CheckReal, ServoPendulum) {
  std::string logs;
  for (const auto& entry : fs::directory_iterator(data_ / "servo_pendulum")) {
    if (entry.path().extension() != ".json") continue;
    const auto json = nlohmann::json::parse(ReadFile(entry.path()));
    std::string csv = "t,q,w,goal,enable\n";
    for (const auto& row : json["entries"]) {
      csv +=
          fmt::format("{},{},{},{},{}\n", row["timestamp"].get<double>(),
                      row["position"].get<double>(), row["speed"].get<double>(),
                      row["goal_position"].get<double>(), row["torque_enable"].get<bool>() ? 1 : 0);
    }
    const std::string name = entry.path().stem().string() + ".csv";
    scratch_.Write(name, csv);
    logs += fmt::format("  - {{file: {}}}\n", name);
  }
  const auto all =
      Check("logs:\n" + logs +
            "time: {column: t}\n"
            "inputs: [{column: goal, unit: rad, actuator: servo, enable: enable}]\n"
            "outputs: [{column: q, unit: rad, sensor: q}, {column: w, unit: rad/s, sensor: w}]\n");
  std::size_t late = 0;
  for (const Finding& f : Bad(all)) {  // the firmware filters its speed, and nothing else is wrong
    EXPECT_EQ(f.what, "lag") << f.text;
    late += f.channel == "w";
    EXPECT_THAT(f.text, ::testing::ContainsRegex("lags the derivative of 'q' by (20|19|21)"));
  }
  EXPECT_EQ(late, 12u) << Report(all);
  EXPECT_THAT(Find(all, "quantisation", "q")->text, HasSubstr("0.00153 rad"));  // 2π/4096
}

TEST_F(CheckReal, Emps) {
  const auto all = Check("logs: [{file: '" + (data_ / "emps/DATA_EMPS.mat").string() +
                         "'}]\ntime: {column: t}\n"
                         "inputs: [{column: qg, unit: m, actuator: axis}]\n"
                         "outputs: [{column: qm, unit: m, sensor: q}, {column: vir, unit: V, "
                         "actuator: axis, quantity: control}]\n");
  EXPECT_TRUE(Bad(all).empty()) << Report(all);
  EXPECT_THAT(Report(all), HasSubstr("qm: follows input 'qg' by 7"));
}

TEST_F(CheckReal, Trunk) {
  std::string logs, inputs, outputs;
  for (const char* name : {"observations_controlled_1", "observations_controlled_1_100g"}) {
    const Table table = Table::Read(data_ / "trunk" / (std::string(name) + ".csv"));
    std::string csv = "t";
    for (const auto& column : table.columns()) csv += "," + column;
    for (std::size_t k = 0; k < table.rows(); ++k) {
      csv += fmt::format("\n{}", 0.01 * table.Number(k, "ID"));
      for (const auto& column : table.columns()) csv += "," + table.Text(k, column);
    }
    scratch_.Write(std::string(name) + ".csv", csv + "\n");
    logs += fmt::format("  - {{file: {}.csv}}\n", name);
  }
  for (int i = 1; i <= 6; ++i)
    inputs += fmt::format("  - {{column: phi{0}, unit: deg, actuator: m{0}}}\n", i);
  for (int i = 1; i <= 3; ++i) {
    for (const char axis : {'x', 'y', 'z'}) {
      outputs += fmt::format("  - {{column: {0}{1}, unit: m, sensor: s{0}{1}}}\n", axis, i);
    }
  }
  const auto all =
      Check("logs:\n" + logs + "time: {column: t}\ninputs:\n" + inputs + "outputs:\n" + outputs);
  for (const Finding& f : Bad(all)) {
    if (f.what != "stale") continue;
    EXPECT_THAT(f.text, HasSubstr("refreshed about every 4.")) << f.channel;
  }
  for (int i = 1; i <= 6; ++i) EXPECT_NE(Find(Bad(all), "stale", fmt::format("phi{}", i)), nullptr);
  const Finding* const jump = Find(all, "jump", "x3");
  ASSERT_NE(jump, nullptr) << Report(all);
  EXPECT_THAT(jump->text, HasSubstr("-0.0344 m in row 10768"));
  EXPECT_NE(Find(all, "invariance"), nullptr) << Report(all);
}

TEST_F(CheckReal, TdcrThreeSegment) {
  std::string inputs, outputs;
  for (int i = 1; i <= 9; ++i)
    inputs += fmt::format("  - {{column: servo_{0}_mm, unit: mm, actuator: s{0}}}\n", i);
  for (const char axis : {'x', 'y', 'z'})
    outputs += fmt::format("  - {{column: tip_{0}, unit: mm, sensor: {0}}}\n", axis);
  const auto all =
      Check("logs: [{file: '" +
            (data_ / "tdcr_three_segment/tdcr_sysid_20260511-183002_train.csv").string() +
            "'}]\ntime: {column: timestamp}\ninputs:\n" + inputs + "outputs:\n" + outputs);
  EXPECT_THAT(Find(all, "gap")->text, HasSubstr("15.68 s after t = 1778538796.086 s"));
  EXPECT_NE(Find(all, "clock_jitter"), nullptr) << Report(all);
  EXPECT_NE(Find(all, "invariance"), nullptr) << Report(all);
}

TEST_F(CheckReal, StiffFlop) {
  const auto all = Check(
      "logs: [{file: '" + (data_ / "stiff_flop/NoLoad.mat").string() +
      "', variable: NoLoad}]\ntime: {column: 1}\n"
      "inputs:\n  - {column: 2, unit: bar, actuator: p1}\n  - {column: 3, unit: bar, actuator: "
      "p2}\n"
      "  - {column: 4, unit: bar, actuator: p3}\n"
      "outputs:\n  - {column: 5, unit: mm, sensor: bx}\n  - {column: 6, unit: mm, sensor: by}\n"
      "  - {column: 7, unit: mm, sensor: bz}\n  - {columns: [8, 9, 10, 11], sensor: bq}\n"
      "  - {column: 12, unit: mm, sensor: tx}\n  - {column: 13, unit: mm, sensor: ty}\n"
      "  - {column: 14, unit: mm, sensor: tz}\n  - {columns: [15, 16, 17, 18], sensor: tq}\n");
  const auto bad = Bad(all);
  EXPECT_NE(Find(bad, "quaternion_norm", "8"), nullptr) << Report(all);
  EXPECT_THAT(Find(bad, "copied", "11")->text, HasSubstr("repeats column '10' in 100 %"));
  EXPECT_NE(Find(all, "quaternion_flip", "15"), nullptr) << Report(all);
  for (int c = 12; c <= 18; ++c) {
    const std::string column = std::to_string(c);
    EXPECT_TRUE(Find(bad, "repeated", column) || Find(bad, "stale", column)) << Report(all);
  }
}

}  // namespace
}  // namespace continuum
