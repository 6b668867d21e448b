#include "sim/film/measured_points.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/io/file.h"
#include "sim/simulation/simulate.h"
#include "sim/simulation/wiring.h"
#include "support/measured_arm.h"

namespace continuum {
namespace {

using testing::MeasuredArm;

// Commands are straight between rows, the camera sees what sines do [m].
constexpr double kStraight = 1e-4;

// A camera that looks from the side at a marker beside the tip, 50 ms late.
Registration Camera() {
  Registration r;
  r.rotation = {1.2, -2.0, 0.7};
  r.translation = {0.3, -0.1, 1.5};
  r.offset[""] = {0.01, -0.02, 0.03};
  r.clock_shift = 0.05;
  return r;
}

// How many points the log's rows have, and how far the measured ones are from the simulated [m].
struct Seen {
  std::size_t points = 0;
  double apart = 0;
};
Seen PointsOf(const Experiment& e, const ModelSpec& system) {
  const Log& log = e.logs.front();
  ModelAndData machine = system.Build();
  const Wiring wiring(e, *machine.model);
  Seen seen;
  Hooks hooks;
  hooks.row = [&](const mjModel& m, mjData& d, std::size_t row) {
    for (const MeasuredPoint& p : MeasuredPoints(e, wiring, log, row, m, d)) {
      ++seen.points;
      const double apart = mju_dist3(p.measured.data(), p.simulated.data());
      if (row + 6 < log.rows()) seen.apart = std::max(seen.apart, apart);  // the log ends earlier
    }
  };
  Simulate(machine, e, log, {}, hooks);
  return seen;
}

TEST(MeasuredPoints, LieWhereARightModelHasThem) {
  const MeasuredArm arm;
  Experiment e = arm.Read("");
  const ModelSpec system = ModelSpec::Load(e.model);
  MeasuredArm::Measure(e, system, Camera());
  e.registration = Camera();
  const Seen seen = PointsOf(e, system);
  EXPECT_EQ(seen.points, e.logs.front().rows());
  EXPECT_LT(seen.apart, kStraight);
}

TEST(MeasuredPoints, AreInTheWorldWhereTheSensorIsInAnotherFrame) {
  const MeasuredArm arm;
  Experiment e = arm.Read("");
  std::string model = ReadFile(e.model);
  const auto insert = [&](const std::string& after, const std::string& text) {
    model.insert(model.find(after) + after.size(), text);
  };
  insert("<worldbody>", "<site name=\"base\" pos=\".1 .2 .3\" euler=\"20 30 40\"/>");
  insert("objname=\"tip\"", " reftype=\"site\" refname=\"base\"");
  arm.folder().Write("arm.xml", model);
  const ModelSpec system = ModelSpec::Load(e.model);
  MeasuredArm::Measure(e, system, Camera());
  e.registration = Camera();
  EXPECT_LT(PointsOf(e, system).apart, kStraight);
}

// A camera that misses rows 10, 20 and 21, 40 to 60 (0.22 s) and 100 to 160 (0.62 s), a direction
// at a time.
TEST(MeasuredPoints, AreHeldWhereFewRowsMissAndLeftOutWhereManyDo) {
  const MeasuredArm arm;
  Experiment e = arm.Read("");
  const ModelSpec system = ModelSpec::Load(e.model);
  MeasuredArm::Measure(e, system, {});
  Log& log = e.logs.front();
  ASSERT_GT(log.rows(), 170u);
  const auto miss = [&](std::size_t from, std::size_t to, int direction) {
    for (std::size_t row = from; row <= to; ++row) log.measured[direction][row] = std::nan("");
  };
  miss(10, 10, 0), miss(20, 21, 0), miss(40, 60, 1), miss(100, 160, 2);
  const ModelAndData machine = system.Build();
  const Wiring wiring(e, *machine.model);
  mj_forward(machine.model.get(), machine.data.get());
  const auto at = [&](std::size_t row) {
    return MeasuredPoints(e, wiring, log, row, *machine.model, *machine.data);
  };
  for (const auto& [row, shown] :
       {std::pair{20, 19}, {21, 22}, {40, 39}, {49, 39}, {51, 61}, {60, 61}}) {
    ASSERT_EQ(at(row).size(), 1u) << row;
    EXPECT_TRUE(at(row).front().held) << row;
    EXPECT_FALSE(at(shown).front().held) << row;
    EXPECT_EQ(at(row).front().measured, at(shown).front().measured) << row;
  }
  ASSERT_EQ(at(10).size(), 1u);
  EXPECT_FALSE(at(10).front().held);  // a single row would only flicker
  for (const std::size_t row : {100, 130, 160}) EXPECT_TRUE(at(row).empty()) << row;
}

TEST(MeasuredPoints, NeedEveryDirectionThatTheLogHas) {
  const MeasuredArm arm;
  Experiment e = arm.Read("");
  for (double& z : e.logs.front().measured[2]) z = std::nan("");
  EXPECT_EQ(PointsOf(e, ModelSpec::Load(e.model)).points, 0);
}

// A camera that sees x and z only, as the marker passes a plane; 1 cm too high.
TEST(MeasuredPoints, TakeADirectionThatIsNotMeasuredFromTheSimulation) {
  const MeasuredArm arm;
  Experiment e = arm.Read("");
  const ModelSpec system = ModelSpec::Load(e.model);
  MeasuredArm::Measure(e, system, {});
  Log& log = e.logs.front();
  for (double& z : log.measured[2]) z += 0.01;
  const auto leave_out = [&](std::size_t channel) {
    const auto at = static_cast<std::ptrdiff_t>(channel);
    e.channels.erase(e.channels.begin() + at);
    for (Log& l : e.logs) l.measured.erase(l.measured.begin() + at);
  };
  leave_out(1);
  const Seen two = PointsOf(e, system);
  EXPECT_EQ(two.points, log.rows());
  EXPECT_NEAR(two.apart, 0.01, kStraight);
  leave_out(0);
  EXPECT_EQ(PointsOf(e, system).points, 0);
}

}  // namespace
}  // namespace continuum
