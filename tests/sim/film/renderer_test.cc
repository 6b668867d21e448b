#include "sim/film/renderer.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>

#include "error.h"
#include "sim/film/overlay_painter.h"
#include "sim/model/mujoco_handles.h"
#include "support/long_test.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Red box top left and green box bottom right of the camera "front", 2 m away, which looks along
// +y.
constexpr const char* kScene = R"(
<mujoco>
  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.95 0.96 0.98"
        rgb2="0.7 0.76 0.84" width="64" height="64"/>
    <texture name="grid" type="2d" builtin="checker" rgb1="0.86 0.88 0.9" rgb2="0.8 0.82 0.85"
        width="64" height="64"/>
    <material name="floor" texture="grid" texrepeat="40 40" reflectance="0.5"/>
  </asset>
  <worldbody>
    <light pos="1 -1 3" dir="-0.3 0.3 -1"/>
    <geom name="floor" type="plane" size="20 20 0.1" material="floor"/>
    <geom name="wall" type="box" size="8 0.1 2" pos="0 6 2" rgba="0.7 0.7 0.7 1"/>
    <camera name="front" pos="0 -2 0.6" xyaxes="1 0 0 0 0 1" fovy="45"/>
    <camera name="above" pos="0 0 4"/>
    <site name="anchor" pos="0 0 1.2" size="0.01"/>
    <body name="box" pos="-0.4 0 0.9">
      <joint name="slide" type="slide" axis="1 0 0"/>
      <joint name="lift" type="slide" axis="0 0 1"/>
      <geom name="red" type="box" size="0.1 0.1 0.1" rgba="0.9 0.1 0.1 1"/>
      <site name="pull" pos="0 0 0.1" size="0.01"/>
    </body>
    <body name="low" pos="0.4 0 0.3">
      <joint type="hinge" axis="0 1 0"/>
      <geom name="green" type="box" size="0.1 0.1 0.1" rgba="0.1 0.8 0.1 1"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="cable" width="0.012" rgba="0.1 0.2 0.9 1">
      <site site="anchor"/><site site="pull"/>
    </spatial>
  </tendon>
</mujoco>)";

Owned<mjModel> Compile(const std::string& xml) {
  const Owned<mjSpec> spec(mj_parseXMLString(xml.c_str(), nullptr, nullptr, 0));
  Owned<mjModel> model(spec ? mj_compile(spec.get(), nullptr) : nullptr);
  if (!model) throw Error::Job("the test's model does not compile");
  return model;
}

Owned<mjData> Pose(const mjModel& m, double slide, double lift) {
  Owned<mjData> d(mj_makeData(&m));
  d->qpos[0] = slide;
  d->qpos[1] = lift;
  mj_forward(&m, d.get());
  return d;
}

using Rgb = std::array<int, 3>;

Rgb Pixel(const Image& image, int x, int y) {
  const unsigned char* const p = image.rgb.data() + 3 * (y * image.width + x);
  return {p[0], p[1], p[2]};
}

// Where camera "front" sees a point of the plane y = -0.1, the boxes' front.
std::pair<int, int> Seen(const Image& image, double x, double z) {
  const double focal = 0.5 * image.height / std::tan(22.5 * std::numbers::pi / 180);
  return {static_cast<int>(0.5 * image.width + focal * x / 1.9),
          static_cast<int>(0.5 * image.height - focal * (z - 0.6) / 1.9)};
}

// By ratio, so that it holds in light and shade; the rest of the scene is grey.
bool IsRed(const Rgb& c) { return c[0] > 40 && c[0] > 3 * c[1] && c[0] > 3 * c[2]; }
bool IsGreen(const Rgb& c) { return c[1] > 40 && c[1] > 3 * c[0] && c[1] > 3 * c[2]; }
bool IsBlue(const Rgb& c) { return c[2] > 40 && 2 * c[2] > 3 * c[0] && 2 * c[2] > 3 * c[1]; }

