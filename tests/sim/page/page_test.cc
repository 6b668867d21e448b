// ctest labels: browser
#include "sim/page/page.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "chromium.h"
#include "error.h"
#include "sim/io/file.h"
#include "sim/page/axis_scale.h"
#include "sim/page/text.h"
#include "sim/page/time_series.h"
#include "support/long_test.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Emptied for every run and left behind, so that the pages can be looked at.
fs::path Folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(::testing::TempDir()) / "continuum_page" / test->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::vector<double> Clock(std::size_t rows, double step) {
  std::vector<double> time;
  for (std::size_t i = 0; i < rows; ++i) time.push_back(static_cast<double>(i) * step);
  return time;
}

template <class F>
std::vector<double> Map(const std::vector<double>& x, F&& f) {
  std::vector<double> y;
  for (const double value : x) y.push_back(f(value));
  return y;
}

// Deterministic on every platform, unlike the standard distributions.
class Noise {
 public:
  double operator()() {
    return static_cast<double>(engine_()) / static_cast<double>(std::mt19937::max()) - 0.5;
  }

 private:
  std::mt19937 engine_{7};
};

void AddPanels(Page& page, Noise& noise) {
  const auto time = Clock(1201, 0.01);
  const auto truth = Map(time, [&](double t) {
    return t > 4.2 && t < 4.6 ? kNaN : 0.4 * std::sin(1.3 * t) + 0.004 * noise();
  });
  const auto before = Map(time, [](double t) { return 0.33 * std::sin(1.3 * t - 0.12); });
  const auto after = Map(time, [](double t) { return 0.398 * std::sin(1.3 * t - 0.004); });
  page.TimeSeries({.title = "pull_left_1.csv, joint angle `bend1_x`",
                   .y = {"bend1_x", "rad"},
                   .time = time,
                   .series = {{"measured", truth, Style::kMeasured},
                              {"before", before, Style::kBefore},
                              {"after", after, Style::kAfter}},
                   .group = "pull_left_1"});
  std::vector<double> residual;
  for (std::size_t i = 0; i < time.size(); ++i) residual.push_back(truth[i] - after[i]);
  page.TimeSeries({.title = "What is left after the fit",
                   .y = {"measured - after", "rad"},
                   .time = time,
                   .series = {{"residual", residual, Style::kResidual}},
                   .group = "pull_left_1",
                   .height = 130});
}

PointGroup Cloud(const std::string& name, double from, double to, Style style, Noise& noise) {
  PointGroup group{name, {}, {}, style};
  for (int i = 0; i < 600; ++i) {
    const double x = from + (to - from) * (noise() + 0.5);
    group.x.push_back(x);
    group.y.push_back(0.08 * std::tanh(6 * x) + 0.03 * x + 0.05 * noise());
  }
  return group;
}

void AddScatters(Page& page, Noise& noise) {
  Trend mean{"mean per bin, 95 %", {}, {}, {}, {}, Style::kMeasured};
  for (double x = -0.95; x < 1; x += 0.1) {
    mean.x.push_back(x);
    mean.y.push_back(0.08 * std::tanh(6 * x) + 0.03 * x);
    mean.low.push_back(mean.y.back() - 0.012);
    mean.high.push_back(mean.y.back() + 0.012);
  }
  for (const auto& [label, unit] : {std::pair{"velocity", "rad/s"}, std::pair{"angle", "rad"},
                                    std::pair{"load", "N m"}, std::pair{"time", "s"}}) {
    page.Scatter({.title = fmt::format("Missing torque over {}", label),
                  .x = {label, unit},
                  .y = {"missing torque", "N m"},
                  .groups = {Cloud("train", -1, 1, Style::kSimulated, noise),
                             Cloud("validate", -0.8, 1, Style::kBefore, noise)},
                  .trends = {mean}});
  }
}

