#include "sim/renderer.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "error.h"

namespace continuum {
namespace {

using Vector = std::array<double, 3>;

Vector At(const mjtNum* p) { return {p[0], p[1], p[2]}; }
double Dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Along the axes of the world; empty as long as low > high.
struct Box {
  Vector low, high;

  Box() {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }
  void Add(const Vector& p, const Vector& half = {0, 0, 0}) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i] - half[i]);
      high[i] = std::max(high[i], p[i] + half[i]);
    }
  }
  void Add(const Box& other) {
    if (other.Empty()) return;
    Add(other.low);
    Add(other.high);
  }
  bool Empty() const { return low[0] > high[0]; }
  Vector Center() const {
    return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
  }
  double Radius() const {
    return Empty() ? 0 : std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2;
  }
  Vector Corner(int k) const {
    return {k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]};
  }
};

// The box of a geom, an object of half sizes h turned by R: half sizes |R| h.
Box BoxOfGeom(const mjModel& m, const mjData& d, int g) {
  const mjtNum* const r = d.geom_xmat + 9 * g;
  const mjtNum* const local = m.geom_aabb + 6 * g;  // center, half sizes
  Vector center = At(d.geom_xpos + 3 * g), half{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      center[i] += r[3 * i + j] * local[j];
      half[i] += std::abs(r[3 * i + j]) * local[3 + j];
    }
  }
  Box box;
  box.Add(center, half);
  return box;
}

// What the free camera has to see.
class Framing {
 public:
  void Include(const mjModel& m, const mjData& d, const mjvOption& option) {
    std::vector<Box> fixed;
    for (int g = 0; g < m.ngeom; ++g) {
      const bool visible = option.geomgroup[m.geom_group[g]] && m.geom_rgba[4 * g + 3] > 0;
      if (!visible || m.geom_type[g] == mjGEOM_PLANE) continue;
      const Box box = BoxOfGeom(m, d, g);
      if (Moves(m, m.geom_bodyid[g]))
        moving_.Add(box);
      else
        fixed.push_back(box);
    }
    for (int s = 0; s < m.nsite; ++s) {
      if (Moves(m, m.site_bodyid[s])) moving_.Add(At(d.site_xpos + 3 * s));
    }
    for (int t = 0; t < m.ntendon; ++t) {
      for (int k = 0; k < d.ten_wrapnum[t]; ++k) {
        moving_.Add(At(d.wrap_xpos + 3 * (d.ten_wrapadr[t] + k)));
      }
    }
    shown_.Add(moving_);
    for (const Box& box : fixed) {
      if (Near(box)) shown_.Add(box);
    }
  }

  // Sets a free camera of given direction so that every corner p of the box is inside its picture:
  // with q = p - center, |q.up| and |q.right|/aspect <= fill tan(fovy/2) (distance + q.forward).
  void Aim(mjvCamera& camera, double fovy, double aspect) {
    if (shown_.Empty()) return;
    constexpr double kFill = 0.84;  // leaves a strip for text above and below
    const double deg = std::numbers::pi / 180;
    const double ca = std::cos(camera.azimuth * deg), sa = std::sin(camera.azimuth * deg);
    const double ce = std::cos(camera.elevation * deg), se = std::sin(camera.elevation * deg);
    const Vector forward = {ca * ce, sa * ce, se}, up = {-ca * se, -sa * se, ce};
    const Vector right = {sa, -ca, 0};
    const double slope = kFill * std::tan(fovy * deg / 2);
    const Vector center = shown_.Center();
    const double radius = std::max(shown_.Radius(), 1e-6);
    camera.distance = 1.2 * radius;
    for (int k = 0; k < 8; ++k) {
      Vector q = shown_.Corner(k);
      for (int i = 0; i < 3; ++i) q[i] -= center[i];
      const double off = std::max(std::abs(Dot(q, up)), std::abs(Dot(q, right)) / aspect);
      camera.distance = std::max(camera.distance, off / slope - Dot(q, forward));
    }
    std::copy(center.begin(), center.end(), camera.lookat);
    nearest_ = camera.distance - radius;
    farthest_ = camera.distance + radius;
  }

  // The clipping planes of a model may suit another scale: moves them off what must be seen.
  void KeepFromClipping(mjvScene& scene) const {
    if (shown_.Empty()) return;
    for (mjvGLCamera& eye : scene.camera) {
      const float near = std::min(eye.frustum_near, static_cast<float>(0.5 * nearest_));
      const float scale = near / eye.frustum_near;
      for (float* side : {&eye.frustum_center, &eye.frustum_width, &eye.frustum_bottom,
                          &eye.frustum_top, &eye.frustum_near}) {
        *side *= scale;
      }
      eye.frustum_far = std::max(eye.frustum_far, static_cast<float>(2 * farthest_));
    }
  }