// The smallest rectangle around the pixels that a test selects.
struct Extent {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, count = 0;
};

template <class F>
Extent Find(const Image& image, F&& selects) {
  Extent e;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!selects(x, y)) continue;
      e.left = std::min(e.left, x), e.right = std::max(e.right, x);
      e.top = std::min(e.top, y), e.bottom = std::max(e.bottom, y);
      ++e.count;
    }
  }
  return e;
}
Extent FindColor(const Image& image, bool (*is)(const Rgb&)) {
  return Find(image, [&](int x, int y) { return is(Pixel(image, x, y)); });
}
Extent Difference(const Image& a, const Image& b) {
  return Find(a, [&](int x, int y) { return Pixel(a, x, y) != Pixel(b, x, y); });
}

class RendererTest : public ::testing::Test {
 protected:
  Owned<mjModel> model_ = Compile(kScene);
  Owned<mjData> data_ = Pose(*model_, 0, 0);
  Renderer renderer_{*model_, 640, 480};
};

TEST_F(RendererTest, ShowsColoursWhereTheyAreAndTheRightWayUp) {
  renderer_.SetCamera("front");
  const Image image = renderer_.Draw(*model_, *data_);
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 480);
  ASSERT_EQ(image.rgb.size(), 3u * 640 * 480);
  const auto [red_x, red_y] = Seen(image, -0.4, 0.9);
  const auto [green_x, green_y] = Seen(image, 0.4, 0.3);
  EXPECT_TRUE(IsRed(Pixel(image, red_x, red_y)));
  EXPECT_TRUE(IsGreen(Pixel(image, green_x, green_y)));
  const auto [cable_x, cable_y] = Seen(image, -0.2 * 1.9 / 2, 0.6 + 0.5 * 1.9 / 2);
  EXPECT_TRUE(IsBlue(Pixel(image, cable_x, cable_y)));
  EXPECT_LT(FindColor(image, IsRed).bottom, FindColor(image, IsGreen).top);
  WritePng(fs::path(::testing::TempDir()) / "continuum_front.png", image);
}

TEST_F(RendererTest, DrawsTheEdgesOfABoxWhereThePinholeHasThem) {
  renderer_.SetCamera("front");
  const Image image = renderer_.Draw(*model_, *data_);
  const Extent red = FindColor(image, IsRed);
  const auto [left, top] = Seen(image, -0.5, 1.0);
  const auto bottom = Seen(image, 0, 0.8).second;
  EXPECT_NEAR(red.left, left, 1);  // a pixel: the edge falls within one
  EXPECT_NEAR(red.top, top, 1);
  EXPECT_NEAR(red.bottom, bottom, 8);  // the underside, further away, shows below the front
}

TEST_F(RendererTest, RepeatsAFrameExactly) {
  const Image first = renderer_.Draw(*model_, *data_);
  EXPECT_EQ(renderer_.Draw(*model_, *data_).rgb, first.rgb);
}

TEST_F(RendererTest, ListsTheCamerasWhenOneIsUnknown) {
  EXPECT_THAT([&] { renderer_.SetCamera("behind"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("front, above"), HasSubstr("behind"))));
  const auto plain = Compile("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>");
  Renderer other(*plain, 64, 64);
  EXPECT_THAT([&] { other.SetCamera("front"); },
              ThrowsMessage<Error>(HasSubstr("the model has no cameras")));
}

TEST_F(RendererTest, WritesTheCaptionTopLeftAndTheTimeBottomLeft) {
  const Image bare = renderer_.Draw(*model_, *data_);
  const Extent caption =
      Difference(bare, renderer_.Draw(*model_, *data_, {.caption = "Pulled left"}));
  EXPECT_GT(caption.count, 500);
  EXPECT_LT(caption.bottom, 48);
  EXPECT_LT(caption.right, 160);
  const Extent time = Difference(bare, renderer_.Draw(*model_, *data_, {.time = 1.5}));
  EXPECT_GT(time.count, 500);
  EXPECT_GT(time.top, 480 - 48);
  EXPECT_LT(time.right, 160);
}