// Uses every element once.
Page Demo() {
  Noise noise;
  Page page("Diagnosis of the servo pendulum", "12 logs, 14 412 rows, model `pendulum.xml`");
  page.Badge(Tone::kGood, "Named: Coulomb friction in joint q1",
             "Validation error 21.3 mrad → 4.1 mrad; probability 0.97");
  page.Paragraph(
      "The model misses a force that **changes sign with the velocity** and does not "
      "grow with it. Its size is `tau_c` = 0.081 ± 0.004 N m.");
  page.Heading("Errors");
  page.Table({"Log", "Use", "Before [mrad]", "After [mrad]", "Removed [%]", "Residual trend"},
             {{"pull_left_1.csv", "train", "20.1", "4.0", "80", "0.12"},
              {"pull_left_2.csv", "train", "22.7", "4.3", "81", "-0.35"},
              {"kp800.csv", "validate", "21.3", "4.1", "81", "0.71"},
              {"long.csv", "validate", "9.8", "–", "", "-0.92"}},
             {.caption = "RMS error per log, before and after",
              .highlighted_rows = {2},
              .bars = {{4, {0.8, 0.81, 0.81, 0}}},
              .heat = {{5, {0.12, -0.35, 0.71, -0.92}}}});
  page.Heading("Time series");
  page.Heading("pull_left_1.csv", 3);
  AddPanels(page, noise);
  page.Heading("The missing force");
  AddScatters(page, noise);
  page.Heading("Candidates");
  page.Bars(
      {.title = "Score of every candidate at its place",
       .value = {"error removed", "%"},
       .bars = {{"coulomb, joint q1", 78.3, 3.1, true},
                {"viscous, joint q1", 41.0, 5.5},
                {"payload, body tip", 12.4, 2.0},
                {"a candidate with a very long name, joint wrist_flexion_extension", 3.2, 0.8},
                {"gravity_tilt", -1.3, 0.4},
                {"dead_time", kNaN}},
       .marks = {{"95 % of placebos", 9.1}}});
  const std::vector<std::string> names{"tau_c", "damping", "stiffness", "mass", "v_s"};
  std::vector<std::vector<double>> correlation(5, std::vector<double>(5));
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < 5; ++j) {
      correlation[i][j] = i == j ? 1 : std::cos(1.7 * static_cast<double>(i * j + i + j));
    }
  }
  correlation[4][0] = kNaN;
  page.HeatMap({.title = "Correlation of the parameters", .rows = names, .values = correlation});
  page.HeatMap({.title = "Can two causes be told apart?",
                .rows = {"coulomb", "viscous"},
                .columns = {"payload", "dead_time", "sensor_delay"},
                .values = {{31.5, 4.2, 3.9}, {120.25, 18.0, 0}}});
  page.Heading("What to do");
  page.Badge(Tone::kWarn, "Two causes cannot be told apart: `dead_time`, `sensor_delay`");
  page.Badge(Tone::kBad, "Unexplained: 31 % of the error has no name yet");
  page.Badge(Tone::kInfo, "Next experiment: hold the load for **10 s**, then release");
  page.List({"repeat `pull_left` with 0.1 kg more", "log the motor current"});
  page.Code(
      "--- pendulum.xml\n+++ extended.xml\n@@ -12,3 +12,3 @@\n <joint name=\"q1\"\n"
      "-       frictionloss=\"0\"/>\n+       frictionloss=\"0.081\"/>\n",
      "diff");
  page.Details("Evaluations", [&] {
    page.Paragraph("Folded away, but drawn when unfolded and when printed.");
    page.TimeSeries(
        {.title = "Cost",
         .y = {"cost", ""},
         .time = Clock(30, 0.5),
         .series = {{"cost", Map(Clock(30, 0.5), [](double t) { return std::exp(-t); })}}});
  });
  return page;
}

