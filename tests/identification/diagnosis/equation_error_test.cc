#include "identification/diagnosis/equation_error.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/candidates/candidate_generator.h"
#include "identification/diagnosis/probing.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Bench;
using testing::Command;
using testing::Pendulum;

// Logs of a servo pendulum by its own integrator; the model may lack something of it.
class ByEquationTest : public Bench {
 protected:
  static constexpr std::size_t kRows = 300;

  Experiment Logs(const Pendulum& p, const std::string& candidates, bool jumps = false) {
    for (int t = 0; t < 4; ++t) {
      auto u = Command(t, kRows);
      for (std::size_t k = 0; jumps && k < kRows; ++k) u[k] = (k / 40 + t) % 2 ? 0.4 : -0.2;
      AddLog("t" + std::to_string(t), "trial: t" + std::to_string(t) + ", use: train", u,
             p.Run(u, testing::kPeriod));
    }
    return ReadExperiment("candidates: [" + candidates + "]\n");
  }
  ModelSpec Model() const { return ModelSpec::Load(Write("model.xml", Pendulum().Xml())); }

  static double Rms(const std::vector<double>& y) {
    double sum = 0;
    for (const double v : y) sum += v * v;
    return std::sqrt(sum / static_cast<double>(y.size()));
  }

  static std::vector<Hypothesis> CandidatesOf(const Experiment& e, const ModelSpec& system) {
    std::vector<std::string> skipped;
    const Problem null(e, system);
    return MakeCandidates(e, {&system}, SizesOf(null, null.Start()), skipped);
  }
  // A candidate, fitted by hand to a value of its only parameter.
  static CandidateResult With(const Experiment& e, const ModelSpec& system,
                              const std::string& effect, double value) {
    for (Hypothesis& h : CandidatesOf(e, system)) {
      if (h.effect != effect) continue;
      CandidateResult c{std::move(h)};
      c.was_fitted = true;
      c.fitted.fit.x = Append(Problem(e, system).Start(), {value});
      return c;
    }
    throw std::out_of_range(effect);
  }
  static EquationErrors View(const Experiment& e, const ModelSpec& system) {
    const Problem base(e, system);
    return {base, base.Start(), base.TrainLogs()};
  }
};

// The truth of the logs, whose inputs jump by 0.6 rad (3 N m): a parabola over 0.11 s cannot
// follow, and no force is missing for it. A tenth of the jump would be seen at its rows without the
// mean.
TEST_F(ByEquationTest, NothingIsMissingWhereInputsJump) {
  const Experiment e = Logs({}, "payload", true);
  const ModelSpec system = Model();
  const Problem problem(e, system);
  const auto all = MissingForces(problem, problem.Start(), problem.TrainLogs());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].joint, "hinge");
  EXPECT_LT(Rms(all[0].force), 0.03);  // 1 % of the jump
}

TEST_F(ByEquationTest, TheMissingForceOfAPayloadIsItsWeightAndInertia) {
  Pendulum truth;
  truth.payload = 0.05;
  const Experiment e = Logs(truth, "payload");
  const ModelSpec system = Model();
  const Problem problem(e, system);
  const auto f = MissingForces(problem, problem.Start(), problem.TrainLogs()).front();
  // M(a − a_model), of the whole inertia: (J + m l²) a = τ − m g l sin q less J a = τ.
  const double j = truth.inertia + (truth.bob + truth.tip) * truth.length * truth.length;
  const double heavy = j + truth.payload * truth.length * truth.length;
  double error = 0, size = 0;
  for (std::size_t k = 0; k < f.force.size(); ++k) {
    const double weight = (truth.bob + truth.tip) * 9.81 * truth.length * std::sin(f.angle[k]);
    const double more = truth.payload * 9.81 * truth.length * std::sin(f.angle[k]);
    const double torque = f.load[k] - truth.damping * f.velocity[k] - weight;
    const double expected = j * ((torque - more) / heavy - torque / j);
    error += std::pow(f.force[k] - expected, 2), size += expected * expected;
  }
  EXPECT_LT(std::sqrt(error / size), 0.15);  // the formula takes no mean over the rows
}

