// A film, simulated, drawn, captioned and encoded, against mjr_render alone of frames of its size.
#include <benchmark/benchmark.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "sim/film/film.h"
#include "sim/film/gl_context.h"
#include "sim/film/video.h"

namespace continuum {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kFps = 25;

using Clock = std::chrono::steady_clock;
double Since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Draws the scene of a pose again and again, as the renderer sets it up.
class Bare {
 public:
  explicit Bare(const ModelAndData& machine) : gl_(Gl::kAuto) {
    gl_.MakeCurrent();
    mjModel sized = *machine.model;  // shares all arrays
    sized.vis.global.offwidth = kWidth;
    sized.vis.global.offheight = kHeight;
    sized.vis.quality.offsamples = 0;
    sized.vis.quality.shadowsize = std::min(sized.vis.quality.shadowsize, 2048);
    mjv_defaultScene(&scene_), mjr_defaultContext(&context_);
    mjv_makeScene(machine.model.get(), &scene_, 8000);
    scene_.flags[mjRND_SHADOW] = 1, scene_.flags[mjRND_REFLECTION] = 0;
    mjr_makeContext(&sized, &context_, mjFONTSCALE_150);
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
    mjvOption option;
    mjvPerturb perturb;
    mjvCamera camera;
    mjv_defaultOption(&option), mjv_defaultPerturb(&perturb), mjv_defaultCamera(&camera);
    camera.type = mjCAMERA_FIXED;
    camera.fixedcamid = mj_name2id(machine.model.get(), mjOBJ_CAMERA, "side");
    mj_forward(machine.model.get(), machine.data.get());
    mjv_updateScene(machine.model.get(), machine.data.get(), &option, &perturb, &camera, mjCAT_ALL,
                    &scene_);
  }
  ~Bare() {
    gl_.MakeCurrent();
    mjr_freeContext(&context_), mjv_freeScene(&scene_);
  }
  Bare(const Bare&) = delete;

  // A pixel is read so that drawing has come to its end.
  double Seconds(int frames) {
    gl_.MakeCurrent();
    mjr_setBuffer(mjFB_OFFSCREEN, &context_);
    unsigned char pixel[3];
    const auto begin = Clock::now();
    for (int k = 0; k < frames; ++k) {
      mjr_render({0, 0, kWidth, kHeight}, &scene_, &context_);
      mjr_readPixels(pixel, nullptr, {0, 0, 1, 1}, &context_);
    }
    return Since(begin);
  }

 private:
  GlContext gl_;
  mjvScene scene_;
  mjrContext context_;
};

void Film(benchmark::State& state) {
  const Experiment e = Experiment::Read(CONTINUUM_SOURCE "/models/annelida/demo/annelida.yaml");
  const ModelSpec system = ModelSpec::Load(e.model);
  Bare bare(system.Build());
  FilmOptions options;
  options.width = kWidth, options.height = kHeight, options.fps = kFps;
  const auto file = std::filesystem::temp_directory_path() / "continuum_film_benchmark.mp4";
  double film = 0, alone = 0;
  for (auto _ : state) {
    int frames = 0;
    const auto begin = Clock::now();
    VideoWriter video(file, kWidth, kHeight, kFps);
    DrawFrames(e, system, e.logs.front(), options, [&](Image image) {
      video.Add(std::move(image));
      ++frames;
    });
    video.Finish();
    film += Since(begin);
    alone += bare.Seconds(frames);
    state.counters["frames"] = frames;
  }
  std::filesystem::remove(file);
  state.counters["film_s"] = film / static_cast<double>(state.iterations());
  state.counters["mjr_render_s"] = alone / static_cast<double>(state.iterations());
  state.counters["ratio"] = film / alone;
}
BENCHMARK(Film)->Unit(benchmark::kSecond)->Iterations(3);

}  // namespace
}  // namespace continuum
