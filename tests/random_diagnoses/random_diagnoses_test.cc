// ctest labels: slow
#include <signal.h>
#include <unistd.h>

#include <cstdlib>

#include <gtest/gtest.h>

#include "random_diagnoses/run_case.h"
#include "support/child.h"
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
  EXPECT_EQ(testing::InChild([] { return "done"; }, 10).text, "done");
  EXPECT_EQ(testing::InChild([] { return std::string(100'000, 'x'); }, 60).text.size(), 100'000u);
  const testing::Ended crashed = testing::InChild([]() -> std::string { std::abort(); }, 10);
  EXPECT_EQ(crashed.signal, SIGABRT);
  EXPECT_FALSE(crashed.trace.empty());
  EXPECT_FALSE(crashed.too_long);
  const testing::Ended quit = testing::InChild([]() -> std::string { std::exit(3); }, 10);
  EXPECT_EQ(quit.exit_code, 3);
  EXPECT_EQ(quit.text, "");
  volatile bool forever = true;
  const auto spin = [&] {
    while (forever) continue;
    return std::string();
  };
  const testing::Ended slow = testing::InChild(spin, 1);
  EXPECT_TRUE(slow.too_long);
  EXPECT_EQ(slow.text, "");
}

}  // namespace
}  // namespace continuum::random_diagnoses
