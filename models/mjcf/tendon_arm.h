#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/mjcf/mjcf_builder.h"

namespace continuum {

/// A continuum arm of several segments, each bent by the displacement of its own tendons (SI).
///
/// The rod bends and neither twists nor stretches. A segment is cut into equal intervals of length
/// l with a universal joint in the middle of each, which bends with
///
///   K = EI/l  [N m/rad],   b = τ K  [N m s/rad]      (1)
///
/// about either axis: under a constant moment the chain has the slope of the rod at the ends of its
/// intervals, and its arc, smaller by x/tan x with x half the angle of an interval. Tendons pass
/// guides on a circle and end on the last plate of their segment; their drives are those of
/// Mjcf::AddDrive.
struct TendonArm {
  struct Segment {
    double length;      ///< [m]
    int links;          ///< intervals
    double EI;          ///< bending stiffness of the rod with all that is on it [N m^2]
    double plate_mass;  ///< of the plate at its end [kg]
    double pretension;  ///< of its tendons [N]
    Point marker;       ///< what is measured of the plate, in its frame [m]
  };
  struct Tendon {
    std::string name;
    int segment;     ///< 1 is the first
    double azimuth;  ///< in the base's frame, from x to y [rad]
    double travel;   ///< taken in per control [m]
  };

  std::string robot;
  std::vector<Segment> segments;
  std::vector<Tendon> tendons;
  bool guided_links;         ///< guides at every link's end, or only on the plates
  bool pull_only;            ///< tendons go slack; else tensions count from those at rest
  double rod_mass;           ///< per length [kg/m]
  double rod_radius;         ///< only drawn [m]
  double tau;                ///< damping over stiffness of the rod [s]
  double guide_radius;       ///< of the guides' circle [m]
  double stiffness;          ///< of a tendon with its drive [N/m]
  double damping;            ///< of a tendon with its drive [N s/m]
  double largest;            ///< tension [N]
  double timestep, gravity;  ///< [s], [m/s^2]
  bool hangs;                ///< z of the base points down, else up
  Point frame;               ///< origin of the measurements, in the world [m]
  std::vector<double> frame_quaternion;  ///< and its axes
};

/// Throws Error with file:line for missing and impossible values.
TendonArm ReadTendonArm(const std::filesystem::path& file);

/// The arm's MJCF: joints bend<i>_x, bend<i>_y (i = 1 at the base), tendons and actuators by name,
/// sites and position sensors plate<s> in the frame `frame`, body tip (massless, for payloads).
std::string TendonArmMjcf(const TendonArm& arm);

}  // namespace continuum
