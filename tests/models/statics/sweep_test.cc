#include "models/statics/sweep.h"

#include <gtest/gtest.h>

#include "error.h"
#include "models/statics/rows.h"

namespace continuum::statics {
namespace {

TEST(Sweep, IsTheGridBetweenTwoRows) {
  const CsvTable table =
      Grid(CsvTable::Parse("case,T1,condition,T2\nlow,0,V,1\nhigh,2,V,2\n", "corners.csv"), 3);
  ASSERT_EQ(table.rows(), 9U);
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"case", "T1", "condition", "T2"}));
  EXPECT_EQ(table.Text(0, "case"), "1");
  EXPECT_EQ(table.Number(4, "T1"), 1);
  EXPECT_EQ(table.Number(4, "T2"), 1.5);
  EXPECT_EQ(table.Text(8, "condition"), "V");
  EXPECT_EQ(table.Number(8, "T1"), 2);
}

TEST(Sweep, RefusesWhatHasNoGrid) {
  const auto refused = [](const char* text, int values) {
    EXPECT_THROW(Grid(CsvTable::Parse(text, "corners.csv"), values), Error) << text;
  };
  refused("case,T1\na,0\n", 3);
  refused("case,T1\na,0\nb,1\nc,2\n", 3);
  refused("case,condition\na,I\nb,II\n", 3);
  refused("case,T1\na,0\nb,1\n", 1);
  refused("case,T1,T2,T3\na,0,0,0\nb,1,1,1\n", 101);
}

// Every row once, and after the one that it goes on from.
TEST(ForRows, SolvesEveryRowAfterItsReference) {
  const std::vector<int> reference{-1, 0, -1, 1, 2, 0, -1};
  std::vector<int> solved(reference.size(), 0);
  ForRows(
      reference.size(), [&](std::size_t i) { return reference[i]; },
      [&](std::size_t i) {
        const int before = reference[i];
        solved[i] += before < 0 ? 1 : 1 + solved[static_cast<std::size_t>(before)];
      });
  EXPECT_EQ(solved, (std::vector<int>{1, 2, 1, 3, 2, 2, 1}));
}

}  // namespace
}  // namespace continuum::statics
