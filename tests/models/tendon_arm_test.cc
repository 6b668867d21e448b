#include "models/generator/tendon_arm.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "sim/file.h"
#include "sim/system.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::HasSubstr;

std::string Folder(const std::string& robot) {
  return CONTINUUM_SOURCE "/models/" + robot + "/" + robot;
}

TEST(TendonArm, TheCommittedModelsAreWhatTheirParametersGive) {
  for (const std::string robot : {"trunk", "tdcr_three_segment"}) {
    EXPECT_EQ(TendonArmMjcf(ReadTendonArm(Folder(robot) + ".yaml")),
              ReadFile(Folder(robot) + ".xml"));
  }
}

// A rod without gravity, bent by a moment at its tip, is an arc of curvature M/EI; the chain has
// the slope of the rod at every end of an interval, whatever their number.
TEST(TendonArm, APureMomentBendsItIntoTheArcOfTheRod) {
  TendonArm arm = ReadTendonArm(Folder("tdcr_three_segment") + ".yaml");
  arm.tendons.clear();
  for (auto& segment : arm.segments) segment.links = 8, segment.EI = 2e-3;
  testing::Scratch scratch;
  const System system = System::Load(scratch.Write("arm.xml", TendonArmMjcf(arm)));
  Machine machine = system.Build();
  const double length = 0.1865, moment = 0.01, slope = moment * length / 2e-3;
  mjData& d = *machine.data;
  const int tip = mj_name2id(machine.model.get(), mjOBJ_BODY, "tip");
  d.xfrc_applied[6 * tip + 4] = moment;  // about y
  for (int step = 0; step < 1000; ++step) mj_step(machine.model.get(), &d);
  const double* const R = d.xmat + 9 * tip;
  EXPECT_NEAR(std::atan2(R[2], R[8]), slope, 1e-6);
  // Chords are longer than arcs: 1 + (θ/n)²/24 with θ/n = 0.04 rad.
  EXPECT_NEAR(d.xpos[3 * tip], length / slope * (1 - std::cos(slope)), 1e-4 * length);
  EXPECT_NEAR(d.xpos[3 * tip + 2], length / slope * std::sin(slope), 1e-4 * length);
}

// Virtual work: a tendon at azimuth φ bends every joint before its end by the moment T r.
TEST(TendonArm, ATendonTakenInBendsTowardItselfByItsStiffnessAndTheRods) {
  TendonArm arm = ReadTendonArm(Folder("tdcr_three_segment") + ".yaml");
  arm.tendons = {{"t", 1, 0, 1}};
  arm.segments[0].pretension = 0;
  testing::Scratch scratch;
  const System system = System::Load(scratch.Write("arm.xml", TendonArmMjcf(arm)));
  Machine machine = system.Build();
  mjData& d = *machine.data;
  const auto settle = [&](double displacement) {
    d.ctrl[0] = displacement;
    for (int step = 0; step < 2000; ++step) mj_step(machine.model.get(), &d);
  };
  settle(1e-3);
  const double r = arm.guide_radius, L = arm.segments[0].length, EI = arm.segments[0].EI;
  const double T = -d.actuator_force[0];
  EXPECT_NEAR(T, 1e-3 / (1 / arm.stiffness + r * r * L / EI), 0.01 * T);  // small angles: 1 %
  const int plate = mj_name2id(machine.model.get(), mjOBJ_SITE, "plate1");
  EXPECT_GT(d.site_xpos[3 * plate], 0);
  settle(-1e-3);
  EXPECT_EQ(d.actuator_force[0], 0);  // slack
}

TEST(TendonArm, ATendonOfASegmentThatIsNotThereIsRefused) {
  testing::Scratch scratch;
  std::string text = ReadFile(Folder("trunk") + ".yaml");
  text.replace(text.find("segment: 2"), 10, "segment: 4");
  try {
    ReadTendonArm(scratch.Write("arm.yaml", text));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("a segment from 1 to 3, found 4"));
  }
}

}  // namespace
}  // namespace continuum
