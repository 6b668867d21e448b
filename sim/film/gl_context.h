#pragma once

#include <memory>
#include <string_view>

namespace continuum {

/// How to get OpenGL without a screen: OSMesa (software), EGL (graphics card, or software), or the
/// one of them that is there: OSMesa first, which newer systems lack.
enum class Gl { kAuto, kOsmesa, kEgl };

/// "auto", "osmesa" or "egl". Throws Error for anything else.
Gl ParseGl(std::string_view name);

/// An OpenGL context without a window, for drawing into framebuffer objects.
///
/// The library is opened at run time and stays for the life of the process; MuJoCo resolves its
/// OpenGL functions from the one it finds, so a process can use only one of the two.
class GlContext {
 public:
  /// Creates the context and makes it current in this thread. Throws Error (kInput) when the other
  /// backend is already in use, (kJob) when the library is missing, naming its Debian package, or
  /// gives no context.
  explicit GlContext(Gl backend);
  ~GlContext();
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;

  /// Makes it current in the calling thread. Throws Error (kJob) when it is current in another one
  /// and the backend forbids that.
  void MakeCurrent();

  /// Largest width or height that a framebuffer can have [px]. The context must be current.
  int MaxSize() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace continuum
