// What replay writes beside its numbers, and into which folder.
#include "bench.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Scratch;

class ReplayOutputs : public testing::AppBench {
 protected:
  ReplayOutputs() {
    files_.Write("second.csv", testing::kLog);
    Spoil("experiment.yaml", "{file: log.csv}", "{file: log.csv}, {file: second.csv}");
  }
  void ExpectDone(std::vector<std::string> arguments) const {
    const auto f = Run(std::move(arguments));
    EXPECT_EQ(f.exit_code, 0) << f.err;
  }
  // Width, height and frames of a film, as its header says.
  std::uint32_t Box(const std::string& film, const char* name, std::size_t from) const {
    const std::string text = Scratch::Text(files_ / film);
    const std::size_t at = text.rfind(name);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<unsigned char>(text.at(at + from + i));
    return value;
  }
};

TEST_F(ReplayOutputs, FilmsOneLogInTheSizeAndRateThatWereAskedFor) {
  ExpectDone({"replay", "experiment.yaml", "--out", "all", "--video", "--size", "128x96"});
  ExpectDone({"replay", "experiment.yaml", "--out", "one", "--video", "--size", "128x96", "--log",
              "second"});
  ExpectDone({"replay", "experiment.yaml", "--out", "slow", "--video", "--size", "256x192", "--fps",
              "10"});
  // stsz: version and flags, size of all frames or 0, number of frames; tkhd ends with the size.
  constexpr std::size_t kFrames = 12, kWidth = 80;
  EXPECT_EQ(Box("all/replay.mp4", "stsz", kFrames), 2 * Box("one/replay.mp4", "stsz", kFrames));
  EXPECT_EQ(Box("slow/replay.mp4", "stsz", kFrames), 8u);  // 0.1 s rows of two logs
  EXPECT_EQ(Box("one/replay.mp4", "tkhd", kWidth) >> 16, 128u);
  EXPECT_EQ(Box("slow/replay.mp4", "tkhd", kWidth) >> 16, 256u);
}

// Of each command that writes simulated logs.
TEST_F(ReplayOutputs, OfLogsThatLeftTheExperimentGo) {
  files_.Write("third.csv", testing::kLog);
  Spoil("experiment.yaml", "{file: second.csv}", "{file: third.csv}, {file: second.csv}");
  Spoil("experiment.yaml", "format: 1", "format: 1\ncandidates: [coulomb]");
  const std::string two = Scratch::Text(files_ / "experiment.yaml");
  for (const std::string command : {"replay", "identify", "diagnose"}) {
    SCOPED_TRACE(command);
    files_.Write("experiment.yaml", two);
    ExpectDone({command, "experiment.yaml", "--out", "out"});
    files_.Write("out/simulated/mine.csv", "time,q\n");
    EXPECT_TRUE(fs::exists(files_ / "out/simulated/second.csv"));
    Spoil("experiment.yaml", ", {file: second.csv}", "");
    ExpectDone({command, "experiment.yaml", "--out", "out"});
    EXPECT_THAT(Listing(), Not(Contains("out/simulated/second.csv")));
    EXPECT_THAT(Listing(), Contains("out/simulated/log.csv"));
    EXPECT_THAT(Listing(), Contains("out/simulated/mine.csv"));
  }
}

TEST_F(ReplayOutputs, SayTheErrorInTheSameWordsOnThePageAndTheTerminal) {
  const auto said = [&] {
    const auto f = Run({"replay", "experiment.yaml", "--out", "out"});
    const std::size_t from = f.out.find("\nall: ") + 6;
    const std::string words = f.out.substr(from, f.out.find(';', from) - from);
    EXPECT_THAT(Scratch::Text(files_ / "out/report.html"), HasSubstr(words));
    return words;
  };
  EXPECT_THAT(said(), ::testing::MatchesRegex("error [0-9.e-]+ rad RMS on train"));
  Spoil("experiment.yaml", "{file: second.csv}", "{file: second.csv, use: validate}");
  EXPECT_THAT(said(),
              ::testing::MatchesRegex("error [0-9.e-]+ rad RMS on train, [0-9.e-]+ on validate"));
}

TEST_F(ReplayOutputs, TellHowFarASensorIsOffInAllOfItsDirections) {
  Spoil(
      "experiment.yaml", "{column: q, unit: rad, sensor: angle}",
      "{column: t, unit: m, sensor: \"tip_pos[0]\"}, {column: q, unit: m, sensor: \"tip_pos[1]\"}");
  const auto f = Run({"replay", "experiment.yaml", "--out", "out"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.out, HasSubstr("tip_pos train: off by "));
  EXPECT_THAT(f.out, HasSubstr(" m RMS, "));
  EXPECT_THAT(f.out, HasSubstr(", 8 rows\n"));
}

}  // namespace
}  // namespace continuum