 private:
  static bool Moves(const mjModel& m, int body) { return m.body_weldid[body] != 0; }

  // Within the reach of the robot: its base and what it may touch, not the room around it.
  bool Near(const Box& box) const {
    if (moving_.Empty()) return true;
    const Vector a = box.Center(), b = moving_.Center();
    const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    return distance + box.Radius() <= 2.5 * moving_.Radius();
  }

  Box moving_, shown_;
  double nearest_ = 0, farthest_ = 0;
};

// MuJoCo's fonts have the printable ASCII characters only.
std::string Ascii(const std::string& text) {
  static const std::vector<std::pair<std::string, std::string>> kSpelled = {
      {"°", " deg"}, {"µ", "u"}, {"μ", "u"}, {"×", "x"},  {"·", "."}, {"²", "^2"}, {"³", "^3"},
      {"–", "-"},    {"—", "-"}, {"−", "-"}, {"±", "+-"}, {"’", "'"}, {"…", "..."}};
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x80) {
      out += c == '\n' || (c >= 32 && c < 127) ? text[i] : ' ';
      ++i;
      continue;
    }
    const auto it = std::find_if(kSpelled.begin(), kSpelled.end(), [&](const auto& s) {
      return text.compare(i, s.first.size(), s.first) == 0;
    });
    out += it == kSpelled.end() ? "?" : it->second;
    if (it != kSpelled.end())
      i += it->first.size();
    else
      while (++i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80) {
      }
  }
  return out;
}

// The glyphs of MuJoCo's font, read back once: to lay text over finished pixels costs far less than
// to have OpenGL draw it into every frame.
struct Font {
  int line = 0;                                       // height of a line [px]
  std::array<int, 127> width{};                       // [px]
  std::array<std::vector<unsigned char>, 127> cover;  // line rows from the top, 0..255

  explicit Font(const mjrContext& context) : line(context.charHeight * 5 / 4) {
    std::copy_n(context.charWidth, width.size(), width.begin());
    for (std::size_t c = 33; c < cover.size(); ++c) {
      const std::array<char, 2> text = {static_cast<char>(c), '\0'};
      const mjrRect box = {0, 0, width[c], line};
      mjr_label(box, mjFONT_NORMAL, text.data(), 0, 0, 0, 1, 1, 1, 1, &context);
      std::vector<unsigned char> rgb(3 * static_cast<std::size_t>(box.width) * box.height);
      mjr_readPixels(rgb.data(), nullptr, box, &context);
      for (int y = line - 1; y >= 0; --y) {
        for (int x = 0; x < width[c]; ++x) cover[c].push_back(rgb[3 * (y * width[c] + x)]);
      }
    }
  }
  int Width(const std::string& text) const {
    int sum = 0;
    for (const char c : text) sum += width[static_cast<unsigned char>(c)];
    return sum;
  }
};

// Text and bars over the finished picture, on dark translucent plates.
class Painter {
 public:
  Painter(const Font& font, Image& image)
      : font_(font), image_(image), pad_(2 * font.line / 5), line_(font.line) {}

  void Caption(const std::string& text) {
    const std::vector<std::string> lines = Wrap(Ascii(text), image_.width - 4 * pad_);
    int widest = 0;
    for (const std::string& line : lines) widest = std::max(widest, font_.Width(line));
    Plate(pad_, pad_, widest + 2 * pad_, line_ * static_cast<int>(lines.size()) + pad_);
    int top = pad_ + pad_ / 2;
    for (const std::string& line : lines) {
      Line(line, 2 * pad_, top);
      top += line_;
    }
  }

  void Time(double time) {
    const std::string text = fmt::format("t = {:.2f} s", time);
    const int top = image_.height - 2 * pad_ - line_;
    Plate(pad_, top, font_.Width(text) + 2 * pad_, line_ + pad_);
    Line(text, 2 * pad_, top + pad_ / 2);
  }

  // The label, and below it: low, the colours, high.
  void Bar(const ColorBar& bar) {
    const std::string label = Ascii(bar.label), low = Ascii(bar.low), high = Ascii(bar.high);
    const int ends = font_.Width(low) + font_.Width(high) + 2 * pad_;
    const int inner = std::max(font_.Width(label), ends + 6 * line_);
    const int left = image_.width - inner - 2 * pad_;
    const int top = image_.height - 2 * line_ - 5 * pad_ / 2;
    Plate(left - pad_, top, inner + 2 * pad_, 2 * line_ + 3 * pad_ / 2);
    Line(label, left, top + pad_ / 2);
    const int row = top + pad_ + line_, from = left + font_.Width(low) + pad_;
    Line(low, left, row);
    Line(high, from + inner - ends + pad_, row);
    Gradient(bar, from, row + line_ / 5, inner - ends, 3 * line_ / 5);
  }

