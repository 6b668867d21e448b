// ctest labels: slow
#include <cstring>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "models/tdcr/solve_fixture.h"
#include "sim/io/csv.h"

namespace continuum::tdcr {
namespace {

using testing::HasSubstr;

// What no rod carries: the row ends after a bounded number of linear systems, says where, and is
// not ok. (1e300 once made a matrix that is not finite, and a search without end.)
TEST_F(TdcrSolve, AbsurdRowsAreGivenUpAndSayWhere) {
  struct Absurd {
    const char *from, *to, *cases;
  };
  constexpr double kMost = 150000;  // of a row
  const char* const plain = "a,5,0,0,0.1,0,-1\n";
  for (const auto& [from, to, cases] : {Absurd{"density: 6450", "density: 1e300", plain},
                                        Absurd{"disk_mass: 0.6e-3", "disk_mass: 1e300", plain},
                                        Absurd{"value: 60.0e9", "value: 1e-6", plain},
                                        Absurd{"mu: 0.2", "mu: 0.2", "a,5,0,0,0,0,-1e90\n"},
                                        Absurd{"mu: 0.2", "mu: 0.2", "a,5,0,0,0.1,0,-1e6\n"}}) {
    std::string text = kRobot;
    request_.robot = Write("robot.yaml", text.replace(text.find(from), strlen(from), to));
    request_.input = Write("cases.csv", kHeader + std::string(cases));
    for (const char* method : {"crt", "crt_friction"}) {
      request_.method = method;
      EXPECT_EQ(SolveTdcr(request_), 1) << method << to << cases;
      const CsvTable table = CsvTable::Read(request_.out);
      EXPECT_EQ(table.Text(0, "status"), "no_convergence") << method << to << cases;
      EXPECT_THAT(table.Text(0, "why"), HasSubstr("of")) << method << to << cases;
      EXPECT_LE(table.Number(0, "iterations"), kMost) << method << to << cases;
    }
  }
}

TEST_F(TdcrSolve, WritesTheContractsColumnsAndEchoesTheCases) {
  request_.input =
      Write("cases.csv", std::string(kHeader) + "a,1,0,0,0,0,0\n\"b, c\",0,0,0,0,0,0\n");
  for (const char* method : {"", "eas", "pcca", "crt"}) {
    request_.method = method;
    EXPECT_EQ(SolveTdcr(request_), 0);
    const CsvTable table = CsvTable::Read(request_.out);
    const auto& columns = table.columns();
    ASSERT_EQ(columns.size(), 12u + 27 + 27 + 11 + 3);
    EXPECT_THAT(std::vector(columns.begin(), columns.begin() + 15),
                testing::ElementsAre("case", "status", "iterations", "residual", "micros", "x", "y",
                                     "z", "stable", "unstable_directions", "branch", "why", "x_1",
                                     "y_1", "z_1"));
    EXPECT_EQ(table.Number(0, "stable"), 1);
    EXPECT_EQ(table.Text(0, "branch"), "rising");
    EXPECT_THAT(std::vector(columns.end() - 15, columns.end()),
                testing::ElementsAre("tau_9", "qw", "qx", "qy", "qz", "Fx", "Fy", "Fz", "Mx", "My",
                                     "Mz", "strain_max", "l_1", "l_2", "l_3"));
    EXPECT_LT(table.Number(0, "l_1"), 0.134);
    EXPECT_EQ(table.Number(1, "qw"), 1);
    EXPECT_EQ(table.Text(1, "case"), "b, c");
    EXPECT_EQ(table.Text(0, "status"), "ok");
    EXPECT_EQ(table.Number(1, "z"), table.Number(1, "z_9"));
    EXPECT_GT(table.Number(0, "kappa_x_5"), 0);
  }
}

TEST_F(TdcrSolve, ACaseOverridesGravityFrictionAndDirection) {
  request_.input = Write("cases.csv",
                         "case,T1,T2,T3,fx,fy,fz,gx,gy,gz,mu,dir1,dir2,dir3\n"
                         "a,4,0,0,0,0,0,0,0,0,0,1,1,1\nb,4,0,0,0,0,0,0,0,0,0.5,0,1,1\n"
                         "c,4,0,0,0,0,0,0,0,0,0.5,1,1,1\n");
  EXPECT_EQ(SolveTdcr(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  EXPECT_EQ(table.Number(0, "x"), table.Number(1, "x"));
  EXPECT_LT(table.Number(2, "x"), 0.95 * table.Number(0, "x"));
}

TEST_F(TdcrSolve, ARowGoesOnFromItsReference) {
  request_.input = Write("cases.csv",
                         "case,T1,T2,T3,fx,fy,fz,dir1,dir2,dir3,reference\n"
                         "low,1,0.5,0.5,0,0,0,auto,auto,auto,\nhigh,5,0.5,0.5,0,0,0,auto,auto,auto,"
                         "low\nheld,5,0.5,0.5,0,0,0,auto,auto,auto,high\n"
                         "back,1,0.5,0.5,0,0,0,auto,auto,auto,held\n");
  for (const char* method : {"eas", "pcca", "crt_friction"}) {
    request_.method = method;
    EXPECT_EQ(SolveTdcr(request_), 0);
    const CsvTable table = CsvTable::Read(request_.out);
    const bool rod = request_.method == "crt_friction";
    EXPECT_NEAR(table.Number(2, "x"), table.Number(1, "x"), rod ? 1e-9 : 1e-12);
    EXPECT_GT(table.Number(3, "x"), table.Number(0, "x") + 5e-4);
  }
  std::filesystem::remove(request_.out);
  request_.method = "eas";
  EXPECT_THAT(MessageOfCases("case,T1,T2,T3,fx,fy,fz,reference\na,1,0,0,0,0,0,b\n"),
              testing::AllOf(HasSubstr("column 'reference'"), HasSubstr("'b'")));
  request_.input =
      Write("cases.csv", "case,T1,T2,T3,fx,fy,fz,reference\na,1,0,0,0,0,0,\nb,1,0,0,0,0,0,a\n");
  request_.measured = Write("measured.csv", "case,x_9,y_9,z_9\na,0,0,0.13\nb,0,0,0.13\n");
  request_.calibrate = true;
  request_.out = folder_ / "calibrated.yaml";
  EXPECT_THAT(Message(), testing::AllOf(HasSubstr("column 'reference'"), HasSubstr("case 'b'")));
}

TEST_F(TdcrSolve, AFailedCaseLeavesItsNumbersEmptyAndTheOthersSolved) {
  request_.method = "crt";
  request_.input = Write("cases.csv", std::string(kHeader) + "a,1e6,0,0,0,0,0\nb,1,0,0,0,0,0\n");
  EXPECT_EQ(SolveTdcr(request_), 1);
  const CsvTable table = CsvTable::Read(request_.out);
  EXPECT_EQ(table.Text(0, "status"), "no_convergence");
  EXPECT_EQ(table.Text(0, "x"), "");
  EXPECT_EQ(table.Text(0, "tau_9"), "");
  EXPECT_NE(table.Text(0, "why"), "");
  EXPECT_GE(table.Number(0, "residual"), 0);
  EXPECT_EQ(table.Text(1, "status"), "ok");
  request_.out = folder_ / "out.json";
  EXPECT_EQ(SolveTdcr(request_), 1);
  EXPECT_THAT(ReadFile(request_.out), HasSubstr("\"x\": null"));
}

TEST_F(TdcrSolve, BadCasesAreNamedWithLineAndColumn) {
  const std::string header = kHeader;
  EXPECT_THAT(MessageOfCases(header + "a,-1,0,0,0,0,0\n"), HasSubstr("cases.csv:2, column 'T1'"));
  EXPECT_THAT(MessageOfCases(header + "a,1,0,0,0,0,0\nb,1,0,x,0,0,0\n"),
              HasSubstr("cases.csv:3, column 'T3'"));
  EXPECT_THAT(MessageOfCases(header + "a,1,0,0,nan,0,0\n"), HasSubstr("a finite number"));
  EXPECT_THAT(MessageOfCases(header + "a,1e300,0,0,0,0,0\n"), HasSubstr("column 'T1'"));
  EXPECT_THAT(MessageOfCases(header), HasSubstr("cases.csv: expected one row or more"));
  EXPECT_THAT(MessageOfCases("case,T1,T2,fx,fy,fz\na,1,1,0,0,0\n"), HasSubstr("'T3'"));
  EXPECT_THAT(MessageOfCases("case,T1,T2,T3,fx,fy,fz,mu\na,1,1,0,0,0,0,1\n"),
              HasSubstr("0 <= mu < 1"));
  EXPECT_THAT(MessageOfCases("case,T1,T2,T3,fx,fy,fz,gx\na,1,1,0,0,0,0,1\n"), HasSubstr("'gy'"));
  EXPECT_THAT(MessageOfCases("case,T1,T2,T3,fx,fy,fz,T4\na,1,1,0,0,0,0,1\n"), HasSubstr("'T4'"));
  EXPECT_THAT(MessageOfCases("case,T1,T2,T3,fx,fy,fz,dir1\na,1,1,0,0,0,0,2\n"),
              HasSubstr("column 'dir1'"));
}

TEST_F(TdcrSolve, BadRobotsAreNamedWithLineAndKey) {
  EXPECT_THAT(MessageOfRobot("length: 0.134", "length: -0.134"), HasSubstr("robot.yaml:3: length"));
  EXPECT_THAT(MessageOfRobot("length: 0.134", "length: {value: 134, unit: mm}"),
              HasSubstr("length.unit: expected a unit of the SI, found 'mm'"));
  EXPECT_THAT(MessageOfRobot("disks: 9", "disks: 1"), HasSubstr("robot.yaml:5: disks"));
  EXPECT_THAT(MessageOfRobot("disks: 9", "disks: 2.5"), HasSubstr("whole number"));
  EXPECT_THAT(MessageOfRobot("mu: 0.2", "mu: 1"), HasSubstr("0 <= mu < 1"));
  EXPECT_THAT(MessageOfRobot("gravity: [0, 0, 9.81]", "gravity: 9.81"), HasSubstr("gravity"));
  EXPECT_THAT(MessageOfRobot("nu: 0.3\n", ""), HasSubstr("'nu'"));
}

TEST_F(TdcrSolve, RepeatedAndMisplacedKeysAreNamedWithTheirLine) {
  EXPECT_THAT(
      MessageOfRobot("mu: 0.2\n", "mu: 0.2\nmu: 0.3\n"),
      testing::AllOf(HasSubstr("robot.yaml:13"), HasSubstr("'mu' twice"), HasSubstr("line 12")));
  EXPECT_THAT(MessageOfRobot("value: 60.0e9", "value: 60.0e9, value: 50.0e9"),
              testing::AllOf(HasSubstr("robot.yaml:8"), HasSubstr("'value' twice")));
  EXPECT_THAT(MessageOfRobot("unit: Pa", "unti: Pa"),
              testing::AllOf(HasSubstr("robot.yaml:8"), HasSubstr("'unti'")));
}

TEST_F(TdcrSolve, KeysAndColumnsThatNothingReadsAreRefused) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  request_.input = Write("cases.csv", "case,T1,T2,T3,fx,fy,fz\na,1,0,0,0,0,0\n");
  EXPECT_EQ(SolveTdcr(request_), 0);
  EXPECT_THAT(heard, testing::IsEmpty());
  std::filesystem::remove(request_.out);
  EXPECT_THAT(MessageOfCases("case,T1,T2,T3,fx,fy,fz,note\na,1,0,0,0,0,0,x\n"),
              testing::AllOf(HasSubstr("cases.csv:1"), HasSubstr("'note'")));
  request_.input = Write("cases.csv", "case,T1,T2,T3,fx,fy,fz\na,1,0,0,0,0,0\n");
  request_.measured = Write("measured.csv", "case,x_9,y_9,z_9,who\na,0,0,0.13,me\n");
  EXPECT_THAT(Message(), testing::AllOf(HasSubstr("measured.csv:1"), HasSubstr("'who'")));
  request_.measured.clear();
  request_.robot = Write("robot.yaml", std::string(kRobot) + "colour: red\n");
  EXPECT_THAT(Message(), testing::AllOf(HasSubstr("robot.yaml:15"), HasSubstr("colour")));
}

TEST_F(TdcrSolve, ImplausibleValuesAreNamedWithTheirRange) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  std::string text = kRobot;
  const std::string diameter = text.substr(text.find("diameter: "), 10);
  text.replace(text.find(diameter), diameter.size(), "diameter: 0.99  # ");
  request_.robot = Write("robot.yaml", text);
  request_.input = Write("cases.csv", std::string(kHeader) + "a,1,0,0,0,0,0\n");
  SolveTdcr(request_);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_THAT(heard[0], testing::AllOf(HasSubstr("robot.yaml:"), HasSubstr("diameter: 0.99 m is"),
                                       HasSubstr("expected 1e-05 to 0.014 m")));
  heard.clear();
  request_.robot = Write("robot.yaml", kRobot);
  request_.input = Write("cases.csv", std::string(kHeader) + "a,3000,0,0,0,0,0\n");
  SolveTdcr(request_);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_THAT(heard[0], testing::AllOf(HasSubstr("cases.csv:2, column 'T1'"), HasSubstr("3000 N")));
}

TEST_F(TdcrSolve, ImplausibleTipMomentsAndTendonStiffnessAreNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  request_.method = "crt";
  request_.robot = Write("robot.yaml", std::string(kRobot) + "tendon_EA: 1.0e-9\n");
  request_.input = Write("cases.csv", "case,T1,T2,T3,fx,fy,fz,mx,my,mz\na,0,0,0,0,0,0,0,0,5\n");
  SolveTdcr(request_);
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_THAT(heard[0], HasSubstr("tendon_EA: 1e-09 N is"));
  EXPECT_THAT(heard[1], HasSubstr("column 'mz': 5 N m is"));
}

TEST_F(TdcrSolve, ALengthInMillimetresIsNamed) {
  std::vector<std::string> heard;
  request_.warn = [&](const std::string& text) { heard.push_back(text); };
  request_.input = Write("cases.csv", "case,L1,L2,L3,fx,fy,fz\na,130,0.14,0.14,0,0,0\n");
  EXPECT_EQ(SolveTdcr(request_), 0);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_THAT(heard[0], testing::AllOf(HasSubstr("cases.csv:2, column 'L1'"), HasSubstr("130 m")));
}

TEST_F(TdcrSolve, GivenLengthsGiveTensions) {
  request_.input = Write("cases.csv", "case,L1,L2,L3,fx,fy,fz\na,0.13,0.14,0.14,0,0,0\n");
  for (const char* method : {"eas", "pcca", "crt", "crt_friction"}) {
    request_.method = method;
    EXPECT_EQ(SolveTdcr(request_), 0);
    const CsvTable table = CsvTable::Read(request_.out);
    EXPECT_GT(table.Number(0, "T_1"), 1);
    EXPECT_EQ(table.Number(0, "T_2"), 0);
    EXPECT_FALSE(table.Has("l_1"));
  }
  std::filesystem::remove(request_.out);
  request_.equilibria = true;
  EXPECT_THAT(Message(), testing::AllOf(HasSubstr("cases.csv:1"), HasSubstr("'L1'")));
  request_.equilibria = false;
  EXPECT_THAT(MessageOfCases("case,L1,L2,L3,fx,fy,fz\na,-0.13,0.14,0.14,0,0,0\n"),
              testing::AllOf(HasSubstr("column 'L1'"), HasSubstr("above 0")));
  EXPECT_THAT(MessageOfCases("case,L1,L2,fx,fy,fz\na,0.13,0.14,0,0,0\n"), HasSubstr("'L3'"));
}

TEST_F(TdcrSolve, ListsEquilibriaAndPlacesAlongThem) {
  request_.input = Write("cases.csv", std::string(kHeader) + "a,0,0,0,0.1,0,-2\n");
  request_.method = "crt";
  request_.equilibria = true;
  request_.shape = folder_ / "line.csv";
  EXPECT_EQ(SolveTdcr(request_), 0);
  const CsvTable table = CsvTable::Read(request_.out);
  ASSERT_EQ(table.rows(), 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_EQ(table.Number(row, "equilibrium"), static_cast<double>(row + 1));
    EXPECT_EQ(table.Text(row, "status"), row == 0 ? "ok" : "saddle");
  }
  EXPECT_LT(table.Number(0, "energy"), table.Number(1, "energy"));
  EXPECT_LT(table.Number(1, "energy"), table.Number(2, "energy"));
  const CsvTable line = CsvTable::Read(request_.shape);
  EXPECT_EQ(line.rows() % 3, 0u);
  EXPECT_EQ(line.Number(line.rows() - 1, "disk"), 9);
  EXPECT_EQ(line.Number(line.rows() - 1, "z"), table.Number(2, "z"));
  std::filesystem::remove(request_.out);
  request_.method = "fit";
  EXPECT_THAT(Message(), HasSubstr("--equilibria"));
}

TEST_F(TdcrSolve, WrongUseIsRefused) {
  EXPECT_THAT(Message(), HasSubstr("--input"));
  request_.input = Write("cases.csv", std::string(kHeader) + "a,1,0,0,0,0,0\n");
  request_.method = "euler";
  EXPECT_THAT(Message(), HasSubstr("eas, pcca, crt"));
  request_.method = "fit";
  EXPECT_THAT(Message(), HasSubstr("--measured"));
  request_.hybrid = "apply";
  EXPECT_THAT(Message(), HasSubstr("a model with --hybrid"));
  request_.method = "";
  EXPECT_THAT(Message(), HasSubstr("'hybrid'"));
  request_.hybrid = "";
  request_.sensitivity = true;
  EXPECT_THAT(Message(), HasSubstr("--sensitivity"));
  request_.sensitivity = false;
  request_.lambda = 1e-6;
  EXPECT_THAT(Message(), HasSubstr("--lambda"));
  request_.hybrid = "train";
  request_.lambda = -1;
  EXPECT_THAT(Message(), HasSubstr("--lambda: expected a number of at least 0"));
  request_.lambda = 1e-3;
  request_.cross_validate = true;
  EXPECT_THAT(Message(), HasSubstr("--lambda: not with --cross-validate"));
  request_.hybrid = "";
  request_.lambda.reset();
  EXPECT_THAT(Message(), HasSubstr("--cross-validate"));
  request_.cross_validate = false;
  request_.out = folder_ / "out.txt";
  EXPECT_THAT(Message(), HasSubstr("--out"));
}
TEST_F(TdcrSolve, DrawsAPicture) {
  request_.input = Write("cases.csv", std::string(kHeader) + "a,3,0,0,0,0,0\n");
  request_.plot = folder_ / "shape.svg";
  EXPECT_EQ(SolveTdcr(request_), 0);
  EXPECT_THAT(ReadFile(request_.plot), HasSubstr("</svg>"));
}

}  // namespace
}  // namespace continuum::tdcr
