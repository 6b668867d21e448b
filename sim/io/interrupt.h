#pragma once

namespace continuum {

/// The user asked to stop (Ctrl-C, or a signal that ends programs); may be called by a signal
/// handler.
void RequestStop();

/// Whether the user asked to stop; long work looks between its steps.
bool StopRequested();

/// Throws Error (kJob) once the user has asked to stop.
void StopIfRequested();

}  // namespace continuum
