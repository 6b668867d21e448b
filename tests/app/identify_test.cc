#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

class IdentifyPath : public testing::AppBench {
 protected:
  nlohmann::json Identify(std::vector<std::string> more, const std::string& says) const {
    more.insert(more.begin(), {"identify", "experiment.yaml", "--out", "out"});
    const auto f = Run(more);
    EXPECT_EQ(f.exit_code, 0) << f.err;
    EXPECT_THAT(f.err, HasSubstr(says));
    return nlohmann::json::parse(testing::Scratch::Text(files_ / "out/fit.json"));
  }
};

TEST_F(IdentifyPath, IsSmoothWhereTheModelIs) {
  const auto fit = Identify({}, "path: smooth");
  EXPECT_EQ(fit["path"], "smooth");
  EXPECT_EQ(fit["at_step"]["timestep"], 0.01);
  EXPECT_EQ(fit["at_step"]["parameters"]["b"], fit["parameters"][0]["value"]);
}

TEST_F(IdentifyPath, GivesParametersForTheModelsStep) {
  const auto fit = Identify({"--for-step"}, "path: smooth");
  const double smooth = fit["parameters"][0]["value"], stepped = fit["at_step"]["parameters"]["b"];
  EXPECT_NE(smooth, stepped);
  EXPECT_NEAR(smooth, stepped, 0.1 * smooth);
  const auto alone = Identify({"--path", "stepped"}, "path: stepped");
  EXPECT_NEAR(alone["parameters"][0]["value"].get<double>(), stepped, 1e-3 * stepped);
}

TEST_F(IdentifyPath, IsSteppedWithDryFrictionAndSaysWhy) {
  Spoil("model.xml", "damping=\"0.1\"", "damping=\"0.1\" frictionloss=\"0.001\"");
  const auto fit = Identify({}, "no smooth path: joint 'hinge' has dry friction");
  EXPECT_EQ(fit["path"], "stepped");
  EXPECT_FALSE(fit.contains("at_step"));
}

TEST_F(IdentifyPath, TellsOfGapsInALogFirst) {
  std::string log = "t,u,q\n";
  for (int k = 0; k < 40; ++k)  // nothing between 1 and 2 s
    if (k <= 10 || k >= 20) log += fmt::format("{},0.1,{}\n", 0.1 * k, 0.001 * k);
  files_.Write("log.csv", log);
  Identify({}, "log check: log: the clock has gaps after 1 of");
}

// A joint that does not move is a measurement too.
TEST_F(IdentifyPath, NamesAChannelWithoutVarianceAndFitsBesideIt) {
  files_.Write("log.csv", "t,u,q,z\n0,0.1,0,0.1\n0.1,0.1,0.01,0.1\n0.2,0.1,0.03,0.1\n");
  Spoil("experiment.yaml", "sensor: angle}",
        "sensor: angle}, {column: z, unit: mm, sensor: \"tip_pos[1]\"}");
  const auto fit = Identify({}, "log check: log, column 'z': no variance: every value is 0.1 mm");
  const auto& z = fit["error"]["logs"][0]["channels"][1];
  EXPECT_EQ(z["channel"], "z");
  EXPECT_TRUE(z["nrmse"].is_number() && z["fit_percent"].is_number());
  EXPECT_TRUE(fit["error"]["train"].is_number());
}

TEST_F(IdentifyPath, IsRefusedWhereItCannotGo) {
  Spoil("model.xml", "damping=\"0.1\"", "damping=\"0.1\" frictionloss=\"0.001\"");
  ExpectRefused({"identify", "experiment.yaml", "--path", "smooth", "--out", "out"},
                {"--path smooth", "'hinge' has dry friction"});
}

