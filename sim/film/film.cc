#include "sim/film/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "engine.h"
#include "error.h"
#include "sim/experiment/measurement_model.h"
#include "sim/film/measured_points.h"
#include "sim/film/video.h"
#include "sim/io/decimal.h"
#include "sim/model/effect_kind.h"
#include "sim/numerics/round_number.h"
#include "sim/simulation/simulate.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

// Joint angles that the log measures at a row; false when it does not measure every joint.
class MeasuredPose {
 public:
  MeasuredPose(const Experiment& e, const Log& log, const mjModel& m)
      : e_(e), log_(log), m_(m), data_(mj_makeData(&m)) {
    std::size_t joints = 0;
    for (std::size_t c = 0; c < e.channels.size(); ++c) {
      const Output& out = e.outputs[e.channels[c].output];
      if (out.kind != Output::Kind::kSensor) continue;
      const int id = mj_name2id(&m, mjOBJ_SENSOR, out.source.c_str());
      if (id < 0 || m.sensor_type[id] != mjSENS_JOINTPOS) continue;
      channels_.emplace_back(c, m.jnt_qposadr[m.sensor_objid[id]]);
      ++joints;
    }
    complete_ = joints == static_cast<std::size_t>(m.njnt);
  }
  mjData* At(std::size_t row) {
    if (!complete_) return nullptr;
    const auto found = FindMeasured(log_, row, [&](std::size_t k) {
      return std::none_of(channels_.begin(), channels_.end(),
                          [&](const auto& c) { return std::isnan(log_.measured[c.first][k]); });
    });
    if (!found) return nullptr;
    for (const auto& [c, adr] : channels_) {
      const auto& how = e_.outputs[e_.channels[c].output].measurement;
      data_->qpos[adr] =
          (log_.measured[c][found->row] - e_.channels[c].factor * how.bias) / how.scale;
    }
    mj_fwdPosition(&m_, data_.get());
    return data_.get();
  }

 private:
  const Experiment& e_;
  const Log& log_;
  const mjModel& m_;
  Owned<mjData> data_;
  std::vector<std::pair<std::size_t, int>> channels_;
  bool complete_ = false;
};

std::string CameraOf(const mjModel& m, const std::string& wanted) {
  if (!wanted.empty()) return wanted;
  for (const char* name : {"side", "front"}) {
    if (mj_name2id(&m, mjOBJ_CAMERA, name) >= 0) return name;
  }
  return "";
}

// What the colours of cables or chambers mean.
std::optional<ColorBar> BarOf(const mjModel& m, const FilmOptions& options) {
  if (options.tension) {
    const auto& [low, high] = *options.tension;
    return ColorBar{"cable tension [N]", Decimal(low), Decimal(high)};
  }
  if (!HasSegmentLaw(m)) return std::nullopt;
  double full = 0;  // all chambers are alike
  for (int a = 0; a < m.nu; ++a) {
    if (!m.actuator_ctrllimited[a]) return std::nullopt;
    full = std::max(full, m.actuator_ctrlrange[2 * a + 1]);
  }
  return ColorBar{"chamber pressure [kPa]", "0", fmt::format("{:g}", 1e-3 * full)};
}

// Calls fn for each of our laws.
template <class Fn>
void ForEachLaw(const mjModel& m, const mjData& d, Fn&& fn) {
  for (int i = 0; i < m.nplugin; ++i) {
    if (BoundLaw* const law = FindBound(m, d, i)) fn(*law);
  }
}

// The largest that an effect knows of each cable's segments [N].
std::vector<std::optional<double>> EffectTensions(const mjModel& m, const mjData& d) {
  std::vector<std::optional<double>> tensions;
  ForEachLaw(m, d, [&](const BoundLaw& law) {
    if (law.LargestTension() > 0) tensions.emplace_back(law.LargestTension());
  });
  return tensions;
}

