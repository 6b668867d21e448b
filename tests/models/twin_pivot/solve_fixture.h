#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "error.h"
#include "models/twin_pivot/solve.h"
#include "sim/io/file.h"

namespace continuum::twin_pivot {

namespace fs = std::filesystem;

inline const fs::path kFolder = CONTINUUM_SOURCE "/models/twin_pivot";

class TwinPivotSolve : public testing::Test {
 protected:
  TwinPivotSolve() {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("twin_pivot_" + std::string(test->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    request_.robot = kFolder / "a.yaml";
    request_.input = folder_ / "cases.csv";
    request_.out = folder_ / "out.csv";
  }
  ~TwinPivotSolve() override { fs::remove_all(folder_); }

  void Cases(const std::string& text) const { WriteFile(request_.input, text); }

  /// The message of the input error, with nothing written.
  std::string Refusal() const {
    try {
      SolveTwinPivot(request_);
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code(), 2);
      EXPECT_FALSE(fs::exists(request_.out));
      return error.what();
    }
    return "accepted";
  }

  std::string RobotRefusal(const std::string& from, const std::string& to) {
    std::string text = ReadFile(kFolder / "a.yaml");
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    WriteFile(folder_ / "robot.yaml", text.replace(at, from.size(), to));
    request_.robot = folder_ / "robot.yaml";
    Cases("case,m1,m2,m3,m4\none,1,1,0.1,0.1\n");
    return Refusal();
  }

  fs::path folder_;
  SolveRequest request_;
};

}  // namespace continuum::twin_pivot
