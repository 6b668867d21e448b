#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "binding/friction_row.h"

namespace continuum {

/// A parameter of a friction law that is the native damping of its joints.
///
/// The laws on one joint add up, so the native damping of the MJCF must be 0 or their sum; a joint
/// whose laws have none keeps its own.
class NativeDamping {
 public:
  /// written: the parameter's value in the MJCF; effect, parameter: for messages.
  NativeDamping(std::string_view effect, std::string_view parameter, double written)
      : effect_(effect), parameter_(parameter), mine_(written) {}

  /// Writes the native damping of the rows, of which `own` is this law's part. Throws Error where
  /// the joint has another of its own.
  void Impose(mjModel& m, const std::vector<FrictionRow>& rows, double own) const;

 private:
  void ImposeSums(mjModel& m, const std::vector<FrictionRow>& rows) const;
  [[noreturn]] void Refuse(const mjModel& m, const FrictionRow& row, double allowed) const;

  std::string effect_, parameter_;
  mutable double mine_;  ///< this law's part so far, so that an edited value can follow
  mutable std::vector<bool> foreign_;  ///< rows whose native damping is the joint's own
};

}  // namespace continuum
