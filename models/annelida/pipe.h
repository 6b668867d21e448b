#pragma once

#include <string>

#include "models/annelida/annelida.h"

namespace continuum {

/// A pipe that goes down, round an elbow of 90 degrees and on along x. The middle of its mouth is
/// the world's origin. All lengths [m], chosen so that the paper's arm gets round it without its
/// stops.
///
/// It is made of flat staves around the circle `inner`. Those in front (−y) touch like the others
/// and are not drawn.
struct Pipe {
  double inner = 0.0625;           ///< radius inside
  double bend = 0.12;              ///< radius of the elbow's axis
  double drop = 0.10, out = 0.05;  ///< straight parts before and after it
  double wall = 0.006;             ///< thickness
  int staves = 12;                 ///< around
  int segments = 8;                ///< of the elbow
};

/// The snake arm in the mouth of a wet pipe, on a slide that feeds it: the actuator `feed` [m]
/// moves the base down. Each link touches the pipe as the sphere around its discs, without
/// friction.
std::string AnnelidaInPipeMjcf(const AnnelidaParameters& p, const Pipe& pipe = {});

}  // namespace continuum
