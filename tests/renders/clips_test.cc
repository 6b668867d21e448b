#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "sim/film/film_recipe.h"
#include "sim/model/model_spec.h"
#include "support/process.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::HasSubstr;
using testing::RunProcess;
using testing::Scratch;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

const fs::path kRenders = fs::path(CONTINUUM_SOURCE) / "renders";

std::vector<fs::path> Recipes() {
  std::vector<fs::path> recipes;
  for (const auto& entry : fs::directory_iterator(kRenders)) {
    if (entry.path().extension() == ".yaml") recipes.push_back(entry.path());
  }
  std::sort(recipes.begin(), recipes.end());
  return recipes;
}

class Recipe : public ::testing::TestWithParam<fs::path> {};

TEST_P(Recipe, NamesWhatItsModelHas) {
  const Clip clip = Clip::Read(GetParam());
  const ModelSpec system = ModelSpec::Load(clip.experiment.model);
  EXPECT_NO_THROW(clip.Check(system));
}

TEST_P(Recipe, IsInTheTableOfItsReadme) {
  EXPECT_THAT(Scratch::Text((kRenders / "README.md").string()),
              HasSubstr("`" + GetParam().stem().string() + "`"));
}

INSTANTIATE_TEST_SUITE_P(Renders, Recipe, ::testing::ValuesIn(Recipes()),
                         [](const auto& info) { return info.param.stem().string(); });

constexpr char kModel[] = R"(<mujoco>
  <worldbody>
    <camera name="side" pos="0 -2 0" xyaxes="1 0 0 0 0 1"/>
    <body>
      <joint name="slide" type="slide"/>
      <geom size="0.1" mass="1"/>
      <site name="middle"/>
    </body>
  </worldbody>
  <actuator><motor name="push" joint="slide"/><motor name="pull" joint="slide"/></actuator>
  <sensor><force name="force" site="middle"/><jointpos name="where" joint="slide"/></sensor>
</mujoco>
)";
constexpr char kRecipe[] = R"(model: model.xml
camera: side
seconds: 0.02
caption: A ball
arrows: [{sensor: force, length: 0.1}]
inputs:
  push: [[0, 1], [0.01, 3], [0.01, 5]]
  pull: {mean: 1, amplitude: 2, period: 0.02, rise: 0.01}
)";

class ClipFile : public ::testing::Test {
 protected:
  ClipFile() {
    files_.Write("model.xml", kModel);
    files_.Write("clip.yaml", kRecipe);
  }
  void Replace(const std::string& old, const std::string& by) {
    std::string text = Scratch::Text(files_ / "clip.yaml");
    files_.Write("clip.yaml", text.replace(text.find(old), old.size(), by));
  }
  void ExpectRefused(const std::string& where, const std::string& found) const {
    const auto check = [&] {
      const Clip clip = Clip::Read(files_ / "clip.yaml");
      clip.Check(ModelSpec::Load(clip.experiment.model));
    };
    EXPECT_THAT(check, ThrowsMessage<Error>(
                           AllOf(HasSubstr("clip.yaml"), HasSubstr(where), HasSubstr(found))));
  }

  const Scratch files_;
};

TEST_F(ClipFile, GivesInputsThatAreStraightBetweenPointsOrAWaveThatRises) {
  const Clip clip = Clip::Read(files_ / "clip.yaml");
  const Log& log = clip.experiment.logs.front();
  EXPECT_THAT(log.time, ElementsAre(0, 0.005, 0.01, 0.015, 0.02));
  ASSERT_THAT(log.input, SizeIs(2));
  const auto near = [](double value) { return ::testing::DoubleNear(value, 1e-5); };
  EXPECT_THAT(log.input[0], ElementsAre(near(1), near(2), near(5), near(5), near(5)));
  EXPECT_THAT(log.input[1], ElementsAre(near(0), near(1.5), near(1), near(-1), near(1)));
}

TEST_F(ClipFile, MayGiveTheDirectionOfItsCamera) {
  Replace("camera: side", "camera: {azimuth: 120, elevation: -20}");
  const Clip clip = Clip::Read(files_ / "clip.yaml");
  ASSERT_TRUE(clip.film.view);
  EXPECT_THAT(clip.film.view->azimuth, Eq(120));
}

TEST_F(ClipFile, RefusesWhatTheModelLacks) {
  Replace("push:", "shove:");
  ExpectRefused("shove", "push");
  Replace("shove:", "push:");
  Replace("camera: side", "camera: above");
  ExpectRefused("camera", "'above'");
  Replace("camera: above", "camera: side");
  Replace("sensor: force", "sensor: where");
  ExpectRefused("arrows[0]", "'where'");
}

TEST_F(ClipFile, MayShowTheModelWithOtherValuesBeside) {
  Replace("inputs:", "beside: {caption: Heavier, set: {\"joint:slide\": {armature: 3}}}\ninputs:");
  const Clip clip = Clip::Read(files_ / "clip.yaml");
  ASSERT_TRUE(clip.beside);
  EXPECT_EQ(clip.beside->caption, "Heavier");
  const ModelSpec system = ModelSpec::Load(clip.experiment.model);
  EXPECT_EQ(system.model().dof_armature[0], 0);
  EXPECT_EQ(clip.Beside(system).model().dof_armature[0], 3);
  const auto film = RunProcess({CONTINUUM_EXECUTABLE, "render", "clip.yaml", "--size", "320x120",
                                "--fps", "100", "--out", "clip.mp4"},
                               files_.folder());
  EXPECT_EQ(film.exit_code, 0) << film.err;
  Replace("joint:slide", "joint:other");
  ExpectRefused("beside.set", "other");
}

TEST_F(ClipFile, RefusesTimesThatGoBack) {
  Replace("[0.01, 5]", "[0.005, 5]");
  ExpectRefused("inputs.push[2]", "0.005");
}

TEST_F(ClipFile, IsNotFilmedWhenItDiverges) {
  Replace("[[0, 1], [0.01, 3], [0.01, 5]]", "[[0, 1e30]]");
  const auto film = RunProcess({CONTINUUM_EXECUTABLE, "render", "clip.yaml", "--out", "clip.mp4"},
                               files_.folder());
  EXPECT_EQ(film.exit_code, 1);
  EXPECT_THAT(film.err, AllOf(HasSubstr("clip.yaml"), HasSubstr("diverge")));
  EXPECT_FALSE(fs::exists(files_ / "clip.mp4"));
}

TEST(Renders, MakeFilmsAClipOnce) {
  const Scratch files;
  const std::vector<std::string> command{(kRenders / "make").string(),
                                         "--out",
                                         files / "films",
                                         "--size",
                                         "160x120",
                                         "--fps",
                                         "2",
                                         "emps"};
  setenv("CONTINUUM", CONTINUUM_EXECUTABLE, 1);
  const auto first = RunProcess(command, files.folder());
  EXPECT_EQ(first.exit_code, 0) << first.err;
  const fs::path film = files / "films/emps.mp4";
  EXPECT_GT(fs::file_size(film), 1000u);
  const auto made = fs::last_write_time(film);
  EXPECT_THAT(RunProcess(command, files.folder()).out, HasSubstr("up to date"));
  EXPECT_EQ(fs::last_write_time(film), made);
}

}  // namespace
}  // namespace continuum
