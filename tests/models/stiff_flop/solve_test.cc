#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "error.h"
#include "models/stiff_flop/module.h"
#include "models/stiff_flop/solve.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"

namespace continuum::stiff_flop {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

const fs::path kRobot = CONTINUUM_SOURCE "/models/stiff_flop/stiff_flop.yaml";

class StiffFlopSolve : public testing::Test {
 protected:
  StiffFlopSolve() {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("stiff_flop_" + std::string(test->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    request_.robot = kRobot;
    request_.input = folder_ / "cases.csv";
    request_.out = folder_ / "out.csv";
  }
  ~StiffFlopSolve() override { fs::remove_all(folder_); }

  void Cases(const std::string& text) const { WriteFile(request_.input, text); }

  CsvTable Solved(int code) const {
    EXPECT_EQ(SolveStiffFlop(request_), code);
    return CsvTable::Read(request_.out);
  }

  /// The message of the input error, with nothing written.
  std::string Refusal() const {
    try {
      SolveStiffFlop(request_);
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code(), 2);
      EXPECT_FALSE(fs::exists(request_.out));
      return error.what();
    }
    return "accepted";
  }

  std::string RobotRefusal(const std::string& from, const std::string& to) {
    std::string text = ReadFile(kRobot);
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    WriteFile(folder_ / "robot.yaml", text.replace(at, from.size(), to));
    request_.robot = folder_ / "robot.yaml";
    Cases("p1,p2,p3\n0,0,0\n");
    return Refusal();
  }

  fs::path folder_;
  SolveRequest request_;
};

// What no module carries: the row ends after a bounded number of linear systems and says where. (A
// matrix that is not finite once made a search without end.)
TEST_F(StiffFlopSolve, AbsurdRowsAreGivenUpAndSayWhere) {
  struct Absurd {
    std::string from, to, cases;
  };
  const std::string plain = "p1,p2,p3\n20000,0,0\n";
  for (const auto& [from, to, cases] : {Absurd{"r_o: {value: 9.0e-3", "r_o: {value: 1e6", plain},
                                        Absurd{"E: {value: 100.0e+3", "E: {value: 1e-300", plain},
                                        Absurd{"m: {value: 24.0e-3", "m: {value: 1e300", plain},
                                        Absurd{"", "", "p1,p2,p3,fx\n20000,0,0,1e90\n"},
                                        Absurd{"", "", "p1,p2,p3,fy\n20000,0,0,-1e6\n"}}) {
    std::string text = ReadFile(kRobot);
    WriteFile(folder_ / "robot.yaml", text.replace(text.find(from), from.size(), to));
    request_.robot = folder_ / "robot.yaml";
    Cases(cases);
    const CsvTable table = Solved(1);
    EXPECT_NE(table.Text(0, "status"), "ok") << to << cases;
    EXPECT_THAT(table.Text(0, "why"), HasSubstr("of")) << to << cases;
  }
}

TEST_F(StiffFlopSolve, ShapesGivePressuresAndPressuresGiveShapes) {
  Cases("phi,kappa,lambda_l,case\n0.5,20,1.2,bent\n0,0,1.1,long\n");
  const CsvTable inverse = Solved(0);
  EXPECT_THAT(inverse.columns(),
              ElementsAre("case", "p1", "p2", "p3", "x", "y", "z", "tx", "ty", "tz", "r_o", "r_G1",
                          "r_G2", "r_G3", "gamma_e1", "gamma_e2", "gamma_e3", "x_in", "x_out",
                          "residual", "iterations", "micros", "status", "why", "qw", "qx", "qy",
                          "qz", "Fx", "Fy", "Fz", "Mx", "My", "Mz", "strain_max"));
  EXPECT_EQ(inverse.Text(0, "case"), "bent");
  EXPECT_EQ(inverse.Text(1, "status"), "ok");
  EXPECT_NEAR(inverse.Number(1, "r_o"), 9e-3 / std::sqrt(1.1), 1e-15);
  Cases("p1,p2,p3,fy,gy\n2e4,0,0,0.1,-9.81\n");
  const CsvTable forward = Solved(0);
  EXPECT_THAT(forward.columns(),
              ElementsAre("case", "x", "y", "z", "tx", "ty", "tz", "kappa", "phi", "lambda_l",
                          "r_o", "r_G1", "r_G2", "r_G3", "gamma_e1", "gamma_e2", "gamma_e3", "x_in",
                          "x_out", "residual", "iterations", "micros", "status", "stable",
                          "unstable_directions", "branch", "why", "qw", "qx", "qy", "qz", "Fx",
                          "Fy", "Fz", "Mx", "My", "Mz", "strain_max"));
  EXPECT_EQ(forward.Number(0, "stable"), 1);
  EXPECT_EQ(forward.Text(0, "case"), "1");
  EXPECT_LT(forward.Number(0, "x"), 0);
  EXPECT_LT(forward.Number(0, "residual"), 1e-9);
}

TEST_F(StiffFlopSolve, ListsEquilibriaAndPlacesAlongThem) {
  request_.method = "hooke+fixed+fixed";
  request_.equilibria = true;
  request_.shape = folder_ / "line.csv";
  Cases("p1,p2,p3,fx,fy,fz\n0,0,0,0.01,-1.5,0\n");
  const CsvTable table = Solved(0);
  ASSERT_EQ(table.rows(), 3U);
  EXPECT_EQ(table.Text(0, "status"), "ok");
  EXPECT_EQ(table.Text(1, "status"), "saddle");
  EXPECT_GT(table.Number(1, "energy"), table.Number(0, "energy"));
  EXPECT_EQ(table.Number(2, "equilibrium"), 3);
  const CsvTable line = CsvTable::Read(request_.shape);
  EXPECT_NEAR(line.Number(line.rows() - 1, "y"), table.Number(2, "y"), 1e-6);
  fs::remove(request_.out);
  request_.method.clear();
  Cases("kappa,phi,lambda_l\n20,0.5,1.2\n");
  EXPECT_NE(Refusal().find("--equilibria"), std::string::npos);
  request_.equilibria = false;
  EXPECT_NE(Refusal().find("--shape"), std::string::npos);
}

TEST_F(StiffFlopSolve, SensitivitiesAreAppended) {
  request_.sensitivity = true;
  Cases("kappa,phi,lambda_l\n20,0.5,1.2\n");
  EXPECT_EQ(Solved(0).columns()[24], "dp1_dgamma");
  EXPECT_EQ(Solved(0).columns()[29], "dp3_dE");
  Cases("p1,p2,p3\n2e4,0,0\n");
  EXPECT_EQ(Solved(0).columns()[27], "dx_dgamma");
}

TEST_F(StiffFlopSolve, AFailedCaseLeavesTheOthers) {
  Cases("kappa,phi,lambda_l\n20,0,1\n90,0,1\n10,0,1\n");
  const CsvTable table = Solved(1);
  EXPECT_EQ(table.Text(0, "status"), "ok");
  EXPECT_EQ(table.Text(1, "status"), "out_of_domain");
  EXPECT_EQ(table.Text(1, "p1"), "");
  EXPECT_EQ(table.Text(1, "micros"), "");
  EXPECT_EQ(table.Text(2, "status"), "ok");
}

TEST_F(StiffFlopSolve, JsonHoldsNullsForWhatIsMissing) {
  request_.out = folder_ / "out.json";
  Cases("p1,p2,p3\n1e7,1e7,1e7\n0,0,0\n");
  EXPECT_EQ(SolveStiffFlop(request_), 1);
  const auto json = nlohmann::json::parse(ReadFile(request_.out));
  EXPECT_EQ(json[0]["status"], "no_equilibrium");
  EXPECT_TRUE(json[0]["x"].is_null());
  EXPECT_TRUE(json[1]["x"].is_number());
}

TEST_F(StiffFlopSolve, EveryMethodOfTable2IsKnownInItsDirection) {
  for (const Method& method : Method::All()) {
    Cases("kappa,phi,lambda_l\n10,0,1.05\n");
    request_.method = method.Name(Direction::kInverse);
    EXPECT_EQ(SolveStiffFlop(request_), 0) << request_.method;
    Cases("p1,p2,p3\n1e4,0,0\n");
    request_.method = method.Name(Direction::kForward);
    EXPECT_EQ(SolveStiffFlop(request_), 0) << request_.method;
  }
}

TEST_F(StiffFlopSolve, AMethodOfTheOtherDirectionIsRefusedWithTheList) {
  Cases("p1,p2,p3\n1e4,0,0\n");
  request_.method = "neo_hookean+general+constant";
  EXPECT_THAT(Refusal(), HasSubstr("hooke+elongation+fixed, hooke+elongation+elongation"));
}

TEST_F(StiffFlopSolve, ColumnsMustBelongToOneDirection) {
  Cases("kappa,phi,lambda_l,p1,p2,p3\n0,0,1,0,0,0\n");
  EXPECT_THAT(Refusal(), HasSubstr("cases.csv:1: expected the columns"));
  Cases("case\none\n");
  EXPECT_THAT(Refusal(), HasSubstr("cases.csv:1: expected the columns"));
  Cases("kappa,phi\n0,0\n");
  EXPECT_THAT(Refusal(), HasSubstr("found kappa, phi"));
  Cases("p1,p2,p3,colour\n0,0,0,red\n");
  EXPECT_THAT(Refusal(), HasSubstr("'colour'"));
}

TEST_F(StiffFlopSolve, BadCellsAreNamed) {
  Cases("p1,p2,p3\n0,0,0\n0,much,0\n");
  EXPECT_THAT(Refusal(), HasSubstr("cases.csv:3"));
  Cases("kappa,phi,lambda_l\n-1,0,1\n");
  EXPECT_THAT(Refusal(), HasSubstr("cases.csv:2, column 'kappa': expected a number >= 0"));
  Cases("kappa,phi,lambda_l\n1,0,0\n");
  EXPECT_THAT(Refusal(), HasSubstr("'lambda_l': expected a number > 0"));
  Cases("p1,p2,p3\n");
  EXPECT_THAT(Refusal(), HasSubstr("cases.csv: expected one row or more"));
}

TEST_F(StiffFlopSolve, BadRobotsAreRefused) {
  EXPECT_THAT(RobotRefusal("module: a", "module: c"), HasSubstr("expected an entry of `modules`"));
  EXPECT_THAT(RobotRefusal("r_c2: {value: 3.0e-3", "r_c2: {value: 2.0e-3"),
              HasSubstr("modules.a.r_c2"));
  EXPECT_THAT(RobotRefusal("1.5599752854", "1.6"), HasSubstr("modules.a.gamma"));
  EXPECT_THAT(RobotRefusal("n_c: {value: 1,", "n_c: {value: 1.5,"), HasSubstr("modules.a.n_c"));
  EXPECT_THAT(RobotRefusal("    l_fs: {value: 16.6e-3, unit: m, source: Table 1}\n", ""),
              HasSubstr("l_fs"));
  EXPECT_THAT(RobotRefusal("    l_fs:", "    length: 3\n    l_fs:"), HasSubstr("length"));
}

// Table 1 prints the diameter of the circle, 18 mm.
TEST_F(StiffFlopSolve, TubesOutsideTheWallAreNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  Cases("p1,p2,p3\n0,0,0\n");
  Solved(0);
  EXPECT_THAT(heard, testing::IsEmpty());
  std::string text = ReadFile(kRobot);
  WriteFile(folder_ / "robot.yaml", text.replace(text.find("value: 9.0e-3"), 13, "value: 18.0e-3"));
  request_.robot = folder_ / "robot.yaml";
  Solved(0);
  EXPECT_THAT(heard, ElementsAre(testing::AllOf(HasSubstr("robot.yaml:11: modules.a.r_o"),
                                                HasSubstr("0.015 to 0.021 m"))));
}

TEST_F(StiffFlopSolve, AStretchInMillimetresIsNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  Cases("kappa,phi,lambda_l\n5,0,48\n");
  SolveStiffFlop(request_);
  EXPECT_THAT(heard, ElementsAre(HasSubstr("case '1', lambda_l: 48 is implausible")));
}

TEST_F(StiffFlopSolve, PlainNumbersAreReadToo) {
  WriteFile(folder_ / "plain.yaml",
            "format: 1\nmodel: stiff_flop\nmodule: a\ngravity: [0, 9.81, 0]\nmodules:\n"
            "  a: {r_c1: 2.5e-3, r_c2: 3.0e-3, gamma: 1.5599752854, r_o: 9.0e-3, r_1: 4.5e-3, "
            "r_2: 12.5e-3, l: 44.0e-3, l_fs: 16.6e-3, E: 100.0e+3, m: 24.0e-3, m_fs: 1.0e-3}\n");
  Cases("kappa,phi,lambda_l\n20,0.5,1.2\n");
  const double p1 = Solved(0).Number(0, "p1");
  request_.robot = folder_ / "plain.yaml";
  EXPECT_EQ(Solved(0).Number(0, "p1"), p1);
}

TEST_F(StiffFlopSolve, ModulesInSeriesHaveTheirPressuresNumberedThrough) {
  std::string text = ReadFile(kRobot);
  text.replace(text.find("module: a"), 9, "series: [a, b]");
  request_.robot = folder_ / "robot.yaml";
  WriteFile(request_.robot, text);
  Cases("p1,p2,p3\n1e4,0,0\n");
  EXPECT_THAT(Refusal(), HasSubstr("p1, p2, p3, p4, p5, p6"));
  Cases("kappa,phi,lambda_l\n10,0,1\n");
  EXPECT_THAT(Refusal(), HasSubstr("kappa is of one module"));
  Cases("p1,p2,p3,p4,p5,p6\n2e4,0,0,0,1e4,0\n");
  request_.sensitivity = true;
  EXPECT_NE(Solved(0).Number(0, "dx_dE"), 0);
  request_.sensitivity = false;
  request_.shape = folder_ / "line.csv";
  request_.outlines = folder_ / "outlines.csv";
  const CsvTable t = Solved(0);
  EXPECT_EQ(t.Number(0, "x_2"), t.Number(0, "x"));
  EXPECT_NE(t.Number(0, "phi_1"), t.Number(0, "phi_2"));
  const CsvTable line = CsvTable::Read(request_.shape);
  EXPECT_EQ(line.Number(line.rows() - 1, "disk"), 2);
  EXPECT_NEAR(line.Number(line.rows() - 1, "s"), 44e-3 + 16.6e-3 + 44e-3, 1e-12);
  const CsvTable outlines = CsvTable::Read(request_.outlines);
  EXPECT_EQ(outlines.Number(outlines.rows() - 1, "module"), 2);
  request_.outlines = folder_ / "outlines.svg";
  Solved(0);
  EXPECT_THAT(ReadFile(request_.outlines), HasSubstr("module 2, section at its base"));
}

TEST_F(StiffFlopSolve, BadLinesAndSeriesAreNamed) {
  EXPECT_THAT(RobotRefusal("module: a", "series: [a, c]"), HasSubstr("series[1]"));
  EXPECT_THAT(RobotRefusal("module: a", "series: []"), HasSubstr("none"));
  EXPECT_THAT(RobotRefusal("module: a", "module: a\nseries: [a]"), HasSubstr("both"));
  EXPECT_THAT(RobotRefusal("    l_fs:", "    lines: 5\n    l_fs:"), HasSubstr("modules.a.lines"));
  EXPECT_THAT(RobotRefusal("    l_fs:", "    psi: [0, 90]\n    l_fs:"), HasSubstr("[rad]"));
  EXPECT_THAT(RobotRefusal("    l_fs:", "    lines: 3\n    psi: [0, 1]\n    l_fs:"),
              HasSubstr("each of `lines`"));
}

TEST_F(StiffFlopSolve, OptionsOfOtherRobotsAreRefused) {
  Cases("p1,p2,p3\n0,0,0\n");
  request_.hybrid = "train";
  EXPECT_THAT(Refusal(), HasSubstr("--hybrid"));
}

TEST_F(StiffFlopSolve, PicturesShowTheShapes) {
  Cases("p1,p2,p3\n0,0,0\n4e4,0,0\n1e7,1e7,1e7\n");
  request_.plot = folder_ / "shapes.svg";
  EXPECT_EQ(SolveStiffFlop(request_), 1);
  EXPECT_THAT(ReadFile(request_.plot), HasSubstr("stiff_flop, module a"));
}

}  // namespace
}  // namespace continuum::stiff_flop
