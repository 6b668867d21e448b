// A process that has another MuJoCo than the one that the plugin was built for, or two.
#include <dlfcn.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "support/process.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class OneMujoco : public ::testing::Test {
 protected:
  static fs::path Library() {
    Dl_info where;
    const bool found = dladdr(dlsym(RTLD_DEFAULT, "mj_version"), &where);
    return found ? where.dli_fname : "";
  }
  std::string Load(std::vector<std::string> libraries) {
    libraries.insert(libraries.begin(), {CONTINUUM_LOADER, CONTINUUM_PLUGIN});
    return testing::RunProcess(std::move(libraries), scratch_.folder()).out;
  }
  testing::Scratch scratch_;
};

TEST_F(OneMujoco, AloneRegistersTheEffects) {
  EXPECT_THAT(Load({Library()}), AllOf(HasSubstr("effects"), Not(HasSubstr("expected"))));
}

TEST_F(OneMujoco, BesideASecondOneIsNamedWithIt) {
  for (const char* name : {"libmujoco.so.3.9.9", "libmujoco.so", "physics.so"}) {
    const fs::path second = scratch_ / name;
    fs::copy_file(Library(), second);
    EXPECT_THAT(Load({Library(), second}),
                AllOf(HasSubstr("expected one MuJoCo library in the process"),
                      HasSubstr(second.string()), HasSubstr(Library().string()),
                      HasSubstr("no effect is registered"), HasSubstr("\n0 effects")));
  }
}

TEST_F(OneMujoco, OfAnotherReleaseIsNamed) {
  std::string bytes = testing::Scratch::Text(Library());
  // The function as x86-64 has it: mov eax, number; ret.
  const auto number = [](int release) {
    std::string code(5, '\xb8');
    std::memcpy(code.data() + 1, &release, 4);
    return code;
  };
  const std::size_t at = bytes.find(number(mjVERSION_HEADER));
  if (at == bytes.npos || bytes.find(number(mjVERSION_HEADER), at + 1) != bytes.npos)
    GTEST_SKIP() << "the release is not found in this MuJoCo's code";
  bytes.replace(at, 5, number(3009008));
  const fs::path other = scratch_.Write("libmujoco.so.3.9.8", bytes);
  EXPECT_THAT(Load({other}),
              AllOf(HasSubstr("mujoco_continuum: expected MuJoCo "),
                    HasSubstr(", found 3.9.8 (" + other.string() + "): no effect is registered"),
                    HasSubstr("\n0 effects")));
}

}  // namespace
}  // namespace continuum