// What actuators pull each tendon with [N]; nullopt of those that none pulls or nobody sees.
std::vector<std::optional<double>> TensionsOf(const mjModel& m, const mjData& d) {
  std::vector<std::optional<double>> tensions(m.ntendon);
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_trntype[a] != mjTRN_TENDON) continue;
    const int t = m.actuator_trnid[2 * a];
    if (m.wrap_type[m.tendon_adr[t]] == mjWRAP_JOINT) continue;
    tensions[t] = tensions[t].value_or(0) - m.actuator_gear[6 * m.actuator_outadr[a]] *
                                                d.actuator_force[m.actuator_outadr[a]];
  }
  return tensions;
}

// Tendons from blue to red over a range [N]: by the actuators that pull them, or as an effect says.
void ColorTendons(const mjModel& m, const mjData& d, const std::array<double, 2>& range,
                  mjvScene& scene) {
  std::vector<double> tension;
  for (const auto& t : TensionsOf(m, d)) tension.push_back(t.value_or(0));
  const ColorBar bar;
  for (int g = 0; g < scene.ngeom; ++g) {
    mjvGeom& geom = scene.geoms[g];
    if (geom.objtype != mjOBJ_TENDON) continue;
    if (geom.category == mjCAT_DECOR)  // by an effect, which knows the tension of each segment
      tension[geom.objid] = range[1] * (geom.rgba[0] - bar.from[0]) / (bar.to[0] - bar.from[0]);
    const auto share = static_cast<float>(
        std::clamp((tension[geom.objid] - range[0]) / (range[1] - range[0]), 0.0, 1.0));
    for (int c = 0; c < 3; ++c) geom.rgba[c] = std::lerp(bar.from[c], bar.to[c], share);
  }
}

// MuJoCo draws an arrow half as long as its size says: its end goes twice as far.
void Connect(const Arrow& arrow, const mjModel& m, int type, const double* from, const double* to,
             mjvScene& scene) {
  if (scene.ngeom >= scene.maxgeom) return;
  mjvGeom& geom = scene.geoms[scene.ngeom++];
  const float rgba[4] = {arrow.color[0], arrow.color[1], arrow.color[2], 1};
  mjv_initGeom(&geom, type, nullptr, nullptr, nullptr, rgba);
  double end[3];
  mju_sub3(end, to, from);
  mju_addScl3(end, from, end, type == mjGEOM_ARROW ? 2 : 1);
  mjv_connector(&geom, type, 0.04 * m.stat.meansize, from, end);
  geom.category = mjCAT_DECOR;
}

void DrawAround(const Arrow& arrow, const mjModel& m, const double* center, const double* torque,
                mjvScene& scene) {
  constexpr int kSegments = 24, kHead = 6;
  double axis[3], side[3], top[3] = {0, 0, 1};
  mju_copy3(axis, torque);
  const double size = mju_normalize3(axis);
  if (std::abs(axis[2]) > 0.99) mju_copy3(top, std::array{1.0, 0.0, 0.0}.data());
  mju_cross(side, axis, top);
  mju_normalize3(side);
  mju_cross(top, side, axis);
  const double angle = std::min(arrow.length * size / arrow.radius, 1.8 * std::numbers::pi);
  const auto at = [&](int segment, double* point) {
    const double turn = angle * (static_cast<double>(segment) / kSegments - 0.5);
    mju_addScl3(point, center, top, arrow.radius * std::cos(turn));
    mju_addToScl3(point, side, arrow.radius * std::sin(turn));
  };
  double from[3], to[3];
  for (int segment = 0; segment < kSegments - kHead; ++segment) {
    at(segment, from), at(segment + 1, to);
    Connect(arrow, m, mjGEOM_CAPSULE, from, to, scene);
  }
  at(kSegments - kHead, from), at(kSegments, to);
  Connect(arrow, m, mjGEOM_ARROW, from, to, scene);
}

void Draw(const Arrow& arrow, const mjModel& m, const mjData& d, mjvScene& scene) {
  const int sensor = arrow.SensorOf(m), site = m.sensor_objid[sensor];
  const double* const center = d.site_xpos + 3 * site;
  double along[3], tip[3];
  mju_mulMatVec3(along, d.site_xmat + 9 * site, d.sensordata + m.sensor_adr[sensor]);
  if (arrow.radius > 0) return DrawAround(arrow, m, center, along, scene);
  mju_addScl3(tip, center, along, arrow.length);
  Connect(arrow, m, mjGEOM_ARROW, center, tip, scene);
}

