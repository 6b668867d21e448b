#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace continuum::testing {

/// Numbers of a machine drawn at random, each with a random direction in which all move together,
/// or of which one moves alone.
class RandomNumbers {
 public:
  RandomNumbers(unsigned seed, double along, std::optional<std::size_t> alone = {})
      : rng_(seed), along_(along), alone_(alone) {}

  /// Between two numbers, moved by `along` times itself or its opposite.
  std::string operator()(double lower, double upper) {
    const double value = std::uniform_real_distribution<double>(lower, upper)(rng_);
    const double drawn = Direction(), slope = alone_ ? drawn_++ == *alone_ : drawn;
    return fmt::format("{:.17g}", value + along_ * slope * std::max(std::abs(value), 1e-3));
  }
  /// The same without a direction.
  std::string Fixed(double lower, double upper) {
    return fmt::format("{:.17g}", std::uniform_real_distribution<double>(lower, upper)(rng_));
  }
  double Direction() { return std::uniform_real_distribution<double>(-1, 1)(rng_); }

 private:
  std::mt19937 rng_;
  double along_;
  std::optional<std::size_t> alone_;
  std::size_t drawn_ = 0;
};

/// A law with the ranges of its parameters, and where it acts.
struct RandomLaw {
  std::string name, effect, place;
  std::vector<std::pair<std::string, std::pair<double, double>>> parameters;
  std::string more = {};                ///< further keys
  std::string joints = {}, cable = {};  ///< further attributes of all joints, of the cable 'tb'
  std::string equality = {};            ///< further elements
  std::string beside = {};              ///< further effects
  std::string inputs = {};              ///< further attributes of the actuators 'pull' and 'lagged'
};
inline void PrintTo(const RandomLaw& law, std::ostream* out) { *out << law.name; }

inline std::string Instance(const RandomLaw& law, RandomNumbers& number) {
  std::string keys = law.place + law.more;
  for (const auto& [key, range] : law.parameters) {
    keys += fmt::format("<config key='{}' value='{}'/>", key, number(range.first, range.second));
  }
  if (law.effect.empty()) return "";
  return fmt::format("<plugin plugin='continuum.{}'><instance name='law'>{}</instance></plugin>{}",
                     law.effect, keys, law.beside);
}

/// Three links on hinges with cables through sites, a tendon of joints, a lagged motor and position
/// servos; beside them a segment of two hinges and a slide with three chambers.
inline std::string RandomArm(const RandomLaw& law, RandomNumbers& number,
                             const std::string& integrator) {
  const std::string plugins = Instance(law, number);
  std::string bodies, close;
  for (int i = 0; i < 3; ++i) {
    bodies += fmt::format(
        "<body name='link{0}' pos='0 0 {1}'><joint name='x{0}' axis='1 {2} 0' stiffness='{3}' "
        "damping='{4}' armature='{5}' springref='{6}' {9}/><joint name='y{0}' axis='0 1 "
        "{2}' stiffness='{3}' damping='{4}' {9}/><inertial pos='{7} 0 -0.05' mass='{8}' "
        "diaginertia='1e-4 1.2e-4 4e-5'/><site name='a{0}' pos='0.03 0.01 -0.1'/>"
        "<site name='b{0}' pos='-0.01 0.03 -0.1'/><site name='c{0}' pos='0.025 0.02 -0.03'/>",
        i, i ? -0.1 : 0, number.Fixed(-0.3, 0.3), number(0.3, 0.9), number(0.01, 0.03),
        number(1e-4, 3e-4), number(-4, 4), number(0, 5e-3), number(0.05, 0.15), law.joints);
    close += "</body>";
  }
  const std::string segment = fmt::format(
      "<body name='base' pos='1 0 0'><body name='mid' pos='0 0 0.06'><joint name='u' axis='0 1 0' "
      "stiffness='0.3' damping='0.01'/><joint name='v' axis='1 0 0' stiffness='0.3' "
      "damping='0.01'/><inertial pos='0 0 0' mass='{}' diaginertia='1e-4 1e-4 1e-4'/><body "
      "name='tip' pos='0 0 0.07'><joint name='s' type='slide' axis='0 0 1' stiffness='200' "
      "damping='2'/><inertial pos='0 0 0' mass='0.1' diaginertia='1e-4 1e-4 1e-4'/></body></body>"
      "</body>",
      number(0.1, 0.2));
  return fmt::format(
      "<mujoco><option timestep='2e-3' integrator='{}'/>"
      "<extension>{}</extension><worldbody><site name='a' pos='0.03 0.01 0'/>"
      "<site name='b' pos='-0.01 0.03 0'/>{}{}{}</worldbody>"
      "<tendon><spatial name='ta' damping='{}'><site site='a'/><site site='c0'/><site site='a0'/>"
      "<site site='a1'/><site site='c2'/><site site='a2'/></spatial><spatial name='tb' "
      "stiffness='{}' {}>"
      "<site site='b'/><site site='b0'/><site site='b1'/></spatial>"
      "<fixed name='tf'><joint joint='x0' coef='1'/><joint joint='y2' coef='-0.5'/></fixed>"
      "</tendon>{}<actuator><general name='pull' tendon='ta' gainprm='{}' gear='{}' {}/>"
      "<general name='lagged' joint='y0' dyntype='filterexact' dynprm='{}' gainprm='0.3' "
      "gear='{}' {}/><position name='servo' joint='x1' kp='{}' kv='{}' gear='{}'/>"
      "<position name='winch' tendon='tb' gear='{}' kp='{}' forcerange='{} {}'/>"
      "<general name='p1' joint='s' gear='0'/><general name='p2' joint='s' gear='0'/><general "
      "name='p3' joint='s' gear='0' dyntype='filterexact' dynprm='7e-3'/></actuator>"
      "<sensor><jointpos name='x0' joint='x0'/><jointvel name='y2' joint='y2'/>"
      "<jointpos name='x1' joint='x1'/><jointpos name='u' joint='u'/><jointpos name='v' "
      "joint='v'/><jointpos name='s' "
      "joint='s'/><framepos name='end' objtype='site' objname='a2'/></sensor>"
      "</mujoco>",
      integrator, plugins, bodies, close, segment, number(0.1, 0.5), number(5, 20), law.cable,
      law.equality, number(-1.2, -0.8), number(0.9, 1.1), law.inputs, number(0.02, 0.05),
      number(1.4, 1.6), law.inputs, number(0.5, 1), number(0.002, 0.01), number(0.8, 1.2),
      number(-1.1, -0.9), number(20, 60), number(-1.2, -0.8), number(2, 4));
}

}  // namespace continuum::testing
