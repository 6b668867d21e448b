#include "identification/problem/extended_model.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "identification/candidates/candidate_generator.h"
#include "identification/fit/fit.h"
#include "identification/identify.h"
#include "identification/report/apply_extension.h"
#include "sim/replay/replay.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::CoulombInstance;
using ::testing::Gt;
using ::testing::HasSubstr;
using testing::Noisy;
using testing::Pendulum;
using ::testing::SizeIs;

class ExtensionTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 150;

  ModelSpec Model(const std::string& extension = "") {
    return ModelSpec::Load(Write("model.xml", Pendulum().Xml(extension)));
  }
  void AddTrial(const Pendulum& p, const std::string& name, int trial, const std::string& keys) {
    const auto u = Command(trial, kRows);
    AddLog(name, keys, u,
           Noisy(p.Run(u, testing::kPeriod), 1e-3, 0, static_cast<unsigned>(logs_.size())));
  }
  // Two trials, one held out, of the servo as the file has it and of one that the log says is
  // stiffer; all servos are 1.2 times stiffer than anybody knows.
  void AddTrials(double payload = 0) {
    Pendulum p;
    p.damping = 0.16;
    p.tau_c = 0.1;
    p.payload = payload;
    p.kp = 1.2 * 5;
    AddTrial(p, "soft0", 0, "use: train, condition: soft");
    AddTrial(p, "soft1", 1, "use: validate, condition: soft");
    p.kp = 1.2 * 8;
    const std::string set = ", condition: stiff, set: {'actuator:servo': {kp: 8}}";
    AddTrial(p, "stiff0", 2, "use: train" + set);
    AddTrial(p, "stiff1", 3, "use: validate" + set);
  }

  // The errors of the two files, as a user would replay them.
  SplitError ErrorsOf(const ExtendedModel& extension, const std::string& folder) {
    MakeFolder(folder_ / folder);
    WriteFile(folder_ / folder / "extended.xml", extension.xml);
    WriteFile(folder_ / folder / "extended.yaml", extension.yaml);
    Experiment e = Experiment::Read(folder_ / folder / "extended.yaml");
    return PooledError(e, Replay(e, ModelSpec::Load(folder_ / folder / "extended.xml")));
  }
  // Extends at x and replays.
  void ExpectTheSameErrors(const Problem& problem, const Problem::Vector& x) {
    const auto r = problem.Residuals(x, problem.AllLogs());
    const auto train = problem.TrainLogs();
    auto validate = train;
    validate.flip();
    const SplitError files = ErrorsOf(Extend(problem, problem.system(), x, folder_ / "out"), "out");
    EXPECT_NEAR(files.train, problem.PooledRms(r, train), 1e-9);
    EXPECT_NEAR(files.validate, problem.PooledRms(r, validate), 1e-9);
  }
  // Fits, extends, replays and compares.
  void ExpectSameErrors(const Problem& problem) {
    const Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs());
    const auto r = problem.Residuals(fit.x, problem.AllLogs());
    auto held_out = problem.TrainLogs();
    held_out.flip();
    const double train = problem.PooledRms(r, problem.TrainLogs());
    const double validate = problem.PooledRms(r, held_out);
    const SplitError files =
        ErrorsOf(Extend(problem, problem.system(), fit.x, folder_ / "out"), "out");
    EXPECT_NEAR(files.train, train, 0.02 * train);
    EXPECT_NEAR(files.validate, validate, 0.02 * validate);
    // The fit moved something: the model as it was is far off.
    const auto before = problem.Residuals(problem.Start(), problem.AllLogs());
    EXPECT_GT(problem.PooledRms(before, problem.TrainLogs()), 2 * train);
  }
};

const std::string kScaled =
    "parameters:\n"
    "  - {name: k, target: 'actuator:servo', attribute: kp, operation: scale, lower: 0.5, upper: "
    "2}\n"
    "  - {name: b, target: 'joint:hinge', attribute: damping, operation: add, lower: -0.05, upper: "
    "0.5}\n"
    "  - {name: tau_c, target: 'plugin:dry', attribute: tau_c, lower: 0, upper: 1}\n";

