#include "effects/gravity_tilt.h"

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace continuum {
namespace {

struct World {
  std::map<std::string, double, std::less<>> values{
      {"gravity[0]", 0}, {"gravity[1]", 0}, {"gravity[2]", -9.81}};
  double Get(std::string_view name) const { return values.find(name)->second; }
  void Set(std::string_view name, double value) { values.find(name)->second = value; }
  void Add(std::string_view, double) {}
  void Scale(std::string_view, double) {}
  void Expect(double x, double y, double z) const {
    EXPECT_NEAR(Get("gravity[0]"), x, 1e-14);
    EXPECT_NEAR(Get("gravity[1]"), y, 1e-14);
    EXPECT_NEAR(Get("gravity[2]"), z, 1e-14);
  }
};

TEST(GravityTilt, RollsAboutXThenPitchesAboutY) {
  World world;
  const double a = 0.3, b = -0.2;
  GravityTilt::Apply(world, {a, b});
  // R_x(a) (0, 0, −g) = (0, g sin a, −g cos a), then R_y(b).
  const double g = 9.81, z = -g * std::cos(a);
  world.Expect(z * std::sin(b), g * std::sin(a), z * std::cos(b));
}

TEST(GravityTilt, KeepsTheSizeOfGravity) {
  World world;
  GravityTilt::Apply(world, {1.1, 0.7});
  EXPECT_NEAR(std::hypot(world.Get("gravity[0]"), world.Get("gravity[1]"), world.Get("gravity[2]")),
              9.81, 1e-14);
}

}  // namespace
}  // namespace continuum
