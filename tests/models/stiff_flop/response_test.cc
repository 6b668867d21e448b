#include "models/stiff_flop/response.h"

#include <gtest/gtest.h>

#include "models/stiff_flop/details.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/published.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::Vector3d;

TEST(StiffFlopResponse, IsThatOfDifferencesOfSolves) {
  const Module module = Published();
  const Case row{"", Vector3d(30e3, 10e3, 0), {{0.05, 0.02, 0.03}, {0, 9.81, 0}}};
  for (const char* name : {"hooke+fixed+fixed", "hooke+general+constant"}) {
    SCOPED_TRACE(name);
    const Method method = Method::Parse(name, Direction::kForward);
    const Solution s = SolveForward(module, method, row, false);
    ASSERT_EQ(s.status, Status::kOk);
    const auto response = Respond(module, method, row, s);
    ASSERT_TRUE(response);
    for (int i = 0; i < 6; ++i) {
      const double step = i < 3 ? 1e-3 : 100;
      Case up = row, down = row;
      (i < 3 ? up.load.force[i] : up.given[i - 3]) += step;
      (i < 3 ? down.load.force[i] : down.given[i - 3]) -= step;
      const Solution above = SolveForward(module, method, up, false);
      const Solution below = SolveForward(module, method, down, false);
      const Vector3d moved = (above.tip - below.tip) / (2 * step);
      const auto frame = [&](const Case& at, const Solution& solution) {
        return Describe(module, method, Direction::kForward, at, solution).tip;
      };
      const Eigen::Quaterniond turn = frame(up, above) * frame(down, below).conjugate();
      const Vector3d turned = turn.vec() * (turn.w() < 0 ? -1 : 1) / step;
      const Eigen::VectorXd is = response->slope.col(i);
      // Third derivatives: a step is 1e-3 of what bends the module by 1.
      EXPECT_LT((is.head<3>() - moved).norm(), 1e-4 * moved.norm()) << i;
      EXPECT_LT((is.segment<3>(3) - turned).norm(), 1e-4 * turned.norm()) << i;
    }
  }
}

// Straight and without pressure, `fixed`: a Timoshenko cantilever. The force at the mount's end,
// l_fs beyond the tip, adds its moment: l^3/(3 E J) + l_fs l^2/(2 E J) + l/(G a).
TEST(StiffFlopResponse, OfTheUnloadedModuleIsTheCantilevers) {
  const Module module = Published();
  const Method method = Method::Parse("hooke+fixed+fixed", Direction::kForward);
  const Case row{"", Vector3d::Zero(), {Vector3d::Zero(), Vector3d::Zero()}};
  const auto response = Respond(module, method, row, SolveForward(module, method, row, false));
  ASSERT_TRUE(response);
  const double l = module.l, E = module.E;
  double area = std::numbers::pi * (module.r_2 * module.r_2 - module.r_1 * module.r_1);
  double inertia = std::numbers::pi * (std::pow(module.r_2, 4) - std::pow(module.r_1, 4)) / 4;
  const double bore = module.n_c * std::numbers::pi * module.r_c1 * module.r_c1;
  // The bores are no wall: three per ring, each with its own moment and half of r_o^2.
  area -= 3 * bore;
  inertia -=
      3 * (bore * bore / (module.n_c * 4 * std::numbers::pi) + bore * module.r_o * module.r_o / 2);
  const double bending = l * l * l / (3 * E * inertia) + module.l_fs * l * l / (2 * E * inertia);
  const double exact = bending + l / (E / 3 * area);
  EXPECT_NEAR(response->slope(0, 0), exact, 1e-6 * exact);
  EXPECT_NEAR(response->slope(2, 2), exact, 1e-6 * exact);
  EXPECT_NEAR(response->slope(1, 1), l / (E * area), 1e-6 * exact);
}

}  // namespace
}  // namespace continuum::stiff_flop
