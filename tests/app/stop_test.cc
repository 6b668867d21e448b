#include <cmath>

#include <nlohmann/json.hpp>

#include "bench.h"

namespace continuum {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Scratch;

// Jobs that would take hours: a log of 1e9 time steps, or a fit to 3e5.
class Stop : public testing::AppBench {
 protected:
  void SetUp() override {
    std::string text = "t,u,q\n";
    for (int k = 0; k < 20; ++k) text += std::to_string(k * 5e5) + ",0.1,0.1\n";
    files_.Write("log.csv", text);
  }
  void WriteLongLog() const {
    std::string text = "t,u,q\n";
    for (int k = 0; k < 3000; ++k) {
      const double t = 0.1 * k;
      text += std::to_string(t) + "," + std::to_string(std::sin(t)) + "," +
              std::to_string(0.02 * std::sin(1.7 * t)) + "\n";
    }
    files_.Write("log.csv", text);
  }
  Finished Interrupt(std::vector<std::string> arguments, const std::string& after,
                     int signal = SIGINT) const {
    arguments.insert(arguments.begin(), CONTINUUM_EXECUTABLE);
    return testing::RunProcess(std::move(arguments), files_.folder(), 60, {after, signal});
  }
  // It says so, exits as a job that failed, and leaves no file.
  void ExpectStops(const std::vector<std::string>& arguments, const std::string& after,
                   int signal = SIGINT) const {
    const auto before = Listing();
    const Finished f = Interrupt(arguments, after, signal);
    EXPECT_EQ(f.signal, 0) << "it died of the signal, or did not stop";
    EXPECT_EQ(f.exit_code, 1) << f.err;
    EXPECT_THAT(f.err, HasSubstr("continuum: interrupted"));
    EXPECT_EQ(Listing(), before);
  }
};

TEST_F(Stop, EndsAReplay) { ExpectStops({"replay", "experiment.yaml", "--out", "out"}, "replay"); }

TEST_F(Stop, EndsAReplayThatIsTerminated) {
  ExpectStops({"replay", "experiment.yaml", "--out", "out"}, "replay", SIGTERM);
}

TEST_F(Stop, EndsAFilm) { ExpectStops({"render", "experiment.yaml", "--out", "x.mp4"}, "film"); }

TEST_F(Stop, OfAFitLeavesTheBestSoFar) {
  WriteLongLog();
  const Finished f = Interrupt({"identify", "experiment.yaml", "--path", "stepped", "--out", "out"},
                               "fit of segments");
  EXPECT_EQ(f.signal, 0);
  EXPECT_EQ(f.exit_code, 1) << f.err;
  EXPECT_THAT(f.err, HasSubstr("interrupted"));
  EXPECT_THAT(Scratch::Text(files_ / "out/fit.json"), HasSubstr("\"parameters\""));
}

TEST_F(Stop, OfAFitSaysThatIntervalsAndCorrelationsAreNotKnown) {
  WriteLongLog();
  Spoil("experiment.yaml", "upper: 1}",
        "upper: 1}, {name: m, target: \"body:link\", attribute: mass, lower: 0.5, upper: 2}");
  const Finished f = Interrupt({"identify", "experiment.yaml", "--path", "stepped", "--out", "out"},
                               "fit of segments");
  EXPECT_THAT(f.out, HasSubstr("interval not computed"));
  const auto fit = nlohmann::json::parse(Scratch::Text(files_ / "out/fit.json"));
  EXPECT_EQ(fit["intervals"], "not computed: interrupted");
  EXPECT_TRUE(fit["parameters"][1]["standard_error"].is_null());
  EXPECT_TRUE(fit["correlation"][0][1].is_null());
  const std::string page = Scratch::Text(files_ / "out/report.html");
  EXPECT_THAT(page, HasSubstr("Intervals and correlations were not computed: interrupted"));
  EXPECT_THAT(page, Not(HasSubstr("Correlation of the parameters")));
}

// The second generation of 20 is not waited for, nor are intervals.
TEST_F(Stop, OfASwarmIsHeardBetweenItsParticles) {
  WriteLongLog();
  Spoil("model.xml", "timestep=\"0.01\"", "timestep=\"0.002\"");
  const Finished f = Interrupt(
      {"identify", "experiment.yaml", "--path", "stepped", "--method", "pso", "--out", "out"},
      "particle swarm");
  EXPECT_EQ(f.exit_code, 1) << f.err;
  EXPECT_THAT(f.err, HasSubstr("interrupted"));
  const auto fit = nlohmann::json::parse(Scratch::Text(files_ / "out/fit.json"));
  EXPECT_LT(fit["evaluations"].get<int>(), 35);
  EXPECT_EQ(fit["parameters"][0]["ci95"], nlohmann::json({nullptr, nullptr}));
}

}  // namespace
}  // namespace continuum
