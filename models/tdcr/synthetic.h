#pragma once

#include <vector>

#include "models/tdcr/measured.h"
#include "models/tdcr/robot.h"

namespace continuum::tdcr {

/// Measurements that stand in for the paper's, which are not public.
struct Experiment {
  Robot nominal;  ///< what the models are told
  std::vector<Case> cases;
  std::vector<Measured> measured;
};

/// Set 1: the segment hangs along gravity, 40 cases, every other one with a tip force of up to 50 g
/// in any direction, 10 for test. Set 2: the segment is level, 30 cases with 30 g at the tip, 10
/// for test. Tensions up to 5 N in all tendons.
///
/// The shapes come from the Cosserat rod with friction whose E, mu, base rotation and natural
/// curvature differ from the nominal robot's (Truth), plus noise of the scanner's 0.041 mm in every
/// coordinate.
Experiment Synthesize(const Robot& nominal, int set, unsigned seed);

/// E 0.85 of the nominal, mu 0.15, the base turned by 0.02, -0.03, 0.05 rad, the rod bent by 0.8/m
/// and twisted by 2/m when nothing acts.
Robot Truth(const Robot& nominal);

}  // namespace continuum::tdcr
