// ctest labels: real-data
#include <cmath>

#include <gtest/gtest.h>

#include "error.h"
#include "sim/model/model_spec.h"
#include "sim/simulation/simulate.h"
#include "support/real_log.h"

namespace continuum {
namespace {

class TdcrThreeSegment : public testing::RealLog {
 protected:
  void SetUp() override {
    Import("tdcr_three_segment");
    Registration& r = experiment_.registration;  // what replay estimates from all train rows
    r.rotation = {0.0322586, 0.0160507, 0.00122373};
    r.translation = {-0.00166693, 0.00342856, -0.00356385};
    r.offset["plate3"] = {-0.00047811, 0.00442831, 0.00314933};
  }

  // RMS distance of the tip [m] over one family of patterns.
  double TipError(const std::string& family) const {
    const ModelSpec system = ModelSpec::Load(experiment_.model);
    for (const Log& log : experiment_.logs) {
      if (log.trial != family) continue;
      ModelAndData machine = system.Build();
      const Trace trace = Simulate(machine, experiment_, log);
      double sum = 0;
      for (std::size_t k = 0; k < log.rows(); ++k) {
        for (std::size_t c = 0; c < 3; ++c)
          sum += std::pow(trace.channel[c][k] - log.measured[c][k], 2);
      }
      return std::sqrt(sum / static_cast<double>(log.rows()));
    }
    throw Error::Input("experiment.yaml", "a log " + family, "none");
  }
};

// A family that bends one segment and one that bends two; 0.1 mm: one digit for other compilers.
TEST_F(TdcrThreeSegment, ReplaysUnfittedAsItsReadmeSays) {
  EXPECT_NEAR(TipError("seg3"), 3.98e-3, 1e-4);
  EXPECT_NEAR(TipError("pair12_same"), 7.72e-3, 1e-4);
}

TEST_F(TdcrThreeSegment, ItsFamiliesHoldEveryRowOnce) {
  std::size_t rows = 0;
  for (const Log& log : experiment_.logs) rows += log.rows();
  EXPECT_EQ(experiment_.logs.size(), 10u);
  EXPECT_EQ(rows, 1620u);
}

// Stiffness, dry friction, three pretensions, and two coordinates for the holes of nine cables.
TEST_F(TdcrThreeSegment, PlacesFitsTheHolesOfEachCable) {
  EXPECT_EQ(Experiment::Read(scratch_ / "places.yaml").parameters.size(), 23u);
}

}  // namespace
}  // namespace continuum