TEST_F(ExtensionTest, ReproducesTheFitWithSettingsOfLogsAndAScaledParameter) {
  AddTrials();
  const ModelSpec system = Model(CoulombInstance(0.02));
  const Experiment e = ReadExperiment(kScaled);
  ExpectSameErrors(Problem(e, system));
}

TEST_F(ExtensionTest, ReproducesParametersPerCondition) {
  AddTrials();
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: k, target: 'actuator:servo', attribute: kp, operation: scale, lower: 0.5, upper: "
      "2, per: condition}\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1}\n");
  ExpectSameErrors(Problem(e, system));
}

// How each log was measured stands in its line.
TEST_F(ExtensionTest, ReproducesABiasOfEachLog) {
  AddTrial(Pendulum(), "first", 0, "use: train");
  AddTrial(Pendulum(), "other", 1, "use: train");
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: own, target: 'sensor:angle', attribute: bias, initial: 0, lower: -1, upper: 1, "
      "per: log}\n");
  const Problem problem(e, system);
  Problem::Vector x = problem.Start();
  x[0] = 0.1, x[1] = -0.2;
  ExpectTheSameErrors(problem, x);
}

TEST_F(ExtensionTest, ReproducesFrozenParameters) {
  AddTrials();
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: k, target: 'actuator:servo', attribute: kp, operation: scale, initial: 1.2, "
      "lower: "
      "0.5, upper: 2, frozen: true}\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1}\n");
  Problem problem(e, system);
  const Fit fit = FitParameters(problem, problem.Start(), problem.TrainLogs());
  const double train =
      problem.PooledRms(problem.Residuals(fit.x, problem.AllLogs()), problem.TrainLogs());
  EXPECT_NEAR(ErrorsOf(Extend(problem, problem.system(), fit.x, folder_ / "out"), "out").train,
              train, 0.02 * train);
}

// The weight hangs on the mass that the log knows; written twice it would count twice.
TEST_F(ExtensionTest, ReproducesAMassAndAWeightOnItThatALogSets) {
  Pendulum p;
  p.tip = 0.04, p.payload = 0.05;
  AddTrial(p, "loaded", 0, "use: train, set: {'body:tip': {mass: 0.04, point_mass: 0.05}}");
  AddTrial(p, "again", 1, "use: validate, set: {'body:tip': {point_mass: 0.05, mass: 0.04}}");
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: b, target: 'joint:hinge', attribute: damping, lower: 0, upper: 1}\n");
  const Problem problem(e, system);
  ExpectTheSameErrors(problem, problem.Start());
}

TEST_F(ExtensionTest, ReproducesWhatScalesAnActuatorsForce) {
  AddTrial(Pendulum(), "weak", 0,
           "use: train, condition: low, set: {'actuator:servo': {force_scale: 0.6, kp: 4}}");
  AddTrial(Pendulum(), "full", 1, "use: train, condition: high");
  AddTrial(Pendulum(), "again", 2, "use: validate, condition: low");
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: own, target: 'actuator:servo', attribute: force_scale, operation: scale, "
      "initial: 0.8, lower: 0, upper: 2, per: condition}\n");
  const Problem problem(e, system);
  Problem::Vector x = problem.Start();
  x[1] = 0.7;
  ExpectTheSameErrors(problem, x);
}

// A weight on all logs is in the model file, one of a log's own in its line, on whatever it sets.
// The effect is absent where there is no limit, which no file can say.
TEST_F(ExtensionTest, ReproducesALimitOfAnActuatorsForce) {
  AddTrials();
  const Experiment e = ReadExperiment(
      "parameters: [{name: limit, target: 'actuator:servo', attribute: "
      "'effect:torque_limit.limit', initial: 1.5, lower: 0.01, upper: 100}]\n");
  const Problem problem(e, Model());
  ExpectTheSameErrors(problem, Problem::Vector::Constant(1, 1.2));
}

