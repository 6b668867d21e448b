// Sensitivities of single steps with effects, in closed form, against central differences of the
// step on machines drawn at random.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "binding/cable_friction.h"
#include "engine.h"
#include "identification/sensitivity/runge_kutta_stages.h"
#include "identification/sensitivity/step_sensitivity.h"
#include "random_laws.h"
#include "sim/model/model_spec.h"
#include "support/long_test.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::RandomLaw;
using testing::RandomNumbers;
using Vector = Eigen::VectorXd;

constexpr double kMove = 5e-7, kReach = 2e-6;
// Of one parameter of a law, whose share of a step is small: differences round to 1e-16/kFarReach.
constexpr double kFarReach = 1e-4;
constexpr double kAgree = 5e-6;
constexpr int kParts = mjSTATE_FULLPHYSICS | mjSTATE_WARMSTART;

// What decides which branch a step takes: which rows and which bends of cables slide, which way.
std::vector<int> Branch(const mjModel& m, const mjData& d) {
  std::vector<int> branch;
  for (int r = 0; r < d.nefc; ++r) {
    const bool friction =
        d.efc_type[r] == mjCNSTR_FRICTION_DOF || d.efc_type[r] == mjCNSTR_FRICTION_TENDON;
    const bool full = std::abs(d.efc_force[r]) >= d.efc_frictionloss[r] * (1 - 1e-9);
    branch.push_back(d.efc_type[r]);
    branch.push_back(friction ? full * (d.efc_force[r] > 0 ? 1 : -1) : d.efc_force[r] > 0);
  }
  for (int a = 0; a < m.nactuator; ++a) branch.push_back(d.actuator_force[a] > 0);
  for (int i = 0; i < m.nplugin; ++i) {
    const auto* const cables = dynamic_cast<const CableFriction*>(&BoundOf(m, d, i));
    if (!cables) continue;
    for (const Bend& bend : cables->bends()) branch.push_back(bend.side);
  }
  return branch;
}

// Takes a step; the branches of all its stages.
std::vector<int> StepOn(ModelAndData& machine) {
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  std::optional<RungeKuttaStages> stages;
  if (m.opt.integrator == mjINT_RK4) stages.emplace(machine), stages->Keep(m, d);
  mj_step(&m, &d);
  std::vector<int> branch = Branch(m, d);  // of RK4: the last
  for (std::size_t i = 0; stages && i + 1 < RungeKuttaStages::kReach.size(); ++i) {
    const auto more = Branch(m, stages->Evaluate(m, i));
    branch.insert(branch.end(), more.begin(), more.end());
  }
  return branch;
}

template <class Xml>
ModelAndData Built(const Xml& xml, double along) {
  return ModelSpec::Parse(xml(along)).Build();
}

// A machine moved both ways along a direction of all its numbers.
struct Around {
  ModelAndData above, below;
  double reach;

  template <class Xml>
  Around(const Xml& xml, double reach)
      : above(Built(xml, reach)), below(Built(xml, -reach)), reach(reach) {}
};

struct Machines {
  ModelAndData here, perturbed;
  Around wide, narrow;

  template <class Xml>
  Machines(const Xml& xml, double reach)
      : here(Built(xml, 0)),
        perturbed(Built(xml, kMove)),
        wide(xml, reach),
        narrow(xml, reach / 2) {}
};

struct State {
  Vector q, v, w, z;
  static State Of(const ModelAndData& machine) {
    const mjModel& m = *machine.model;
    const mjData& d = *machine.data;
    return {Vector::Map(d.qpos, m.nq), Vector::Map(d.qvel, m.nv), Vector::Map(d.act, m.na),
            Vector::Map(d.plugin_state, m.npluginstate)};
  }
};

void Drive(ModelAndData& machine, int step, double phase) {
  mjData& d = *machine.data;
  const double t = 2e-3 * step;
  d.ctrl[0] = 5 + 4 * std::sin(9 * t + phase);
  d.ctrl[1] = 0.9 * std::sin(7 * t + 2 * phase);
  d.ctrl[2] = 0.8 * std::sin(5 * t + 3 * phase);
  d.ctrl[3] = -0.2 + 0.1 * std::sin(4 * t + phase);
  for (int i = 0; i < 3; ++i) d.ctrl[4 + i] = 2e4 * (1 + std::sin(9 * t + i + phase));
}

