#pragma once

#include <string>
#include <vector>

#include "random_diagnoses/draw.h"

namespace continuum::random_diagnoses {

/// A number of the model that an experiment may compare.
struct Seen {
  std::string source;  ///< as the experiment names it
  std::string unit;
};

/// A small random model: one to six hinges and slides, tendons, actuators and sensors of all kinds,
/// limits, contacts, keyframes, elements without names or with odd ones.
struct RandomModel {
  std::string xml;    ///< MJCF, as the user has it
  std::string truth;  ///< the same with other damping, masses, gains and dry friction
  std::vector<std::string> joints, tendons, bodies,
      actuators;  ///< names; empty where there is none
  std::vector<Seen> seen;
};
RandomModel DrawModel(Draw& draw);

}  // namespace continuum::random_diagnoses
