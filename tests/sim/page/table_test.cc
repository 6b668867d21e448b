// ctest labels: browser
// Tables with links, which sort and filter in the browser, and plots of intervals.
#include "sim/page/table.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "chromium.h"
#include "error.h"
#include "sim/page/page.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Page Robots() {
  Page page("robots");
  TableOptions options;
  options.sortable = true;
  options.links[0] = {"a/report.html", "", "c/report.html"};
  page.Table({"name", "gain"}, {{"arm", "9 %"}, {"leg", "−12 %"}, {"arm and leg", ""}}, options);
  return page;
}

TEST(Table, HasLinksWhereTheyAreGiven) {
  const std::string html = Robots().Html();
  EXPECT_THAT(html, HasSubstr("<a href=\"a/report.html\">arm</a>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"\">leg</td>"));
}

TEST(Table, ThatDoesNotSortCarriesNoScript) {
  Page page("plain");
  page.Table({"a"}, {{"1"}});
  EXPECT_THAT(page.Html(), Not(HasSubstr("<script")));
}

TEST(Table, LinksThatDoNotFitAreNamed) {
  TableOptions options;
  options.links[1] = {"x"};
  EXPECT_THROW(page::TableHtml({"a"}, {{"1"}}, options), Error);
}

// What the page shows after a script of the test: names of the rows in order, hidden ones in ().
std::string After(const std::string& script) {
  const testing::Scratch scratch;
  std::string html = Robots().Html();
  const std::string look =
      "const shown = [...document.querySelectorAll('tbody tr')].map("
      "(r) => r.hidden ? '(' + r.cells[0].textContent + ')' : r.cells[0].textContent).join(', ');"
      "document.body.dataset.shown = shown;";
  html.insert(html.rfind("</body>"), "<script>" + script + look + "</script>");
  const auto view = testing::OpenInChromium(scratch.Write("page.html", html), scratch / "browser");
  EXPECT_EQ(view.errors, "");
  const std::string mark = "data-shown=\"";
  const std::size_t at = view.dom.find(mark);
  if (at == std::string::npos) return "no rows";
  const std::size_t from = at + mark.size();
  return view.dom.substr(from, view.dom.find('"', from) - from);
}

TEST(Table, SortsByNumbersOfAColumnAndPutsEmptyCellsLast) {
  CONTINUUM_REQUIRE_CHROMIUM();
  const std::string click = "document.querySelectorAll('th')[1].click();";
  EXPECT_EQ(After(click), "leg, arm, arm and leg");
  EXPECT_EQ(After(click + click), "arm, leg, arm and leg");
}

TEST(Table, ShowsRowsThatHaveAllWordsOfTheFilter) {
  CONTINUUM_REQUIRE_CHROMIUM();
  EXPECT_EQ(After("const i = document.querySelector('.filter input'); i.value = 'LEG  and';"
                  "i.dispatchEvent(new Event('input'));"),
            "(arm), (leg), arm and leg");
}

TEST(Intervals, AreDrawnWithTheirBandAndTheOddOneStandsOut) {
  Page page("units");
  IntervalsSpec spec{"damping", {"damping", "N*m*s/rad"}, {}};
  spec.rows = {{"a", 1, 0.9, 1.1}, {"b", 1.2, NAN, NAN}, {"odd <one>", 3, 2.9, 3.1, true}};
  spec.low = 0.8;
  spec.high = 1.4;
  page.Intervals(spec);
  const std::string html = page.Html();
  EXPECT_THAT(html, HasSubstr("class=\"spread\""));
  EXPECT_THAT(html, HasSubstr("class=\"point chosen\""));
  EXPECT_THAT(html, HasSubstr("odd &lt;one&gt;"));
  spec.rows.assign(100, {"many", 1, 0.9, 1.1});
  Page many("many");
  many.Intervals(spec);
  EXPECT_THAT(many.Html(), Not(HasSubstr("label end")));
}

TEST(Intervals, WithoutAValueSaySo) {
  Page page("units");
  page.Intervals({"x", {"x", ""}, {{"a", NAN, NAN, NAN}}, NAN, NAN});
  EXPECT_THAT(page.Html(), HasSubstr("class=\"nothing\""));
}

}  // namespace
}  // namespace continuum
