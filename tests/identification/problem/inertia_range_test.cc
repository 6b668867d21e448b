#include "identification/problem/inertia_range.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using ::testing::HasSubstr;

ModelSpec Model(const std::string& compiler = "") {
  return ModelSpec::Parse("<mujoco>" + compiler +
                          "<worldbody><body name='b'><joint/><inertial pos='0 0 0' mass='1' "
                          "diaginertia='1e-4 1.2e-4 2e-4'/></body></worldbody></mujoco>");
}

FreeParameter Inertia(int axis) {
  FreeParameter p{"I", "kg*m^2", 2e-4, 1e-6, 1e-2, 1e-4, {}, {true}};
  p.change = {"body:b", "inertia[" + std::to_string(axis) + "]"};
  return p;
}

TEST(InertiaRange, OfOneThatIsFreeAloneIsWhatABodyCanHave) {
  std::vector<FreeParameter> one{Inertia(2)};
  KeepToInertias(Model(), one);
  EXPECT_NEAR(one[0].upper, 2.2e-4, 1e-12);
  EXPECT_NEAR(one[0].lower, 2e-5, 1e-12);
  EXPECT_THAT(one[0].why_upper,
              HasSubstr("at most inertia[0] + inertia[1] = 0.00022: free these too"));
  EXPECT_THAT(one[0].why_lower, HasSubstr("at least |inertia[0] − inertia[1]| = 2e-05"));
  const ModelSpec model = Model();
  for (double value : {one[0].lower, one[0].upper}) {
    one[0].change.value = value;
    EXPECT_NO_THROW(model.Build({&one[0].change, 1}));
  }
}

TEST(InertiaRange, StaysWhereAnotherIsFreeTooOrTheModelBalancesThem) {
  std::vector<FreeParameter> two{Inertia(2), Inertia(0)};
  KeepToInertias(Model(), two);
  EXPECT_EQ(two[0].upper, 1e-2);
  EXPECT_EQ(two[0].why_upper + two[1].why_upper, "");
  std::vector<FreeParameter> one{Inertia(2)};
  KeepToInertias(Model("<compiler balanceinertia='true'/>"), one);
  EXPECT_EQ(one[0].upper, 1e-2);
}

}  // namespace
}  // namespace continuum
