#include "identification/problem/last_runs.h"

#include <gtest/gtest.h>

#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

LastRun RunWith(double value, std::size_t rows) {
  LastRun run;
  run.changes = {{"joint:q", "stiffness", value}};
  run.trace.channel = {std::vector<double>(rows, value)};
  return run;
}

TEST(LastRuns, RemembersMoreOfShortOnes) {
  const std::size_t threads = ThreadCount();
  for (const std::size_t rows : {std::size_t{10}, std::size_t{1000000}}) {
    LastRuns runs(1);
    for (std::size_t k = 0; k <= threads; ++k) runs.Keep(0, RunWith(static_cast<double>(k), rows));
    const bool is_short = rows < 100;
    EXPECT_EQ(runs.Find(0, RunWith(0, 0)) != nullptr, is_short && threads < 12) << rows;
    EXPECT_NE(runs.Find(0, RunWith(static_cast<double>(threads), 0)), nullptr) << rows;
  }
}

TEST(LastRuns, ASlopeTakesNoPlaceOfAnother) {
  LastRuns runs(1);
  runs.Keep(0, RunWith(-1, 10));
  for (int k = 0; k < 100; ++k) runs.KeepBehind(0, RunWith(k, 10));
  const auto found = runs.Find(0, RunWith(-1, 0));
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->trace.channel[0][0], -1);
}

}  // namespace
}  // namespace continuum
