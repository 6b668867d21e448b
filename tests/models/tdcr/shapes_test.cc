// ctest labels: slow
// Measured shapes: calibration, the Euler arc splines that fit them, and training of the hybrid.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <random>

#include "models/tdcr/calibrate.h"
#include "models/tdcr/fit.h"
#include "models/tdcr/hybrid.h"
#include "models/tdcr/solve_fixture.h"
#include "models/tdcr/synthetic.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"

namespace continuum::tdcr {
namespace {

using testing::HasSubstr;

TEST_F(TdcrSolve, BadMeasurementsAreNamedWithLine) {
  request_.input = Write("cases.csv", std::string(kHeader) + "a,1,0,0,0,0,0\n");
  const auto message = [&](const std::string& text) {
    request_.measured = Write("measured.csv", text);
    return Message();
  };
  EXPECT_THAT(message("case,x_10,y_10,z_10\na,0,0,0\n"), HasSubstr("'x_10'"));
  EXPECT_THAT(message("case,x_1,y_1\na,0,0\n"), HasSubstr("'z_1'"));
  EXPECT_THAT(message("case,x_1,y_1,z_1\na,0,,0\n"), HasSubstr("measured.csv:2"));
  EXPECT_THAT(message("case,x_1,y_1,z_1\na,,,\n"), HasSubstr("at least one"));
  EXPECT_THAT(message("case,x_1,y_1,z_1\na,0,0,1\na,0,0,1\n"), HasSubstr("measured.csv:3"));
  EXPECT_THAT(message("case,use,x_1,y_1,z_1\na,maybe,0,0,1\n"), HasSubstr("train or test"));
  EXPECT_THAT(message("case,x_1,y_1,z_1\n"), HasSubstr("one row or more"));
  EXPECT_THAT(message("case,x_1,y_1,z_1\nA,0,0,0.01\n"), HasSubstr("shape of one of the cases"));
  request_.calibrate = true;
  request_.out = folder_ / "calibrated.yaml";
  EXPECT_THAT(message("case,x_9,y_9,z_9\na,0,0,0.13\n"), HasSubstr("at least 5"));
  request_.method = "crt";
  EXPECT_THAT(message("case,x_9,y_9,z_9\na,0,0,0.13\n"), HasSubstr("at least 4"));
}

TEST_F(TdcrSolve, PointsThatNoDiskReachesAreNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  request_.input = Write("cases.csv", std::string(kHeader) + "a,1,0,0,0,0,0\n");
  request_.measured = Write("measured.csv", "case,x_9,y_9,z_9\na,21,0,132\n");
  EXPECT_EQ(SolveTdcr(request_), 0);
  EXPECT_THAT(heard,
              testing::ElementsAre(HasSubstr("up to 134 m from the base of a rod of 0.134")));
}

// Shapes of a robot by one of the methods, as a table in its measuring frame.
std::string MeasuredText(const Robot& robot, const std::vector<Case>& cases, Method method) {
  std::string text = "case,use";
  for (int i = 1; i <= robot.disks; ++i) text += fmt::format(",x_{0},y_{0},z_{0}", i);
  int row = 0;
  for (Case c : cases) {
    c.loads.mu = robot.mu;
    const Solution s = SolveCase(robot, c.loads, method);
    const Eigen::Matrix3Xd x = robot.MeasuringToBase().transpose() * s.disks;
    text += fmt::format("\n{},{}", c.name, ++row % 4 == 0 ? "test" : "train");
    for (const double coordinate : x.reshaped()) text += "," + Decimal(coordinate);
  }
  return text + "\n";
}

std::string CasesText(int count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  std::string text = kHeader;
  for (int i = 1; i <= count; ++i) {
    text += fmt::format("c{}", i);
    for (int k = 0; k < 3; ++k) text += "," + Decimal(4 * share(random));
    for (int k = 0; k < 3; ++k) text += "," + Decimal(0.2 * (2 * share(random) - 1));
    text += "\n";
  }
  return text;
}

TEST_F(TdcrSolve, CalibrationFindsTheParametersThatMadeTheShapes) {
  request_.input = Write("cases.csv", CasesText(12));
  for (const char* method : {"eas", "pcca", "crt"}) {
    Robot truth = ReadRobot(Yaml::Read(request_.robot));
    truth.E = 51e9;
    truth.mu = 0.12;
    truth.base_rotation = {0.05, -0.1, 0.3};
    const auto cases = ReadCases(CsvTable::Read(request_.input), truth);
    request_.measured = Write("measured.csv", MeasuredText(truth, cases, ParseMethod(method)));
    request_.method = method;
    request_.calibrate = true;
    request_.out = folder_ / "calibrated.yaml";
    ASSERT_EQ(SolveTdcr(request_), 0);
    const Yaml file = Yaml::Read(request_.out);
    const Robot found = ReadRobot(file);
    EXPECT_NEAR(found.E / truth.E, 1, 1e-7) << method;
    EXPECT_LT((found.base_rotation - truth.base_rotation).norm(), 1e-7) << method;
    const Yaml calibration = file.At("calibration");
    EXPECT_EQ(calibration.At("cases").Integer(), 9);
    EXPECT_EQ(calibration.Has("mu"), std::string(method) != "crt");
    if (calibration.Has("mu")) {
      EXPECT_NEAR(found.mu, truth.mu, 1e-6) << method;
    }
    EXPECT_LT(calibration.At("tip_error_percent").At("test").At("max").Number(), 1e-4);
    // The calibrated file is a robot's file: with the measurements it gives the errors.
    SolveRequest again = request_;
    again.robot = request_.out;
    again.calibrate = false;
    again.out = folder_ / "errors.csv";
    ASSERT_EQ(SolveTdcr(again), 0);
    EXPECT_LT(CsvTable::Read(again.out).Number(3, "error_9"), 1e-6 * truth.length);
  }
}

TEST_F(TdcrSolve, ACalibratedValueSaysWhereItIsFrom) {
  std::string robot = kRobot;
  robot.replace(robot.find("unit: Pa"), 8, "unit: Pa, uncertainty: 15e9, source: a guess");
  request_.robot = Write("robot.yaml", robot);
  request_.input = Write("cases.csv", CasesText(12));
  Robot truth = ReadRobot(Yaml::Read(request_.robot));
  truth.natural = {0.3, 0, 0.5};
  const auto cases = ReadCases(CsvTable::Read(request_.input), truth);
  request_.measured = Write("measured.csv", MeasuredText(truth, cases, Method::kCrt));
  request_.calibrate = true;
  request_.out = folder_ / "calibrated.yaml";
  ASSERT_EQ(SolveTdcr(request_), 0);
  const Yaml file = Yaml::Read(request_.out);
  EXPECT_EQ(file.At("calibration").At("status").Text(), "ok");
  EXPECT_EQ(file.At("E").At("source").Text(), "calibrated by eas on 9 cases of measured.csv");
  EXPECT_EQ(file.At("E").At("uncertainty").Number(),
            file.At("calibration").At("standard_error").At("E").Number());
}

TEST_F(TdcrSolve, ACalibrationThatExplainsNothingIsCalledPoor) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  request_.input = Write("cases.csv", CasesText(12));
  request_.calibrate = true;
  request_.out = folder_ / "calibrated.yaml";
  std::mt19937 random(5);
  for (const double size : {0.1, 0.02}) {  // tips anywhere in a ball around the straight tip
    std::uniform_real_distribution<double> place(-size, size);
    std::string text = "case,x_9,y_9,z_9\n";
    for (int i = 1; i <= 12; ++i) {
      text += fmt::format("c{},{},{},{}\n", i, place(random), place(random), 0.1 + place(random));
    }
    request_.measured = Write("measured.csv", text);
    heard.clear();
    EXPECT_EQ(SolveTdcr(request_), 1) << size;
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_THAT(heard[0], testing::AllOf(HasSubstr("measured.csv"), HasSubstr("poor"),
                                         HasSubstr("not explained")));
    const Yaml calibration = Yaml::Read(request_.out).At("calibration");
    EXPECT_EQ(calibration.At("status").Text(), "poor");
    EXPECT_GT(calibration.At("rmse").Number(), 0.5 * size);
  }
}

// Of a table with a header the first `count` rows, each with the name of the row two further on.
std::string MovedOnByTwo(const std::string& text, std::size_t count) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    lines.push_back(text.substr(at, text.find('\n', at) - at));
  }
  std::string moved = lines[0] + "\n";
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = lines[1 + (i + 2) % count];
    const std::string& shape = lines[1 + i];
    moved += name.substr(0, name.find(',')) + shape.substr(shape.find(',')) + "\n";
  }
  return moved;
}

