#include "identification/diagnosis/look_logs.h"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::ElementsAre;

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
  EXPECT_THAT(LogsForALook(WithLogs(6, 400)), ElementsAre(true, true, false, true, true, false));
}

TEST(LogsForALook, AreSomeEvenlySpreadWhereThereIsMuch) {
  EXPECT_THAT(LogsForALook(WithLogs(6, 2500)), ElementsAre(true, false, false, true, false, false));
}

TEST(LogsForALook, AreNeverFewerThanTwoOfSeveral) {
  EXPECT_THAT(LogsForALook(WithLogs(3, 100'000)), ElementsAre(true, true, false));
  EXPECT_THAT(LogsForALook(WithLogs(1, 100'000)), ElementsAre(true));
}

TEST(LogsForALook, LeaveOutReplicates) {
  Experiment e = WithLogs(5, 100);
  for (std::size_t l = 0; l < 5; ++l) e.logs[l].trial = l < 2 ? "one" : "two";
  EXPECT_THAT(LogsForALook(e), ElementsAre(true, false, false, true, false));
  for (Log& log : e.logs) log.trial = "one";
  EXPECT_THAT(LogsForALook(e), ElementsAre(true, true, false, true, true));
}

}  // namespace
}  // namespace continuum