TEST_F(RendererTest, WritesBrightTextOnADarkPlate) {
  const Image image = renderer_.Draw(*model_, *data_, {.caption = "Pulled left"});
  int bright = 0, dark = 0;
  for (int y = 8; y < 32; ++y) {
    for (int x = 8; x < 80; ++x) {
      const Rgb c = Pixel(image, x, y);
      bright += c[0] > 240 && c[1] > 240 && c[2] > 240;
      dark += c[0] < 130 && c[1] < 130 && c[2] < 130;
    }
  }
  EXPECT_GT(bright, 60);
  EXPECT_GT(dark, 600);
}

TEST_F(RendererTest, WrapsALongCaptionInsideTheFrame) {
  const Image bare = renderer_.Draw(*model_, *data_);
  std::string text;
  for (int k = 0; k < 40; ++k) text += "friction ";
  const Extent words = Difference(bare, renderer_.Draw(*model_, *data_, {.caption = text}));
  EXPECT_LT(words.right, 632);
  EXPECT_GT(words.bottom, 60);
  text = std::string(200, 'W');
  const Extent one_word = Difference(bare, renderer_.Draw(*model_, *data_, {.caption = text}));
  EXPECT_LT(one_word.right, 632);
  EXPECT_GT(one_word.bottom, 60);
}

TEST_F(RendererTest, SpellsSignsThatTheFontLacks) {
  const Image spelled = renderer_.Draw(*model_, *data_, {.caption = "30 deg - 2x5 ?"});
  EXPECT_EQ(renderer_.Draw(*model_, *data_, {.caption = "30° – 2×5 ☃"}).rgb, spelled.rgb);
}

// Camera "front" is 2 m from the boxes' centres: 640 / 8 pixels are 0.276 m there.
TEST_F(RendererTest, DrawsARoundLengthToScaleRightOfTheTime) {
  renderer_.SetCamera("front");
  const Image bare = renderer_.Draw(*model_, *data_);
  const Image timed = renderer_.Draw(*model_, *data_, {.time = 1.5});
  Ruler ruler;
  const Image image = renderer_.Draw(*model_, *data_, {.time = 1.5, .ruler = &ruler});
  const Extent plate = Difference(timed, image);
  EXPECT_GT(plate.left, Difference(bare, timed).right);
  EXPECT_LT(plate.right, 320);
  const int middle = (plate.top + plate.bottom) / 2;
  int bar = 0;
  while (Pixel(image, plate.left + bar, middle) != Rgb{255, 255, 255}) ++bar;
  const int left = plate.left + bar;
  for (bar = 0; Pixel(image, left + bar, middle) == Rgb{255, 255, 255};) ++bar;
  const double focal = 240 / std::tan(22.5 * std::numbers::pi / 180);
  EXPECT_NEAR(bar, 0.2 * focal / 2, 1);
}

TEST_F(RendererTest, DrawsAColourBarBottomRight) {
  const Image bare = renderer_.Draw(*model_, *data_);
  const Overlay overlay{.bar = ColorBar{.label = "cable tension [N]",
                                        .low = "0",
                                        .high = "12.3",
                                        .from = {0, 0, 1},
                                        .to = {1, 0, 0}}};
  const Image image = renderer_.Draw(*model_, *data_, overlay);
  const Extent bar = Difference(bare, image);
  EXPECT_GT(bar.left, 320);
  EXPECT_GT(bar.top, 400);
  const auto inside = [&](auto&& is) {
    return Find(image, [&, is](int x, int y) {
      return x >= bar.left && y >= bar.top && is(Pixel(image, x, y));
    });
  };
  const Extent low = inside([](const Rgb& c) { return c[2] > 240 && c[0] < 15 && c[1] == 0; });
  const Extent high = inside([](const Rgb& c) { return c[0] > 240 && c[2] < 15 && c[1] == 0; });
  const Extent mid = inside([](const Rgb& c) { return std::abs(c[0] - c[2]) < 9 && c[1] == 0; });
  ASSERT_GT(low.count, 0);
  ASSERT_GT(high.count, 0);
  EXPECT_NEAR(mid.left + mid.right, low.left + high.right, 4);
  EXPECT_LT(low.right, high.left);
}

