#pragma once

namespace continuum {

/// Registers the sensor plugin "continuum.wrench".
void RegisterWrench();

}  // namespace continuum