// The state after a step from a state moved along a direction; its branch.
struct Moved {
  State after;
  std::vector<int> branch;
};
Moved Step(ModelAndData& machine, const std::vector<double>& from, const State& along, double by,
           int step, double phase) {
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  mj_setState(&m, &d, from.data(), kParts);
  for (int i = 0; i < m.nv; ++i) d.qpos[i] += by * along.q[i], d.qvel[i] += by * along.v[i];
  for (int i = 0; i < m.na; ++i) d.act[i] += by * along.w[i];
  for (int i = 0; i < m.npluginstate; ++i) d.plugin_state[i] += by * along.z[i];
  Drive(machine, step, phase);
  const auto branch = StepOn(machine);
  return {State::Of(machine), branch};
}

// How fast the state after a step moves with a direction, by central differences; nothing where
// the step takes another branch on the way.
std::optional<State> Slope(Around& around, const std::vector<double>& from, const State& along,
                           int step, double phase, const std::vector<int>& branch) {
  const Moved up = Step(around.above, from, along, around.reach, step, phase),
              down = Step(around.below, from, along, -around.reach, step, phase);
  if (branch != up.branch || branch != down.branch) return std::nullopt;
  const auto slope = [&](Vector State::*part) -> Vector {
    return (up.after.*part - down.after.*part) / (2 * around.reach);
  };
  return State{slope(&State::q), slope(&State::v), slope(&State::w), slope(&State::z)};
}

// Largest error of a block over its largest number.
double Error(const Vector& found, const Vector& expected) {
  if (found.size() == 0) return 0;
  return (found - expected).cwiseAbs().maxCoeff() / std::max(expected.cwiseAbs().maxCoeff(), 1e-6);
}
double Error(const State& found, const State& expected) {
  return std::max({Error(found.q, expected.q), Error(found.v, expected.v),
                   Error(found.w, expected.w), Error(found.z, expected.z)});
}

std::vector<double> Listed(const Vector& x) { return {x.begin(), x.end()}; }

// What a derivative may be wrong by.
enum class Mutation { kNone, kFlippedParameters, kNoPositions, kNoStates };
// What moves: parameters of the machines, and with them the state.
enum class Moves { kAll, kParameters };

class Comparison {
 public:
  explicit Comparison(Machines& machines, unsigned seed, Mutation mutation = Mutation::kNone,
                      Moves moves = Moves::kAll)
      : machines_(machines), mutation_(mutation), moves_(moves), rng_(seed), phase_(seed) {}

  // The worst error of some steps along a motion; < 0: all were near to a switch.
  double Worst(int steps, int every) {
    double worst = -1;
    for (int step = 0; step < steps; ++step) {
      if (step % every == every - 1) worst = std::max(worst, ErrorOf(step));
      Drive(machines_.here, step, phase_);
      mj_step(machines_.here.model.get(), machines_.here.data.get());
    }
    return worst;
  }

 private:
  State Direction() {
    const mjModel& m = *machines_.here.model;
    const mjData& d = *machines_.here.data;
    const double size = moves_ == Moves::kAll;
    const auto some = [&](Eigen::Index n) {
      return Vector(Vector::NullaryExpr(
          n, [&] { return size * std::uniform_real_distribution<double>(-1, 1)(rng_); }));
    };
    State along{some(m.nv), some(m.nv), some(m.na), some(m.npluginstate)};
    for (int i = 0; i < m.na; ++i) along.w[i] *= std::max(1.0, std::abs(d.act[i]));
    for (int i = 0; i < m.npluginstate; ++i) {
      const double z = d.plugin_state[i];
      if (z == 0 || z == 1 || z == 2) along.z[i] = 0;  // what a row did, or nothing yet
    }
    return along;
  }

  double ErrorOf(int step) {
    const mjModel& m = *machines_.here.model;
    mjData& d = *machines_.here.data;
    std::vector<double> from(mj_stateSize(&m, kParts));
    mj_getState(&m, &d, from.data(), kParts);
    const State along = Direction();
    const bool flipped = mutation_ == Mutation::kFlippedParameters;
    StepSensitivity sensitivity(machines_.here, Wiring({}, m), {&machines_.perturbed},
                                flipped ? -kMove : kMove);
    EXPECT_EQ(ModelDifference(m, *machines_.perturbed.model).field, "");
    const double q = mutation_ != Mutation::kNoPositions, z = mutation_ != Mutation::kNoStates;
    sensitivity.Start(0,
                      {Listed(q * along.q), Listed(along.v), Listed(along.w), Listed(z * along.z)});
    mj_setState(&m, &d, from.data(), kParts);
    Drive(machines_.here, step, phase_);
    sensitivity.Before(m, d);
    const auto branch = StepOn(machines_.here);
    EXPECT_TRUE(sensitivity.After(m, d));
    mj_setState(&m, &d, from.data(), kParts);
    const auto wide = Slope(machines_.wide, from, along, step, phase_, branch),
               narrow = Slope(machines_.narrow, from, along, step, phase_, branch);
    // Differences that do not agree with each other stepped over a bend, or only round.
    if (!wide || !narrow || Error(*narrow, *wide) > kAgree) return -1;
    using Kind = Number::Kind;
    const auto& n = sensitivity.numbers();
    return Error({n[Kind::kPosition].col(0), n[Kind::kSpeed].col(0),
                  sensitivity.activation().col(0), n[Kind::kState].col(0)},
                 *wide);
  }