TEST_F(ExtensionTest, ReproducesWeightsOfAllLogsBesideThoseOfOne) {
  AddTrial(Pendulum(), "bare", 0, "use: train");
  AddTrial(Pendulum(), "loaded", 1, "use: train, set: {'body:tip': {point_mass: 0.05}}");
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(
      "parameters:\n"
      "  - {name: w, target: 'body:tip', attribute: point_mass, initial: 0.03, lower: 0, upper: "
      "1}\n");
  const Problem problem(e, system);
  const auto x = problem.Start();
  const auto r = problem.Residuals(x, problem.AllLogs());
  const ExtendedModel extension = Extend(problem, problem.system(), x, folder_ / "out");
  EXPECT_NEAR(ErrorsOf(extension, "out").train, problem.PooledRms(r, problem.AllLogs()), 1e-9);
  // And so is where a fit of these files begins.
  const Experiment again = Experiment::Read(folder_ / "out/extended.yaml");
  const Problem on(again, ModelSpec::Load(folder_ / "out/extended.xml"));
  const auto s = on.Residuals(on.Start(), on.AllLogs());
  EXPECT_NEAR(on.PooledRms(s, on.AllLogs()), problem.PooledRms(r, problem.AllLogs()), 1e-9);
}

// Simulations without contacts go without it.
TEST_F(ExtensionTest, KeepsGeomsThatOnlyShow) {
  AddTrial(Pendulum(), "soft0", 0, "use: train");
  std::string xml = Pendulum().Xml(CoulombInstance(0.1));
  const std::string end = "</body>";
  xml.insert(xml.find(end), R"(<geom name="skin" size="0.02" contype="0" conaffinity="0"/>)");
  const ModelSpec system = ModelSpec::Load(Write("model.xml", xml));
  const Experiment e = ReadExperiment(kScaled);
  const Problem problem(e, system);
  const ExtendedModel extension = Extend(problem, system, problem.Start(), folder_ / "out");
  EXPECT_THAT(extension.xml, HasSubstr("name=\"skin\""));
  IdentifyOptions options;
  options.folder = folder_ / "out";
  EXPECT_THAT(Identify(e, system, options).fitted.xml, HasSubstr("name=\"skin\""));
}

TEST_F(ExtensionTest, KeepsWindowsTrialsOutputsAndFolds) {
  AddTrials();
  const ModelSpec system = Model(CoulombInstance(0.1));
  std::filesystem::copy_file(folder_ / "soft0.csv", folder_ / "again.csv");
  logs_ += "  - {file: again.csv, use: validate, trial: again, window: [0, 0.9]}\n";
  const Experiment e = ReadExperiment(kScaled + "folds: [trial, condition]\nloss: {soft_l1: 3}\n",
                                      ", sigma: 0.001, weight: 2, bias: 0.01, delay: 0.002");
  const Problem problem(e, system);
  MakeFolder(folder_ / "out");
  const ExtendedModel extension =
      Extend(problem, problem.system(), problem.Start(), folder_ / "out");
  WriteFile(folder_ / "out" / "extended.xml", extension.xml);
  WriteFile(folder_ / "out" / "extended.yaml", extension.yaml);
  const Experiment again = Experiment::Read(folder_ / "out" / "extended.yaml");
  ASSERT_EQ(again.logs.size(), e.logs.size());
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    EXPECT_EQ(again.logs[l].label, e.logs[l].label);
    EXPECT_EQ(again.logs[l].trial, e.logs[l].trial);
    EXPECT_EQ(again.logs[l].condition, e.logs[l].condition);
    EXPECT_EQ(again.logs[l].train, e.logs[l].train);
    EXPECT_EQ(again.logs[l].time, e.logs[l].time);
  }
  EXPECT_EQ(again.outputs[0].measurement, e.outputs[0].measurement);
  EXPECT_EQ(again.outputs[0].sigma, e.outputs[0].sigma);
  EXPECT_EQ(again.outputs[0].weight, e.outputs[0].weight);
  EXPECT_EQ(again.folds, e.folds);
  EXPECT_EQ(again.soft, e.soft);
  EXPECT_THAT(again.parameters, SizeIs(3));
}

