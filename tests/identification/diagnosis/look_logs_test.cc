#include "identification/diagnosis/look_logs.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::ElementsAre;

constexpr double kStep = 1e-3;

Experiment WithLogs(std::size_t count, std::size_t rows) {
  Experiment e;
  for (std::size_t l = 0; l < count; ++l) {
    Log log;
    log.time.resize(rows);
    log.train = l % 3 != 2;
    e.logs.push_back(std::move(log));
  }
  return e;
}

TEST(LogsForALook, AreAllTrainLogsWhereThereIsLittle) {
  EXPECT_THAT(LogsForALook(WithLogs(6, 400), kStep),
              ElementsAre(true, true, false, true, true, false));
}

TEST(LogsForALook, AreSomeEvenlySpreadWhereThereIsMuch) {
  EXPECT_THAT(LogsForALook(WithLogs(6, 2500), kStep),
              ElementsAre(true, false, false, true, false, false));
}

TEST(LogsForALook, AreSomeWhereThereIsMuchToSimulate) {
  Experiment e = WithLogs(6, 400);
  for (Log& log : e.logs) log.time.back() = 40;
  EXPECT_THAT(LogsForALook(e, kStep), ElementsAre(true, false, false, true, false, false));
  EXPECT_THAT(LogsForALook(e, 10 * kStep), ElementsAre(true, true, false, true, true, false));
  e.quasi_static = true;
  EXPECT_THAT(LogsForALook(e, kStep), ElementsAre(true, true, false, true, true, false));
}

TEST(LogsForALook, AreNeverFewerThanTwoOfSeveral) {
  EXPECT_THAT(LogsForALook(WithLogs(3, 100'000), kStep), ElementsAre(true, true, false));
  EXPECT_THAT(LogsForALook(WithLogs(1, 100'000), kStep), ElementsAre(true));
}

TEST(LogsForALook, LeaveOutReplicates) {
  Experiment e = WithLogs(5, 100);
  for (std::size_t l = 0; l < 5; ++l) e.logs[l].trial = l < 2 ? "one" : "two";
  EXPECT_THAT(LogsForALook(e, kStep), ElementsAre(true, false, false, true, false));
  for (Log& log : e.logs) log.trial = "one";
  EXPECT_THAT(LogsForALook(e, kStep), ElementsAre(true, true, false, true, true));
}

}  // namespace
}  // namespace continuum