// Says of each row whether a frame is due.
class Clock {
 public:
  Clock(const Log& log, const FilmOptions& options)
      : log_(log), frame_(options.speed / options.fps) {}

  bool Due(std::size_t row) {
    const double t = log_.time[row] - log_.time.front();
    if (t + 1e-9 < next_) return false;
    next_ += frame_ * std::ceil((t - next_ + 1e-9) / frame_);
    return true;
  }

 private:
  const Log& log_;
  double frame_, next_ = 0;
};

Renderer RendererOf(const mjModel& m, const FilmOptions& options) {
  Renderer renderer(m, options.width, options.height, options.gl);
  const std::string camera = CameraOf(m, options.camera);
  if (options.view)
    renderer.SetView(*options.view);
  else if (!camera.empty())
    renderer.SetCamera(camera);
  return renderer;
}

}  // namespace

int Arrow::SensorOf(const mjModel& m) const {
  const int id = mj_name2id(&m, mjOBJ_SENSOR, sensor.c_str());
  if (id >= 0 && (m.sensor_type[id] == mjSENS_FORCE || m.sensor_type[id] == mjSENS_TORQUE))
    return id;
  throw Error::Input(where, "a sensor of force or torque", "'" + sensor + "'");
}

void Decorate(const FilmOptions& options, const mjModel& m, const mjData& d, mjvScene& scene) {
  if (options.tension) ColorTendons(m, d, *options.tension, scene);
  for (const Arrow& arrow : options.arrows) Draw(arrow, m, d, scene);
}

// Both ends lie within the robot as a rule: drawn nearer to the camera and smaller they look the
// same, and are in front.
void DrawMeasured(const MeasuredPoint& point, const mjModel& m, mjvScene& scene) {
  const float green[4] = {0.10f, 0.65f, 0.25f, point.held ? 0.4f : 1};
  constexpr double kNearer = 0.6;  // of the distance; what is nearer than half may be clipped
  if (scene.ngeom + 2 > scene.maxgeom) return;
  double from[3], to[3];
  for (int i = 0; i < 3; ++i) {
    const double eye = (scene.camera[0].pos[i] + scene.camera[1].pos[i]) / 2;
    from[i] = std::lerp(eye, point.measured[i], kNearer);
    to[i] = std::lerp(eye, point.simulated[i], kNearer);
  }
  const double radius = kNearer * 0.25 * m.stat.meansize, size[3] = {radius, radius, radius};
  mjvGeom& ball = scene.geoms[scene.ngeom++];
  mjv_initGeom(&ball, mjGEOM_SPHERE, size, from, nullptr, green);
  ball.category = mjCAT_DECOR;
  if (point.held) return;
  mjvGeom& line = scene.geoms[scene.ngeom++];
  mjv_initGeom(&line, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, green);
  mjv_connector(&line, mjGEOM_CAPSULE, 0.3 * radius, from, to);
  line.category = mjCAT_DECOR;
}

void Outlook::Include(const std::vector<std::optional<double>>& tensions) {
  for (const auto& t : tensions) {
    if (!t) continue;
    if (!tension) tension = {0, 0};
    tension = {std::min((*tension)[0], -RoundUpClosely(-*t)),
               std::max((*tension)[1], RoundUpClosely(*t))};
  }
}

void Outlook::Include(const Outlook& other) {
  framing.Include(other.framing);
  if (other.tension) Include({(*other.tension)[0], (*other.tension)[1]});
}