void ExpectNoExternalReference(const std::string& html) {
  const std::regex reference(R"re((src|href)\s*=\s*["']?\s*(https?:|//|file:)|url\(|@import)re",
                             std::regex::icase);
  std::smatch found;
  EXPECT_FALSE(std::regex_search(html, found, reference)) << found.str();
  EXPECT_THAT(html, Not(HasSubstr("sourceMappingURL")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
}

TEST(Page, RefersToNothingOutsideItself) { ExpectNoExternalReference(Demo().Html()); }

TEST(Page, TheSameCallsGiveTheSameBytes) { EXPECT_EQ(Demo().Html(), Demo().Html()); }

TEST(Page, OpensInChromiumWithoutErrorAndWithoutBlankPlot) {
  CONTINUUM_LONG_IF_SANITIZED("a browser");
  CONTINUUM_REQUIRE_CHROMIUM();
  const fs::path folder = Folder();
  Demo().Write(folder / "demo.html");
  for (const bool dark : {false, true}) {
    const auto view =
        testing::OpenInChromium(folder / "demo.html", folder, {.dark = dark, .width = 1200});
    EXPECT_EQ(view.errors, "");
    EXPECT_FALSE(view.external);
    EXPECT_EQ(view.charts, 3);
    EXPECT_EQ(view.blank, 0);
    EXPECT_GT(fs::file_size(view.screenshot), 50000u);
  }
}

TEST(Page, TheBrowserProbeSeesErrorsBlankPlotsAndRequests) {
  CONTINUUM_REQUIRE_CHROMIUM();
  const fs::path folder = Folder();
  WriteFile(folder / "broken.html",
            "<html><head></head><body><figure><span class=\"key\"><i></i></span>"
            "<div class=\"chart\"><canvas></canvas></div></figure><img src=\"missing.png\">"
            "<script>console.log('spoken'); throw new Error('boom')</script></body></html>");
  const auto view = testing::OpenInChromium(folder / "broken.html", folder);
  EXPECT_THAT(view.errors, HasSubstr("boom"));
  EXPECT_THAT(view.errors, HasSubstr("spoken"));
  EXPECT_EQ(view.charts, 1);
  EXPECT_EQ(view.blank, 1);
  EXPECT_TRUE(view.external);
}

// The hostile text of one place; every place in the page gets its own number.
std::string Hostile(int place) {
  return fmt::format(
      "</script><script>window.probeErrors.push('ran {0}')</script>"
      "<img src=x onerror=\"window.probeErrors.push('image {0}')\">'\"&\x01\xff",
      place);
}

Page HostilePage() {
  Page page(Hostile(1), Hostile(2));
  page.Heading(Hostile(3));
  page.Heading(Hostile(4), 3);
  page.Paragraph("**" + Hostile(5) + "** `" + Hostile(6) + "`");
  page.List({Hostile(7)});
  page.Badge(Tone::kBad, Hostile(8), Hostile(9));
  page.Table({Hostile(10)}, {{Hostile(11)}}, {.caption = Hostile(12)});
  page.TimeSeries({.title = Hostile(13),
                   .y = {Hostile(14), Hostile(15)},
                   .time = {0, 1},
                   .series = {{Hostile(16), {0, 1}}, {"__proto__", {1, 2}}, {"__proto__", {2, 3}}},
                   .group = Hostile(17)});
  page.Scatter({.title = Hostile(18),
                .x = {Hostile(19), Hostile(20)},
                .y = {Hostile(21), Hostile(22)},
                .groups = {{Hostile(23), {0}, {0}}},
                .trends = {{Hostile(24), {0, 1}, {0, 1}}}});
  page.Bars({.title = Hostile(25),
             .value = {Hostile(26), Hostile(27)},
             .bars = {{Hostile(28), 1}},
             .marks = {{Hostile(29), 0.5}}});
  page.HeatMap({.title = Hostile(30), .rows = {Hostile(31)}, .values = {{1}}});
  page.Code(Hostile(32) + "\n+" + Hostile(33), "diff");
  page.Code(Hostile(34), Hostile(35));
  page.Details(Hostile(36), [] {});
  return page;
}

TEST(Page, HostileNamesStayText) {
  const std::string html = HostilePage().Html();
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, Not(HasSubstr("<script>window")));
  EXPECT_THAT(html, Not(HasSubstr("\x01")));
  EXPECT_THAT(html, Not(HasSubstr("\xff")));
}

TEST(Page, HostileNamesAreHarmlessInTheBrowser) {
  CONTINUUM_REQUIRE_CHROMIUM();
  const fs::path folder = Folder();
  HostilePage().Write(folder / "hostile.html");
  const auto view = testing::OpenInChromium(folder / "hostile.html", folder);
  EXPECT_EQ(view.errors, "");
  EXPECT_FALSE(view.external);
  EXPECT_EQ(view.blank, 0);
}

Page SparsePage() {
  Page page("Little data");
  const Axis angle{"angle", "rad"};
  page.TimeSeries({.title = "one point", .y = angle, .time = {2}, .series = {{"q", {0.5}}}});
  page.TimeSeries({.title = "point between gaps",
                   .y = angle,
                   .time = {0, 1, 2, 3, 4},
                   .series = {{"q", {kNaN, kNaN, 1e-7, kNaN, kNaN}}}});
  page.TimeSeries({.title = "constant", .y = angle, .time = {0, 1}, .series = {{"q", {3, 3}}}});
  page.TimeSeries({.title = "uneven clock, one silent channel",
                   .y = angle,
                   .time = {0, 0.1, 0.1, 5},
                   .series = {{"q", {0, 1, 0, 2}}, {"silent", {kNaN, kNaN, INFINITY, kNaN}}}});
  page.TimeSeries({.title = "no rows", .y = angle, .time = {}, .series = {{"q", {}}}});
  page.TimeSeries({.title = "no series", .y = angle, .time = {0, 1}, .series = {}});
  page.TimeSeries(
      {.title = "gaps only", .y = angle, .time = {0, 1}, .series = {{"q", {kNaN, kNaN}}}});
  page.Scatter({.title = "no points", .x = angle, .y = angle, .groups = {}});
  page.Scatter({.title = "one point", .x = angle, .y = angle, .groups = {{"p", {0}, {0}}}});
  page.Scatter({.title = "with gaps",
                .x = angle,
                .y = angle,
                .groups = {{"p", {1e9, 1e9, kNaN}, {1, 2, 3}}},
                .trends = {{"t", {1e9, 1e9, 1e9}, {1, kNaN, 2}}}});
  page.Bars({.title = "no bars", .value = angle, .bars = {}});
  page.Bars({.title = "zeros", .value = angle, .bars = {{"a", 0}, {"b", 0}}});
  page.HeatMap({.title = "empty", .rows = {}, .values = {}});
  page.HeatMap({.title = "zeros", .rows = {"a"}, .values = {{0}}});
  page.Table({"a"}, {});
  return page;
}

TEST(Page, EmptyConstantAndSinglePointDataAreShownOrNamed) {
  const std::string html = SparsePage().Html();
  const auto main = html.find("<main>");
  EXPECT_THAT(html.substr(main, html.find("</main>") - main), Not(HasSubstr("nan")));
  EXPECT_THAT(html, HasSubstr("silent (no value)"));
  EXPECT_THAT(html, HasSubstr("left out: 1 without a finite value"));
  CONTINUUM_REQUIRE_CHROMIUM();
  const fs::path folder = Folder();
  SparsePage().Write(folder / "sparse.html");
  const auto view = testing::OpenInChromium(folder / "sparse.html", folder);
  EXPECT_EQ(view.errors, "");
  EXPECT_EQ(view.charts, 4);
  EXPECT_EQ(view.blank, 0);
}

TEST(Page, TwelveLogsWithTwoChannelsStayBelowThreeMegabytes) {
  CONTINUUM_LONG_IF_SANITIZED("a browser");
  Noise noise;
  const auto time = Clock(1201, 0.01);
  const auto wave = [&](double t) { return std::sin(t) + 0.01 * noise(); };
  Page page("Replay");
  for (int log = 0; log < 12; ++log) {
    for (const char* channel : {"q1", "q2"}) {
      page.TimeSeries({.title = fmt::format("log {}, {}", log, channel),
                       .y = {channel, "rad"},
                       .time = time,
                       .series = {{"measured", Map(time, wave), Style::kMeasured},
                                  {"before", Map(time, wave), Style::kBefore},
                                  {"after", Map(time, wave), Style::kAfter}},
                       .group = std::to_string(log)});
    }
  }
  const std::string html = page.Html();
  RecordProperty("bytes", static_cast<int>(html.size()));
  EXPECT_LT(html.size(), 3'000'000u);
  CONTINUUM_REQUIRE_CHROMIUM();
  const fs::path folder = Folder();
  page.Write(folder / "replay.html");
  const auto view = testing::OpenInChromium(folder / "replay.html", folder);
  EXPECT_EQ(view.errors, "");
  EXPECT_EQ(view.charts, 24);
  EXPECT_EQ(view.blank, 0);
}

TEST(Page, SizesThatDoNotFitAreNamed) {
  Page page("");
  const auto message = [](auto&& call) -> std::string {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::kInput);
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([&] {
              page.Table({"a", "b"}, {{"1"}}, {.caption = "T"});
            }),
            "table 'T': expected 2 cells per row, found 1");
  EXPECT_EQ(message([&] {
              page.TimeSeries({.title = "P", .y = {}, .time = {0, 1}, .series = {{"q", {1}}}});
            }),
            "plot 'P', q: expected 2 values, found 1");
  EXPECT_EQ(message([&] {
              page.TimeSeries({.title = "P", .y = {}, .time = {1, 0}, .series = {}});
            }),
            "plot 'P': expected finite, ascending times, found 0 s at row 1");
  EXPECT_EQ(message([&] {
              page.Scatter({.title = "S", .x = {}, .y = {}, .groups = {{"g", {1}, {}}}});
            }),
            "plot 'S', g: expected 1 values, found 0");
  EXPECT_EQ(message([&] {
              page.HeatMap({.title = "H", .rows = {"r"}, .values = {{1, 2}}});
            }),
            "plot 'H', r: expected 1 values, found 2");
}

