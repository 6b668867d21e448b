#include "sim/film/renderer.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "error.h"
#include "sim/film/overlay_painter.h"

namespace continuum {
namespace {

int FontScale(int height) {
  if (height < 720) return mjFONTSCALE_100;
  return height < 1080 ? mjFONTSCALE_150 : mjFONTSCALE_200;
}

// What a copy of a model shares with it.
std::array<mjtSize, 5> Contents(const mjModel& m) {
  return {m.ngeom, m.nmesh, m.nmat, m.ntex, m.nhfield};
}

struct SceneDeleter {
  void operator()(mjvScene* scene) const {
    mjv_freeScene(scene);
    delete scene;
  }
};

struct ContextDeleter {
  void operator()(mjrContext* context) const {
    mjr_freeContext(context);
    delete context;
  }
};

}  // namespace

std::vector<std::string> CamerasOf(const mjModel& m) {
  std::vector<std::string> names;
  for (int c = 0; c < m.ncam; ++c) {
    const char* const name = mj_id2name(&m, mjOBJ_CAMERA, c);
    names.emplace_back(name ? name : "");
  }
  return names;
}

int CameraNamed(const std::vector<std::string>& cameras, std::string_view name) {
  const auto it = std::find(cameras.begin(), cameras.end(), name);
  if (it != cameras.end()) return static_cast<int>(it - cameras.begin());
  const std::string known = cameras.empty() ? "no name, as the model has no cameras"
                                            : fmt::format("one of {}", fmt::join(cameras, ", "));
  throw Error::Input("camera", known, "'" + std::string(name) + "'");
}

class Renderer::Impl {
 public:
  Impl(const mjModel& m, int width, int height, Gl backend)
      : width_(width),
        height_(height),
        contents_(Contents(m)),
        cameras_(CamerasOf(m)),
        gl_(backend) {
    const int limit = std::min(gl_.MaxSize(), 16384);
    if (width < 64 || height < 64 || width > limit || height > limit) {
      throw Error::Input("frame", fmt::format("a width and height from 64 to {} px", limit),
                         fmt::format("{} x {}", width, height));
    }
    mjv_defaultOption(&option_);
    mjv_defaultPerturb(&perturb_);
    SetFreeCamera(m);
    MakeScene(m);
    MakeContext(m);
  }

  ~Impl() {
    try {
      gl_.MakeCurrent();
    } catch (const Error&) {  // its objects die with the context
      context_.release();
    }
  }

  void SetCamera(std::string_view name) {
    if (name.empty()) {
      camera_ = free_;
      return;
    }
    camera_.fixedcamid = CameraNamed(cameras_, name);
    camera_.type = mjCAMERA_FIXED;
  }

  void SetView(const View& view) {
    camera_ = free_;
    camera_.azimuth = view.azimuth;
    camera_.elevation = view.elevation;
  }

  void Include(const mjModel& m, const mjData& d) {
    CheckModel(m);
    framing_.Include(m, d);
  }
  void Include(const Framing& framing) { framing_.Include(framing); }

  Image Draw(const mjModel& m, mjData& d, const Overlay& overlay) {
    Include(m, d);
    if (overlay.ghost) Include(m, *overlay.ghost);
    gl_.MakeCurrent();
    mjr_setBuffer(mjFB_OFFSCREEN, context_.get());
    UpdateScene(m, d, overlay);
    mjr_render({0, 0, width_, height_}, scene_.get(), context_.get());
    Image image = Read();
    if (overlay.ruler) overlay.ruler->Measure(PixelAt(d), width_);
    Paint(overlay, *font_, image);
    return image;
  }

 private:
  void SetFreeCamera(const mjModel& m) {
    mjv_defaultCamera(&free_);
    free_.type = mjCAMERA_FREE;
    const bool unset = m.vis.global.azimuth == 90 && m.vis.global.elevation == -45;
    free_.azimuth = unset ? 120 : m.vis.global.azimuth;
    free_.elevation = unset ? -20 : m.vis.global.elevation;
    camera_ = free_;
  }

  void MakeScene(const mjModel& m) {
    const auto decoration = 4 * (m.ngeom + m.nsite + m.nwrap + m.nbody + m.njnt);
    scene_.reset(new mjvScene);
    mjv_defaultScene(scene_.get());
    mjv_makeScene(&m, scene_.get(), static_cast<int>(4000 + decoration));
    scene_->flags[mjRND_SHADOW] = 1;
    scene_->flags[mjRND_REFLECTION] = 0;
  }

