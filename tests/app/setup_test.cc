#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/process.h"
#include "support/scratch.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(Setup, WithoutRootAndSudoNamesThePackagesToInstall) {
  const testing::Scratch path;  // a machine with little on it, and the user is somebody
  const auto program = [&](const std::string& name, const std::string& script) {
    path.Write(name, "#!/bin/sh\n" + script + "\n");
    fs::permissions(path / name, fs::perms::owner_all);
  };
  program("id", "echo 1000");
  program("dpkg-query", "exit 1");
  program("apt-get", "echo called >> " + (path / "calls").string());
  for (const char* name : {"sed", "grep", "dirname"})
    fs::create_symlink(std::string("/usr/bin/") + name, path / name);
  const auto f = testing::RunProcess({"/usr/bin/env", "PATH=" + path.folder().string(), "/bin/bash",
                                      CONTINUUM_SOURCE "/scripts/setup"},
                                     path.folder());
  EXPECT_EQ(f.exit_code, 2) << f.err;
  EXPECT_THAT(f.err, HasSubstr("root or sudo"));
  EXPECT_THAT(f.err, HasSubstr("apt-get install --no-install-recommends build-essential cmake"));
  EXPECT_FALSE(fs::exists(path / "calls"));
}

}  // namespace
}  // namespace continuum
