#include "app/filming.h"

#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/console.h"
#include "error.h"

namespace continuum {
namespace {

// "960x720"
void ReadSize(const std::string& text, FilmOptions& film) {
  std::istringstream in(text);
  char by = 0;
  in >> film.width >> by >> film.height;
  const auto allowed = [](int n) { return 64 <= n && n <= 16384; };
  const bool whole = in && by == 'x' && in.peek() == std::istringstream::traits_type::eof();
  if (whole && allowed(film.width) && allowed(film.height)) return;
  throw Error::Input("--size", "WIDTHxHEIGHT, each from 64 to 16384 px", "'" + text + "'");
}

}  // namespace

std::vector<CLI::Option*> Filming::AddTo(CLI::App& command) {
  return {command.add_option("--size", size, "of a frame, WIDTHxHEIGHT")->capture_default_str(),
          command.add_option("--fps", fps, "frames per second")
              ->check(WholeNumberWithin(1, 1000))
              ->capture_default_str(),
          command.add_option("--camera", camera, "a camera of the model"),
          command.add_option("--gl", gl, "auto (osmesa, else egl), osmesa or egl")
              ->capture_default_str(),
          command.add_option("--log", log, "film only this log")};
}

void Filming::Set(FilmOptions& film, const mjModel& m) const {
  ReadSize(size, film);
  film.fps = fps;
  if (!camera.empty()) {
    CameraNamed(CamerasOf(m), camera);
    film.camera = camera;
    film.view.reset();
  }
  film.gl = ParseGl(gl);
  film.progress = ShowProgress;
}

std::vector<std::size_t> Filming::LogsOf(const Experiment& e) const {
  std::vector<std::size_t> logs;
  std::vector<std::string> labels;
  for (std::size_t l = 0; l < e.logs.size(); ++l) {
    labels.push_back(e.logs[l].label);
    if (log.empty() || log == labels.back()) logs.push_back(l);
  }
  if (!logs.empty()) return logs;
  throw Error::Input("--log", fmt::format("one of {}", fmt::join(labels, ", ")), "'" + log + "'");
}

}  // namespace continuum