  void MakeContext(const mjModel& m) {
    mjModel sized = m;  // shares all arrays; only the options differ
    sized.vis.global.offwidth = width_;
    sized.vis.global.offheight = height_;
    sized.vis.quality.offsamples = 0;
    sized.vis.quality.shadowsize = std::min(m.vis.quality.shadowsize, 2048);
    context_.reset(new mjrContext);
    mjr_defaultContext(context_.get());
    mjr_makeContext(&sized, context_.get(), FontScale(height_));
    mjr_setBuffer(mjFB_OFFSCREEN, context_.get());
    if (context_->currentBuffer != mjFB_OFFSCREEN) {
      throw Error::Job("OpenGL gives no off-screen buffer");
    }
    font_.emplace(*context_);
  }

  void CheckModel(const mjModel& m) const {
    if (Contents(m) == contents_) return;
    throw Error::Input("drawing", "the model that the renderer was made for", "another one");
  }

  void UpdateScene(const mjModel& m, mjData& d, const Overlay& overlay) {
    const bool free = camera_.type == mjCAMERA_FREE;
    const double aspect = static_cast<double>(width_) / height_;
    if (free) framing_.Aim(camera_, m.vis.global.fovy, aspect);
    mjv_updateScene(&m, &d, &option_, &perturb_, &camera_, mjCAT_ALL, scene_.get());
    if (overlay.ghost) AddGhost(m, *overlay.ghost);
    if (overlay.geoms) overlay.geoms(*scene_);
    if (free) framing_.KeepFromClipping(*scene_);
    if (scene_->status != 0) {
      throw Error::Job(fmt::format("a frame has more than {} geoms", scene_->maxgeom));
    }
  }

  // Length of a pixel [m] where the free camera looks, for others at the depth of the model's
  // centre of mass; 0 behind the camera.
  double PixelAt(const mjData& d) const {
    const mjvGLCamera& eye = scene_->camera[0];  // both eyes are as far away
    const double* const seen = camera_.type == mjCAMERA_FREE ? camera_.lookat : d.subtree_com;
    double depth = 0;
    for (int i = 0; i < 3; ++i) depth += eye.forward[i] * (seen[i] - eye.pos[i]);
    if (depth <= 0) return 0;
    const double height = eye.frustum_top - eye.frustum_bottom;
    return (eye.orthographic ? height : height * depth / eye.frustum_near) / height_;
  }

  void AddGhost(const mjModel& m, mjData& ghost) {
    const int first = scene_->ngeom;
    mjv_addGeoms(&m, &ghost, &option_, &perturb_, mjCAT_DYNAMIC, scene_.get());
    for (int g = first; g < scene_->ngeom; ++g) {
      scene_->geoms[g].rgba[3] *= 0.3f;
      scene_->geoms[g].castshadow = 0;
    }
  }

  Image Read() const {
    const std::size_t row = 3 * static_cast<std::size_t>(width_);
    Image image{width_, height_, std::vector<unsigned char>(row * height_)};
    mjr_readPixels(image.rgb.data(), nullptr, {0, 0, width_, height_}, context_.get());
    if (const int code = mjr_getError(); code != 0) {
      throw Error::Job(fmt::format("OpenGL reports error {:#x} after a frame", code));
    }
    auto low = image.rgb.begin(), high = image.rgb.end();  // OpenGL's rows go up
    for (int y = 0; y < height_ / 2; ++y, low += row) {
      high -= row;
      std::swap_ranges(low, low + row, high);
    }
    return image;
  }

  int width_, height_;
  std::array<mjtSize, 5> contents_;
  std::vector<std::string> cameras_;
  Framing framing_;
  mjvCamera free_, camera_;
  mjvOption option_;
  mjvPerturb perturb_;
  GlContext gl_;
  std::unique_ptr<mjvScene, SceneDeleter> scene_;
  std::unique_ptr<mjrContext, ContextDeleter> context_;
  std::optional<Font> font_;
};

Renderer::Renderer(const mjModel& m, int width, int height, Gl gl)
    : impl_(std::make_unique<Impl>(m, width, height, gl)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::SetCamera(std::string_view name) { impl_->SetCamera(name); }
void Renderer::SetView(const View& view) { impl_->SetView(view); }
void Renderer::Include(const mjModel& m, const mjData& d) { impl_->Include(m, d); }
void Renderer::Include(const Framing& framing) { impl_->Include(framing); }
Image Renderer::Draw(const mjModel& m, mjData& d, const Overlay& overlay) {
  return impl_->Draw(m, d, overlay);
}

}  // namespace continuum
