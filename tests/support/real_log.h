#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "sim/experiment/experiment.h"
#include "support/recordings.h"
#include "support/scratch.h"

namespace continuum::testing {

/// A test on the recordings of a real machine: folder of its own, imported experiment. Skips where
/// the recordings are not at hand.
class RealLog : public ::testing::Test {
 protected:
  /// Runs models/<robot>/import.py; nothing to test when it was skipped.
  void Import(const std::string& robot) {
    const std::filesystem::path data = Recordings(robot);
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "no recordings at " << data;
    const std::string import = CONTINUUM_SOURCE "/models/" + robot + "/import.py";
    const std::string command = "python3 '" + import + "' '" + data.string() + "' '" +
                                scratch_.folder().string() + "' > /dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    experiment_ = Experiment::Read(scratch_ / "experiment.yaml");
  }

  Scratch scratch_;
  Experiment experiment_;
};

}  // namespace continuum::testing
