// ctest labels: real-data
#include <filesystem>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench.h"
#include "sim/io/csv.h"
#include "sim/io/file.h"
#include "support/long_test.h"
#include "support/recordings.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using namespace testing;  // the bench
using ::testing::HasSubstr;

// The logs of real machines, where they are at hand.
class CheckReal : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(data_)) GTEST_SKIP() << "no recordings at " << data_;
    scratch_.Write("model.xml", "<mujoco/>");
  }

  // logs, time, inputs, outputs of an experiment file.
  std::vector<Finding> Check(const std::string& yaml) const {
    return CheckLogs(Experiment::Read(
        scratch_.Write("experiment.yaml", "format: 1\nmodel: model.xml\n" + yaml)));
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
  CONTINUUM_LONG_IF_SANITIZED("long logs");
  std::string logs, inputs, outputs;
  for (const char* name : {"observations_controlled_1", "observations_controlled_1_100g"}) {
    const CsvTable table = CsvTable::Read(data_ / "trunk" / (std::string(name) + ".csv"));
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
  EXPECT_THAT(Find(all, "gap")->text, HasSubstr("15.68 s after t = 193.6 s"));
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
