#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "models/twin_pivot/cases.h"
#include "models/twin_pivot/solve_fixture.h"
#include "sim/io/csv.h"

namespace continuum::twin_pivot {
namespace {

using testing::HasSubstr;

TEST_F(TwinPivotSolve, EveryPublishedCaseConvergesUnderEveryConditionOnBothPrototypes) {
  request_.input = kFolder / "cases.csv";
  for (const char* robot : {"a.yaml", "b.yaml"}) {
    for (const char* method : {"", "printed"}) {
      request_.robot = kFolder / robot;
      request_.method = method;
      EXPECT_EQ(SolveTwinPivot(request_), 0);
      const CsvTable results = CsvTable::Read(request_.out);
      ASSERT_EQ(results.rows(), 210U);
      for (std::size_t row = 0; row < results.rows(); ++row) {
        EXPECT_EQ(results.Text(row, "status"), "ok");
        EXPECT_LE(results.Number(row, "residual"), 1e-10);
      }
    }
  }
}

TEST_F(TwinPivotSolve, MultiSectionTrajectoryRuns) {
  request_.robot = kFolder / "c.yaml";
  request_.input = kFolder / "trajectory.csv";
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const CsvTable results = CsvTable::Read(request_.out);
  EXPECT_TRUE(results.Has("beta_14"));
  EXPECT_TRUE(results.Has("F_end_8"));
  for (std::size_t row = 1; row < results.rows(); ++row) {
    for (const char* axis : {"x", "y", "z"}) {
      // 60 steps around a loop of some 300 mm: no jump from one to the next.
      EXPECT_NEAR(results.Number(row, axis), results.Number(row - 1, axis), 0.015);
    }
  }
}

// Loads that no robot of this kind carries: the row ends after a bounded number of linear systems,
// whatever is absurd, and says where.
TEST_F(TwinPivotSolve, AbsurdRowsAreGivenUpAndSayWhere) {
  constexpr double kMost = 25000;  // of a row, rounded up
  const std::string plain = "case,F1,F2,F3,F4\none,5,5,1,1\n";
  struct Absurd {
    std::string from, to, cases;
  };
  for (const auto& [from, to, cases] :
       {Absurd{"h: {value: 6.0e-3", "h: {value: 1e6", plain},
        Absurd{"m_D: {value: 1.4e-3", "m_D: {value: 1e300", plain},
        Absurd{"E: {value: 60.6e9", "E: {value: 1e-300", plain},
        Absurd{"", "", "case,F1,F2,F3,F4,fy\none,5,5,1,1,-1e90\n"},
        Absurd{"", "", "case,F1,F2,F3,F4,fz\none,5,5,1,1,-200\n"},
        Absurd{"", "", "case,F1,F2,F3,F4,reference\nzero,5,5,1,1,\none,1e6,1,1,1,zero\n"}}) {
    std::string text = ReadFile(kFolder / "b.yaml");
    WriteFile(folder_ / "robot.yaml", text.replace(text.find(from), from.size(), to));
    request_.robot = folder_ / "robot.yaml";
    Cases(cases);
    EXPECT_EQ(SolveTwinPivot(request_), 1) << to << cases;
    const CsvTable results = CsvTable::Read(request_.out);
    const std::size_t last = results.rows() - 1;
    EXPECT_EQ(results.Text(last, "status"), "no_convergence") << to << cases;
    EXPECT_THAT(results.Text(last, "why"), HasSubstr("of")) << to << cases;
    EXPECT_LE(results.Number(last, "iterations"), kMost) << to << cases;
  }
}

TEST_F(TwinPivotSolve, MassesAreTensionsOf981NewtonPerKilogramWhateverTheGravity) {
  Cases("case,m1,m2,m3,m4,gx,gy,gz\none,1,0.5,0.2,0.1,1,2,3\n");
  const Robot robot = Robot::Read(request_.robot);
  const auto by_mass = ReadCases(request_.input, robot);
  Cases("case,gz,gy,gx,F4,F3,F2,F1\none,3,2,1,0.981,1.962,4.905,9.81\n");
  const auto by_force = ReadCases(request_.input, robot);
  EXPECT_EQ(by_force[0].load.gravity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(by_force[0].load.gravity, by_mass[0].load.gravity);
  for (int j = 0; j < 4; ++j) {
    EXPECT_DOUBLE_EQ(by_mass[0].load.tension[j], by_force[0].load.tension[j]);
  }
  EXPECT_EQ(by_mass[0].load.condition, Condition::kV);
}

TEST_F(TwinPivotSolve, ResultsKeepFullPrecisionInCsvAndJson) {
  Cases("case,condition,F1,F2,F3,F4\n\"pull, up\",II,9,8,1,2\n");
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  const std::vector<std::string> columns = {"case",
                                            "condition",
                                            "status",
                                            "iterations",
                                            "residual",
                                            "micros",
                                            "x",
                                            "y",
                                            "z",
                                            "stable",
                                            "unstable_directions",
                                            "branch",
                                            "why",
                                            "beta_1",
                                            "beta_2",
                                            "beta_3",
                                            "beta_4",
                                            "beta_5",
                                            "beta_6",
                                            "F_end_1",
                                            "F_end_2",
                                            "F_end_3",
                                            "F_end_4",
                                            "qw",
                                            "qx",
                                            "qy",
                                            "qz",
                                            "Fx",
                                            "Fy",
                                            "Fz",
                                            "Mx",
                                            "My",
                                            "Mz",
                                            "strain_max",
                                            "l_1",
                                            "l_2",
                                            "l_3",
                                            "l_4",
                                            "parts"};
  EXPECT_EQ(table.columns(), columns);
  request_.out = folder_ / "out.json";
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const auto json = nlohmann::json::parse(ReadFile(request_.out));
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["case"], "pull, up");
  const Robot robot = Robot::Read(request_.robot);
  Load load;
  load.condition = Condition::kII;
  load.tension = {9, 8, 1, 2};
  const Solution solution = Solve(robot, load);
  EXPECT_EQ(json[0]["y"].get<double>(), solution.tip.y());
  EXPECT_EQ(table.Number(0, "beta_6"), solution.beta[5]);
  EXPECT_EQ(table.Number(0, "F_end_4"), solution.tension(5, 3));
}

TEST_F(TwinPivotSolve, FailedCaseAndThoseThatReferToItDoNotStopTheOthers) {
  Cases("case,F1,F2,F3,F4,reference\nbad,1e9,0,0,0,\nafter,5,5,1,1,bad\ngood,5,5,1,1,\n");
  EXPECT_EQ(SolveTwinPivot(request_), 1);
  const CsvTable table = CsvTable::Read(request_.out);
  EXPECT_EQ(table.Text(0, "status"), "no_convergence");
  EXPECT_FALSE(table.Text(0, "residual").empty());
  EXPECT_FALSE(table.Text(0, "iterations").empty());
  EXPECT_TRUE(table.Text(0, "x").empty());
  EXPECT_TRUE(table.Text(0, "F_end_1").empty());
  EXPECT_FALSE(table.Text(0, "why").empty());
  EXPECT_EQ(table.Text(1, "status"), "no_convergence");
  EXPECT_EQ(table.Text(1, "why"), "its reference 'bad' failed");
  EXPECT_EQ(table.Text(2, "status"), "ok");
  EXPECT_TRUE(table.Text(2, "why").empty());
}

TEST_F(TwinPivotSolve, ReferenceIsTheSolutionOfAnEarlierRow) {
  Cases("case,F1,F2,F3,F4,reference\nfar,14,14,8,8,\nback,11,11,8,8,far\ndirect,11,11,8,8,\n");
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  EXPECT_GT(table.Number(1, "y"), table.Number(2, "y"));
}

TEST_F(TwinPivotSolve, GivenLengthsGiveTensions) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  Cases("case,L1,L2,L3,L4\nwound,0.036,0.036,0.04,0.04\nmm,0.036,36,0.04,0.04\n");
  request_.shape = folder_ / "line.csv";
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  EXPECT_GT(table.Number(0, "T_1"), 1);
  EXPECT_EQ(table.Number(0, "T_3"), 0);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_NE(heard[0].find("case 'mm', cable 2: 36 m is implausible"), std::string::npos);
  const CsvTable line = CsvTable::Read(request_.shape);
  EXPECT_EQ(line.Number(line.rows() / 2 - 1, "x"), table.Number(0, "x"));
  EXPECT_LT(line.Number(0, "T_1"), table.Number(0, "T_1"));  // friction at the base disc
  fs::remove(request_.out);
  request_.equilibria = true;
  EXPECT_NE(Refusal().find("'L1'"), std::string::npos);
}

TEST_F(TwinPivotSolve, ListsEquilibria) {
  Cases("case,F1,F2,F3,F4\none,5,5,1,1\n");
  request_.equilibria = true;
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  ASSERT_EQ(table.rows(), 1U);
  EXPECT_EQ(table.Number(0, "equilibrium"), 1);
  EXPECT_LT(table.Number(0, "energy"), 0);
  fs::remove(request_.out);
  request_.calibrate = true;
  EXPECT_NE(Refusal().find("--equilibria"), std::string::npos);
}

TEST_F(TwinPivotSolve, AnAngleInDegreesAndAnImplausibleTensionAreNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  Cases("case,F1,F2,F3,F4\none,5,5,1,1\n");
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  EXPECT_TRUE(heard.empty());
  Cases("case,F1,F2,F3,F4\none,3000,5,1,1\n");
  SolveTwinPivot(request_);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_NE(heard[0].find("case 'one', cable 1: 3000 N is implausible"), std::string::npos);
  heard.clear();
  std::string text = ReadFile(request_.robot);
  const std::size_t phi = text.find("-0.78539816");
  text.replace(phi, 11, "-45");
  request_.robot = folder_ / "degrees.yaml";
  WriteFile(request_.robot, text);
  Cases("case,F1,F2,F3,F4\none,5,5,1,1\n");
  SolveTwinPivot(request_);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_NE(heard[0].find("-45 is taken as radians"), std::string::npos);
}

TEST_F(TwinPivotSolve, DeadLoadsThatWouldRollItUpAreNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  Cases("case,F1,F2,F3,F4,payload,fx,Mz,fy_2,gx\none,5,5,1,1,0.02,0.3,0.01,0.1,1\n");
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  EXPECT_TRUE(heard.empty());
  Cases("case,F1,F2,F3,F4,payload,fx,Mz,fy_2,gx\none,5,5,1,1,20,1e6,300,-1e4,9810\n");
  SolveTwinPivot(request_);
  ASSERT_EQ(heard.size(), 5U);
  const char* const what[] = {"payload: 20 kg", "force: 1e+06 N", "moment: 300 N m",
                              "gravity: 9810", "force on disc 2: 1e+04 N"};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NE(heard[i].find(std::string("case 'one', ") + what[i]), std::string::npos) << heard[i];
  }
}

