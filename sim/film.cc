#include "sim/film.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "error.h"
#include "sim/video.h"

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
    for (const auto& [c, adr] : channels_) {
      const auto& how = e_.outputs[e_.channels[c].output].measurement;
      const double y = (log_.measured[c][row] - e_.channels[c].factor * how.bias) / how.scale;
      if (std::isnan(y)) return nullptr;
      data_->qpos[adr] = y;
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

bool HasCables(const mjModel& m) {
  for (int i = 0; i < m.nplugin; ++i) {
    if (std::string(mjp_getPluginAtSlot(m.plugin[i])->name) == "continuum.capstan") return true;
  }
  return false;
}

// Draws one log's rows at the film's rate.
class Shot {
 public:
  Shot(const Experiment& e, const System& system, const Log& log, const FilmOptions& options)
      : e_(e),
        log_(log),
        options_(options),
        machine_(system.Build(log.set)),
        renderer_(*machine_.model, options.width, options.height, options.gl),
        measured_(e, log, *machine_.model) {
    const std::string camera = CameraOf(*machine_.model, options.camera);
    if (!camera.empty()) renderer_.SetCamera(camera);
  }

  void Film(const std::function<void(Image)>& take) {
    const double frame = 1.0 / options_.fps;
    const auto due = [&](std::size_t row, double& next) {
      const double t = log_.time[row] - log_.time.front();
      if (t + 1e-9 < next) return false;
      next += frame * std::ceil((t - next + 1e-9) / frame);
      return true;
    };
    double next = 0;
    Hooks look = Hooks::Stoppable();
    look.row = [&](const mjModel& m, mjData& d, std::size_t row) {
      if (due(row, next)) renderer_.Include(m, d);
    };
    Simulate(machine_, e_, log_, {}, look);
    next = 0;
    Hooks draw = Hooks::Stoppable();
    draw.row = [&](const mjModel& m, mjData& d, std::size_t row) {
      if (!due(row, next)) return;
      Overlay overlay;
      overlay.caption = options_.caption.empty() ? log_.label : options_.caption;
      overlay.time = log_.time[row] - log_.time.front();
      if (options_.ghost) overlay.ghost = measured_.At(row);
      if (overlay.ghost) overlay.caption += " (translucent: measured)";
      if (HasCables(m)) overlay.bar = ColorBar{"cable tension [N]", "0", "20"};
      take(renderer_.Draw(m, d, overlay));
    };
    Simulate(machine_, e_, log_, {}, draw);
  }

 private:
  const Experiment& e_;
  const Log& log_;
  const FilmOptions& options_;
  Machine machine_;
  Renderer renderer_;
  MeasuredPose measured_;
};

}  // namespace

void FilmExperiment(const Experiment& e, const System& system, const std::vector<std::size_t>& logs,
                    const std::filesystem::path& file, const FilmOptions& options) {
  VideoWriter video(file, options.width, options.height, options.fps);
  for (const std::size_t l : logs) {
    if (options.progress) options.progress("film of " + e.logs[l].label);
    Shot(e, system, e.logs[l], options).Film([&](Image image) { video.Add(std::move(image)); });
  }
  video.Finish();
}

void PictureOf(const Experiment& e, const System& system, const std::filesystem::path& file,
               const FilmOptions& options) {
  std::vector<Image> frames;
  FilmOptions few = options;
  const Log& log = e.logs.front();
  few.fps = static_cast<int>(std::clamp(4 / (log.time.back() - log.time.front()), 1., 1000.));
  Shot(e, system, log, few).Film([&](Image image) { frames.push_back(std::move(image)); });
  WritePng(file, frames[frames.size() / 2]);
}

}  // namespace continuum
