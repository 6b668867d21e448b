#include "sim/numerics/work_limit.h"

#include <gmock/gmock.h>

#include <string>

namespace continuum::numerics {
namespace {

void Spend(int systems) {
  for (int i = 0; i < systems; ++i) WorkLimit::Spend();
}

Outcome Done() {
  Outcome outcome;
  outcome.status = Status::kOk;
  return outcome;
}

TEST(WorkLimit, WhatEndsWithinItIsLeftAsItIs) {
  Spend(1000);  // no limit
  const Outcome outcome = Limited(10, [] {
    Spend(10);
    return Done();
  });
  EXPECT_TRUE(outcome.ok());
  EXPECT_EQ(outcome.why, "");
}

TEST(WorkLimit, WhatCostsMoreIsGivenUpAndSaysWhere) {
  const Outcome outcome = Limited(10, [] {
    try {
      Spend(100);
    } catch (GaveUp& at) {
      at.where = "at 0.5 of the rising load";
      throw;
    }
    return Done();
  });
  EXPECT_EQ(outcome.status, Status::kNoConvergence);
  EXPECT_EQ(outcome.iterations, 11);
  EXPECT_EQ(outcome.why, "given up after 11 linear systems, at 0.5 of the rising load");
}

TEST(WorkLimit, AJobOfManyRowsEndsByItsOwnLimit) {
  int rows = 0;
  const Outcome outcome = Limited(25, [&] {
    Outcome last;
    for (; rows < 1000 && (rows == 0 || last.iterations > 1); ++rows) {
      last = Limited(10, [] {
        Spend(100);
        return Done();
      });
    }
    return last;
  });
  EXPECT_LE(rows, 4);
  EXPECT_THAT(outcome.why, testing::StartsWith("given up after"));
  EXPECT_FALSE(outcome.ok());
}

TEST(WorkLimit, EndsWithItsScope) {
  EXPECT_THROW(
      {
        const WorkLimit limit(1);
        Spend(2);
      },
      GaveUp);
  EXPECT_NO_THROW(Spend(100));
}

}  // namespace
}  // namespace continuum::numerics
