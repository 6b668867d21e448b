#include "hidden_effects/study_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "hidden_effects/outcome.h"
#include "sim/io/csv.h"
#include "support/scratch.h"

namespace continuum::hidden {
namespace {

using ::testing::ElementsAre;
using testing::Scratch;
namespace fs = std::filesystem;

nlohmann::json Cause(const char* effect, const char* parameter, double value) {
  return {{"effect", effect},
          {"equivalent", {"dahl", "sensor_delay"}},
          {"probability_is", "posterior among the candidates tried"},
          {"parameters", {{parameter, {{"value", value}, {"ci95", {value / 2, nullptr}}}}}}};
}

nlohmann::json Candidate(const char* effect, double probability, double lambda) {
  return {{"effect", effect},
          {"likelihood", 100},
          {"probability", probability},
          {"lambda", lambda},
          {"first_order", {{"explained", 10 * probability}, {"p", 1e-6}}}};
}

// A name with a relative, and an effect that is not listed.
nlohmann::json Diagnosed() {
  return {{"verdict", "ambiguous"},
          {"complete", true},
          {"seconds", 3},
          {"gain", {{"validate_error_removed", 0.6}, {"explainable_error_removed", 0.9}}},
          {"lack_of_fit", {{"force", 0.2}, {"channel", 0.1}}},
          {"leading", {{"effect", "coulomb"}}},
          {"causes", {Cause("coulomb", "tau_c", 0.1)}},
          {"alternatives", {Cause("coulomb", "tau_c", 0.1)}},
          {"relatives", {Cause("dahl", "tau_c", 0.2)}},
          {"candidates", {Candidate("coulomb", 0.7, 0), Candidate("dahl", 0.3, 4)}}};
}

TEST(StudyOfHiddenEffects, ReadsAnAnswerFromItsFile) {
  const Answer a = AnswerFrom({{"coulomb"}, 2}, Diagnosed());
  EXPECT_THAT(a.named, ElementsAre("coulomb", "sensor_delay"));
  EXPECT_THAT(a.relatives, ElementsAre("dahl"));
  EXPECT_EQ(a.value, 0.1);
  EXPECT_EQ(a.low, 0.05);
  EXPECT_GT(a.high, 1e300);
  EXPECT_EQ(a.screened, "coulomb");
  EXPECT_EQ(a.leading, "coulomb");
  EXPECT_EQ(a.closest, 4);
  EXPECT_EQ(a.stated.at("dahl"), 0.3);
  EXPECT_EQ(a.lack, 0.1);
}

TEST(StudyOfHiddenEffects, TellsTheCauseFromWhatCorrectsTheModel) {
  auto json = Diagnosed();
  json["causes"][0]["correction"] = true;
  auto partner = Cause("payload", "mass", 1);
  partner.update({{"equivalent", {"armature", "gravity_tilt"}},
                  {"relatives", {"armature"}},
                  {"correction", false},
                  {"probability_is", "of both causes together"}});
  json["causes"].push_back(partner);
  const Answer a = AnswerFrom({{"payload"}, 2}, json);
  EXPECT_THAT(a.named, ElementsAre("payload", "gravity_tilt"));
  EXPECT_THAT(a.partner, ElementsAre("coulomb", "sensor_delay"));
  EXPECT_THAT(a.relatives, ElementsAre("dahl", "armature"));
  EXPECT_TRUE(a.corrects);
  EXPECT_TRUE(a.stated.empty());
}

TEST(StudyOfHiddenEffects, HasALineForEachRowThatRan) {
  const Scratch files;
  const std::vector<Case> cases{{{"coulomb"}, 2}, {{"payload"}, 1}, {}};
  WriteStudy(cases, "quick", files / "study");
  const auto table = CsvTable::Read(files / "study/study.csv");
  ASSERT_EQ(table.rows(), 3);
  EXPECT_EQ(table.Text(0, "hidden"), "coulomb");
  EXPECT_EQ(table.Text(2, "hidden"), "none");
  EXPECT_TRUE(fs::exists(files / "study" / table.Text(1, "experiment")));

  fs::create_directories(files / "out/case_00001");
  fs::create_directories(files / "out/case_00002.failed");
  files.Write("out/case_00001/diagnosis.json", Diagnosed().dump());
  files.Write("out/case_00001/row.json", R"({"processor_seconds": 7})");
  files.Write("out/case_00002.failed/row.json", R"({"reason": "no room"})");
  const auto lines = LinesOfStudy(cases, files / "study", files / "out");
  ASSERT_EQ(lines.size(), 2);
  EXPECT_EQ(lines[0].at("cpu"), 7);
  EXPECT_EQ(lines[0].at("right"), true);
  EXPECT_EQ(lines[1].at("what"), "no room");
  EXPECT_EQ(OutcomesOf(lines).back().verdict, "no answer");
  EXPECT_THROW(LinesOfStudy({cases[0], cases[2], cases[1]}, files / "study", files / "out"), Error);
}

}  // namespace
}  // namespace continuum::hidden
