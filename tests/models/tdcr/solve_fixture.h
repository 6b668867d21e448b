// A robot and cases in a folder of their own, for tests of `continuum solve`.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "error.h"
#include "models/tdcr/solve.h"
#include "sim/io/file.h"

namespace continuum::tdcr {

inline const char kRobot[] =
    "format: 1\nrobot: tdcr\nlength: 0.134\ndiameter: 0.99e-3\ndisks: 9\ntendons: 3\n"
    "tendon_radius: 7.0e-3\nE: {value: 60.0e9, unit: Pa}\nnu: 0.3\ndensity: 6450\n"
    "disk_mass: 0.6e-3\nmu: 0.2\ngravity: [0, 0, 9.81]\nbase_rotation: [0, 0, 0]\n";
inline const char kHeader[] = "case,T1,T2,T3,fx,fy,fz\n";

class TdcrSolve : public testing::Test {
 protected:
  TdcrSolve()
      : folder_(std::filesystem::temp_directory_path() /
                fmt::format("tdcr_{}_{}", getpid(),
                            testing::UnitTest::GetInstance()->current_test_info()->name())) {
    MakeFolder(folder_);
    request_.robot = Write("robot.yaml", kRobot);
    request_.out = folder_ / "out.csv";
  }
  ~TdcrSolve() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    WriteFile(folder_ / name, text);
    return folder_ / name;
  }
  // The message of the input error that the request ends with; nothing may have been written.
  std::string Message() const {
    try {
      SolveTdcr(request_);
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      EXPECT_FALSE(std::filesystem::exists(request_.out));
      return e.what();
    }
    return "no error";
  }
  std::string MessageOfCases(const std::string& text) {
    request_.input = Write("cases.csv", text);
    return Message();
  }
  std::string MessageOfRobot(const std::string& from, const std::string& to) {
    std::string text = kRobot;
    text.replace(text.find(from), from.size(), to);
    request_.robot = Write("robot.yaml", text);
    request_.input = Write("cases.csv", std::string(kHeader) + "a,1,0,0,0,0,0\n");
    return Message();
  }

  std::filesystem::path folder_;
  SolveRequest request_;
};

}  // namespace continuum::tdcr