Outlook LookAhead(const Experiment& e, const ModelSpec& system, const Log& log,
                  const FilmOptions& options) {
  ModelAndData machine = system.Build(SettingsOfModel(log));
  const Wiring wiring(e, *machine.model);
  MeasuredPose measured(e, log, *machine.model);
  Clock clock(log, options);
  Outlook ahead;
  Hooks look = Hooks::Stoppable();
  look.row = [&](const mjModel& m, mjData& d, std::size_t row) {
    if (!clock.Due(row)) return;
    ahead.framing.Include(m, d);
    if (!options.tension) ahead.Include(TensionsOf(m, d)), ahead.Include(EffectTensions(m, d));
    if (!options.ghost) return;
    if (const mjData* const ghost = measured.At(row))
      ahead.framing.Include(m, *ghost);
    else
      ahead.marked = ahead.marked || !MeasuredPoints(e, wiring, log, row, m, d).empty();
  };
  const Trace trace = Simulate(machine, e, log, options.start, look);
  if (options.whole && trace.diverged) throw Error::Job(log.file.string() + ": " + trace.Failure());
  return ahead;
}

void DrawFrames(const Experiment& e, const ModelSpec& system, const Log& log, FilmOptions options,
                const Outlook& ahead, Ruler& ruler, const std::function<void(Image)>& take) {
  const bool pulled = ahead.tension && (*ahead.tension)[0] < (*ahead.tension)[1];
  if (!options.tension && pulled) options.tension = ahead.tension;
  ModelAndData machine = system.Build(SettingsOfModel(log));
  const Wiring wiring(e, *machine.model);
  MeasuredPose measured(e, log, *machine.model);
  Renderer renderer = RendererOf(*machine.model, options);
  renderer.Include(ahead.framing);
  Clock clock(log, options);
  Hooks draw = Hooks::Stoppable();
  draw.row = [&](const mjModel& m, mjData& d, std::size_t row) {
    if (!clock.Due(row)) return;
    Overlay overlay;
    overlay.caption = options.caption.empty() ? log.label : options.caption;
    overlay.time = log.time[row] - log.time.front();
    if (options.ghost) overlay.ghost = measured.At(row);
    if (overlay.ghost) overlay.caption += " (translucent: measured)";
    const bool marks = !overlay.ghost && ahead.marked;
    std::vector<MeasuredPoint> points;
    if (marks) points = MeasuredPoints(e, wiring, log, row, m, d);
    if (marks) overlay.caption += " (green: measured)";
    overlay.ruler = &ruler;
    overlay.bar = BarOf(m, options);
    overlay.geoms = [&](mjvScene& scene) {
      Decorate(options, m, d, scene);
      for (const MeasuredPoint& point : points) DrawMeasured(point, m, scene);
    };
    const double red = options.tension ? (*options.tension)[1] : 0;
    ForEachLaw(m, d, [&](BoundLaw& law) { law.DrawRedAt(red); });
    take(renderer.Draw(m, d, overlay));
  };
  Simulate(machine, e, log, options.start, draw);
}

void DrawFrames(const Experiment& e, const ModelSpec& system, const Log& log,
                const FilmOptions& options, const std::function<void(Image)>& take) {
  Ruler ruler;
  DrawFrames(e, system, log, options, LookAhead(e, system, log, options), ruler, take);
}

void FilmExperiment(const Experiment& e, const ModelSpec& system,
                    const std::vector<std::size_t>& logs, const std::filesystem::path& file,
                    const FilmOptions& options) {
  VideoWriter video(file, options.width, options.height, options.fps);
  std::size_t done = 0;
  for (const std::size_t l : logs) {
    if (options.progress) options.progress({"film", done++, logs.size(), e.logs[l].label});
    DrawFrames(e, system, e.logs[l], options, [&](Image image) { video.Add(std::move(image)); });
  }
  video.Finish();
}

void PictureOf(const Experiment& e, const ModelSpec& system, std::size_t l,
               const std::filesystem::path& file, const FilmOptions& options) {
  std::vector<Image> frames;
  FilmOptions few = options;
  const Log& log = e.logs[l];
  few.speed = 1;
  few.fps = static_cast<int>(std::clamp(4 / (log.time.back() - log.time.front()), 1., 1000.));
  DrawFrames(e, system, log, few, [&](Image image) { frames.push_back(std::move(image)); });
  WritePng(file, frames[frames.size() / 2]);
}

}  // namespace continuum
