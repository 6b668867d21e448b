// ctest labels: slow
#include <gtest/gtest.h>

#include <algorithm>

#include "models/tdcr/calibrate.h"
#include "models/tdcr/disks.h"
#include "models/tdcr/hybrid.h"
#include "models/tdcr/synthetic.h"

namespace continuum::tdcr {
namespace {

Robot Nominal() { return ReadRobot(Yaml::Read(CONTINUUM_SOURCE "/models/tdcr/tdcr.yaml")); }

// A set of the paper's kind, calibrated as before every training.
struct Calibrated {
  Calibrated(int set, unsigned seed)
      : experiment(Synthesize(Nominal(), set, seed)),
        calibration(Calibrate(experiment.nominal, Method::kEas, Pairs(), "synthetic")) {
    for (Case& c : experiment.cases) c.loads.mu = calibration.robot.mu;
  }
  std::vector<Pair> Pairs() const {
    return Match(experiment.cases, experiment.measured, "synthetic");
  }
  Hybrid Train(std::optional<double> penalty) const {
    return tdcr::Train(calibration.robot, Method::kEas, Pairs(), "synthetic", penalty);
  }
  Experiment experiment;
  Calibration calibration;
};

TEST(TdcrHybrid, CrossValidationKeepsTheHangingSetFromBeingLearntByHeart) {
  for (const unsigned seed : {2u, 3u, 2021u}) {
    const Calibrated set(1, seed);
    const Hybrid printed = set.Train(0), hybrid = set.Train(std::nullopt);
    const Spread before = *Statistics(set.calibration.tips.test);
    const Spread after = *Statistics(hybrid.tips.test);
    EXPECT_GT(hybrid.penalty, 0) << seed;
    EXPECT_LT(Statistics(printed.tips.train)->mean, Statistics(hybrid.tips.train)->mean) << seed;
    ASSERT_TRUE(hybrid.left_out && printed.left_out);
    EXPECT_LT(Statistics(hybrid.left_out->tips)->mean, Statistics(printed.left_out->tips)->mean)
        << seed;
    EXPECT_FALSE(hybrid.poor()) << seed;
    EXPECT_LT(after.mean, 0.9 * before.mean) << seed;
    EXPECT_LT(after.max, before.max) << seed;
  }
}

// Shapes that are what the correction can say: nothing is to be held back then.
TEST(TdcrHybrid, ATrueLinearCorrectionIsFoundAgain) {
  Experiment e = Synthesize(Nominal(), 1, 7);
  Hybrid truth;
  truth.features = {"tau_1", "fx", "T1", "T2"};
  truth.weights.resize(4, 6);
  truth.weights << 0.1, 0, 0.2, 0, 0.1, 0, 2, 0, 1, 0, 0, 3, 0.3, 0.1, 0, 0.2, 0, 0.5, 0, -0.2, 0.4,
      0, 0.1, 0;
  for (std::size_t i = 0; i < e.cases.size(); ++i) {
    Solution s = SolveCase(e.nominal, e.cases[i].loads, Method::kEas);
    Apply(truth, e.nominal, e.cases[i].loads, s);
    e.measured[i].disks = s.disks;
  }
  const Hybrid hybrid = Train(e.nominal, Method::kEas, Match(e.cases, e.measured, "synthetic"),
                              "synthetic", std::nullopt);
  EXPECT_LT(Statistics(hybrid.tips.test)->max, 0.01);  // % of L; uncorrected some 10
  for (std::size_t i = 0; i < truth.features.size(); ++i) {
    const auto at = std::find(hybrid.features.begin(), hybrid.features.end(), truth.features[i]);
    ASSERT_NE(at, hybrid.features.end());
    const auto row = at - hybrid.features.begin();
    const auto difference = hybrid.weights.row(row) - truth.weights.row(static_cast<int>(i));
    EXPECT_LT(difference.norm(), 0.01 * truth.weights.row(static_cast<int>(i)).norm());
  }
}

TEST(TdcrHybrid, AHeavyPenaltyLeavesTheModelAsItWas) {
  const Calibrated set(2, 5);
  const Hybrid hybrid = set.Train(1e6);
  EXPECT_LT(hybrid.weights.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_NEAR(Statistics(hybrid.tips.train)->mean, Statistics(set.calibration.tips.train)->mean,
              1e-3);
}

// The rod's disks are not quite those of arcs with its curvatures: only the correction moves them.
TEST(TdcrHybrid, OfTheRodChangesNothingWithoutWeightsAndImprovesWithThem) {
  const Experiment e = Synthesize(Nominal(), 2, 5);
  const auto pairs = Match(e.cases, e.measured, "synthetic");
  const Calibration c = Calibrate(e.nominal, Method::kCrt, pairs, "synthetic");
  const Hybrid none = Train(c.robot, Method::kCrt, pairs, "synthetic", 1e9);
  EXPECT_NEAR(Statistics(none.tips.test)->mean, Statistics(c.tips.test)->mean, 1e-3);
  const Hybrid hybrid = Train(c.robot, Method::kCrt, pairs, "synthetic", std::nullopt);
  EXPECT_LT(Statistics(hybrid.tips.test)->mean, 0.8 * Statistics(c.tips.test)->mean);
}

// The line of a corrected rod ends at its corrected tip: arcs of the integrator's steps bend by
// what their arc between disks does.
TEST(TdcrHybrid, TheLineOfACorrectedRodFollowsItsDisks) {
  const Robot robot = Nominal();
  Hybrid hybrid;
  hybrid.method = Method::kCrt;
  hybrid.features = {"T1"};
  hybrid.weights.resize(1, 6);
  hybrid.weights << 0.4, 0.2, 0.1, -0.3, 0.5, 0.2;  // [1/(m N)]
  Loads loads = NoLoads(robot);
  loads.tension = {4, 1, 0};
  Solution s = SolveCase(robot, loads, Method::kCrt);
  const Eigen::Vector3d before = s.disks.rightCols<1>();
  Apply(hybrid, robot, loads, s);
  EXPECT_GT((s.disks.rightCols<1>() - before).norm(), 0.02 * robot.length);
  EXPECT_LT((s.line.points.rightCols<1>() - s.disks.rightCols<1>()).norm(), 2e-3 * robot.length);
}

}  // namespace
}  // namespace continuum::tdcr