// Four parameters of the motion, one of a sensor, and a log on which the link touches the floor.
TEST_F(IdentifyPath, ListsHowEachDerivativeIsMadeAndWhy) {
  Spoil("model.xml", "<worldbody>",
        "<worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\" pos=\"0 0 -0.33\"/>"
        "<body name=\"falls\" pos=\"1 0 0\"><joint name=\"down\" type=\"slide\" axis=\"0 0 1\"/>"
        "<geom size=\"0.05\" contype=\"0\" conaffinity=\"0\"/></body>");
  files_.Write("long.csv", "t,u,q\n0,0.1,0\n0.1,0.1,0.01\n0.2,0.1,0.03\n0.4,0.1,0.06\n");
  Spoil("experiment.yaml", "upper: 1}]",
        "upper: 1},\n  {name: k, target: \"joint:hinge\", attribute: stiffness, lower: 0, upper: "
        "9},\n"
        "  {name: m, target: \"body:link\", attribute: mass, lower: 0.1, upper: 9},\n"
        "  {name: tip, target: \"body:falls\", attribute: \"pos[0]\", lower: -1, upper: 2},\n"
        "  {name: bias, target: \"sensor:angle\", attribute: bias, lower: -1, upper: 1}]");
  Spoil("experiment.yaml", "{file: log.csv}", "{file: log.csv}, {file: long.csv}");
  const auto f = Run({"identify", "experiment.yaml", "--derivatives", "--path", "stepped"});
  EXPECT_EQ(f.exit_code, 0) << f.err;
  EXPECT_THAT(f.out, HasSubstr("b          closed form\n"));
  EXPECT_THAT(f.out, HasSubstr("tip        single steps    body_pos differs\n"));
  EXPECT_THAT(f.out, HasSubstr("bias       same motion     the motion stays the same\n"));
  EXPECT_EQ(Listing().size(), 6u);  // nothing is written
  Spoil("model.xml", "0 0 -0.33", "0 0 -0.3");
  const auto touched = Run({"identify", "experiment.yaml", "--derivatives", "--path", "stepped"});
  EXPECT_THAT(touched.out, HasSubstr("k          by differences  a contact acts at "));
  const auto smooth = Run({"identify", "experiment.yaml", "--derivatives"});
  EXPECT_THAT(smooth.out, HasSubstr("path: stepped"));
  const auto few = Run({"identify", "experiment.yaml", "--derivatives", "--path", "stepped",
                        "--differences", "1e-6"});
  EXPECT_THAT(few.out, HasSubstr("k          by differences  as asked for\n"));
  ExpectRefused({"identify", "experiment.yaml", "--derivatives", "--method", "pso"},
                {"--derivatives", "--method lm", "pso"});
}

TEST_F(IdentifyPath, FromSeveralStartsSaysWhereEachEnds) {
  const auto fit = Identify({"--starts", "3", "--seed", "5"}, "fits from several starts (3 steps)");
  ASSERT_EQ(fit["starts"].size(), 3u);
  for (const auto& start : fit["starts"])
    EXPECT_GE(start["cost"].get<double>(), fit["cost"].get<double>());
  EXPECT_NE(fit["starts"][1]["parameters"]["b"], fit["starts"][2]["parameters"]["b"]);
  const std::string report = testing::Scratch::Text(files_ / "out/report.html");
  EXPECT_THAT(report, AllOf(HasSubstr("cost at its end"), HasSubstr("random 2")));
  ExpectRefused({"identify", "experiment.yaml", "--starts", "3", "--method", "pso", "--out", "no"},
                {"--starts", "--method lm", "pso"});
}

TEST_F(IdentifyPath, GoesOnFromAnEarlierFit) {
  const auto short_one = Identify({"--iterations", "50"}, "\nfit\n");
  const auto on = Identify({"--from", "out/fit.json"}, "\nfit\n");
  EXPECT_EQ(on["trace"][0], short_one["cost"]);
  EXPECT_LE(on["iterations"].get<int>(), 2);
  files_.Write("other.json", R"({"parameters": [{"name": "mass", "value": 1}]})");
  ExpectRefused({"identify", "experiment.yaml", "--from", "other.json", "--out", "no"},
                {"other.json", "parameter 'b'"});
  files_.Write("broken.json", "{");
  ExpectRefused({"identify", "experiment.yaml", "--from", "broken.json", "--out", "no"},
                {"broken.json", "JSON"});
  files_.Write("beyond.json", R"({"parameters": [{"name": "b", "value": 1e6}]})");
  ExpectRefused({"identify", "experiment.yaml", "--from", "beyond.json", "--out", "no"},
                {"beyond.json: parameter 'b'", "bounds", "experiment.yaml:", "1e+06"});
}

// With more logs than the page has colours; the joint and the tip beside each other.
TEST_F(IdentifyPath, ReportsWhatRemainsOfEveryChannelAndEveryLog) {
  std::string logs = "logs:\n";
  for (int l = 0; l < 8; ++l) {
    std::string log = "t,u,q,x\n";
    for (int k = 0; k < 40; ++k)
      log += fmt::format("{},{},{},{}\n", 0.05 * k, 0.1 + 0.1 * ((k / 10 + l) % 3),
                         0.001 * k + 0.01 * (k % 3), 0.3 * (k % 2));
    files_.Write(fmt::format("log{}.csv", l), log);
    logs += fmt::format("  - {{file: log{}.csv}}\n", l);
  }
  Spoil("experiment.yaml", "logs: [{file: log.csv}]\n", logs);
  Spoil("experiment.yaml", "sensor: angle}",
        "sensor: angle}, {column: x, unit: mm, sensor: \"tip_pos[0]\"}");
  Identify({}, "path:");
  const std::string page = testing::Scratch::Text(files_ / "out/report.html");
  for (const char* title : {"q: autocorrelation", "x: autocorrelation", "q: over input u",
                            "x: over input u", "mean of 8 logs, lowest to highest"})
    EXPECT_THAT(page, HasSubstr(title));
  for (int l = 0; l < 8; ++l)
    EXPECT_THAT(page, HasSubstr(fmt::format("<td class=\"\">log{}</td><td class=\"number\">", l)));
}

