#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace continuum {

/// Where and when the outputs were measured, beside what each output's Measurement says:
///
///   p_meas(t) = R (p + Q o)(t − s) + T
///
/// of every position (framepos): R(rotation) and T turn and shift the world into the frame of the
/// measurement, o is the offset of the marker in the axes Q of the sensor's object, s the shift of
/// the outputs' clock against that of the inputs. R turns other vectors and orientations too.
struct Registration {
  enum class Part { kAbsent, kKnown, kEstimate };
  using Vector = std::array<double, 3>;
  Part frame = Part::kAbsent, marker = Part::kAbsent, clock = Part::kAbsent;
  Vector rotation{}, translation{};      ///< rotation vector [rad], [m]
  std::map<std::string, Vector> offset;  ///< of each sensor's marker [m]; "": of all others
  double clock_shift = 0;                ///< [s], positive: outputs are late

  bool has_frame() const {
    return frame != Part::kAbsent || rotation != Vector{} || translation != Vector{};
  }
  bool has_marker() const { return marker != Part::kAbsent || !offset.empty(); }
  bool has_clock() const { return clock != Part::kAbsent || clock_shift != 0; }
  bool estimates() const {
    return frame == Part::kEstimate || marker == Part::kEstimate || clock == Part::kEstimate;
  }
};

/// The offset of the marker of an output's sensor ("tip_pos" or "tip_pos[1]") [m]; zero without.
Registration::Vector OffsetOf(const Registration& r, const std::string& source);

/// A number of a registration by the name it has as a parameter's attribute (target
/// "registration"): rotation[i], translation[i], marker:SENSOR[i], clock_shift. Throws Error for
/// other names.
double& RegistrationValue(Registration& r, const std::string& attribute);
bool IsRegistration(const std::string& attribute);

/// Values and units; null when there is no registration.
nlohmann::json RegistrationJson(const Registration& r);
/// One line of text a part.
std::vector<std::string> RegistrationLines(const Registration& r);
/// As the experiment's key, all values known; empty when there is no registration.
std::string RegistrationYaml(const Registration& r);

}  // namespace continuum