TEST_F(TwinPivotSolve, BadCasesAreRefusedWithLineAndColumn) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"case,m1,m2,m3\none,1,1,1\n", "m4"},
      {"case,m1,m2,m3,m4,F1\none,1,1,1,1,1\n", "cases.csv:1"},
      {"m1,m2,m3,m4\n1,1,1,1\n", "case"},
      {"case,m1,m2,m3,m4,tension\none,1,1,1,1,1\n", "column 'tension'"},
      {"case,m1,m2,m3,m4\none,1,1,1,1\ntwo,1,1,x,1\n", "cases.csv:3, column 'm3'"},
      {"case,m1,m2,m3,m4\none,1,,1,1\n", "cases.csv:2, column 'm2'"},
      {"case,m1,m2,m3,m4\none,1,nan,1,1\n", "cases.csv:2, column 'm2'"},
      {"case,m1,m2,m3,m4\none,1,-1,1,1\n", "cases.csv:2, column 'm2'"},
      {"case,F1,F2,F3,F4\none,1,-1,1,1\n", "cases.csv:2, column 'F2'"},
      {"case,m1,m2,m3,m4,payload\none,1,1,1,1,-0.1\n", "cases.csv:2, column 'payload'"},
      {"case,m1,m2,m3,m4,fx\none,1,1,1,1,inf\n", "cases.csv:2, column 'fx'"},
      {"case,m1,m2,m3,m4,condition\none,1,1,1,1,VI\n", "cases.csv:2, column 'condition'"},
      {"case,m1,m2,m3,m4,reference\none,1,1,1,1,two\ntwo,1,1,1,1,\n",
       "cases.csv:2, column 'reference'"},
      {"case,m1,m2,m3,m4\none,1,1,1,1\none,1,1,1,1\n", "cases.csv:3, column 'case'"},
      {"case,F1,F2,F3,F4,fx_7\none,1,1,1,1,1\n", "column 'fx_7'"},
      {"case,F1,F2,F3,F4,fx_01\none,1,1,1,1,1\n", "k = 1 to 6"},
      {"case,F1,F2,F3,F4,Mx_2\none,1,1,1,1,much\n", "cases.csv:2, column 'Mx_2'"},
      {"case,F1,F2,F3,F4,payload_2\none,1,1,1,1,-1\n", "cases.csv:2, column 'payload_2'"},
      {"case,m1,m2,m3,m4\n", "cases.csv"}};
  for (const auto& [text, place] : bad) {
    Cases(text);
    EXPECT_THAT(Refusal(), HasSubstr(place)) << text;
  }
}