TEST_F(ByEquationTest, TheTruthExplainsTheMissingForceAndAnotherDoesNot) {
  Pendulum truth;
  truth.payload = 0.05;
  const Experiment e = Logs(truth, "payload, coulomb");
  const ModelSpec system = Model();
  const EquationErrors view = View(e, system);
  ASSERT_TRUE(view.any());
  CandidateResult payload = With(e, system, "payload", 0.02);  // sizes are fitted again
  CandidateResult coulomb = With(e, system, "coulomb", 0.01);
  payload.by_equation = view.Of(payload), coulomb.by_equation = view.Of(coulomb);
  ASSERT_TRUE(payload.by_equation && coulomb.by_equation);
  EXPECT_GT(payload.by_equation->share, 0.95);
  EXPECT_LT(coulomb.by_equation->share, 0.5);
  EXPECT_TRUE(ClearlyBetterByEquation(payload, coulomb));
  EXPECT_FALSE(ClearlyBetterByEquation(coulomb, payload));
}

// What a payload or friction changes is the same to 5 % in a fifth of the steps.
TEST_F(ByEquationTest, FewStepsFromRowToRowShowWhatALawChanges) {
  const Experiment e = Logs({}, "payload, coulomb");
  const ModelSpec system = Model();
  const Problem base(e, system);
  const double step = base.step();
  const auto forces = [&](const Problem& problem, const Problem::Vector& x, double by) {
    const auto joint = MissingForces(problem, x, problem.TrainLogs(), by).front().force;
    return Problem::Vector(Problem::Vector::Map(joint.data(), std::ssize(joint)));
  };
  for (const auto& [effect, size] : {std::pair("payload", 0.05), std::pair("coulomb", 0.02)}) {
    const CandidateResult c = With(e, system, effect, size);
    const Problem problem(e, c.hypothesis.system, c.hypothesis.Free());
    const auto change = [&](double by) {
      return Problem::Vector(forces(problem, c.fitted.fit.x, by) - forces(base, base.Start(), by));
    };
    const Problem::Vector fine = change(step), coarse = change(5 * step);
    EXPECT_LT((coarse - fine).norm(), 0.05 * fine.norm()) << effect;
  }
}

TEST_F(ByEquationTest, OfSeveralShapesItFindsTheBest) {
  Pendulum truth;
  truth.tau_c = 0.05;
  const Experiment e = Logs(truth, "dahl");
  const ModelSpec system = Model();
  const auto all = CandidatesOf(e, system);
  ASSERT_EQ(all.size(), 1u);
  const Problem problem(e, all[0].system, all[0].Free());
  const EquationErrors view = View(e, system);
  const auto first = view.From(all[0], problem, 0);
  ASSERT_TRUE(first.has_value());
  const EquationStart best = view.BestShape(all[0], problem, *first);
  for (std::size_t i = 0; i < all[0].starts.size(); ++i) {
    const auto one = view.From(all[0], problem, i);
    EXPECT_LE(one ? one->share : 0, best.share);
  }
  EXPECT_EQ(view.From(all[0], problem, best.start)->share, best.share);
}

// Without the payload the missing force wants more inertia than is allowed.
TEST_F(ByEquationTest, AParameterLeavesTheBoundThatHoldsItWithoutTheTruth) {
  Pendulum truth;
  truth.payload = 0.05;
  Logs(truth, "payload");
  const Experiment e = ReadExperiment(
      "candidates: [payload]\nparameters:\n"
      "  - {name: a, target: 'joint:hinge', attribute: armature, initial: 1e-4, lower: 0, "
      "upper: 5e-4}\n");
  const ModelSpec system = Model();
  const auto all = CandidatesOf(e, system);
  ASSERT_EQ(all.size(), 1u);
  const Problem problem(e, all[0].system, all[0].Free());
  const auto start = View(e, system).From(all[0], problem, 0);
  ASSERT_TRUE(start.has_value());
  EXPECT_GT(start->share, 0.95);
  EXPECT_LT(start->together[0], 1e-4);
  EXPECT_NEAR(start->together[1], truth.payload, 0.1 * truth.payload);
}

TEST_F(ByEquationTest, AnEffectOnTheSensorsAloneIsNotSeen) {
  const Experiment e = Logs({}, "sensor_delay, payload");
  const ModelSpec system = Model();
  const EquationErrors view = View(e, system);
  EXPECT_FALSE(view.Of(With(e, system, "sensor_delay", 0.01)).has_value());
}

TEST_F(ByEquationTest, ThereIsNoViewWhereARowWasNotMeasured) {
  auto q = Pendulum().Run(Command(0, kRows), testing::kPeriod);
  q[100] = std::nan("");
  AddLog("gap", "trial: gap, use: train", Command(0, kRows), q);
  const Experiment e = ReadExperiment("candidates: [payload]\n");
  EXPECT_FALSE(View(e, Model()).any());
}

}  // namespace
}  // namespace continuum
