#pragma once

namespace continuum {

/// Where several ranks worked: says how much each of them did, and ends the job for all but the
/// first. Whether this one goes on, with what only one may do. Throws Error when the user, or
/// mpirun as a rank is gone, asked to stop.
bool GoOnAlone();

}  // namespace continuum
