#include "identification/diagnosis/deviations.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Experiment With(const std::vector<std::string>& columns, const std::string& unit, double factor,
                const std::vector<std::vector<double>>& measured) {
  Experiment e;
  Output out;
  out.columns = columns, out.unit = unit;
  e.outputs = {out};
  for (std::size_t c = 0; c < columns.size(); ++c)
    e.channels.push_back({columns[c], unit, 0, c, factor});
  Log log;
  log.label = "run";
  for (std::size_t k = 0; k < measured.front().size(); ++k)
    log.time.push_back(0.1 * static_cast<double>(k));
  log.measured = measured;
  e.logs = {log};
  return e;
}

TEST(Deviation, IsFoundWhereTheFirstRowWasNotMeasured) {
  const Experiment e = With({"x"}, "mm", 1e-3, {{kNan, 0.001, 0.002, 0.001}});
  const auto wrong = FindDeviations(e, {{{{0, 0.001, 0.005, 0.001}}}});
  ASSERT_THAT(wrong, SizeIs(1));
  EXPECT_EQ(wrong[0].when, "0.20 s");
  EXPECT_EQ(wrong[0].what, "is 3 mm too high");
}

TEST(Deviation, OfAnOrientationIsATurnAboutAnAxis) {
  const double c = std::cos(0.1), s = std::sin(0.1);
  const Experiment e = With({"qw", "qx", "qy", "qz"}, "rad", 1, {{1, 1}, {0, 0}, {0, 0}, {0, 0}});
  const auto wrong = FindDeviations(e, {{{{1, c}, {0, 0}, {0, -s}, {0, 0}}}});
  ASSERT_THAT(wrong, SizeIs(1));
  EXPECT_EQ(wrong[0].channel, "qy");
  EXPECT_THAT(wrong[0].what, HasSubstr("turned by -0.2 rad about y"));
}

}  // namespace
}  // namespace continuum
