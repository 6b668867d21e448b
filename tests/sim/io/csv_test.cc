#include "sim/io/csv.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "error.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string Message(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    return e.what();
  }
  return "no error";
}
std::string ParseError(const std::string& text) {
  return Message([&] { CsvTable::Parse(text, "log.csv"); });
}

TEST(CsvTable, ReadsColumnsByNameInAnyLineEnding) {
  const CsvTable t =
      CsvTable::Parse("\xEF\xBB\xBFtime , T1\r\n\r\n0,1\r\n+0.5 , -2e-3\r\n", "log.csv");
  EXPECT_THAT(t.columns(), ElementsAre("time", "T1"));
  EXPECT_THAT(t.Numbers("time"), ElementsAre(0, 0.5));
  EXPECT_THAT(t.Numbers("T1"), ElementsAre(1, -2e-3));
  EXPECT_EQ(t.Where(1), "log.csv:4");
  const CsvTable old = CsvTable::Parse("time,T1\r0,1\r0.5,2\r", "log.csv");
  EXPECT_THAT(old.Numbers("T1"), ElementsAre(1, 2));
}

TEST(CsvTable, KeepsCommasAndQuotesInsideQuotedCells) {
  const CsvTable t = CsvTable::Parse("a,b\n\"x, \"\"y\"\"\",\n", "log.csv");
  EXPECT_EQ(t.Text(0, "a"), "x, \"y\"");
  EXPECT_TRUE(std::isnan(t.NumberOrNan(0, "b")));
}

// The same table as programs write it.
TEST(CsvTable, FindsWhatStandsBetweenCells) {
  for (const std::string text : {
           "t,u,q\n0,0.5,-1e-3\n0.1,1.5,2\n",
           "t;u;q\n0;0.5;-1e-3\n0.1;1.5;2\n",
           "t\tu\tq\n0\t0.5\t-1e-3\n0.1\t1.5\t2\n",
           "t|u|q\n0|0.5|-1e-3\n0.1|1.5|2\n",
           "t u  q\n0 0.5 -1e-3\n 0.1  1.5\t2 \n",
           "t,\tu,\tq\n0,\t0.5,\t-1e-3\n0.1,\t1.5,\t2\n",
           "t;u;q\n0;0,5;-1e-3\n0,1;1,5;2\n",
           "t\tu\tq\n0\t0,5\t-1e-3\n0,1\t1,5\t2\n",
           "t u q\n0 0,5 -1e-3\n0,1 1,5 2\n",
           "\"t\",\"u\",\"q\"\n\"0\",\"0,5\",\"-1e-3\"\n\"0,1\",\"1,5\",\"2\"\n",
           "t,u,q,\n0,0.5,-1e-3,\n0.1,1.5,2,\n",
           "t;u;q\n0;0,5;-1e-3;\n0,1;1,5;2;\n",
           "# made by hand, on a bench; at 20 degrees\nt,u,q\n0,0.5,-1e-3\n% again\n0.1,1.5,2\n",
           "# t,u,q\n0,0.5,-1e-3\n0.1,1.5,2\n",
           "# t u q\n0 0.5 -1e-3\n0.1 1.5 2\n",
       }) {
    const CsvTable t = CsvTable::Parse(text, "log.csv");
    ASSERT_THAT(t.columns(), ElementsAre("t", "u", "q")) << text;
    EXPECT_THAT(t.Numbers("t"), ElementsAre(0, 0.1)) << text;
    EXPECT_THAT(t.Numbers("u"), ElementsAre(0.5, 1.5)) << text;
    EXPECT_THAT(t.Numbers("q"), ElementsAre(-1e-3, 2)) << text;
  }
}

TEST(CsvTable, NumbersColumnsOfAFileWithoutAHeader) {
  for (const std::string text : {"0,0.5,-0.1\n0.1,1.5,\n", "0 0.5 -0.1\n0.1 1.5 nan\n",
                                 "0;0,5;-0,1\n0,1;1,5;\n", "# bench 2\n0,0.5,-0.1\n0.1,1.5,NA\n"}) {
    const CsvTable t = CsvTable::Parse(text, "log.csv");
    ASSERT_THAT(t.columns(), ElementsAre("1", "2", "3")) << text;
    EXPECT_THAT(t.Numbers("2"), ElementsAre(0.5, 1.5)) << text;
    EXPECT_TRUE(std::isnan(t.NumberOrNan(1, "3"))) << text;
    EXPECT_THAT(Message([&] { t.Numbers("q"); }),
                HasSubstr("its columns are numbered, as in `column: 1`"))
        << text;
  }
  EXPECT_THAT(ParseError("0,1\n0,1,2\n"), HasSubstr("as in the first row"));
  // Names that are numbers.
  EXPECT_THAT(CsvTable::Parse("0,1,2\n5,6,7\n", "log.csv").Numbers("2"), ElementsAre(7));
}

