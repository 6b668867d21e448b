#pragma once

namespace continuum {

/// Throws Error when more than one MuJoCo library is in the process, or one of another release than
/// the plugin was built for.
void RequireOneMujoco();

}  // namespace continuum
