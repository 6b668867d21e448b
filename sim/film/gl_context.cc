#include "sim/film/gl_context.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <array>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "error.h"

namespace continuum {

struct GlContext::Impl {
  virtual ~Impl() = default;
  virtual void MakeCurrent() = 0;
  virtual void* Function(const char* name) = 0;
};

namespace {

constexpr unsigned kGlUnsignedByte = 0x1401;
constexpr unsigned kGlRgba = 0x1908;
constexpr unsigned kGlMaxRenderbufferSize = 0x84E8;

std::string Name(Gl backend) { return backend == Gl::kOsmesa ? "osmesa" : "egl"; }

// Where a backend is found.
struct Files {
  std::array<const char*, 2> names;  // of the library
  const char* package;               // Debian's
};
constexpr Files kOsmesaFiles{{"libOSMesa.so.8", "libOSMesa.so.6"}, "libosmesa6"};
constexpr Files kEglFiles{{"libEGL.so.1", "libEGL.so"}, "libegl1"};

// Never closed: MuJoCo keeps pointers into it. nullptr if there is none.
void* Open(const Files& files) {
  for (const char* name : files.names) {
    if (void* const handle = dlopen(name, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) return handle;
  }
  return nullptr;
}

// The one that is there.
Gl Found() {
  if (Open(kOsmesaFiles)) return Gl::kOsmesa;
  if (Open(kEglFiles)) return Gl::kEgl;
  throw Error::Job(fmt::format(
      "pictures need EGL or OSMesa, and neither {} nor {} can be opened; on Debian: apt install "
      "{}, or {} where the system has it",
      kEglFiles.names[0], kOsmesaFiles.names[0], kEglFiles.package, kOsmesaFiles.package));
}

// The backend of this process: whoever asks first decides.
Gl Reserve(Gl backend) {
  static std::mutex mutex;
  static std::optional<Gl> used;
  const std::lock_guard lock(mutex);
  if (backend == Gl::kAuto) backend = used ? *used : Found();
  if (used && *used != backend) {
    throw Error::Input("OpenGL", "the backend this process already uses, " + Name(*used),
                       Name(backend));
  }
  used = backend;
  return backend;
}

class Library {
 public:
  explicit Library(const Files& files) : name_(files.names[0]), handle_(Open(files)) {
    if (handle_) return;
    throw Error::Job(
        fmt::format("{} cannot be opened; on Debian: apt install {}", name_, files.package));
  }

  template <class F>
  void Get(F& function, const char* symbol) const {
    function = reinterpret_cast<F>(dlsym(handle_, symbol));
    if (!function) throw Error::Job(name_ + " has no function " + symbol);
  }

 private:
  std::string name_;
  void* handle_;
};

struct Osmesa {
  Library library{kOsmesaFiles};
  void* (*create)(unsigned format, int depth, int stencil, int accumulation, void* share);
  void (*destroy)(void* context);
  unsigned char (*make_current)(void* context, void* buffer, unsigned type, int width, int height);
  void* (*get_current)();
  void* (*get_function)(const char* name);

  Osmesa() {
    library.Get(create, "OSMesaCreateContextExt");
    library.Get(destroy, "OSMesaDestroyContext");
    library.Get(make_current, "OSMesaMakeCurrent");
    library.Get(get_current, "OSMesaGetCurrentContext");
    library.Get(get_function, "OSMesaGetProcAddress");
  }
};

class OsmesaContext : public GlContext::Impl {
 public:
  OsmesaContext() : context_(lib_.create(kGlRgba, 24, 8, 0, nullptr)) {
    if (!context_) throw Error::Job("OSMesa gives no OpenGL context");
  }
  ~OsmesaContext() override { lib_.destroy(context_); }

  void MakeCurrent() override {
    if (lib_.get_current() == context_) return;
    if (!lib_.make_current(context_, window_.data(), kGlUnsignedByte, 1, 1)) {
      throw Error::Job("OSMesa cannot make its OpenGL context current");
    }
  }
  void* Function(const char* name) override { return lib_.get_function(name); }

 private:
  Osmesa lib_;
  std::array<unsigned char, 4> window_{};  // OSMesa wants one; all drawing is off-screen
  void* context_;
};

constexpr int kEglNone = 0x3038;
constexpr int kEglSurfaceType = 0x3033;
constexpr int kEglRenderableType = 0x3040;
constexpr int kEglOpenglBit = 0x0008;
constexpr unsigned kEglOpenglApi = 0x30A2;
constexpr unsigned kEglPlatformDevice = 0x313F;
constexpr unsigned kEglPlatformSurfaceless = 0x31DD;

struct Egl {
  Library library{kEglFiles};
  unsigned (*initialize)(void* display, int* major, int* minor);
  unsigned (*bind_api)(unsigned api);
  unsigned (*choose_config)(void* display, const int* attributes, void** configs, int size,
                            int* found);
  void* (*create_context)(void* display, void* config, void* share, const int* attributes);
  unsigned (*destroy_context)(void* display, void* context);
  unsigned (*make_current)(void* display, void* draw, void* read, void* context);
  void* (*get_current)();
  int (*get_error)();
  void* (*get_function)(const char* name);

  Egl() {
    library.Get(initialize, "eglInitialize");
    library.Get(bind_api, "eglBindAPI");
    library.Get(choose_config, "eglChooseConfig");
    library.Get(create_context, "eglCreateContext");
    library.Get(destroy_context, "eglDestroyContext");
    library.Get(make_current, "eglMakeCurrent");
    library.Get(get_current, "eglGetCurrentContext");
    library.Get(get_error, "eglGetError");
    library.Get(get_function, "eglGetProcAddress");
  }
  [[noreturn]] void Fail(const std::string& what) const {
    throw Error::Job(fmt::format("EGL {} (error {:#06x})", what, get_error()));
  }
};

class EglContext : public GlContext::Impl {
 public:
  EglContext() {
    if (!lib_.bind_api(kEglOpenglApi)) lib_.Fail("has no OpenGL");
    for (void* const display : Displays()) {
      if (Open(display)) return;
    }
    lib_.Fail("finds neither a device nor a surfaceless display with OpenGL");
  }
  // The display stays: all contexts of a device share it.
  ~EglContext() override {
    if (lib_.get_current() == context_) lib_.make_current(display_, nullptr, nullptr, nullptr);
    lib_.destroy_context(display_, context_);
  }

  void MakeCurrent() override {
    if (lib_.get_current() == context_) return;
    if (!lib_.bind_api(kEglOpenglApi) || !lib_.make_current(display_, nullptr, nullptr, context_)) {
      lib_.Fail("cannot make its OpenGL context current");
    }
  }
  void* Function(const char* name) override { return lib_.get_function(name); }

 private:
  template <class F>
  F Extension(const char* name) const {
    return reinterpret_cast<F>(lib_.get_function(name));
  }

  // Devices come first: with a graphics card, the surfaceless display may still be software.
  std::vector<void*> Displays() const {
    const auto get_display =
        Extension<void* (*)(unsigned, void*, const int*)>("eglGetPlatformDisplayEXT");
    const auto query = Extension<unsigned (*)(int, void**, int*)>("eglQueryDevicesEXT");
    if (!get_display) lib_.Fail("has no eglGetPlatformDisplayEXT");
    std::vector<void*> displays;
    std::array<void*, 16> devices{};
    int count = 0;
    if (query && query(static_cast<int>(devices.size()), devices.data(), &count)) {
      for (int i = 0; i < count; ++i) {
        displays.push_back(get_display(kEglPlatformDevice, devices[i], nullptr));
      }
    }
    displays.push_back(get_display(kEglPlatformSurfaceless, nullptr, nullptr));
    return displays;
  }

  bool Open(void* display) {
    if (!display || !lib_.initialize(display, nullptr, nullptr)) return false;
    const int wanted[] = {kEglSurfaceType, 0, kEglRenderableType, kEglOpenglBit, kEglNone};
    void* config = nullptr;
    int found = 0;
    if (!lib_.choose_config(display, wanted, &config, 1, &found) || found == 0) return false;
    void* const context = lib_.create_context(display, config, nullptr, nullptr);
    if (!context) return false;
    if (!lib_.make_current(display, nullptr, nullptr, context)) {
      lib_.destroy_context(display, context);
      return false;
    }
    display_ = display;
    context_ = context;
    return true;
  }

  Egl lib_;
  void* display_ = nullptr;
  void* context_ = nullptr;
};

std::unique_ptr<GlContext::Impl> Create(Gl backend) {
  if (Reserve(backend) == Gl::kOsmesa) return std::make_unique<OsmesaContext>();
  return std::make_unique<EglContext>();
}

}  // namespace

Gl ParseGl(std::string_view name) {
  if (name == "auto") return Gl::kAuto;
  if (name == "osmesa") return Gl::kOsmesa;
  if (name == "egl") return Gl::kEgl;
  throw Error::Input("OpenGL", "auto, osmesa or egl", std::string(name));
}

GlContext::GlContext(Gl backend) : impl_(Create(backend)) { MakeCurrent(); }
GlContext::~GlContext() = default;
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;

void GlContext::MakeCurrent() { impl_->MakeCurrent(); }

int GlContext::MaxSize() const {
  const auto get = reinterpret_cast<void (*)(unsigned, int*)>(impl_->Function("glGetIntegerv"));
  int size = 0;
  if (get) get(kGlMaxRenderbufferSize, &size);
  if (size <= 0) throw Error::Job("OpenGL has no framebuffer objects");
  return size;
}

}  // namespace continuum