 private:
  using Color = std::array<float, 3>;

  void Blend(int x, int y, const Color& color, float opacity) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    unsigned char* const pixel = image_.rgb.data() + 3 * (std::ptrdiff_t{y} * image_.width + x);
    for (int c = 0; c < 3; ++c) {
      const auto old = static_cast<float>(pixel[c]);
      pixel[c] = static_cast<unsigned char>(old + opacity * (255 * color[c] - old) + 0.5f);
    }
  }
  void Plate(int left, int top, int width, int height) {
    for (int y = top; y < top + height; ++y) {
      for (int x = left; x < left + width; ++x) Blend(x, y, {0.05f, 0.07f, 0.10f}, 0.62f);
    }
  }
  void Line(const std::string& text, int left, int top) {
    for (const char character : text) {
      const auto c = static_cast<unsigned char>(character);
      const int width = font_.width[c];
      for (std::size_t i = 0; i < font_.cover[c].size(); ++i) {
        const auto k = static_cast<int>(i);
        const float cover = static_cast<float>(font_.cover[c][i]) / 255;
        if (cover > 0) Blend(left + k % width, top + k / width, {1, 1, 1}, cover);
      }
      left += width;
    }
  }
  void Gradient(const ColorBar& bar, int left, int top, int width, int height) {
    for (int x = 0; x < width; ++x) {
      const float share = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
      Color color;
      for (int c = 0; c < 3; ++c) {
        color[c] = std::clamp(std::lerp(bar.from[c], bar.to[c], share), 0.0f, 1.0f);
      }
      for (int y = 0; y < height; ++y) Blend(left + x, top + y, color, 1);
    }
  }

  // At spaces; a word longer than a line goes on in the next.
  std::vector<std::string> Wrap(const std::string& text, int width) const {
    std::vector<std::string> lines(1);
    std::size_t space = std::string::npos;  // last one of the line
    for (const char c : text) {
      if (c == '\n') {
        lines.emplace_back();
        space = std::string::npos;
        continue;
      }
      if (c == ' ') space = lines.back().size();
      lines.back() += c;
      if (font_.Width(lines.back()) <= width || lines.back().size() == 1) continue;
      const std::size_t cut = space == std::string::npos ? lines.back().size() - 1 : space;
      std::string rest = lines.back().substr(space == std::string::npos ? cut : cut + 1);
      lines.back().resize(cut);
      lines.push_back(std::move(rest));
      space = std::string::npos;
    }
    return lines;
  }

  const Font& font_;
  Image& image_;
  int pad_, line_;
};

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

class Renderer::Impl {
 public:
  Impl(const mjModel& m, int width, int height, Gl backend)
      : width_(width), height_(height), contents_(Contents(m)), gl_(backend) {
    const int limit = std::min(gl_.MaxSize(), 16384);
    if (width < 64 || height < 64 || width > limit || height > limit) {
      throw Error::Input("frame", fmt::format("a width and height from 64 to {} px", limit),
                         fmt::format("{} x {}", width, height));
    }
    for (int c = 0; c < m.ncam; ++c) {
      const char* const name = mj_id2name(&m, mjOBJ_CAMERA, c);
      cameras_.emplace_back(name ? name : "");
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
    const auto it = std::find(cameras_.begin(), cameras_.end(), name);
    if (it == cameras_.end()) {
      const std::string known = cameras_.empty()
                                    ? "no name, as the model has no cameras"
                                    : fmt::format("one of {}", fmt::join(cameras_, ", "));
      throw Error::Input("camera", known, std::string(name));
    }
    camera_.type = mjCAMERA_FIXED;
    camera_.fixedcamid = static_cast<int>(it - cameras_.begin());
  }

  void Include(const mjModel& m, const mjData& d) {
    CheckModel(m);
    framing_.Include(m, d, option_);
  }

  Image Draw(const mjModel& m, mjData& d, const Overlay& overlay) {
    Include(m, d);
    if (overlay.ghost) Include(m, *overlay.ghost);
    gl_.MakeCurrent();
    mjr_setBuffer(mjFB_OFFSCREEN, context_.get());
    UpdateScene(m, d, overlay);
    mjr_render({0, 0, width_, height_}, scene_.get(), context_.get());
    Image image = Read();
    Painter painter(*font_, image);
    if (!overlay.caption.empty()) painter.Caption(overlay.caption);
    if (overlay.time) painter.Time(*overlay.time);
    if (overlay.bar) painter.Bar(*overlay.bar);
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
void Renderer::Include(const mjModel& m, const mjData& d) { impl_->Include(m, d); }
Image Renderer::Draw(const mjModel& m, mjData& d, const Overlay& overlay) {
  return impl_->Draw(m, d, overlay);
}

}  // namespace continuum
