// ctest labels: slow
// Folders and files with any name, for every command.
#include "bench.h"
#include "support/long_test.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using testing::Scratch;

class AnyPath : public testing::AppBench, public ::testing::WithParamInterface<const char*> {
 protected:
  AnyPath() {
    fs::create_directory(files_ / GetParam());
    for (const char* file : {"model.xml", "log.csv", "input.csv", "diagnosis.json"})
      fs::rename(files_ / file, files_.folder() / GetParam() / file);
    fs::copy(files_.folder() / GetParam() / "log.csv", files_.folder() / GetParam() / "again.csv");
    Spoil("experiment.yaml", "{file: log.csv}",
          "{file: log.csv}, {file: again.csv, use: validate}");
    Spoil("experiment.yaml", "format: 1", "format: 1\ncandidates: [coulomb]");
    fs::rename(files_ / "experiment.yaml", files_.folder() / GetParam() / "experiment.yaml");
  }
  void SetUp() override {
    CONTINUUM_LONG_IF_SANITIZED("LeakSanitizer crashes at the end of some films");
  }
  static std::string In(const std::string& file) { return std::string(GetParam()) + "/" + file; }
  void ExpectWrites(std::vector<std::string> command, const std::vector<std::string>& outputs) {
    SCOPED_TRACE(command.front());
    const auto f = Run(std::move(command));
    EXPECT_EQ(f.exit_code, 0) << f.err;
    for (const std::string& output : outputs) {
      EXPECT_GT(Scratch::Text(files_ / In(output)).size(), 0u) << output;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(App, AnyPath,
                         ::testing::Values("Versuche März – 1", "50 % {x} %s <a> & 'b' \"c\"",
                                           "#1: [a, b]", "-o", "日本語 🤖", " \t~ $HOME `x`"),
                         [](const auto& info) { return "N" + std::to_string(info.index); });

TEST_P(AnyPath, MayBeReadAndWrittenByEveryCommand) {
  const std::string here = "./";  // a name that begins with a dash is no option then
  const std::string e = here + In("experiment.yaml"), m = here + In("model.xml");
  const auto out = [&](const std::string& name) { return here + In(name); };
  ExpectWrites({"run", m, "--input", here + In("input.csv"), "--out", out("é 1.csv")}, {"é 1.csv"});
  ExpectWrites({"run", m, "--until", "0.1", "--out", out("y.csv"), "--video", out("é 1.mp4")},
               {"y.csv", "é 1.mp4"});
  ExpectWrites({"check", e}, {});
  ExpectWrites({"check", e, "--json"}, {});
  ExpectWrites({"replay", e, "--out", out("r r"), "--video"},
               {"r r/errors.json", "r r/report.html", "r r/simulated/log.csv", "r r/replay.mp4"});
  ExpectWrites({"render", e, "--out", out("é %d 1.png")}, {"é %d 1.png"});
  ExpectWrites({"render", e, "--out", out("é %d 2.mp4")}, {"é %d 2.mp4"});
  ExpectWrites({"identify", e, "--out", out("f")}, {"f/fit.json", "f/fitted.xml", "f/report.html"});
  ExpectWrites({"diagnose", e, "--out", out("d")},
               {"d/diagnosis.json", "d/extended.xml", "d/extended.yaml", "d/report.html"});
  ExpectWrites({"apply", here + In("diagnosis.json"), m, "--out", out("x.xml")}, {"x.xml"});
  // What was written can be read.
  ExpectWrites({"replay", out("d/extended.yaml"), "--out", out("again")}, {"again/errors.json"});
  ExpectWrites({"run", out("f/fitted.xml"), "--until", "0.1", "--out", out("z.csv")}, {"z.csv"});
  const fs::path tdcr = CONTINUUM_SOURCE "/models/tdcr";
  fs::copy(tdcr / "tdcr.yaml", files_ / In("tdcr.yaml"));
  ExpectWrites({"solve", out("tdcr.yaml"), "--input", tdcr / "cases.csv", "--out", out("s.csv"),
                "--plot", out("s.png")},
               {"s.csv", "s.png"});
}

}  // namespace
}  // namespace continuum
