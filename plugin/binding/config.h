#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

#include "effects/effect.h"
#include "error.h"

namespace continuum {

/// The names of our MuJoCo plugins begin with it.
inline constexpr std::string_view kPluginPrefix = "continuum.";
/// "continuum.stribeck": the MuJoCo plugin of an effect.
inline std::string PluginName(std::string_view effect) {
  return std::string(kPluginPrefix) + std::string(effect);
}

/// Our sensor plugin, which is no effect.
inline constexpr std::string_view kWrenchPlugin = "continuum.wrench";

/// MuJoCo's type of the objects at a place; mjOBJ_UNKNOWN for the world.
mjtObj ObjectType(Place place);
/// The number of a model's objects at a place.
int ObjectCount(const mjModel& m, Place place);

/// Joints or tendons that a law acts on.
struct Lines {
  bool joints;
  std::vector<int> ids;
};

/// Why an effect cannot act on an object: "a hinge or slide joint", "a free joint". Nothing is
/// found where it can.
struct Misfit {
  std::string expected, found;
};

/// The configuration of one plugin instance, as the MJCF gives it.
class Config {
 public:
  Config(const mjModel& m, int instance) : m_(&m), instance_(instance) {}

  /// "" when the MJCF does not set the key.
  std::string_view Get(std::string_view key) const;
  int instance() const { return instance_; }
  /// "continuum.stribeck 'friction'", for messages.
  std::string Who() const;

  /// The number under param.name, or param.Omitted(). Throws Error with value, range and unit.
  double Read(const Param& param) const;
  /// The index of the option under choice.name, 0 when absent.
  int Read(const Choice& choice) const;

  /// Ids of the objects that the names and globs (* ? [..]) under the key of a place match,
  /// ascending. Throws Error when a name or glob matches nothing.
  ///
  /// MuJoCo's attach puts a prefix before the names of a model, that of the instance too, but not
  /// into configurations. Names are therefore looked for with the prefix of the instance first (of
  /// "a_friction", "bend*" finds "a_bend1"), then as written. What Attachment knows goes before
  /// both.
  std::vector<int> Match(Place place) const;
  /// The id of the object of this exact name, found in the same way; -1: there is none.
  int Find(Place place, const std::string& name) const;

  /// Of what Match finds, all that an effect can act on. Throws Error for others that are written
  /// by their name; a glob leaves them out, but not all that it matches. The globs of "friction"
  /// also leave out "b_joint" where there is an instance "b_friction" of the same effect: that came
  /// with the robot to which both belong.
  std::vector<int> MatchFit(Place place, const std::function<Misfit(int)>& judge) const;
  /// What MatchFit has left out ("it leaves out joints 'root' (a free joint)"); empty: nothing.
  const std::string& LeftOut() const { return left_out_; }

  /// What one of the keys 'joint' and 'tendon' matches, as MatchFit for joints of other types.
  /// Throws Error when both or none are given.
  Lines MatchLines(Joints types) const;

 private:
  std::vector<int> MatchBehind(const std::string& prefix, Place place, std::string* missing) const;
  std::vector<int> MatchAttached(Place place, const std::vector<int>& written) const;
  std::vector<std::string> Prefixes(Place place) const;
  bool IsAttached(const std::string& prefix) const;
  void LeaveOutUnnamed(Place place, const std::function<bool(int)>& fits) const;

  const mjModel* m_;
  int instance_;
  mutable std::string left_out_;
};

/// The type of a joint in words: "a hinge joint".
std::string_view JointType(int type);

/// Whether a glob (* ? [..]) matches the whole name. A backslash takes the meaning of the character
/// after it; a text that is the name itself matches it whatever its characters mean. A dot that a
/// name begins with is matched by a dot only: so are named the parts that an effect has made.
bool GlobMatches(const std::string& glob, const std::string& name);

/// The words of a text. A space after a backslash belongs to its word.
std::vector<std::string> Words(std::string_view text);

/// Whether one of several globs, separated by spaces, matches the whole name.
bool AnyGlobMatches(std::string_view globs, const std::string& name);

/// The glob that matches this name and no other, as one word: of "joint[0] a" it is joint\[0]\ a.
std::string Escaped(const std::string& name);
/// The name that such a word stands for.
std::string Unescaped(const std::string& word);

template <class E>
std::vector<double> ReadParams(const Config& config) {
  std::vector<double> p;
  for (const Param& param : E::kParams) p.push_back(config.Read(param));
  return p;
}

template <class E>
ParamsOf<E, double> AsParams(const std::vector<double>& values) {
  ParamsOf<E, double> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = values[i];
  return p;
}

template <class E>
constexpr std::span<const Choice> ChoicesOf() {
  if constexpr (requires { E::kChoices; }) {
    return E::kChoices;
  } else {
    return {};
  }
}

}  // namespace continuum