TEST_F(TwinPivotSolve, BadRobotsAreRefusedWithLineAndKey) {
  const std::vector<std::array<std::string, 3>> bad = {
      {"format: 1", "format: 2", "format"},
      {"[6]", "[5]", "discs"},
      {"[6]", "[]", "discs"},
      {"[6]", "[100000000]", "at most 400 discs"},
      {"[6]", "[6, 6]", "r"},
      {"value: 6.1666667e-3", "value: 0", ": L"},
      {"value: 60.6e9", "value: -1", ": E"},
      {"value: 2, source", "value: 0, source", "rods"},
      {"[5.0e-3, 5.0e-3, 5.0e-3, 5.0e-3]", "[5.0e-3, 5.0e-3, 5.0e-3, 0]", "[3]"},
      {"-0.78539816", "left", "[0]"},
      {"value: 1.4e-3", "value: -1.4e-3", "m_D"},
      {"value: 0.14", "value: -0.14", "friction.c"},
      {"value: 1.0e-6", "value: 0", "friction.eps"},
      {"[0, -9.81, 0]", "[0, -9.81]", "gravity"},
      {"m_D:", "m_disc:", "m_disc"},
      {"m_D:", "cables: [2]\nm_D:", "3 to 60 cables in a section"},
      {"m_D:", "cables: [3, 3]\nm_D:", "one per section"},
      {"m_D:", "cables: [3]\nm_D:", "3 numbers, one for each cable"},
      {"value: 1.4e-3", "value: [1.4e-3, 1e-3]", "m_D"},
      {"m_D:", "strain_limit: 0\nm_D:", "strain_limit"},
      {"value: 1.0e-6", "value: 1.0e-6}\n  theta_max: {value: 2", "friction.theta_max"},
      {"value: 0.3,", "value: .nan,", "mu_const"}};
  for (const auto& [from, to, key] : bad) {
    const std::string message = RobotRefusal(from, to);
    EXPECT_THAT(message, HasSubstr("robot.yaml:")) << to;
    EXPECT_THAT(message, HasSubstr(key)) << to;
  }
}

