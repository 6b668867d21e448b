#pragma once

#include <string>
#include <vector>

#include "identification/inverse_dynamics/missing_force.h"

namespace continuum {

/// A number that says what shape a term has: a frequency, a place, a width.
struct TermShape {
  std::string name;  ///< in the parts
  std::string unit;
  double lower, upper;
  std::vector<double> grid;  ///< values to begin a search from
};

/// A term of a law that nobody has listed: a sum of parts, each with a size of its own.
struct LawTerm {
  struct Part {
    std::string text;  ///< of the variables of Formula and the shapes: "sin(s1*q)"
    std::string unit;  ///< of its size, so that the sum is a force
  };
  std::vector<Part> parts;
  std::vector<TermShape> shapes = {};
  /// A number of the model, which effects of the catalog change: no law by itself.
  bool plain = false;

  /// Every combination of values from the grids; one, empty, where it has no shapes.
  std::vector<std::vector<double>> Grid() const;
};

/// How a joint moves on all logs, as far as terms are shaped by it.
struct JointReach {
  bool slides = false;
  double lower = 0, upper = 0;  ///< position
  double speed = 0;             ///< root mean square
  double duration = 0;          ///< of the longest log [s]
  double period = 0;            ///< between rows [s]
};
JointReach ReachOf(const MissingForce& joint);

/// Terms that a force on a joint may be made of: springs that are stiffer somewhere or beyond a
/// point, periodic in the position, drag, motor and weight times anything, time, heat of the motor.
std::vector<LawTerm> TermsOf(const JointReach& reach);
/// Those that tie the joint to another one, by its name.
std::vector<LawTerm> TermsWith(const JointReach& reach, const JointReach& other,
                               const std::string& name);
/// Those that are products of two other joints, by their names.
std::vector<LawTerm> TermsWith(const JointReach& reach, const std::string& one,
                               const std::string& other);
/// Those that two joints feel from each other: of energies of their product, their difference (a
/// spring or damper between them) or their sum.
std::vector<LawTerm> TermsOfTwo(const JointReach& one, const JointReach& other);

}  // namespace continuum