TEST_F(RendererTest, DrawsTheGhostTranslucentInItsOwnPose) {
  renderer_.SetCamera("front");
  const auto ghost = Pose(*model_, 0.4, 0.1);
  const Image bare = renderer_.Draw(*model_, *data_);
  const Image solid = renderer_.Draw(*model_, *ghost);
  const Image both = renderer_.Draw(*model_, *data_, {.ghost = ghost.get()});
  const auto [x, y] = Seen(both, 0, 1.0);
  const auto [red_x, red_y] = Seen(both, -0.4, 0.9);
  EXPECT_EQ(Pixel(both, red_x, red_y), Pixel(bare, red_x, red_y));
  for (int c = 1; c < 3; ++c) {
    const int behind = Pixel(bare, x, y)[c], before = Pixel(solid, x, y)[c];
    const double share = 1.0 * (Pixel(both, x, y)[c] - behind) / (before - behind);
    EXPECT_GT(share, 0.25);  // OpenGL blends near and far faces: not the ghost's opacity itself
    EXPECT_LT(share, 0.75);
  }
}

TEST_F(RendererTest, DrawsMarkersThatTheCallerAdds) {
  renderer_.SetCamera("front");
  const Overlay overlay{.geoms = [](mjvScene& scene) {
    const mjtNum size[] = {0.05, 0.05, 0.05}, pos[] = {0, -0.1, 0.6};
    const float rgba[] = {0.9f, 0.05f, 0.05f, 1};
    mjv_initGeom(scene.geoms + scene.ngeom++, mjGEOM_SPHERE, size, pos, nullptr, rgba);
  }};
  EXPECT_FALSE(IsRed(Pixel(renderer_.Draw(*model_, *data_), 320, 240)));
  renderer_.SetCamera("front");
  EXPECT_TRUE(IsRed(Pixel(renderer_.Draw(*model_, *data_, overlay), 320, 240)));
}

bool IsRobot(const Rgb& c) { return IsRed(c) || IsGreen(c) || IsBlue(c); }

// Nothing of the robot touches the edge.
void ExpectWhole(const Image& image) {
  EXPECT_GT(FindColor(image, IsRed).count, 20);
  EXPECT_GT(FindColor(image, IsGreen).count, 20);
  const Extent all = FindColor(image, IsRobot);
  EXPECT_GT(all.left, 0.03 * image.width);
  EXPECT_LT(all.right, 0.97 * image.width);
  EXPECT_GT(all.top, 0.03 * image.height);
  EXPECT_LT(all.bottom, 0.97 * image.height);
}

// The share of the picture's width or height, whichever is larger, that the robot takes.
double Share(const Image& image) {
  const Extent all = FindColor(image, IsRobot);
  return std::max(1.0 * (all.right - all.left) / image.width,
                  1.0 * (all.bottom - all.top) / image.height);
}

TEST(FreeCamera, SeesTheWholeRobotInEveryPose) {
  CONTINUUM_LONG_IF_SANITIZED("hundreds of frames");
  const auto model = Compile(kScene);
  for (const auto& [width, height] : {std::pair{640, 480}, {320, 640}, {800, 200}}) {
    for (const auto& [slide, lift] :
         {std::pair{0.0, 0.0}, {3.0, 0.0}, {-4.0, 0.5}, {0.0, 5.0}, {0.3, -0.7}}) {
      SCOPED_TRACE(fmt::format("{} x {}, slide {}, lift {}", width, height, slide, lift));
      Renderer renderer(*model, width, height);
      ExpectWhole(renderer.Draw(*model, *Pose(*model, slide, lift)));
    }
  }
}

