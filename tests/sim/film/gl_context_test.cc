#include "sim/film/gl_context.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "error.h"
#include "sim/film/renderer.h"
#include "sim/model/model_spec.h"
#include "sim/model/mujoco_handles.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Gl, IsParsedByName) {
  EXPECT_EQ(ParseGl("auto"), Gl::kAuto);
  EXPECT_EQ(ParseGl("osmesa"), Gl::kOsmesa);
  EXPECT_EQ(ParseGl("egl"), Gl::kEgl);
  EXPECT_THAT([] { ParseGl("glx"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("auto, osmesa or egl"), HasSubstr("glx"))));
}

// Newer systems lack it.
bool HasOsmesa() { return dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE); }

TEST(Gl, HasOneBackendInAProcess) {
  if (!HasOsmesa()) GTEST_SKIP() << "no OSMesa";
  const GlContext context(Gl::kOsmesa);
  EXPECT_THAT([] { GlContext other(Gl::kEgl); },
              ThrowsMessage<Error>(AllOf(HasSubstr("osmesa"), HasSubstr("found egl"))));
}

TEST(Gl, TakesTheBackendThatTheProcessUses) {
  const GlContext first(Gl::kAuto), second(Gl::kAuto);
  EXPECT_GT(second.MaxSize(), 0);
}

// The snake arm with shadows, cables and all that a frame may show beside the model.
Image SnakeArm(Gl backend) {
  const ModelSpec system =
      ModelSpec::Load(std::string(CONTINUUM_SOURCE) + "/models/annelida/annelida.xml");
  const ModelAndData machine = system.Build();
  mj_forward(machine.model.get(), machine.data.get());
  Renderer renderer(*machine.model, 640, 480, backend);
  const ColorBar bar{.label = "cable tension [N]", .low = "0", .high = "20"};
  Ruler ruler;
  return renderer.Draw(*machine.model, *machine.data,
                       {.caption = "Snake arm", .time = 1.5, .ruler = &ruler, .bar = bar});
}

// Mean difference of the colours, 0 to 255, of a and of b moved to the left by some pixels.
double Difference(const Image& a, const std::string& b, int moved = 0) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int i = 0; i < 3 * (a.width - moved); ++i, ++count) {
      const auto at = static_cast<std::size_t>(3 * y * a.width + i);
      sum += std::abs(a.rgb[at] - static_cast<unsigned char>(b[at + 3 * moved]));
    }
  }
  return sum / count;
}

constexpr int kNoDevice = 77;

[[noreturn]] void DrawByEgl(const std::string& file) {
  try {
    const Image image = SnakeArm(Gl::kEgl);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.rgb.data()),
               static_cast<std::streamsize>(image.rgb.size()));
    std::exit(0);
  } catch (const Error& error) {
    const std::string why = error.what();
    std::fprintf(stderr, "%s\n", why.c_str());
    const bool none =
        why.find("cannot be opened") != why.npos || why.find("finds neither") != why.npos;
    std::exit(none ? kNoDevice : 1);
  }
}

// Each library has a process of its own: that of EGL begins anew and finds the file by its
// environment.
TEST(GlDeathTest, EglAndOsmesaDrawTheSamePicture) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  constexpr char kVariable[] = "CONTINUUM_EGL_PICTURE";
  std::optional<testing::Scratch> scratch;
  if (!getenv(kVariable)) setenv(kVariable, (scratch.emplace() / "egl.rgb").c_str(), 1);
  const std::string file = getenv(kVariable);
  int code = -1;
  EXPECT_EXIT(
      DrawByEgl(file),
      [&code](int status) {
        code = WEXITSTATUS(status);
        return WIFEXITED(status) && (code == 0 || code == kNoDevice);
      },
      "");
  unsetenv(kVariable);
  if (code == kNoDevice) GTEST_SKIP() << "no EGL device";
  if (!HasOsmesa()) GTEST_SKIP() << "no OSMesa";
  const Image image = SnakeArm(Gl::kOsmesa);
  const std::string egl = testing::Scratch::Text(file);
  ASSERT_EQ(egl.size(), image.rgb.size());
  EXPECT_LT(Difference(image, egl), 0.1);   // 0 where both are Mesa's; cards round otherwise
  EXPECT_GT(Difference(image, egl, 1), 1);  // what one pixel makes: 1.64
}

}  // namespace
}  // namespace continuum
