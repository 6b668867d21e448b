#include <sys/stat.h>

#include "bench.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Scratch;

// A wrong command line among good files.
struct Bad {
  const char* name;
  std::vector<std::string> arguments, words;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadCommand : public testing::AppBench, public ::testing::WithParamInterface<Bad> {};

TEST_P(BadCommand, IsRefusedByOptionOrFile) {
  ExpectRefused(GetParam().arguments, GetParam().words);
}

const std::string kE = "experiment.yaml", kM = "model.xml";

INSTANTIATE_TEST_SUITE_P(
    App, BadCommand,
    ::testing::Values(
        Bad{"Nothing", {}, {"subcommand"}}, Bad{"UnknownSubcommand", {"dance"}, {"dance"}},
        Bad{"UnknownOption", {"run", kM, "--loud"}, {"--loud"}},
        Bad{"NoArgument", {"run"}, {"model"}}, Bad{"NoValue", {"run", kM, "--until"}, {"--until"}},
        Bad{"RunNoSuchModel", {"run", "none.xml"}, {"none.xml", "readable"}},
        Bad{"RunFolder", {"run", "."}, {".", "a folder"}},
        Bad{"RunLog", {"run", "log.csv"}, {"log.csv"}},
        Bad{"RunNoSuchInput", {"run", kM, "--input", "none.csv"}, {"none.csv", "readable"}},
        Bad{"RunFolderAsInput", {"run", kM, "--input", "."}, {"a folder"}},
        Bad{"RunWrongColumns", {"run", kM, "--input", "log.csv"}, {"log.csv:1", "motor", "'t'"}},
        Bad{"RunIntoAFolder", {"run", kM, "--until", "0.1", "--out", "."}, {"."}},
        Bad{"RunIntoNoFolder",
            {"run", kM, "--until", "0.1", "--out", "none/x.csv"},
            {"none/x.csv", "writable"}},
        Bad{"RunIntoReadOnly",
            {"run", kM, "--until", "0.1", "--out", "/proc/none/x.csv"},
            {"/proc/none/x.csv", "writable"}},
        Bad{"RunFilmOfAnotherKind", {"run", kM, "--until", "0.1", "--video", "x.avi"}, {"--video"}},
        Bad{"RunFilmBelowAFile",
            {"run", kM, "--until", "0.1", "--video", "log.csv/x.mp4"},
            {"log.csv/x.mp4", "writable"}},
        Bad{"RunEndlessModel", {"run", "/dev/zero"}, {"/dev/zero", "a regular file", "a device"}},
        Bad{"RunEndlessInput", {"run", kM, "--input", "/dev/zero"}, {"/dev/zero", "a device"}},
        Bad{"CheckEndless", {"check", "/dev/zero"}, {"/dev/zero", "a regular file", "a device"}},
        Bad{"CheckNoSuchFile", {"check", "none.yaml"}, {"none.yaml"}},
        Bad{"CheckFolder", {"check", "."}, {"a folder"}},
        Bad{"CheckNoSuchModel", {"check", "none.xml"}, {"none.xml"}},
        Bad{"RunOneFileForTwo",
            {"run", "model.xml", "--until", "1", "--out", "a.mp4", "--video", "./a.mp4"},
            {"--video", "another file", "'./a.mp4'"}},
        Bad{"ReplayNoOut", {"replay", kE}, {"--out"}},
        Bad{"ReplayIntoAFile", {"replay", kE, "--out", "log.csv"}, {"log.csv", "folder"}},
        Bad{"ReplayBelowAFile", {"replay", kE, "--out", "log.csv/out"}, {"log.csv/out", "folder"}},
        Bad{"ReplayIntoReadOnly", {"replay", kE, "--out", "/proc/out"}, {"/proc/out", "folder"}},
        Bad{"RenderNoSize", {"render", kE, "--out", "x.png", "--size", "big"}, {"--size", "'big'"}},
        Bad{"RenderHuge",
            {"render", kE, "--out", "x.png", "--size", "99999999999x2"},
            {"--size", "99999999999x2"}},
        Bad{"RenderEmpty", {"render", kE, "--out", "x.png", "--size", "0x0"}, {"--size", "'0x0'"}},
        Bad{"RenderNegative", {"render", kE, "--out", "x.png", "--size=-2x2"}, {"--size"}},
        Bad{"RenderAnotherKind", {"render", kE, "--out", "x.gif"}, {"--out", "x.gif"}},
        Bad{"RenderNoSuchLog", {"render", kE, "--out", "x.mp4", "--log", "no"}, {"--log", "'no'"}},
        Bad{"RenderNoSuchLogAsPicture",
            {"render", kE, "--out", "x.png", "--log", "no"},
            {"--log", "'no'"}},
        Bad{"RenderNoSuchCamera",
            {"render", kE, "--out", "x.png", "--camera", "mine"},
            {"camera", "mine"}},
        Bad{"ReplayFilmOptionsWithoutAFilm",
            {"replay", kE, "--out", "out", "--size", "640x480"},
            {"--size requires --video"}},
        Bad{"ReplayFilmOfOddSize",
            {"replay", kE, "--out", "out", "--video", "--size", "641x480"},
            {"out/replay.mp4", "even width", "641 x 480"}},
        Bad{"ReplayFilmOfNoSuchLog",
            {"replay", kE, "--out", "out", "--video", "--log", "no"},
            {"--log", "one of log", "'no'"}},
        Bad{"ReplayFilmByNoSuchCamera",
            {"replay", kE, "--out", "out", "--video", "--camera", "mine"},
            {"camera", "'mine'"}},
        Bad{"RenderUnknownGl", {"render", kE, "--out", "x.png", "--gl", "vulkan"}, {"vulkan"}},
        Bad{"RenderBelowAFile",
            {"render", kE, "--out", "log.csv/x.mp4"},
            {"log.csv/x.mp4", "writable"}},
        Bad{"RenderNoFrames", {"render", kE, "--out", "x.mp4", "--fps", "0"}, {"--fps"}},
        Bad{"IdentifyMethod", {"identify", kE, "--out", "out", "--method", "luck"}, {"--method"}},
        Bad{"IdentifyPath",
            {"identify", kE, "--out", "out", "--path", "scenic"},
            {"--path", "scenic"}},
        Bad{"IdentifyIterations",
            {"identify", kE, "--out", "out", "--iterations", "nan"},
            {"--iterations"}},
        Bad{"DiagnoseUnknownEffect",
            {"diagnose", kE, "--out", "out", "--candidates", "ghost"},
            {"--candidates", "ghost"}},
        Bad{"DiagnoseCompareNothing",
            {"diagnose", kE, "--out", "out", "--compare", "none.json"},
            {"none.json"}},
        Bad{"DiagnoseCompareAnother",
            {"diagnose", kE, "--out", "out", "--compare", "diagnosis.json"},
            {"diagnosis.json"}},
        Bad{"DiagnoseNoCandidates",
            {"diagnose", kE, "--out", "out", "--candidates", ""},
            {"--candidates", "a value", "''"}},
        Bad{"DiagnoseLongSeed",
            {"diagnose", kE, "--out", "out", "--seed", "99999999999999999999999"},
            {"--seed", "[0, 18446744073709551615]", "99999999999999999999999"}},
        Bad{"IdentifyLongSeed",
            {"identify", kE, "--out", "out", "--seed", "99999999999999999999999"},
            {"--seed", "[0, 18446744073709551615]", "99999999999999999999999"}},
        Bad{"DiagnoseSeed", {"diagnose", kE, "--out", "out", "--seed", "-1"}, {"--seed"}},
        Bad{"ApplyNoSuchDiagnosis",
            {"apply", "none.json", kM, "--out", "x.xml"},
            {"none.json", "readable"}},
        Bad{"ApplyYaml", {"apply", kE, kM, "--out", "x.xml"}, {kE, "JSON"}},
        Bad{"ApplyToALog", {"apply", "diagnosis.json", "log.csv", "--out", "x.xml"}, {"log.csv"}},
        Bad{"ApplyIntoNoFolder",
            {"apply", "diagnosis.json", kM, "--out", "none/x.xml"},
            {"none/x.xml", "writable"}},
        Bad{"ApplyIntoAFolder",
            {"apply", "diagnosis.json", kM, "--out", "."},
            {"expected a writable file, found a folder"}},
        Bad{"SolvePictureBelowAFile",
            {"solve", CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml", "--input",
             CONTINUUM_SOURCE "/models/tdcr/cases.csv", "--out", "x.csv", "--plot",
             "log.csv/x.png"},
            {"log.csv/x.png", "writable"}},
        Bad{"SolveLambda",
            {"solve", "none.yaml", "--out", "x.csv", "--lambda", "nan"},
            {"--lambda", "[0, 1e+09]", "'nan'"}},
        Bad{"SolveNoSuchRobot", {"solve", "none.yaml", "--out", "x.csv"}, {"none.yaml"}},
        Bad{"SolveExperiment", {"solve", kE, "--out", "x.csv"}, {"experiment.yaml:2", "tdcr"}}),
    testing::kCaseName);

class AtOnce : public testing::AppBench {
 protected:
  // Refused without a word of progress: before the work.
  void ExpectRefusedAtOnce(const std::string& command, const std::string& place) const {
    SCOPED_TRACE(command);
    ExpectRefused({command, kE, "--out", "out"}, {place});
    EXPECT_THAT(Run({command, kE, "--out", "out"}).err, ::testing::StartsWith("continuum: "));
  }
};

TEST_F(AtOnce, ADiagnosisWithNeitherNoiseNorLogsToLeaveOutIsRefused) {
  ExpectRefusedAtOnce("diagnose", "experiment.yaml: folds: expected at least two groups");
}

class Unwritable : public AtOnce {};

TEST_F(Unwritable, OutputsAreNoticedBeforeTheWork) {
  for (const char* file : {"errors.json", "fit.json", "diagnosis.json"})
    fs::create_directories(files_ / "out" / file);
  ExpectRefusedAtOnce("replay", "out/errors.json");
  ExpectRefusedAtOnce("identify", "out/fit.json");
  ExpectRefusedAtOnce("diagnose", "out/diagnosis.json");
}

TEST_F(Unwritable, FileInThePlaceOfTheFolderOfSimulationsIsNoticed) {
  fs::create_directory(files_ / "out");
  files_.Write("out/simulated", "precious");
  ExpectRefusedAtOnce("replay", "out/simulated: expected a folder, found a file");
}

class Pipe : public testing::AppBench {};

TEST_F(Pipe, IsRefusedWithoutWaitingForItsOtherEnd) {
  ASSERT_EQ(mkfifo((files_ / "pipe").c_str(), 0600), 0);
  const std::vector<std::vector<std::string>> commands{
      {"check", "pipe"},
      {"replay", "pipe", "--out", "out"},
      {"identify", "pipe", "--out", "out"},
      {"diagnose", "pipe", "--out", "out"},
      {"render", "pipe", "--out", "x.png"},
      {"run", "pipe"},
      {"run", kM, "--input", "pipe"},
      {"apply", "pipe", kM, "--out", "x.xml"},
      {"apply", "diagnosis.json", "pipe", "--out", "x.xml"},
      {"solve", "pipe", "--out", "x.csv"}};
  for (const auto& command : commands) {
    SCOPED_TRACE(command.front());
    ExpectRefused(command, {"pipe", "a regular file", "a pipe"});
  }
  Spoil(kE, "model.xml", "pipe");
  ExpectRefused({"check", kE}, {"pipe", "a regular file"});
}

class GoodFile : public testing::AppBench {
 protected:
  void ExpectReplayed(const std::string& experiment = "experiment.yaml") const {
    const auto f = Run({"replay", experiment, "--out", "out"});
    EXPECT_EQ(f.exit_code, 0) << f.err;
    EXPECT_TRUE(fs::exists(files_ / "out/errors.json"));
  }
};

TEST_F(GoodFile, MayHaveAByteOrderMarkAndWindowsLineEnds) {
  for (const char* file : {"log.csv", "experiment.yaml", "model.xml"}) {
    std::string text = "\xEF\xBB\xBF";
    for (const char c : Scratch::Text(files_ / file))
      text += c == '\n' ? "\r\n" : std::string(1, c);
    files_.Write(file, text);
  }
  ExpectReplayed();
}

TEST_F(GoodFile, MayLieInAFolderWithSpacesAndUmlauts) {
  const fs::path folder = "Versuche März – 1";
  fs::create_directory(files_.folder() / folder);
  for (const char* file : {"log.csv", "experiment.yaml", "model.xml"})
    fs::rename(files_ / file, files_.folder() / folder / file);
  ExpectReplayed(folder / "experiment.yaml");
}

TEST_F(GoodFile, MayUseAnchors) {
  Spoil("experiment.yaml", "[{file: log.csv}]",
        "\n  - {file: &log log.csv, window: [0, 0.1]}\n"
        "  - {file: *log, window: [0.2, 0.3]}\n");
  ExpectReplayed();
}

TEST_F(GoodFile, MayHaveRowsAtOneTimeButForRounding) {
  Spoil("log.csv", "0.1,0.1,0.01\n", "0.1,0.1,0.01\n0.100000000001,0.1,0.01\n");
  ExpectReplayed();
  EXPECT_THAT(Scratch::Text(files_ / "out/errors.json"), Not(HasSubstr("null")));
}

TEST_F(GoodFile, NeedsItsModel) {
  fs::remove(files_ / "model.xml");
  ExpectRefused({"replay", "experiment.yaml", "--out", "out"},
                {"experiment.yaml:2: model", "no file model.xml"});
}

TEST_F(GoodFile, IsNoMatFileBecauseOfItsName) {
  Spoil("experiment.yaml", "log.csv", "log.mat");
  fs::rename(files_ / "log.csv", files_ / "log.mat");
  ExpectRefused({"replay", "experiment.yaml", "--out", "out"}, {"log.mat", "MATLAB"});
}

TEST_F(GoodFile, StillFailsAsAJobWhenTheSimulationDivergesAndLeavesNoEmptyFolder) {
  Spoil("log.csv", "0.1,0.1,0.01", "0.1,1e15,0.01");
  const auto before = Listing();
  const auto f = Run({"replay", "experiment.yaml", "--out", "out"});
  EXPECT_EQ(f.exit_code, 1);
  EXPECT_THAT(f.err, HasSubstr("diverges"));
  EXPECT_EQ(Listing(), before);
}

TEST_F(GoodFile, WithoutAJointPositionCannotStartAsMeasured) {
  Spoil("experiment.yaml", "format: 1", "format: 1\nstart: measured");
  ExpectReplayed();
  fs::remove_all(files_ / "out");
  Spoil("log.csv", "0,0.1,0\n", "0,0.1,\n");
  ExpectRefused({"replay", "experiment.yaml", "--out", "out"},
                {"log.csv", "column 'q'", "start: measured"});
}

}  // namespace
}  // namespace continuum
