// The table of docs/closed-form.md is what the program says.
#include "by_differences.h"

#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

namespace continuum {
namespace {

TEST(ByDifferences, OfEveryCaseTheReasonIsNamed) {
  EXPECT_EQ(testing::WhyByDifferences({}), "");  // without any of them
  for (const testing::ByDifferences& c : testing::CasesByDifferences())
    EXPECT_NE(testing::WhyByDifferences(c), "") << c.what;
}

TEST(ByDifferences, AreListedInTheDocuments) {
  std::ifstream file(CONTINUUM_SOURCE "/docs/closed-form.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string table = testing::TableOfDifferences();
  EXPECT_NE(page.find(table), std::string::npos) << "docs/closed-form.md has to hold:\n" << table;
}

}  // namespace
}  // namespace continuum
