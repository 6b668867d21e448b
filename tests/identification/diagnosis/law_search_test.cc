#include "identification/diagnosis/law_search.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Pendulum;

// Logs of a pendulum on a torque motor whose joint feels one law more than its model, by symplectic
// Euler at 20 us:
//
//   J q'' = u − b q' − M g l sin q − τ(q, q', u, t)
class LawSearchTest : public testing::Bench {
 protected:
  static constexpr double kNoise = 2e-4;  // [rad]
  static constexpr std::size_t kRows = 400;
  using Torque = std::function<double(double q, double v, double u, double t)>;

  static double Motor(int trial, double t) {
    const double wave[] = {1.7, 2.9, 2.1, 3.7}, fast[] = {5.1, 7.3, 9.1, 4.3};
    return std::min(1.0, t) *
           (0.35 * std::sin(wave[trial] * t) + 0.15 * std::sin(fast[trial] * t + 1));
  }

  static std::vector<double> Run(int trial, const Torque& law) {
    constexpr double h = 2e-5, g = 9.81;
    const Pendulum p;
    const double mass = p.bob + p.tip, j = p.inertia + mass * p.length * p.length;
    double q = 0, v = 0, t = 0;
    std::vector<double> angle;
    for (std::size_t row = 0; row < kRows; ++row) {
      angle.push_back(q);
      const double u = Motor(trial, testing::kPeriod * static_cast<double>(row));
      for (long k = 0; k < std::lround(testing::kPeriod / h); ++k, t += h) {
        v += h * (u - p.damping * v - mass * g * p.length * std::sin(q) - law(q, v, u, t)) / j;
        q += h * v;
      }
    }
    return angle;
  }

  std::vector<SuggestedLaw> Ask(const Torque& law) {
    for (int trial = 0; trial < 4; ++trial) {
      std::vector<double> u;
      for (std::size_t row = 0; row < kRows; ++row)
        u.push_back(Motor(trial, testing::kPeriod * static_cast<double>(row)));
      AddLog("t" + std::to_string(trial), "trial: t" + std::to_string(trial) + ", use: train", u,
             testing::Noisy(Run(trial, law), kNoise, 0, static_cast<unsigned>(trial + 1)));
    }
    const Experiment e = ReadExperiment(
        "parameters: [{name: damping, target: \"joint:*\", attribute: damping, operation: scale, "
        "initial: 1, lower: 0.2, upper: 5}]\n");
    std::string xml = Pendulum().Xml();
    const std::string servo = "<position name=\"servo\" joint=\"hinge\" kp=\"5\"/>";
    xml.replace(xml.find(servo), servo.size(), "<motor name=\"servo\" joint=\"hinge\"/>");
    const ModelSpec system = ModelSpec::Load(Write("model.xml", xml));
    const Problem base(e, system);
    const EquationErrors view(base, base.Start(), base.TrainLogs());
    std::vector<Fold> folds;
    for (std::size_t l = 0; l < e.logs.size(); ++l) {
      folds.push_back({"log", std::vector<bool>(e.logs.size(), false)});
      folds.back().left_out[l] = true;
    }
    return SuggestLaws(LawRows(e, view, folds), 1, 4);
  }
  static double Value(const SuggestedLaw& found, const std::string& name) {
    for (const Parameter& p : found.law.parameters)
      if (p.name == name) return p.initial;
    throw std::out_of_range(name);
  }
  static std::string Texts(const std::vector<SuggestedLaw>& found) {
    std::string all;
    for (const SuggestedLaw& law : found) all += law.law.formula + "; ";
    return all;
  }
};

TEST_F(LawSearchTest, FindsAWave) {
  const auto found = Ask([](double q, double, double, double) { return 0.05 * std::sin(9 * q); });
  ASSERT_FALSE(found.empty());
  ASSERT_EQ(found[0].law.formula, "a1*sin(s1*q)") << Texts(found);
  EXPECT_NEAR(Value(found[0], "s1"), 9, 0.1);
  EXPECT_NEAR(Value(found[0], "a1"), 0.05, 0.005);
  EXPECT_EQ(found[0].joints, std::vector<std::string>{"hinge"});
}

TEST_F(LawSearchTest, FindsDrag) {
  const auto found = Ask([](double, double v, double, double) { return 0.2 * v * std::abs(v); });
  ASSERT_FALSE(found.empty());
  ASSERT_EQ(found[0].law.formula, "a1*v*abs(v)") << Texts(found);
  EXPECT_NEAR(Value(found[0], "a1"), 0.2, 0.02);
  EXPECT_EQ(found[0].law.parameters[0].unit, "N*m*s^2/rad^2");
}

TEST_F(LawSearchTest, FindsASpringThatIsStifferSomewhere) {
  const auto found = Ask([](double q, double, double, double) {
    return 0.6 * (q - 0.25) * std::exp(-std::pow((q - 0.25) / 0.1, 2));
  });
  ASSERT_FALSE(found.empty());
  ASSERT_EQ(found[0].law.formula, "a1*(q - s1)*exp(-((q - s1)/s2)^2)") << Texts(found);
  EXPECT_NEAR(Value(found[0], "a1"), 0.6, 0.1);
  EXPECT_NEAR(Value(found[0], "s1"), 0.25, 0.01);
  EXPECT_NEAR(Value(found[0], "s2"), 0.1, 0.01);
}

TEST_F(LawSearchTest, FindsAGainThatFallsWithTheWeight) {
  const Pendulum p;
  const double weight = (p.bob + p.tip) * 9.81 * p.length;
  const auto found = Ask(
      [&](double q, double, double u, double) { return 0.5 * u * std::abs(weight * std::sin(q)); });
  ASSERT_FALSE(found.empty());
  // At these angles the sine is nearly its argument.
  EXPECT_THAT(found[0].law.formula, ::testing::AnyOf("a1*motor*abs(weight)", "a1*motor*abs(q)"));
  EXPECT_THAT(Texts(found), HasSubstr("a1*motor*abs(weight)"));
}

TEST_F(LawSearchTest, FindsHeat) {
  double heat = 0, last = 0;
  const auto found = Ask([&](double, double, double u, double t) {
    if (t == 0) heat = last = 0;
    heat += (t - last) * (u * u - heat) / 1.5;
    last = t;
    return 1.5 * heat;
  });
  ASSERT_FALSE(found.empty());
  ASSERT_EQ(found[0].law.formula, "a1*heat") << Texts(found);
  EXPECT_NEAR(Value(found[0], "a1"), 1.5, 0.2);
  EXPECT_NEAR(Value(found[0], "heat_time"), 1.5, 0.3);
}

TEST_F(LawSearchTest, FindsNothingInNoise) {
  EXPECT_THAT(Ask([](double, double, double, double) { return 0; }), IsEmpty());
}

}  // namespace
}  // namespace continuum
