#pragma once

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/process.h"
#include "support/scratch.h"

namespace continuum::testing {

inline constexpr char kModel[] = R"(<mujoco model="arm">
  <option timestep="0.01" integrator="implicitfast"/>
  <worldbody>
    <body name="link">
      <joint name="hinge" axis="0 1 0" damping="0.1"/>
      <geom name="rod" type="capsule" size="0.02" fromto="0 0 0 0 0 -0.3" mass="1"/>
      <site name="tip" pos="0 0 -0.3"/>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="hinge"/></actuator>
  <sensor>
    <jointpos name="angle" joint="hinge"/>
    <framepos name="tip_pos" objtype="site" objname="tip"/>
  </sensor>
</mujoco>
)";
inline constexpr char kExperiment[] = R"(format: 1
model: model.xml
time: {column: t, unit: s}
inputs: [{column: u, unit: Nm, actuator: motor}]
outputs: [{column: q, unit: rad, sensor: angle}]
parameters: [{name: b, target: "joint:hinge", attribute: damping, lower: 0.01, upper: 1}]
logs: [{file: log.csv}]
)";
inline constexpr char kLog[] = "t,u,q\n0,0.1,0\n0.1,0.1,0.01\n0.2,0.1,0.03\n0.3,0.1,0.06\n";
inline constexpr char kInput[] = "time,motor\n0.5,0.1\n0.6,0.2\n0.7,0.1\n";
/// What `apply` needs of a diagnosis: a stiffer joint and dry friction.
inline constexpr char kDiagnosis[] = R"({"extension": {
  "instances": [{"effect": "coulomb", "name": "dry", "config": [["joint", "hinge"], ["tau_c", "0.01"]],
                 "replaces": ""}],
  "changes": [{"target": "joint:hinge", "attribute": "damping", "value": 2, "operation": "scale"}]}}
)";

/// Names the cases of a table by their member `name`.
inline constexpr auto kCaseName = [](const auto& info) { return std::string(info.param.name); };

/// A folder with a good model, log, experiment, input and diagnosis, in which `continuum` runs.
class AppBench : public ::testing::Test {
 protected:
  AppBench() {
    files_.Write("model.xml", kModel);
    files_.Write("log.csv", kLog);
    files_.Write("experiment.yaml", kExperiment);
    files_.Write("input.csv", kInput);
    files_.Write("diagnosis.json", kDiagnosis);
  }

  Finished Run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), CONTINUUM_EXECUTABLE);
    return RunProcess(std::move(arguments), files_.folder());
  }
  /// Runs a script in bash, where PATH has `continuum`.
  Finished Shell(const std::string& script, unsigned seconds = 60) const {
    std::filesystem::create_directories(files_ / "bin");
    if (!std::filesystem::exists(files_ / "bin/continuum"))
      std::filesystem::create_symlink(CONTINUUM_EXECUTABLE, files_ / "bin/continuum");
    return RunProcess({"/bin/bash", "-c", "export PATH=\"$PWD/bin:$PATH\"; " + script},
                      files_.folder(), seconds);
  }
  /// Replaces one text in a file.
  void Spoil(const std::string& file, const std::string& old, const std::string& by) const {
    std::string text = Scratch::Text(files_ / file);
    const std::size_t at = text.find(old);
    ASSERT_NE(at, text.npos) << file << " has no " << old;
    files_.Write(file, text.replace(at, old.size(), by));
  }
  std::vector<std::string> Listing() const {
    std::vector<std::string> names;
    for (const auto& e : std::filesystem::recursive_directory_iterator(files_.folder()))
      names.push_back(e.path().lexically_relative(files_.folder()).string());
    std::sort(names.begin(), names.end());
    return names;
  }

  /// The run ends with exit code 2 and one line that holds all words, and leaves no file behind.
  void ExpectRefused(const std::vector<std::string>& arguments,
                     const std::vector<std::string>& words) const {
    const auto before = Listing();
    const Finished f = Run(arguments);
    EXPECT_EQ(f.signal, 0) << "it crashed or hung";
    EXPECT_EQ(f.exit_code, 2) << f.err;
    EXPECT_EQ(f.out, "");
    EXPECT_EQ(Messages(f.err), 1) << f.err;
    for (const std::string& word : words) EXPECT_THAT(f.err, ::testing::HasSubstr(word));
    EXPECT_EQ(Listing(), before);
  }

  Scratch files_;

 private:
  // Progress may come first; the message is the last line but for the hint at --help.
  static int Messages(const std::string& err) {
    int messages = 0;
    bool after = false;
    std::istringstream in(err);
    for (std::string line; std::getline(in, line);) {
      const bool message = line.starts_with("continuum: ");
      messages += message;
      if (after && !message && line != "See continuum --help.") messages += 100;
      after |= message;
    }
    return messages;
  }
};

}  // namespace continuum::testing
