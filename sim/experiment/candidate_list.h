#pragma once

#include <vector>

#include "sim/experiment/experiment.h"

namespace continuum {

class Yaml;

/// The list under `candidates`: "all", names of effects, maps. Throws Error (file:line: key), also
/// for a candidate that is listed twice and for different laws of one name.
std::vector<Candidate> ReadCandidates(const Yaml& list);

}  // namespace continuum