// The least squares end in a valley, flat as that of a rigid rod. Sixty weights learn 20 wrong
// shapes by heart: only the cases left out show it.
TEST_F(TdcrSolve, ShapesOfOtherCasesGiveAPoorCalibrationAndTraining) {
  request_.robot = CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml";
  request_.input = CONTINUUM_SOURCE "/models/tdcr/sample/cases.csv";
  const std::string text = ReadFile(CONTINUUM_SOURCE "/models/tdcr/sample/measured.csv");
  request_.out = folder_ / "out.yaml";
  for (const std::size_t count : {40u, 20u}) {
    std::vector<std::string> heard;
    request_.warn = [&](const std::string& sentence) { heard.push_back(sentence); };
    request_.measured = Write("measured.csv", MovedOnByTwo(text, count));
    request_.hybrid = "";
    request_.lambda.reset();
    request_.calibrate = true;
    EXPECT_EQ(SolveTdcr(request_), 1) << count;
    request_.calibrate = false;
    request_.hybrid = "train";
    request_.lambda = 0;
    EXPECT_EQ(SolveTdcr(request_), 1) << count;
    EXPECT_THAT(heard, testing::ElementsAre(HasSubstr("the calibration is poor"),
                                            HasSubstr("the training is poor")));
    const Yaml hybrid = Yaml::Read(request_.out).At("hybrid");
    EXPECT_EQ(hybrid.At("status").Text(), "poor");
    EXPECT_GT(hybrid.At("rmse_left_out").Number(), 0.5 * hybrid.At("scatter").Number());
    const bool by_heart = hybrid.At("rmse").Number() < 0.5 * hybrid.At("scatter").Number();
    EXPECT_EQ(by_heart, count == 20);
  }
}