TEST(Page, FileAppearsWholeOrNotAtAll) {
  const fs::path folder = Folder();
  EXPECT_THROW(Demo().Write(folder / "missing" / "page.html"), Error);
  Demo().Write(folder / "page.html");
  EXPECT_EQ(ReadFile(folder / "page.html"), Demo().Html());
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(Page, NumberColumnsAreAlignedRight) {
  Page page("");
  page.Table({"name", "value"}, {{"a", "-1.5"}, {"b", "–"}, {"c", "± 2 N"}});
  const std::string html = page.Html();
  EXPECT_THAT(html, HasSubstr("<th class=\"\">name</th><th class=\"number\">value</th>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"number\">± 2 N</td>"));
}

TEST(Page, PagesWithoutTimeSeriesCarryNoScript) {
  Page page("Plain");
  page.Bars({.title = "bars", .value = {"share", "%"}, .bars = {{"a", 1}}});
  EXPECT_THAT(page.Html(), Not(HasSubstr("<script")));
}

TEST(PageText, MarksUpBoldAndCodeAndLeavesUnpairedMarks) {
  EXPECT_EQ(page::Inline("a **b `c`** `**d**` e"),
            "a <strong>b <code>c</code></strong> <code>**d**</code> e");
  EXPECT_EQ(page::Inline("2 ** 3 and a ` tick"), "2 ** 3 and a ` tick");
  EXPECT_EQ(page::Inline("<**&**>"), "&lt;<strong>&amp;</strong>&gt;");
}

TEST(PageText, BytesThatAreNotUtf8AreReplaced) {
  EXPECT_EQ(page::Escape("20 \xB0"), "20 \xEF\xBF\xBD");
  EXPECT_EQ(page::Escape("τ µ 😀"), "τ µ 😀");
  EXPECT_EQ(page::Escape("\xE2\x82"), "\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST(PageSeries, DecimationKeepsEveryExtremeAndGap) {
  const std::size_t rows = 100'000;
  Series smooth{"smooth", {}, Style::kAuto}, spiky = smooth;
  for (std::size_t i = 0; i < rows; ++i) {
    smooth.values.push_back(std::sin(1e-4 * static_cast<double>(i)));
    spiky.values.push_back(i == 31'234 ? 50.0 : i == 77'001 ? -50.0 : i == 5'000 ? kNaN : 0.0);
  }
  const auto kept = page::Decimate({smooth, spiky}, rows, 20'000);
  EXPECT_LE(kept.size(), 20'002u);
  EXPECT_EQ(kept.front(), 0u);
  EXPECT_EQ(kept.back(), rows - 1);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const std::size_t row : {31'234u, 77'001u, 5'000u}) {
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), row)) << row;
  }
}

TEST(PageSeries, ShortSeriesAreKeptWhole) {
  EXPECT_THAT(page::Decimate({{"q", {1, 2, 3}}}, 3, 20'000), ElementsAre(0, 1, 2));
}

TEST(PageSeries, DataAreCompactAndGapsAreNull) {
  const TimeSeriesSpec spec{.title = "",
                            .y = {},
                            .time = {0, 0.1, 0.2},
                            .series = {{"q", {1.0 / 3, kNaN, -0.0}, Style::kMeasured}}};
  EXPECT_EQ(page::SeriesJson(spec, {0, 1, 2}, 4),
            "{\"group\":4,\"start\":0,\"step\":0.1,\"styles\":[\"measured\"],"
            "\"values\":[[0.333333,null,0]]}");
}

TEST(PageSeries, ARippleOnALargeOffsetSurvives) {
  const TimeSeriesSpec spec{.title = "",
                            .y = {},
                            .time = {0, 1, 5},
                            .series = {{"p", {101325.01, 101325.02, 101325.03}}}};
  EXPECT_THAT(page::SeriesJson(spec, {0, 1, 2}, 0),
              HasSubstr("\"time\":[0,1,5],\"styles\":[\"palette0\"],"
                        "\"values\":[[101325.01,101325.02,101325.03]]"));
}

TEST(PageScale, TicksAreRoundAndInside) {
  std::vector<std::string> texts;
  for (const auto& tick : page::Ticks(-0.07, 0.21, 6)) texts.push_back(tick.text);
  EXPECT_THAT(texts, ElementsAre("−0.05", "0", "0.05", "0.1", "0.15", "0.2"));
}

TEST(PageScale, ARangeWithoutWidthIsWidened) {
  for (const double value : {0.0, 5.0, -1e12, 1e-300}) {
    page::Range range;
    range.Add(value);
    const page::Scale scale(range, 0, 100);
    EXPECT_LT(scale.low(), value);
    EXPECT_GT(scale.high(), value);
    EXPECT_NEAR(scale(value), 50, 1e-6);
  }
}

}  // namespace
}  // namespace continuum
