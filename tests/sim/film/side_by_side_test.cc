#include "sim/film/side_by_side.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "error.h"
#include "sim/io/file.h"
#include "support/measured_arm.h"

namespace continuum {
namespace {

class SideBySide : public ::testing::Test {
 protected:
  SideBySide() {
    std::string model = ReadFile(before_.model);
    model.replace(model.find("stiffness=\"0.4\""), 15, "stiffness=\"0.1\"");
    after_.model = arm_.folder().Write("after.xml", model);
    options_.width = 160, options_.height = 120, options_.fps = 10;
  }

  // Of the first log by one model, with the camera where another model needs it too.
  std::vector<Image> Frames(const Experiment& e, const Experiment& other, const std::string& name) {
    FilmOptions options = options_;
    options.caption = name + ": " + e.logs[0].label;
    const ModelSpec system = ModelSpec::Load(e.model);
    Outlook ahead = LookAhead(e, system, e.logs[0], options);
    ahead.framing.Include(
        LookAhead(other, ModelSpec::Load(other.model), other.logs[0], options).framing);
    Ruler ruler;
    std::vector<Image> frames;
    DrawFrames(e, system, e.logs[0], options, ahead, ruler,
               [&](Image image) { frames.push_back(std::move(image)); });
    return frames;
  }

  testing::MeasuredArm arm_;
  Experiment before_ = arm_.Read(""), after_ = before_;
  FilmOptions options_;
};

TEST_F(SideBySide, TheHalvesAreTheFramesOfEitherModelSeenFromOnePlace) {
  const auto left = Frames(before_, after_, "before"), right = Frames(after_, before_, "after");
  ASSERT_GT(left.size(), 3u);
  ASSERT_NE(left[3].rgb, right[3].rgb);
  const ModelSpec before = ModelSpec::Load(before_.model), after = ModelSpec::Load(after_.model);
  std::size_t k = 0;
  DrawSideBySide({before_, before, "before"}, {after_, after, "after"}, 0, options_,
                 [&](const Image& both) {
                   ASSERT_LT(k, left.size());
                   ASSERT_EQ(both.width, 320);
                   for (int y = 0; y < both.height; ++y) {
                     const auto row = both.rgb.begin() + 3 * 320 * y;
                     const auto at = 3 * 160 * y;
                     ASSERT_TRUE(std::equal(row, row + 480, left[k].rgb.begin() + at)) << k;
                     ASSERT_TRUE(std::equal(row + 480, row + 960, right[k].rgb.begin() + at)) << k;
                   }
                   ++k;
                 });
  EXPECT_EQ(k, left.size());
}

// Rows of white pixels below: the longest is the bar of the scale.
int LongestBar(const Image& both, int begin, int end) {
  int longest = 0;
  for (int y = both.height / 2; y < both.height; ++y) {
    for (int x = begin, run = 0; x < end; ++x) {
      const auto at = both.rgb.begin() + 3 * (std::ptrdiff_t{y} * both.width + x);
      run = std::all_of(at, at + 3, [](int c) { return c == 255; }) ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  return longest;
}

// The softer arm swings further: on its own its camera would stand back.
TEST_F(SideBySide, TheHalvesHaveOneScale) {
  options_.width = 640, options_.height = 480, options_.fps = 1;
  const ModelSpec before = ModelSpec::Load(before_.model), after = ModelSpec::Load(after_.model);
  const Outlook one = LookAhead(before_, before, before_.logs[0], options_);
  const Outlook other = LookAhead(after_, after, after_.logs[0], options_);
  const auto distance = [](Framing framing) {
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    framing.Aim(camera, 45, 640. / 480);
    return camera.distance;
  };
  ASSERT_GT(distance(other.framing), 1.02 * distance(one.framing));
  int frames = 0;
  DrawSideBySide({before_, before, "before"}, {after_, after, "after"}, 0, options_,
                 [&](const Image& both) {
                   const int left = LongestBar(both, 0, 640);
                   ASSERT_GT(left, 40);
                   ASSERT_EQ(left, LongestBar(both, 640, 1280));
                   ++frames;
                 });
  EXPECT_GT(frames, 3);
}

TEST_F(SideBySide, EndsWithTheErrorOfEitherModelOrOfItsTaker) {
  const ModelSpec before = ModelSpec::Load(before_.model);
  options_.camera = "nowhere";
  const auto draw = [&](const std::function<void(Image)>& take) {
    DrawSideBySide({before_, before, "before"}, {before_, before, "after"}, 0, options_, take);
  };
  EXPECT_THROW(draw([](const Image&) {}), Error);
  options_.camera = "";
  EXPECT_THROW(draw([](const Image&) { throw Error::Job("full"); }), Error);
}

}  // namespace
}  // namespace continuum
