#include "models/statics/results.h"

#include <limits>

#include <gmock/gmock.h>

#include "error.h"

namespace continuum::statics {
namespace {

using testing::HasSubstr;

TEST(Results, KeepEveryDigitAndLeaveFailuresEmpty) {
  Results results({"case", "status", "iterations", "residual", "micros", "x"});
  results.Row();
  results.Set("case", "a, \"b\"");
  results.Set({numerics::Status::kOk, 3, 1e-13, 2.5, ""}, "ok");
  results.Set("x", 1.0 / 3);
  results.Row();
  results.Set("case", "c");
  results.Set(
      {numerics::Status::kNoConvergence, 60, std::numeric_limits<double>::infinity(), 9, "why"},
      "no_convergence");
  EXPECT_EQ(results.Csv(),
            "case,status,iterations,residual,micros,x\n"
            "\"a, \"\"b\"\"\",ok,3,1e-13,2.5,0.3333333333333333\n"
            "c,no_convergence,60,,9,\n");
  EXPECT_THAT(results.Json(), HasSubstr("\"x\": null"));
  results.Set("case", "F\xE4lle");  // Latin-1
  EXPECT_THAT(results.Csv(), HasSubstr("F\xE4lle"));
  EXPECT_THAT(results.Json(), HasSubstr("F\xEF\xBF\xBDlle"));
  EXPECT_THROW(results.Set("y", 1.0), Error);
  EXPECT_THROW(results.Write("results.txt"), Error);
}

}  // namespace
}  // namespace continuum::statics