TEST(CsvTable, ReadsOneSignForDecimalsInAFile) {
  const CsvTable t = CsvTable::Parse("t;x\n0.5;1\n1.5;1,5\n", "log.csv");
  EXPECT_THAT(Message([&] { t.Number(1, "x"); }),
              AllOf(HasSubstr("log.csv:3"), HasSubstr("decimal point, as elsewhere")));
  EXPECT_THAT(ParseError("t,x\n0,5,1,5\n"), HasSubstr("put ';' between cells"));
}

TEST(CsvTable, KnowsTheWordsForWhatWasNotMeasured) {
  for (const std::string word : {"", "NA", "N/A", "#N/A", "null", "None", "NaN", "-nan(ind)", "-",
                                 "--", "<NA>", "-1.#IND", "1.#QNAN", "#DIV/0!", "?"}) {
    const CsvTable t = CsvTable::Parse("t,x\n0,1\n1," + word + "\n", "log.csv");
    EXPECT_TRUE(std::isnan(t.NumberOrNan(1, "x"))) << word;
    EXPECT_THAT(Message([&] { t.Number(1, "x"); }), HasSubstr("finite number")) << word;
  }
}

TEST(CsvTable, ReadsDatesAndTimesOfDayToTheNanosecond) {
  const CsvTable t = CsvTable::Parse(
      "t\n2024-05-01T12:00:00.010000001Z\n\"2024-05-01 14:00:00,01+02:00\"\n12:00:01.5\n"
      "1714564800.010000001\n05/01/2024 12:00\n2024-02-30T12:00:00\n",
      "log.csv");
  const long double noon = 1714564800;
  EXPECT_TRUE(t.TimeAt(0, "t").stamp);
  EXPECT_EQ(std::round((t.TimeAt(0, "t").value - noon) * 1e9L), 10'000'001);
  EXPECT_EQ(std::round((t.TimeAt(1, "t").value - noon) * 1e9L), 10'000'000);
  EXPECT_EQ(t.TimeAt(2, "t").value, 12 * 3600 + 1.5L);
  EXPECT_FALSE(t.TimeAt(3, "t").stamp);
  EXPECT_EQ(std::round((t.TimeAt(3, "t").value - noon) * 1e9L), 10'000'001);
  for (const std::size_t row : {4, 5}) {  // a day or a month? and a day that is none
    EXPECT_THAT(Message([&] { t.TimeAt(row, "t"); }), HasSubstr("a time like 2024-05-01T12"))
        << row;
  }
}

TEST(CsvTable, SaysWhereALineIsWrong) {
  EXPECT_THAT(ParseError(""), AllOf(HasSubstr("log.csv"), HasSubstr("header")));
  EXPECT_THAT(ParseError("\n \r\n"), HasSubstr("header"));
  EXPECT_THAT(ParseError("t,x,t\n"), AllOf(HasSubstr("log.csv:1"), HasSubstr("'t' twice")));
  EXPECT_THAT(ParseError("2,,x\n"), AllOf(HasSubstr("log.csv:1"), HasSubstr("'2' twice")));
  EXPECT_THAT(ParseError("t,x\n0,1\n\n2\n"), AllOf(HasSubstr("log.csv:4"), HasSubstr("found 1")));
  EXPECT_THAT(ParseError("t,x\n0,1,2\n"), AllOf(HasSubstr("log.csv:2"), HasSubstr("found 3")));
  EXPECT_THAT(ParseError("t\n\"0\n"), AllOf(HasSubstr("log.csv:2"), HasSubstr("closing quote")));
  EXPECT_THAT(ParseError("t\n\"0\"1\n"), AllOf(HasSubstr("log.csv:2"), HasSubstr("'1'")));
  EXPECT_THAT(ParseError(std::string("t\n\0\n", 4)), HasSubstr("zero byte"));
}

TEST(CsvTable, SaysWhichCellIsNoFiniteNumber) {
  for (const std::string cell : {"", "nan", "inf", "-inf", "1e999", "0x10", "1 2", "1,", "--1",
                                 "++1", "+-1", "1d3", "one"}) {
    const CsvTable t = CsvTable::Parse("t,x\n0,\"" + cell + "\"\n", "log.csv");
    EXPECT_THAT(Message([&] { t.Number(0, "x"); }),
                AllOf(HasSubstr("log.csv:2"), HasSubstr("'x'"), HasSubstr("finite number")))
        << cell;
  }
  for (const std::string cell : {"1e101", "-1e300"}) {  // finite, but its square is not
    const CsvTable t = CsvTable::Parse("t,x\n0," + cell + "\n", "log.csv");
    EXPECT_THAT(Message([&] { t.NumberOrNan(0, "x"); }),
                AllOf(HasSubstr("log.csv:2"), HasSubstr("within +-1e100"), HasSubstr(cell)));
  }
  const CsvTable t = CsvTable::Parse("t\n0\n", "log.csv");
  EXPECT_THAT(Message([&] { t.Numbers("x"); }),
              AllOf(HasSubstr("column 'x'"), HasSubstr("found t")));
}