TEST(FreeCamera, FramesTheRobotAndNotTheRoomAroundIt) {
  const auto model = Compile(kScene);  // its wall is 16 m wide, the robot 1 m
  for (const auto& [width, height] : {std::pair{640, 480}, {320, 640}, {800, 200}}) {
    Renderer renderer(*model, width, height);
    EXPECT_GT(Share(renderer.Draw(*model, *Pose(*model, 0, 0))), 0.6) << width;
  }
}

TEST(FreeCamera, DoesNotClipARobotThatIsSmallInItsModel) {
  const auto model = Compile(R"(
    <mujoco>
      <statistic extent="100"/>
      <worldbody>
        <light pos="0 0 1"/>
        <body><joint type="slide"/><geom type="box" size=".01 .01 .01" rgba=".9 .1 .1 1"/></body>
        <body pos="0.04 0 0">
          <joint type="slide"/><geom type="box" size=".01 .01 .01" rgba=".1 .8 .1 1"/>
        </body>
      </worldbody>
    </mujoco>)");
  Renderer renderer(*model, 320, 240);
  ExpectWhole(renderer.Draw(*model, *Pose(*model, 0, 0)));
}

TEST_F(RendererTest, KeepsTheFreeCameraAtRestOverIncludedPoses) {
  const auto far = Pose(*model_, 2, 0.5);
  renderer_.Include(*model_, *far);
  const Image first = renderer_.Draw(*model_, *data_);
  renderer_.Draw(*model_, *far);
  EXPECT_EQ(renderer_.Draw(*model_, *data_).rgb, first.rgb);
}

TEST_F(RendererTest, GoesBackToTheFreeCamera) {
  const Image before = renderer_.Draw(*model_, *data_);
  renderer_.SetCamera("above");
  EXPECT_NE(renderer_.Draw(*model_, *data_).rgb, before.rgb);
  renderer_.SetCamera("");
  EXPECT_EQ(renderer_.Draw(*model_, *data_).rgb, before.rgb);
}

TEST_F(RendererTest, LivesBesideAnother) {
  const Image before = renderer_.Draw(*model_, *data_);
  {
    Renderer other(*model_, 320, 240);
    EXPECT_EQ(other.Draw(*model_, *data_).width, 320);
    EXPECT_EQ(renderer_.Draw(*model_, *data_).rgb, before.rgb);
  }
  EXPECT_EQ(renderer_.Draw(*model_, *data_).rgb, before.rgb);
}

TEST_F(RendererTest, RefusesAnotherModel) {
  const auto other = Compile("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>");
  const Owned<mjData> data(mj_makeData(other.get()));
  EXPECT_THAT([&] { renderer_.Draw(*other, *data); },
              ThrowsMessage<Error>(HasSubstr("the model that the renderer was made for")));
}

TEST_F(RendererTest, NamesTheSizesThatOpenGlHas) {
  EXPECT_THAT([&] { Renderer(*model_, 20, 480); },
              ThrowsMessage<Error>(AllOf(HasSubstr("from 64 to"), HasSubstr("20 x 480"))));
  EXPECT_THAT([&] { Renderer(*model_, 640, 1000000); },
              ThrowsMessage<Error>(HasSubstr("640 x 1000000")));
}

TEST(Ruler, KeepsItsLengthWhileTheModelComesALittleNearer) {
  Ruler ruler;
  ruler.Measure(1e-3, 800);
  EXPECT_DOUBLE_EQ(ruler.length, 0.1);
  ruler.Measure(0.9e-3, 800);
  EXPECT_DOUBLE_EQ(ruler.length, 0.1);
  ruler.Measure(0.5e-3, 800);
  EXPECT_DOUBLE_EQ(ruler.length, 0.05);
  ruler.Measure(0, 800);  // not known
  EXPECT_EQ(ruler.pixel, 0);
}

}  // namespace
}  // namespace continuum