TEST_F(IdentifyPath, NeedsAParameterThatIsFree) {
  Spoil("experiment.yaml", "name: b,", "name: b, frozen: true,");
  ExpectRefused({"identify", "experiment.yaml", "--out", "no"},
                {"experiment.yaml: parameters", "frozen ones only"});
}

TEST_F(IdentifyPath, SaysWhereAParameterStartsAtItsBoundAndWhatTheModelsStepsGive) {
  Spoil("model.xml", "damping=\"0.1\"", "damping=\"0.01\"");
  const auto f = Run({"identify", "experiment.yaml", "--out", "out"});
  EXPECT_THAT(f.out, HasSubstr("; it starts at its lower bound)"));
  EXPECT_THAT(f.out, HasSubstr("\nas the model steps: error "));
}

TEST_F(IdentifyPath, FitsAValueOfEachLogsOwnWhereItSeesAllOfThem) {
  files_.Write("held.csv", testing::kLog);
  Spoil("experiment.yaml", "{file: log.csv}", "{file: log.csv}, {file: held.csv, use: validate}");
  Spoil("experiment.yaml", "upper: 1}", "upper: 1, per: log}");
  ExpectRefused({"identify", "experiment.yaml", "--out", "no"},
                {"experiment.yaml:6: parameters[0].per", "identify --all", "'held'"});
  EXPECT_EQ(Run({"replay", "experiment.yaml", "--out", "as_it_stands"}).exit_code, 0);
  const auto fit = Identify({"--all", "--path", "stepped"}, "path: stepped");
  EXPECT_EQ(fit["parameters"][0]["name"], "b[held]");
  EXPECT_EQ(fit["parameters"][0]["standard_error"], fit["parameters"][1]["standard_error"]);
  ASSERT_EQ(Run({"replay", "out/fitted.yaml", "--out", "replayed"}).exit_code, 0);
  const auto replayed =
      nlohmann::json::parse(testing::Scratch::Text(files_ / "replayed/errors.json"));
  for (const char* use : {"train", "validate"}) {
    const double error = fit["error"][use];
    EXPECT_NEAR(replayed[use].get<double>(), error, 1e-9 * error) << use;
  }
}

TEST_F(IdentifyPath, TracesEveryIterationAndTakesNoMoreThanAllowed) {
  Spoil("model.xml", "damping=\"0.1\"", "damping=\"0.1\" frictionloss=\"0.001\"");
  for (const int most : {1, 3}) {
    const auto f =
        Run({"identify", "experiment.yaml", "--iterations", std::to_string(most), "--out", "out"});
    const auto fit = nlohmann::json::parse(testing::Scratch::Text(files_ / "out/fit.json"));
    const int taken = fit["iterations"];
    EXPECT_LE(taken, most);
    EXPECT_EQ(std::ssize(fit["trace"]), taken + 1);
    EXPECT_THAT(f.out, HasSubstr(fmt::format("\n{} iterations, ", taken)));
  }
}

// Values of single logs, starts, sensors and the clock are not the model's: the experiment has
// them.
TEST_F(IdentifyPath, LeavesAnExperimentThatReplaysTheFit) {
  std::string other = "t,u,q\n";
  for (int k = 0; k < 30; ++k)
    other += fmt::format("{},{},{}\n", 0.1 * k, k < 15 ? 0.2 : 0., 0.1 + 0.01 * (k % 7));
  files_.Write("other.csv", other);
  files_.Write("experiment.yaml", R"(format: 1
model: model.xml
time: {column: t, unit: s}
start: estimate
inputs: [{column: u, unit: Nm, actuator: motor}]
outputs: [{column: q, unit: rad, sensor: angle}]
parameters:
  - {name: b, target: "joint:hinge", attribute: damping, lower: 0.01, upper: 1, per: condition}
  - {name: shown, target: "sensor:angle", attribute: bias, initial: 0, lower: -1, upper: 1}
logs:
  - {file: other.csv, condition: cold, window: [0, 1.2]}
  - {file: other.csv, condition: warm, trial: later, window: [1.2, 2.9]}
)");
  const auto fit = Identify({"--path", "stepped"}, "path: stepped");
  EXPECT_EQ(fit["fitted_experiment"], "fitted.yaml");
  const auto f = Run({"replay", "out/fitted.yaml", "--out", "replayed"});
  ASSERT_EQ(f.exit_code, 0) << f.err;
  const auto replayed =
      nlohmann::json::parse(testing::Scratch::Text(files_ / "replayed/errors.json"));
  const double error = fit["error"]["train"];
  EXPECT_NEAR(replayed["train"].get<double>(), error, 1e-9 * error);
}

}  // namespace
}  // namespace continuum