TEST(CsvTable, SaysWhatLinesWithoutNumbersMayBe) {
  const auto wrong = [](const std::string& text, std::size_t row) {
    return Message([&] { CsvTable::Parse(text, "log.csv").Number(row, "t"); });
  };
  EXPECT_THAT(wrong("t,x\ns,rad\n0,1\n", 0), HasSubstr("a line of units? Put # before it"));
  EXPECT_THAT(wrong("t,x\n0,1\nt,x\n", 1), HasSubstr("the header again?"));
  EXPECT_THAT(ParseError("t,x\n0,1\n1\n"), HasSubstr("cut off? Then delete it"));
  EXPECT_THAT(ParseError("t,x\n0\n1,1\n"), Not(HasSubstr("cut off")));
  for (const std::string preface : {"arm: 3\n", "arm,3\nday,2024-05-01\n"}) {
    EXPECT_THAT(ParseError(preface + "t,u,q\n0,1,2\n1,1,2\n"),
                HasSubstr("are the first lines no table? Put # before them"))
        << preface;
  }
}

TEST(CsvTable, NumbersAColumnWithoutAName) {
  const CsvTable t = CsvTable::Parse(",t,x\n0,0.5,1\n1,1.5,2\n", "log.csv");  // as pandas writes
  EXPECT_THAT(t.columns(), ElementsAre("1", "t", "x"));
  EXPECT_THAT(t.Numbers("t"), ElementsAre(0.5, 1.5));
}

TEST(CsvTable, SkipsTheLineByWhichExcelKnowsTheDelimiter) {
  const CsvTable t = CsvTable::Parse("sep=;\nt;x\n0,5;1\n", "log.csv");
  EXPECT_THAT(t.columns(), ElementsAre("t", "x"));
  EXPECT_THAT(t.Numbers("t"), ElementsAre(0.5));
}

TEST(CsvTable, ReadsFlagsInTheUsualSpellings) {
  const CsvTable t = CsvTable::Parse("on\nTrue\nfalse\n1\n0.0\nyes\n", "log.csv");
  EXPECT_TRUE(t.Flag(0, "on"));
  EXPECT_FALSE(t.Flag(1, "on"));
  EXPECT_TRUE(t.Flag(2, "on"));
  EXPECT_FALSE(t.Flag(3, "on"));
  EXPECT_THAT(Message([&] { t.Flag(4, "on"); }), HasSubstr("log.csv:6"));
}

RC_GTEST_PROP(CsvTable, NeverFailsOnArbitraryBytesExceptWithAnError, (const std::string& bytes)) {
  try {
    const CsvTable t = CsvTable::Parse(bytes, "log.csv");
    for (std::size_t row = 0; row < t.rows(); ++row) {
      RC_ASSERT(t.Where(row).starts_with("log.csv:"));
      for (const auto& column : t.columns()) {
        try {
          RC_ASSERT(std::isfinite(t.Number(row, column)));
        } catch (const Error&) {
        }
      }
    }
  } catch (const Error& e) {
    RC_ASSERT(std::string(e.what()).starts_with("log.csv"));
  }
}

// Denser in what matters to a reader of CSV than arbitrary bytes are.
RC_GTEST_PROP(CsvTable, NeverFailsOnArbitraryCsvExceptWithAnError, ()) {
  const auto text = *rc::gen::container<std::string>(rc::gen::element(
      ',', ';', '"', '\n', '\r', ' ', '\t', 't', '1', '-', '.', 'e', '#', ':', '\xEF', '\0'));
  try {
    const CsvTable t = CsvTable::Parse(text, "log.csv");
    for (std::size_t row = 0; row < t.rows(); ++row) {
      for (const auto& column : t.columns()) t.Text(row, column);
    }
  } catch (const Error&) {
  }
}

TEST(CsvTable, LeavesANameWithABlankWhole) {
  const CsvTable t = CsvTable::Parse("bend angle\n0.5\n", "log.csv");
  EXPECT_EQ(t.columns(), std::vector<std::string>{"bend angle"});
  EXPECT_EQ(t.Number(0, "bend angle"), 0.5);
}

RC_GTEST_PROP(CsvTable, RoundTripsNamesAndNumbersExactly, ()) {
  const auto names =
      *rc::gen::unique<std::vector<std::string>>(rc::gen::nonEmpty(rc::gen::container<std::string>(
          rc::gen::element('a', 'B', '[', ']', ',', '"', ' ', '_', '#'))));
  RC_PRE(!names.empty());
  const auto rows = *rc::gen::container<std::vector<std::vector<double>>>(
      rc::gen::container<std::vector<double>>(names.size(), rc::gen::arbitrary<double>()));
  std::string text;
  for (std::size_t c = 0; c < names.size(); ++c) text += (c ? "," : "") + CsvCell(names[c]);
  for (const auto& row : rows) {
    text += "\n";
    for (std::size_t c = 0; c < names.size(); ++c) text += (c ? "," : "") + Decimal(row[c]);
  }
  const CsvTable t = CsvTable::Parse(text, "log.csv");
  RC_ASSERT(t.columns() == names);
  RC_ASSERT(t.rows() == rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < names.size(); ++c) RC_ASSERT(t.Number(r, names[c]) == rows[r][c]);
  }
}

}  // namespace
}  // namespace continuum
