#include "sim/film/film_recipe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "error.h"
#include "sim/experiment/log_reader.h"
#include "sim/io/decimal.h"
#include "sim/io/yaml.h"
#include "sim/simulation/simulate.h"

namespace continuum {
namespace {

constexpr double kRow = 5e-3;  // of the film, inputs are straight between [s]
constexpr double kLongest = 600, kTiny = 1e-3;

std::vector<double> Count(const Yaml& y, std::size_t count, const char* expected) {
  const auto numbers = y.Numbers();
  if (numbers.size() == count) return numbers;
  throw Error::Input(y.Where(), expected, std::to_string(numbers.size()) + " numbers");
}

// At t, of points in order of time; a later point of the same time counts.
double InterpolateLinearly(const std::vector<std::vector<double>>& points, double t) {
  const auto next = std::upper_bound(points.begin(), points.end(), t,
                                     [](double time, const auto& p) { return time < p[0]; });
  if (next == points.begin()) return points.front()[1];
  const auto& from = *std::prev(next);
  if (next == points.end()) return from[1];
  return std::lerp(from[1], (*next)[1], (t - from[0]) / ((*next)[0] - from[0]));
}

std::vector<double> ReadPoints(const Yaml& y, const std::vector<double>& time) {
  std::vector<std::vector<double>> points;
  for (const Yaml& item : y.Items()) {
    points.push_back(Count(item, 2, "[time, control]"));
    if (points.size() > 1 && points.back()[0] < points.end()[-2][0])
      throw Error::Input(item.Where(), "times in order", Decimal(points.back()[0]));
  }
  if (points.empty()) throw Error::Input(y.Where(), "at least one point", "none");
  std::vector<double> values;
  for (const double t : time) values.push_back(InterpolateLinearly(points, t + 1e-9));
  return values;
}

std::vector<double> ReadWave(const Yaml& y, const std::vector<double>& time) {
  y.Only({"mean", "amplitude", "period", "delay", "rise"});
  const double mean = y.NumberOr("mean", 0, -1e12, 1e12), amplitude = y.At("amplitude").Number();
  const double period = y.At("period").Number(kTiny, kLongest);
  const double delay = y.NumberOr("delay", 0, -kLongest, kLongest);
  const double rise = y.NumberOr("rise", 0, 0, kLongest);
  std::vector<double> values;
  for (const double t : time) {
    const double share = t < rise ? t / rise : 1;
    values.push_back(share *
                     (mean + amplitude * std::sin(2 * std::numbers::pi * (t - delay) / period)));
  }
  return values;
}

Arrow ReadArrow(const Yaml& y) {
  y.Only({"sensor", "length", "color", "radius"});
  Arrow arrow{y.At("sensor").Text(), y.At("length").Number(), {0.1F, 0.6F, 0.3F}, y.Where()};
  if (const auto color = y.Find("color")) {
    const auto rgb = Count(*color, 3, "[red, green, blue]");
    std::transform(rgb.begin(), rgb.end(), arrow.color.begin(),
                   [](double c) { return static_cast<float>(c); });
  }
  if (const auto radius = y.Find("radius")) {
    arrow.radius = radius->Number();
    if (!(arrow.radius > 0))
      throw Error::Input(radius->Where(), "a radius above 0", radius->Text());
  }
  return arrow;
}

void ReadCamera(const Yaml& y, FilmOptions& film) {
  if (y.IsScalar()) {
    film.camera = y.Text();
    return;
  }
  y.Only({"azimuth", "elevation"});
  film.view = View{y.At("azimuth").Number(-360, 360), y.At("elevation").Number(-90, 90)};
}

Clip::Comparison ReadComparison(const Yaml& y) {
  y.Only({"caption", "set"});
  const Yaml set = y.At("set");
  return {y.At("caption").Text(), ReadSettings(set), set.Where()};
}

}  // namespace

bool Clip::Is(const std::filesystem::path& file) { return Yaml::Read(file).Has("seconds"); }

Clip Clip::Read(const std::filesystem::path& file) {
  const Yaml y = Yaml::Read(file);
  y.Only(
      {"model", "camera", "seconds", "caption", "speed", "tension", "arrows", "beside", "inputs"});
  Clip clip;
  clip.experiment.file = file;
  clip.experiment.model = file.parent_path() / y.At("model").Text();
  clip.film.whole = true;
  clip.film.caption = y.At("caption").Text();
  ReadCamera(y.At("camera"), clip.film);
  clip.film.speed = y.NumberOr("speed", 1, kTiny, 100);
  if (const auto tension = y.Find("tension")) {
    const auto range = Count(*tension, 2, "[blue, red]");
    if (!(range[0] < range[1])) throw Error::Input(tension->Where(), "rising numbers", "none");
    clip.film.tension = {range[0], range[1]};
  }
  if (const auto arrows = y.Find("arrows")) {
    for (const Yaml& item : arrows->Items()) clip.film.arrows.push_back(ReadArrow(item));
  }
  if (const auto beside = y.Find("beside")) clip.beside = ReadComparison(*beside);

  Log log;
  log.label = file.stem().string();
  log.file = file;
  const double seconds = y.At("seconds").Number(kTiny, kLongest);
  const double row = kRow * std::min(1.0, clip.film.speed);
  const auto rows = static_cast<int>(std::lround(std::ceil(seconds / row)));
  for (int k = 0; k <= rows; ++k) log.time.push_back(std::min(k * row, seconds));
  const Yaml inputs = y.At("inputs");
  for (const std::string& actuator : inputs.Keys()) {
    const Yaml course = inputs.At(actuator);
    Input in;
    in.column = in.actuator = actuator;
    in.linear = true;
    in.where = course.Where();
    clip.experiment.inputs.push_back(in);
    log.input.push_back(course.IsMap() ? ReadWave(course, log.time) : ReadPoints(course, log.time));
    log.enable.emplace_back();
  }
  clip.experiment.logs.push_back(std::move(log));
  return clip;
}

void Clip::Check(const ModelSpec& system) const {
  const mjModel& m = system.model();
  Wiring(experiment, m);
  if (!film.camera.empty() && mj_name2id(&m, mjOBJ_CAMERA, film.camera.c_str()) < 0)
    throw Error::Input(experiment.file.string() + ": camera", "a camera of the model",
                       "'" + film.camera + "'");
  for (const Arrow& arrow : film.arrows) arrow.SensorOf(m);
  if (beside) Beside(system);
}

ModelSpec Clip::Beside(const ModelSpec& system) const {
  try {
    return system.With(beside->set, {});
  } catch (const Error& error) {
    throw Error::Input(beside->where, error.what());
  }
}

}  // namespace continuum
