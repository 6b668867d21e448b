#pragma once

namespace continuum {

/// The user asked to stop (Ctrl-C, or a signal that ends programs); may be called by a signal
/// handler.
void RequestStop();

/// Whether the user asked to stop; long work looks between its steps.
bool StopRequested();

/// While one lives, the first request to stop only asks to come to an end with what there is, by
/// EndRequested; the next one stops.
class GracefulEnd {
 public:
  GracefulEnd();
  ~GracefulEnd();
  GracefulEnd(const GracefulEnd&) = delete;
  GracefulEnd& operator=(const GracefulEnd&) = delete;
};

/// Whether the user asked to stop or to come to an end.
bool EndRequested();

/// Throws Error (kJob) once the user has asked to stop.
void StopIfRequested();

}  // namespace continuum