  Machines& machines_;
  Mutation mutation_;
  Moves moves_;
  std::mt19937 rng_;
  double phase_;
};

constexpr unsigned kMachines = testing::kIsSanitized ? 5 : 50;

std::string AnyIntegrator(unsigned seed) {
  constexpr std::array kAll{"Euler", "implicitfast", "RK4", "implicit"};
  return kAll[seed % kAll.size()];
}

// alone: the one number that moves, those of the law first.
Machines MachinesOf(const RandomLaw& law, unsigned seed, const std::string& integrator,
                    std::optional<std::size_t> alone = {}) {
  const auto xml = [&](double along) {
    RandomNumbers number(seed, along, alone);
    return RandomArm(law, number, integrator);
  };
  return {xml, alone ? kFarReach : kReach};
}

class IntegratorSensitivityTest
    : public ::testing::TestWithParam<std::tuple<RandomLaw, std::string>> {};

TEST_P(IntegratorSensitivityTest, AreThoseOfSingleSteps) {
  const auto& [law, integrator] = GetParam();
  unsigned compared = 0;
  for (unsigned seed = 0; seed < kMachines; ++seed) {
    Machines machines = MachinesOf(law, seed, integrator);
    const Wiring wiring({}, *machines.here.model);
    ASSERT_EQ(StepSensitivity::Obstacle(*machines.here.model, *machines.here.data, wiring), "");
    const double error = Comparison(machines, seed).Worst(60, 15);
    compared += error >= 0;
    EXPECT_LT(error, 1e-5) << "machine " << seed;
  }
  EXPECT_GT(compared, kMachines * 9 / 10);  // the others were near to a switch
}

class EffectSensitivityTest : public ::testing::TestWithParam<RandomLaw> {};

TEST_P(EffectSensitivityTest, AreThoseOfEveryParameterAlone) {
  CONTINUUM_LONG_IF_SANITIZED("ten machines for each parameter");
  constexpr unsigned kSome = 10;
  for (std::size_t k = 0; k < GetParam().parameters.size(); ++k) {
    const std::string& name = GetParam().parameters[k].first;
    unsigned compared = 0, seen = 0;
    for (unsigned seed = 0; seed < kSome; ++seed) {
      const auto error = [&](Mutation mutation) {
        Machines machines = MachinesOf(GetParam(), seed, seed % 2 ? "implicitfast" : "Euler", k);
        return Comparison(machines, seed, mutation, Moves::kParameters).Worst(60, 15);
      };
      const double right = error(Mutation::kNone);
      compared += right >= 0;
      EXPECT_LT(right, 1e-5) << name << " of machine " << seed;
      seen += error(Mutation::kFlippedParameters) > 1e-2;
    }
    EXPECT_GT(compared, kSome / 2) << name;
    EXPECT_GT(seen, kSome / 3) << name;
  }
}

// What such a comparison must not let pass.
TEST_P(EffectSensitivityTest, SeesWhatIsLeftOut) {
  CONTINUUM_LONG_IF_SANITIZED("eight machines for each mutation");
  constexpr unsigned kSome = 8;
  for (const Mutation mutation :
       {Mutation::kFlippedParameters, Mutation::kNoPositions, Mutation::kNoStates}) {
    unsigned seen = 0;
    for (unsigned seed = 0; seed < kSome; ++seed) {
      Machines machines = MachinesOf(GetParam(), seed, AnyIntegrator(seed));
      if (mutation == Mutation::kNoStates && machines.here.model->npluginstate == 0) ++seen;
      seen += Comparison(machines, seed, mutation).Worst(60, 15) > 1e-4;
    }
    EXPECT_GT(seen, 0u) << static_cast<int>(mutation);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Law, IntegratorSensitivityTest,
    ::testing::Combine(::testing::ValuesIn(testing::RandomLaws()),
                       ::testing::Values("Euler", "implicitfast", "implicit", "RK4")),
    [](const auto& info) { return std::get<0>(info.param).name + std::get<1>(info.param); });

INSTANTIATE_TEST_SUITE_P(Law, EffectSensitivityTest, ::testing::ValuesIn(testing::RandomLaws()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace continuum
