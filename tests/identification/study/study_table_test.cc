#include "identification/study/study_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "identification/study/option_words.h"
#include "identification/study/row_selection.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using testing::Scratch;
using ::testing::ThrowsMessage;

class ReadsStudies : public ::testing::Test {
 protected:
  ReadsStudies() {
    for (const char* robot : {"a", "b", "c"}) {
      std::filesystem::create_directories(scratch_ / "robots" / robot);
      scratch_.Write("robots/" + std::string(robot) + "/arm.yaml", "format: 1\n");
    }
  }
  StudyTable Read(const std::string& name, const std::string& text) const {
    return ReadStudy({scratch_.Write(name, text)}, {});
  }
  Scratch scratch_;
};

TEST_F(ReadsStudies, OfATable) {
  const StudyTable s = Read("s.csv",
                            "experiment,command,options,name,batch\n"
                            "robots/a/arm.yaml,diagnose,--effort quick,first,A\n"
                            "robots/b/arm.yaml,check,,,\"B, old\"\n");
  ASSERT_EQ(s.rows.size(), 2);
  EXPECT_THAT(s.labels, ElementsAre("batch"));
  EXPECT_EQ(s.rows[0].number, 1);
  EXPECT_EQ(s.rows[0].name, "first");
  EXPECT_THAT(s.rows[0].where, HasSubstr("s.csv:2"));
  EXPECT_THAT(s.rows[0].options, ElementsAre("--effort", "quick"));
  EXPECT_EQ(s.rows[1].name, "robots_b_arm-check");
  EXPECT_THAT(s.rows[1].labels, ElementsAre(Pair("batch", "B, old")));
  for (const StudyRow& row : s.rows) EXPECT_EQ(row.fault, "");
}

TEST_F(ReadsStudies, OfAYamlFileWithAPattern) {
  const StudyTable s = Read("s.yaml",
                            "command: identify\noptions: --starts 4\nrows:\n"
                            "  - {experiment: 'robots/*/arm.yaml', labels: {batch: A}}\n"
                            "  - {experiment: robots/a/arm.yaml, command: check, options: ''}\n");
  ASSERT_EQ(s.rows.size(), 4);
  EXPECT_EQ(s.rows[2].name, "robots_c_arm-identify");
  EXPECT_THAT(s.rows[2].options, ElementsAre("--starts", "4"));
  EXPECT_THAT(s.rows[2].where, HasSubstr("s.yaml:4"));
  EXPECT_EQ(s.rows[3].command, "check");
  EXPECT_TRUE(s.rows[3].options.empty());
}

TEST_F(ReadsStudies, OfAPatternOnTheCommandLine) {
  const StudyTable s =
      ReadStudy({(scratch_ / "robots/*/arm.yaml").string()}, {"replay", "--log 'a b'"});
  ASSERT_EQ(s.rows.size(), 3);
  EXPECT_THAT(s.rows[0].options, ElementsAre("--log", "a b"));
  EXPECT_THAT([&] { ReadStudy({(scratch_ / "robots/a/arm.yaml").string()}, {}); },
              ThrowsMessage<Error>(HasSubstr("--command")));
}

TEST_F(ReadsStudies, WhatIsWrongWithARowIsItsOwnFault) {
  const StudyTable s = Read("s.csv",
                            "experiment,command,options,name\n"
                            "robots/a/arm.yaml,check,,one\n"
                            "robots/b/arm.yaml,check,,one\n"
                            "robots/b/arm.yaml,chekc,,two\n"
                            "robots/x*/arm.yaml,check,,three\n"
                            ",check,,four\n"
                            "robots/b/arm.yaml,replay,--out there,five\n"
                            "robots/b/arm.yaml,check,,../six\n"
                            "robots/b/arm.yaml,check,,7\n"
                            "robots/b/arm.yaml,replay,\"--log 'a\",eight\n"
                            "robots/b/arm.yaml,check,,study.html\n"
                            "robots/c/arm.yaml,check,,last\n");
  const std::vector<std::string> expected{"",
                                          "s.csv:3: expected a folder of its own",
                                          "check | replay | identify | diagnose",
                                          "s.csv:5: expected a file, found none like",
                                          "s.csv:6, experiment",
                                          "--out",
                                          "'../six'",
                                          "no number",
                                          "a closing '",
                                          "no use for",
                                          ""};
  ASSERT_EQ(s.rows.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_THAT(s.rows[i].fault, HasSubstr(expected[i])) << i;
  EXPECT_EQ(s.rows.front().fault + s.rows.back().fault, "");
  EXPECT_THAT(s.rows[1].fault, HasSubstr("row 1 ("));
}

TEST_F(ReadsStudies, ATableThatCannotBeReadIsRefused) {
  EXPECT_THAT([&] { Read("s.csv", "file,command\na,check\n"); },
              ThrowsMessage<Error>(HasSubstr("a column 'experiment'")));
  EXPECT_THROW(Read("s.csv", "experiment\n"), Error);
  EXPECT_THAT([&] { Read("s.yaml", "rows:\n  - {experiment: a, comand: b}\n"); },
              ThrowsMessage<Error>(HasSubstr("s.yaml:2")));
  EXPECT_THROW(ReadStudy({(scratch_ / "none.csv").string()}, {}), Error);
}

TEST(OptionWords, AreThoseOfAShell) {
  EXPECT_THAT(OptionWords(" a  'b c' d\"e f\"g '' ", ""), ElementsAre("a", "b c", "de fg", ""));
  EXPECT_TRUE(OptionWords("", "").empty());
  EXPECT_THROW(OptionWords("'a", "here"), Error);
}

class SelectsRows : public ::testing::Test {
 protected:
  SelectsRows() {
    for (std::size_t i = 1; i <= 10; ++i)
      study_.rows.push_back({i, "", "row_" + std::to_string(i), "", ""});
  }
  StudyTable study_;
};

TEST_F(SelectsRows, ByNumbersRangesAndNames) {
  EXPECT_THAT(SelectRows(study_, "7,2:4,row_10,3", ""), ElementsAre(1, 2, 3, 6, 9));
  EXPECT_EQ(SelectRows(study_, "", "").size(), 10);
  for (const char* rows : {"0", "11", "4:2", "4:11", "row_11", "2:", "-1", "1,,2"})
    EXPECT_THROW(SelectRows(study_, rows, ""), Error) << rows;
}

TEST_F(SelectsRows, ShardsShareAllRows) {
  std::multiset<std::size_t> all;
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    const auto rows = SelectRows(study_, "2:9", shard);
    all.insert(rows.begin(), rows.end());
  }
  EXPECT_THAT(all, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(SelectRows(study_, "", "12/12"), ElementsAre());
  for (const char* shard : {"0/3", "4/3", "1", "1/0", "a/b"})
    EXPECT_THROW(SelectRows(study_, "", shard), Error) << shard;
}

}  // namespace
}  // namespace continuum
