// ctest labels: slow
#include <signal.h>
#include <unistd.h>

#include <cstdlib>

#include <gtest/gtest.h>

#include "random_diagnoses/child.h"
#include "random_diagnoses/run_case.h"
#include "support/long_test.h"

namespace continuum::random_diagnoses {
namespace {

class RandomDiagnosis : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomDiagnosis, EndsWithAVerdictOrAMessage) {
  CONTINUUM_LONG_IF_SANITIZED("a whole diagnosis");
  const Outcome outcome = RunCase(GetParam(), 120);
  EXPECT_TRUE(outcome.problems.empty()) << OutcomeJson(outcome).dump(1);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomDiagnosis, ::testing::Range<std::uint64_t>(1, 9));

TEST(Child, LeavesWhatItReturnsOrWhatEndedIt) {
  EXPECT_EQ(InChild([] { return "done"; }, 10).text, "done");
  const Ended crashed = InChild([]() -> std::string { std::abort(); }, 10);
  EXPECT_EQ(crashed.signal, SIGABRT);
  EXPECT_FALSE(crashed.trace.empty());
  const Ended quit = InChild([]() -> std::string { std::exit(3); }, 10);
  EXPECT_EQ(quit.exit_code, 3);
  EXPECT_EQ(quit.text, "");
  volatile bool forever = true;
  const auto spin = [&] {
    while (forever) continue;
    return std::string();
  };
  const Ended slow = InChild(spin, 1);
  EXPECT_TRUE(slow.too_long);
}

}  // namespace
}  // namespace continuum::random_diagnoses