class Applied : public ExtensionTest, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Candidates, Applied,
                         ::testing::Values("payload", "stiffness", "stribeck", "load_friction",
                                           "backlash"),
                         [](const auto& info) { return std::string(info.param); });

// A native edit, a signal, and laws that take the place of the model's Coulomb friction.
TEST_P(Applied, GivesTheSameModelAsTheExtensionWithTheSameErrors) {
  AddTrials(0.05);
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(kScaled + "candidates: [" + GetParam() + "]\n");
  std::vector<std::string> skipped;
  const Problem null(e, system);
  const auto candidates = MakeCandidates(e, {&system}, SizesOf(null, null.Start()), skipped);
  ASSERT_THAT(candidates, SizeIs(Gt(0u))) << (skipped.empty() ? "" : skipped.front());
  for (const Hypothesis& h : candidates) {
    SCOPED_TRACE(h.Name());
    const Problem problem(e, h.system, h.extra);
    auto x = problem.Start();
    x[0] = 1.15, x[1] = 0.04, x[2] = 0.09;
    const ExtendedModel extension = Extend(problem, problem.system(), x, folder_ / "out");
    const nlohmann::json json{
        {"extension", ChangesJson(problem.CommonChanges(x), {{h.instance, h.replaces}})}};
    EXPECT_EQ(ApplyJson(system, nlohmann::json::parse(json.dump()), "diagnosis.json"),
              extension.xml);
    const double train =
        problem.PooledRms(problem.Residuals(x, problem.AllLogs()), problem.TrainLogs());
    EXPECT_NEAR(ErrorsOf(extension, "out").train, train, 0.02 * train);
  }
}

TEST_F(ExtensionTest, ACandidateBesideAllIsTriedOnce) {
  AddTrials(0.05);
  const ModelSpec system = Model(CoulombInstance(0.1));
  std::vector<std::string> skipped;
  const auto count = [&](const std::string& candidates) {
    const Experiment e = ReadExperiment(kScaled + "candidates: [" + candidates + "]\n");
    const Problem null(e, system);
    return MakeCandidates(e, {&system}, SizesOf(null, null.Start()), skipped).size();
  };
  EXPECT_EQ(count("all, payload"), count("all"));
  EXPECT_GT(count("payload, backlash"), count("payload"));
}

TEST_F(ExtensionTest, AnInputIsLookedForInItsOwnUnit) {
  AddTrials(0.05);
  const ModelSpec system = Model(CoulombInstance(0.1));
  const Experiment e = ReadExperiment(kScaled + "candidates: [input_offset]\n");
  Experiment pascal = e;
  for (Log& log : pascal.logs) {
    for (double& u : log.input.front()) u *= 1e5;
  }
  const Problem null(e, system);
  const Sizes sizes = SizesOf(null, null.Start());
  std::vector<std::string> skipped;
  const auto reach = [&](const Experiment& one) {
    return MakeCandidates(one, {&system}, sizes, skipped).at(0).extra.at(0).upper;
  };
  EXPECT_NEAR(reach(pascal), 1e5 * reach(e), 1e-6 * reach(pascal));
}

TEST_F(ExtensionTest, ApplyNamesWhatIsMissing) {
  const ModelSpec system = Model();
  for (const char* text : {"{}", R"({"extension": {"changes": []}})"}) {
    try {
      ApplyJson(system, nlohmann::json::parse(text), "some.json");
      FAIL() << text;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("some.json"));
      EXPECT_EQ(error.exit_code(), 2);
    }
  }
  const auto json = nlohmann::json::parse(
      R"({"extension": {"instances": [], "changes": [{"target": "joint:elbow",
          "attribute": "damping", "value": 1, "operation": "set"}]}})");
  try {
    ApplyJson(system, json, "some.json");
    FAIL() << "there is no elbow";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("elbow"));
  }
}

}  // namespace
}  // namespace continuum
