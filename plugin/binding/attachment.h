#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <mujoco/mujoco.h>

namespace continuum {

/// What attach may have put around the names of a robot, in configurations not: "left" + "bend1" +
/// "_2". Both may be empty.
struct Affixes {
  std::string prefix, suffix;
};

/// All keys and values of an instance, as the model keeps them: copies of one have the same.
std::string_view ConfigBytes(const mjModel& m, int instance);

/// How an instance came into a model, by the body that refers to it and by the names around that
/// body. Attach gives a prefix and a suffix to all names of a robot; mjModel does not keep which.
///
/// A body and the instance that it refers to have the affixes in common, and so have all named
/// parts of that body's branch. That alone may be chance (a body "finger", an instance "friction"),
/// so an affix also needs one of: the whole robot has it; or a twin, an instance of the same effect
/// and the same configuration, that is named the same but for its affixes.
class Attachment {
 public:
  Attachment(const mjModel& m, int instance);

  /// Affixes that an instance has for certain, the longest first; none where it has none.
  const std::vector<Affixes>& certain() const { return certain_; }
  /// Affixes that it may have: they count where names as written are none of its robot's, or of its
  /// branch where a name says more than "*".
  const std::vector<Affixes>& possible() const { return possible_; }
  /// Whether a body is of the robot that refers to the instance: of the tree that it hangs on.
  bool IsOfRobot(int body) const;
  /// Whether a body may have been attached so: its name, if it has one, has these affixes,
  /// and not the longer ones of a twin ("h1" and "h10").
  bool CanHave(int body, const Affixes& affixes) const;
  /// Whether a body is of the branch of the one that refers to the instance.
  bool IsOfBranch(int body) const;
  /// Whether a body is of this instance's robot, and another instance is referred to elsewhere.
  bool IsOwn(int body, int other) const;
  /// Whether a body is of the branch of a twin, and not of the instance's own.
  bool IsOfTwin(int body) const;

 private:
  struct Twin {
    int body;
    std::string name;
  };
  bool IsTwinOf(const Affixes& affixes) const;

  const mjModel* m_;
  std::string name_;
  int body_ = -1;  ///< that refers to it; −1: none does
  std::vector<Twin> twins_;
  std::vector<Affixes> certain_, possible_;
};

}  // namespace continuum