TEST_F(TdcrSolve, FitFindsAnEulerArcSplineAgain) {
  request_.input = Write("cases.csv", CasesText(8));
  const Robot robot = ReadRobot(Yaml::Read(request_.robot));
  const auto cases = ReadCases(CsvTable::Read(request_.input), robot);
  request_.measured = Write("measured.csv", MeasuredText(robot, cases, Method::kEas));
  request_.input.clear();
  request_.method = "fit";
  request_.lambda = 0;
  ASSERT_EQ(SolveTdcr(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    EXPECT_LE(table.Number(row, "residual"), 1e-9);
    EXPECT_LT(table.Number(row, "error_9"), 1e-9 * robot.length);
    const Solution s = SolveCase(robot, cases[row].loads, Method::kEas);
    EXPECT_NEAR(table.Number(row, "kappa_x_1"), s.u(0, 0), 1e-6);
    EXPECT_NEAR(table.Number(row, "tau_9"), s.u(2, 8), 1e-6);
  }
}

TEST_F(TdcrSolve, FitOfATipAloneIsHeldByThePenalty) {
  request_.measured = Write("measured.csv", "case,x_9,y_9,z_9\na,0.05,0.02,0.11\n");
  request_.method = "fit";
  ASSERT_EQ(SolveTdcr(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  EXPECT_LE(table.Number(0, "residual"), 1e-9);
  EXPECT_LT(table.Number(0, "error_9"), 0.03 * 0.134);
  EXPECT_FALSE(table.Has("error_8"));
}

TEST_F(TdcrSolve, HybridTrainingLowersTheTrainingErrorAndApplyRepeatsIt) {
  const Robot robot = ReadRobot(Yaml::Read(request_.robot));
  request_.input = Write("cases.csv", CasesText(40));
  const auto cases = ReadCases(CsvTable::Read(request_.input), robot);
  Robot twisted = robot;
  twisted.natural = {0.5, 0, 2};
  request_.measured = Write("measured.csv", MeasuredText(twisted, cases, Method::kCrt));
  request_.hybrid = "train";
  request_.lambda = 0;
  request_.out = folder_ / "hybrid.yaml";
  ASSERT_EQ(SolveTdcr(request_), 0);
  const Yaml hybrid = Yaml::Read(request_.out).At("hybrid");
  EXPECT_EQ(hybrid.At("features").Items().size(), 10u);
  EXPECT_EQ(hybrid.At("status").Text(), "ok");
  EXPECT_GT(hybrid.At("rmse_left_out").Number(), hybrid.At("rmse").Number());
  const double trained = hybrid.At("tip_error_percent").At("train").At("mean").Number();

  const auto mean_error = [&](const SolveRequest& request) {
    EXPECT_EQ(SolveTdcr(request), 0);
    const CsvTable table = CsvTable::Read(request.out);
    double sum = 0;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if ((row + 1) % 4 != 0) sum += table.Number(row, "error_9");
    }
    return 100 * sum / 30 / robot.length;
  };
  SolveRequest plain = request_;
  plain.hybrid = "";
  plain.lambda.reset();
  plain.out = folder_ / "plain.csv";
  SolveRequest apply = plain;
  apply.robot = request_.out;
  apply.hybrid = "apply";
  apply.out = folder_ / "applied.csv";
  const double before = mean_error(plain), after = mean_error(apply);
  EXPECT_LT(after, 0.25 * before);
  EXPECT_NEAR(after, trained, 1e-6);
}

// Twelve cases for ten features are learnt by heart, unless the weights are held back.
TEST_F(TdcrSolve, ATrainingOnFewCasesIsPoorUnlessItIsCrossValidated) {
  const Robot robot = ReadRobot(Yaml::Read(request_.robot));
  request_.input = Write("cases.csv", CasesText(16));
  Robot twisted = robot;
  twisted.natural = {0.5, 0, 2};
  const auto cases = ReadCases(CsvTable::Read(request_.input), robot);
  request_.measured = Write("measured.csv", MeasuredText(twisted, cases, Method::kCrt));
  request_.hybrid = "train";
  request_.lambda = 0;
  request_.out = folder_ / "hybrid.yaml";
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& sentence) { heard.push_back(sentence); };
  EXPECT_EQ(SolveTdcr(request_), 1);
  EXPECT_THAT(heard, testing::ElementsAre(testing::AnyOf(HasSubstr("left out of a training"),
                                                         HasSubstr("too few cases"))));
  request_.lambda.reset();
  EXPECT_EQ(SolveTdcr(request_), 0);
  EXPECT_EQ(Yaml::Read(request_.out).At("hybrid").At("status").Text(), "ok");
}

TEST_F(TdcrSolve, HybridTrainingLeavesConstantFeaturesOutAndRefusesTooFewResiduals) {
  std::string cases = kHeader, measured = "case,x_9,y_9,z_9\n";
  for (int i = 1; i <= 5; ++i) {
    cases += fmt::format("c{},{},1,0,0.1,0,0\n", i, i);
    measured += fmt::format("c{},{},0.01,0.1\n", i, 0.01 * i);
  }
  request_.input = Write("cases.csv", cases);
  request_.measured = Write("measured.csv", measured);
  request_.hybrid = "train";
  request_.out = folder_ / "hybrid.yaml";
  // tau_1, tau_1^2, tau_n, tau_n^2 and T1 change: 30 weights against 15 residuals.
  EXPECT_THAT(Message(), HasSubstr("at least 30 residuals for 30 weights, found 15"));
}
TEST(TdcrSynthetic, HybridHalvesTheErrorOfTheLevelSet) {
  Robot nominal;
  nominal.density = 6450;
  nominal.disk_mass = 0.6e-3;
  nominal.mu = 0.2;
  const Experiment e = Synthesize(nominal, 2, 2022);
  EXPECT_EQ(e.cases.size(), 30u);
  const Calibration c =
      Calibrate(e.nominal, Method::kEas, Match(e.cases, e.measured, "synthetic"), "synthetic");
  std::vector<Case> cases = e.cases;
  for (Case& each : cases) each.loads.mu = c.robot.mu;
  const Hybrid h =
      Train(c.robot, Method::kEas, Match(cases, e.measured, "synthetic"), "synthetic", 0);
  EXPECT_THAT(h.features, testing::Not(testing::Contains("fx")));  // a constant tip force
  EXPECT_LT(Statistics(h.tips.test)->mean, 0.6 * Statistics(c.tips.test)->mean);
}

}  // namespace
}  // namespace continuum::tdcr
