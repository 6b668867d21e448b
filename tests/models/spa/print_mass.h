#pragma once

#include <ostream>

#include "models/spa/spa.h"

namespace continuum {

/// For every test that compares or is named by a SpaMass: printed in one way, whoever is linked
/// first.
inline void PrintTo(SpaMass mass, std::ostream* out) {
  *out << (mass == SpaMass::kArc ? "Arc" : "Centroid");
}

}  // namespace continuum
