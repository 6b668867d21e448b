// ctest labels: slow
#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hidden_effects/gates.h"
#include "support/long_test.h"

namespace continuum::hidden {

static void PrintTo(const Gate& gate, std::ostream* out) { *out << gate.name; }

namespace {

class HiddenEffects : public ::testing::TestWithParam<Gate> {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Answer Ask(const Case& c) {
    std::filesystem::remove_all(folder_);
    Answer a = Solve(c, folder_);
    told_ += c.Name() + ": " + a.verdict;
    for (const auto& n : a.named) told_ += " " + n;
    for (const auto& n : a.partner) told_ += " +" + n;
    told_ += fmt::format(", {:g} in [{:g}, {:g}]\n", a.truth, a.low, a.high);
    return a;
  }

  std::string told_;

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("hidden_effects_{}", ::getpid());
};

INSTANTIATE_TEST_SUITE_P(Small, HiddenEffects, ::testing::ValuesIn(Gates()),
                         [](const auto& info) { return info.param.name; });

// One test for each gate, so that they run side by side.
TEST_P(HiddenEffects, PassTheGate) {
  if (GetParam().is_long) CONTINUUM_LONG("several whole diagnoses");
  std::vector<Asked> asked;
  for (const Case& c : GetParam().cases) asked.push_back({c, Ask(c)});
  EXPECT_TRUE(GetParam().holds(asked)) << told_;
}

}  // namespace
}  // namespace continuum::hidden
