#include "sim/side_by_side.h"

#include <gtest/gtest.h>

#include "error.h"
#include "sim/file.h"
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

  std::vector<Image> Frames(const Experiment& e, const std::string& name) {
    FilmOptions options = options_;
    options.caption = name + ": " + e.logs[0].label;
    std::vector<Image> frames;
    DrawFrames(e, System::Load(e.model), e.logs[0], options,
               [&](Image image) { frames.push_back(std::move(image)); });
    return frames;
  }

  testing::MeasuredArm arm_;
  Experiment before_ = arm_.Read(""), after_ = before_;
  FilmOptions options_;
};

TEST_F(SideBySide, TheHalvesAreTheFramesOfEitherModel) {
  const auto left = Frames(before_, "before"), right = Frames(after_, "after");
  ASSERT_GT(left.size(), 3u);
  ASSERT_NE(left[3].rgb, right[3].rgb);
  const System before = System::Load(before_.model), after = System::Load(after_.model);
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

TEST_F(SideBySide, EndsWithTheErrorOfEitherModelOrOfItsTaker) {
  const System before = System::Load(before_.model);
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
