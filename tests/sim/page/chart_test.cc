#include "sim/page/chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

Chart Two() {
  return {"A & B",
          {"time", "s"},
          {"angle", "rad"},
          {{"up", "#c00", {0, 1}, {0, 2}}, {"rest", "#000", {1}, {2}, ChartLine::Kind::kDots}}};
}

TEST(Chart, IsOneSvgFileWithTitleAxesAndLegend) {
  const std::string svg = ChartsSvg({Two(), Two()});
  EXPECT_THAT(svg,
              ::testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"880\""));
  EXPECT_THAT(svg, ::testing::EndsWith("</svg>\n"));
  for (const char* text : {"A &amp; B", "time [s]", "angle [rad]", ">up<", ">rest<", "h0"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  EXPECT_EQ(svg, ChartsSvg({Two(), Two()}));
}

TEST(Chart, WithOneScaleASquareIsASquare) {
  Chart chart{"square", {"x", "m"}, {"y", "m"}, {{"", "#000", {0, 1, 1}, {0, 0, 1}}}, true};
  const std::string svg = ChartsSvg({chart});
  const std::size_t at = svg.find("class=\"line\"");
  double x[3], y[3];
  ASSERT_EQ(std::sscanf(svg.c_str() + svg.find("d=\"", at), "d=\"M%lf %lfL%lf %lfL%lf %lf", x, y,
                        x + 1, y + 1, x + 2, y + 2),
            6);
  EXPECT_NEAR(x[1] - x[0], y[1] - y[2], 0.11);  // written to a tenth of a pixel
}

TEST(Chart, ALineWithoutItsPointsIsRefused) {
  Chart chart = Two();
  chart.lines[0].y.pop_back();
  EXPECT_THROW(ChartsSvg({chart}), Error);
  chart.lines[0].x.clear(), chart.lines[0].y.clear();
  EXPECT_THROW(ChartsSvg({chart}), Error);
}

}  // namespace
}  // namespace continuum
