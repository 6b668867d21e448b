#include <array>
#include <cstdint>
#include <cstring>

#include "bench.h"
#include "sim/film/image.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Scratch;

constexpr char kPyramid[] =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

// MuJoCo's own format: rows, columns, heights.
std::string Heights() {
  const std::array<std::int32_t, 2> size{2, 2};
  const std::array<float, 4> heights{0, 0, 0, 1};
  std::string bytes(sizeof size + sizeof heights, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  std::memcpy(bytes.data() + sizeof size, &heights, sizeof heights);
  return bytes;
}

class ApplyCommand : public testing::AppBench {
 protected:
  // A model with assets in folders of its own, one of them named through an included file.
  void GiveAssets(const std::string& compiler, const std::string& folder) const {
    fs::create_directories(files_ / "robot/assets");
    files_.Write("robot/assets/mesh.obj", kPyramid);
    files_.Write("robot/assets/heights.bin", Heights());
    WritePng(files_ / "robot/assets/black.png", {1, 1, {0, 0, 0}});
    files_.Write("robot/part.xml", "<mujoco><asset><mesh name='pyramid' file='" + folder +
                                       "mesh.obj'/></asset></mujoco>");
    Spoil("model.xml", "<worldbody>",
          compiler + R"(<include file="part.xml"/>
      <asset>
        <hfield name="ground" size="1 1 1 1" file=")" +
              folder + R"(heights.bin"/>
        <texture name="black" type="2d" file=")" +
              folder + R"(black.png"/>
        <texture name="grey" type="2d" builtin="flat" width="4" height="4"/>
      </asset>
      <worldbody>
        <geom type="hfield" hfield="ground" contype="0" conaffinity="0"/>)");
    Spoil("model.xml", "<site", "<geom type='mesh' mesh='pyramid' mass='0.1'/><site");
    fs::rename(files_ / "model.xml", files_ / "robot/model.xml");
  }
  void ExpectRuns(const std::string& model) const {
    const auto f = Run({"run", model, "--until", "0.1"});
    EXPECT_EQ(f.exit_code, 0) << f.err;
  }
};

TEST_F(ApplyCommand, WritesAModelThatRuns) {
  const auto f = Run({"apply", "diagnosis.json", "model.xml", "--out", "extended.xml"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(Scratch::Text(files_ / "extended.xml"),
              AllOf(HasSubstr("continuum.coulomb"), HasSubstr("damping=\"0.2\"")));
  ExpectRuns("extended.xml");
}

TEST_F(ApplyCommand, KeepsMeshesAndHeightFieldsWhereverItWrites) {
  GiveAssets("<compiler meshdir='assets' texturedir='assets'/>", "");
  fs::create_directories(files_ / "far/away");
  for (const char* out : {"extended.xml", "robot/extended.xml", "far/away/extended.xml"}) {
    SCOPED_TRACE(out);
    const auto f = Run({"apply", "diagnosis.json", "robot/model.xml", "--out", out});
    EXPECT_EQ(f.exit_code, 0) << f.err;
    ExpectRuns(out);
  }
  EXPECT_THAT(Scratch::Text(files_ / "far/away/extended.xml"),
              HasSubstr("meshdir=\"../../robot/assets\""));
}

TEST_F(ApplyCommand, KeepsAssetsOfAModelWithoutMeshdir) {
  GiveAssets("", "assets/");
  const auto f = Run({"apply", "diagnosis.json", "robot/model.xml", "--out", "extended.xml"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  ExpectRuns("extended.xml");
}

TEST_F(ApplyCommand, KeepsAssetsInAnAbsoluteFolderAndThroughALink) {
  GiveAssets("<compiler assetdir='" + (files_ / "robot/assets").string() + "'/>", "");
  fs::create_directories(files_ / "far/away");
  fs::create_directory_symlink("far/away", files_ / "link");
  const auto f = Run({"apply", "diagnosis.json", "robot/model.xml", "--out", "link/extended.xml"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  ExpectRuns("far/away/extended.xml");
}

TEST_F(ApplyCommand, LeadsFromTheTargetOfALink) {
  GiveAssets("<compiler meshdir='assets' texturedir='assets'/>", "");
  fs::create_directories(files_ / "far/away");
  fs::create_symlink("far/away/extended.xml", files_ / "extended.xml");
  EXPECT_EQ(Run({"apply", "diagnosis.json", "robot/model.xml", "--out", "extended.xml"}).exit_code,
            0);
  ExpectRuns("far/away/extended.xml");
}

TEST_F(ApplyCommand, OfIdentifyAndDiagnoseKeepAssetsToo) {
  GiveAssets("<compiler meshdir='assets' texturedir='assets'/>", "");
  Spoil("experiment.yaml", "model.xml", "robot/model.xml");
  const auto f = Run({"identify", "experiment.yaml", "--iterations", "1", "--out", "far/away/fit"});
  EXPECT_NE(f.exit_code, 2) << f.err;  // one iteration need not converge
  ExpectRuns("far/away/fit/fitted.xml");
}

TEST_F(ApplyCommand, LeavesTheOldFileWhenTheResultDoesNotCompile) {
  files_.Write("extended.xml", "precious");
  Spoil("diagnosis.json", "\"tau_c\", \"0.01\"", "\"tau_c\", \"-1\"");
  ExpectRefused({"apply", "diagnosis.json", "model.xml", "--out", "extended.xml"},
                {"diagnosis.json", "tau_c"});
  EXPECT_EQ(Scratch::Text(files_ / "extended.xml"), "precious");
}

struct Bad {
  const char *name, *old, *by;
  std::vector<std::string> words;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }
class BadDiagnosis : public testing::AppBench, public ::testing::WithParamInterface<Bad> {};
INSTANTIATE_TEST_SUITE_P(
    Files, BadDiagnosis,
    ::testing::Values(
        Bad{"NoJson", "{\"extension\"", "extension", {"JSON"}},
        Bad{"NoExtension", "\"extension\"", "\"other\"", {"'extension'"}},
        Bad{"NullChanges",
            R"([{"target": "joint:hinge", "attribute": "damping", "value": 2, "operation": "scale"}])",
            "null",
            {"extension.changes", "a list", "null"}},
        Bad{"UnknownOperation",
            "\"scale\"",
            "\"halve\"",
            {"extension.changes[0].operation", "set | scale | add", "halve"}},
        Bad{"NoOperation",
            ", \"operation\": \"scale\"",
            "",
            {"extension.changes[0]", "'operation'"}},
        Bad{"TextAsValue",
            "\"value\": 2",
            "\"value\": \"2\"",
            {"extension.changes[0].value", "a finite number"}},
        Bad{"NullValue",
            "\"value\": 2",
            "\"value\": null",
            {"extension.changes[0].value", "a finite number", "null"}},
        Bad{"NegativeFactor",
            "\"value\": 2",
            "\"value\": -2",
            {"joint:hinge: damping: expected a number >= 0, found -2"}},
        Bad{"HugeFactor",
            "\"value\": 2",
            "\"value\": 1e300",
            {"joint:hinge: damping: expected a number <= 1e+12, found 1e+300"}},
        Bad{"UnknownTarget", "joint:hinge", "joint:elbow", {"elbow"}},
        Bad{"UnknownAttribute", "damping", "dampening", {"dampening"}},
        Bad{"UnknownEffect", "coulomb", "ghost", {"ghost"}},
        Bad{"NoReplaces", "\"replaces\"", "\"other\"", {"extension.instances[0]", "'replaces'"}},
        Bad{"ReplacesWhatIsNotThere", R"("replaces": "")", R"("replaces": "wet")", {"wet"}},
        Bad{"HalfAPair",
            R"(["joint", "hinge"])",
            R"(["joint"])",
            {"extension.instances[0].config[0]", "[key, value]"}},
        Bad{"NumberAsName",
            R"("name": "dry")",
            R"("name": 3)",
            {"extension.instances[0].name", "3"}},
        Bad{"ListOfNumbers",
            R"([["joint", "hinge"], ["tau_c", "0.01"]])",
            "[1]",
            {"extension.instances[0].config[0]"}}),
    testing::kCaseName);

TEST_P(BadDiagnosis, IsRefusedByFileAndKey) {
  Spoil("diagnosis.json", GetParam().old, GetParam().by);
  auto words = GetParam().words;
  words.push_back("diagnosis.json");
  ExpectRefused({"apply", "diagnosis.json", "model.xml", "--out", "extended.xml"}, words);
}

}  // namespace
}  // namespace continuum