TEST_F(TwinPivotSolve, StrainAndAngleBeyondTheirLimitsAreNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  std::string text = ReadFile(kFolder / "a.yaml");
  text.replace(text.find("m_D:"), 4, "strain_limit: 0.002\nm_D:");
  text.replace(text.find("  eps:"), 6, "  theta_max: 0.02\n  eps:");
  request_.robot = folder_ / "limits.yaml";
  WriteFile(request_.robot, text);
  Cases("case,F1,F2,F3,F4,condition\nlow,1,1,1,1,V\nhigh,8,8,1,1,V\nno mu,8,8,1,1,I\n");
  EXPECT_EQ(SolveTwinPivot(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  EXPECT_EQ(table.Text(0, "beyond"), "");
  EXPECT_THAT(table.Text(1, "beyond"), HasSubstr("> 0.002; theta "));
  EXPECT_THAT(table.Text(1, "beyond"), HasSubstr("> 0.02 rad"));
  EXPECT_THAT(table.Text(2, "beyond"), Not(HasSubstr("theta")));
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_THAT(heard[0], HasSubstr("is beyond 0.002, in 2 of 3 rows"));
  EXPECT_THAT(heard[1], HasSubstr("at 'high' is beyond 0.02, in 1 of 3 rows"));
}

TEST_F(TwinPivotSolve, BadPathsAreRefused) {
  Cases("case,F1,F2,F3,F4\none,1,1,1,1\n");
  request_.follow = folder_ / "path.csv";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"x,y\n0,0\n1,0\n", "a column 'z'"},
      {"x,y,z,t\n0,0,0,0\n0.01,0,0,0\n", "column 't'"},
      {"x,y,z\n0,0,0\n", "two points"},
      {"x,y,z\n0,0.01,0\n0.01,0.01,0\n", "y = z = 0"},
      {"x,y,z\n0,0,0\n0,0,0\n", "path.csv:3"},
      {"x,y,z,low\n0,0,0,-1\n0.01,0,0,1\n", "path.csv:2, column 'low'"},
      {"x,y,z,low,high\n0,0,0,3,2\n0.01,0,0,1,2\n", "path.csv:2, column 'high'"},
      {"x,y,z\n0,0,0\n0.01,0.001,0\n0.1,0.002,0\n", "path.csv:4"}};
  for (const auto& [text, place] : bad) {
    WriteFile(request_.follow, text);
    EXPECT_THAT(Refusal(), HasSubstr(place)) << text;
  }
  WriteFile(request_.follow, "x,y,z\n0,0,0\n0.01,0,0\n");
  Cases("case,F1,F2,F3,F4\none,1,1,1,1\ntwo,1,1,1,1\n");
  EXPECT_THAT(Refusal(), HasSubstr("one row"));
  Cases("case,L1,L2,L3,L4\none,0.03,0.03,0.04,0.04\n");
  EXPECT_THAT(Refusal(), HasSubstr("--follow"));
}

TEST_F(TwinPivotSolve, NegativeFrictionInUseNamesTheFile) {
  EXPECT_THAT(RobotRefusal("value: 16.7", "value: -300"), HasSubstr("robot.yaml: friction"));
}

TEST_F(TwinPivotSolve, OptionsOfOtherModelsAreRefused) {
  Cases("case,m1,m2,m3,m4\none,1,1,0.1,0.1\n");
  const SolveRequest good = request_;
  request_.method = "newton";
  EXPECT_THAT(Refusal(), HasSubstr("virtual_work or printed"));
  request_ = good;
  request_.hybrid = "train";
  EXPECT_THAT(Refusal(), HasSubstr("--hybrid"));
  request_ = good;
  request_.lambda = 1e-6;
  EXPECT_THAT(Refusal(), HasSubstr("--lambda"));
  request_ = good;
  request_.out = folder_ / "out.txt";
  EXPECT_THAT(Refusal(), HasSubstr("--out"));
  request_ = good;
  request_.input.clear();
  EXPECT_THAT(Refusal(), HasSubstr("--input"));
}

}  // namespace
}  // namespace continuum::twin_pivot
