#include "models/mjcf/tendon_arm.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "sim/io/file.h"
#include "sim/model/model_spec.h"
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

// A rod without gravity, bent by a moment M at its tip, is an arc of curvature M/EI. The chain has
// its slope at every end of an interval; an interval of angle δ spans l cos(δ/2) instead of the
// arc's chord l sin(δ/2)/(δ/2), so that the chain is the arc, smaller by x/tan x with x = δ/2.
TEST(TendonArm, APureMomentBendsItIntoTheArcOfTheRod) {
  TendonArm arm = ReadTendonArm(Folder("tdcr_three_segment") + ".yaml");
  arm.tendons.clear();
  for (auto& segment : arm.segments) segment.links = 8, segment.length = 0.06, segment.EI = 2e-3;
  testing::Scratch scratch;
  const ModelSpec system = ModelSpec::Load(scratch.Write("arm.xml", TendonArmMjcf(arm)));
  ModelAndData machine = system.Build();
  const double length = 0.18, moment = 0.01, slope = moment * length / 2e-3, x = slope / 48;
  const double radius = length / slope * x / std::tan(x);
  mjData& d = *machine.data;
  const int tip = mj_name2id(machine.model.get(), mjOBJ_BODY, "tip");
  d.xfrc_applied[6 * tip + 4] = moment;  // about y
  for (int step = 0; step < 1000; ++step) mj_step(machine.model.get(), &d);
  const double* const R = d.xmat + 9 * tip;
  EXPECT_NEAR(std::atan2(R[2], R[8]), slope, 1e-6);
  EXPECT_NEAR(d.xpos[3 * tip], radius * (1 - std::cos(slope)), 1e-6 * length);
  EXPECT_NEAR(d.xpos[3 * tip + 2], radius * std::sin(slope), 1e-6 * length);
}

// Statics of n equal joints under one tendon: between two guides it is l cos(θ/2) − 2 r sin(θ/2)
// long, so that K θ = T (l/2 sin(θ/2) + r cos(θ/2)) with T = k (u + n (l cos − 2 r sin) − n l).
double TensionOf(const TendonArm& arm, double displacement) {
  const TendonArm::Segment& s = arm.segments[0];
  const double l = s.length / s.links, r = arm.guide_radius, K = s.EI / l;
  const auto tension = [&](double h) {  // h = θ/2
    return arm.stiffness *
           (displacement + s.links * (l * std::cos(h) - 2 * r * std::sin(h)) - s.length);
  };
  double low = 0, high = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double h = (low + high) / 2;
    const bool bends_on = tension(h) * (l / 2 * std::sin(h) + r * std::cos(h)) > K * 2 * h;
    (bends_on ? low : high) = h;
  }
  return tension(low);
}

TEST(TendonArm, ATendonTakenInPullsWithTheTensionOfTheChainsStatics) {
  TendonArm arm = ReadTendonArm(Folder("tdcr_three_segment") + ".yaml");
  arm.tendons = {{"t", 1, 0, 1}};
  arm.segments[0].pretension = 0;
  testing::Scratch scratch;
  const ModelSpec system = ModelSpec::Load(scratch.Write("arm.xml", TendonArmMjcf(arm)));
  ModelAndData machine = system.Build();
  mjData& d = *machine.data;
  const auto settle = [&](double displacement) {
    d.ctrl[0] = displacement;
    for (int step = 0; step < 2000; ++step) mj_step(machine.model.get(), &d);
  };
  settle(1e-3);
  EXPECT_NEAR(-d.actuator_force[0], TensionOf(arm, 1e-3), 1e-6);
  const int plate = mj_name2id(machine.model.get(), mjOBJ_SITE, "plate1");
  EXPECT_GT(d.site_xpos[3 * plate], 0);  // toward the tendon
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
