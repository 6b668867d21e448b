#include "models/statics/error_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/marks.h"
#include "models/statics/palette.h"
#include "models/statics/results.h"
#include "sim/io/file.h"
#include "sim/page/axis_scale.h"

namespace continuum::statics {
namespace {

constexpr const char* kSets[] = {"train", "test"};
constexpr double kMillimetres = 1e3;

struct Summary {
  double mean = 0, std = 0, min = 0, q1 = 0, median = 0, q3 = 0, max = 0;
};

// Of values that rise: linear between neighbours.
double Quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  const double next = sorted[std::min(i + 1, sorted.size() - 1)];
  return sorted[i] + (at - static_cast<double>(i)) * (next - sorted[i]);
}

Summary SummaryOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto v =
      Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  Summary s{v.mean(), 0, values.front(), 0, 0, 0, values.back()};
  if (v.size() > 1) {
    s.std = std::sqrt((v - s.mean).square().sum() / static_cast<double>(v.size() - 1));
  }
  s.q1 = Quantile(values, 0.25);
  s.median = Quantile(values, 0.5);
  s.q3 = Quantile(values, 0.75);
  return s;
}

std::vector<double> Together(const std::vector<std::vector<double>>& parts) {
  std::vector<double> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void AddRow(const char* set, const std::string& disk, const std::vector<double>& values,
            double length, Results& results) {
  if (values.empty()) return;
  const Summary s = SummaryOf(values);
  results.Row();
  results.Set("set", set);
  results.Set("disk", disk);
  results.Set("cases", static_cast<int>(values.size()));
  results.Set("mae", s.mean);
  results.Set("mape", 100 * s.mean / length);
  for (const auto& [name, value] :
       {std::pair("std", s.std), std::pair("min", s.min), std::pair("q1", s.q1),
        std::pair("median", s.median), std::pair("q3", s.q3), std::pair("max", s.max)}) {
    results.Set(name, value);
  }
}

// Where and how a box stands on the page.
struct BoxPlace {
  double x, half;
  const page::Scale& up;
  Colour colour;
};

void DrawBox(const std::vector<double>& values, const BoxPlace& place, Canvas& canvas) {
  const Summary s = SummaryOf(values);
  const double reach = 1.5 * (s.q3 - s.q1);
  double low = s.q1, high = s.q3;
  const auto y = [&](double value) { return place.up(kMillimetres * value); };
  for (const double value : values) {
    if (value >= s.q1 - reach) low = std::min(low, value);
    if (value <= s.q3 + reach) high = std::max(high, value);
    if (value < s.q1 - reach || value > s.q3 + reach) {
      canvas.Dot({place.x, y(value)}, 1.2, place.colour);
    }
  }
  const double left = place.x - place.half, right = place.x + place.half;
  const Pen pen{place.colour, 0.9}, thick{place.colour, 1.8};
  canvas.Stroke({{place.x, y(low)}, {place.x, y(s.q1)}}, pen);
  canvas.Stroke({{place.x, y(s.q3)}, {place.x, y(high)}}, pen);
  for (const double end : {low, high}) {
    canvas.Stroke({{place.x - place.half / 2, y(end)}, {place.x + place.half / 2, y(end)}}, pen);
  }
  const std::vector<PagePoint> box{
      {left, y(s.q1)}, {right, y(s.q1)}, {right, y(s.q3)}, {left, y(s.q3)}, {left, y(s.q1)}};
  canvas.Fill(box, place.colour.Faded(0.2));
  canvas.Stroke(box, pen);
  canvas.Stroke({{left, y(s.median)}, {right, y(s.median)}}, thick);
  DrawCross({place.x, y(s.mean)}, 1.8, kInk, canvas);
}

constexpr double kWidth = 340, kHeight = 220, kLeft = 44, kRight = 330, kTop = 36, kBottom = 184;

void DrawScale(const page::Scale& up, double length, Canvas& canvas) {
  const Pen grid{{0.88, 0.88, 0.88}, 0.6}, frame{kInk, 0.8};
  for (const page::Tick& tick : page::Ticks(up.low(), up.high(), 6)) {
    const double y = up(tick.value);
    canvas.Stroke({{kLeft, y}, {kRight, y}}, grid);
    canvas.Text({kLeft - 4, y}, tick.text, {1, 0.5}, kSmall);
  }
  canvas.Stroke({{kLeft, kTop}, {kRight, kTop}, {kRight, kBottom}, {kLeft, kBottom}, {kLeft, kTop}},
                frame);
  canvas.Text({12, (kTop + kBottom) / 2}, "distance from measured [mm]", {0.5, 0.5}, {}, true);
  canvas.Text({(kLeft + kRight) / 2, kHeight - 10},
              fmt::format("disk (the last is the tip); length {:.4g} mm", kMillimetres * length),
              {0.5, 0});
}

}  // namespace

ErrorTable::ErrorTable(double length, int disks) : length_(length) {
  for (auto& set : distances_) set.resize(static_cast<std::size_t>(disks));
}

void ErrorTable::Add(bool test, const Eigen::VectorXd& distances) {
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    if (std::isnan(distances[i])) continue;
    distances_[test ? 1 : 0][static_cast<std::size_t>(i)].push_back(distances[i]);
  }
}

std::size_t ErrorTable::rows() const {
  return Together(distances_[0]).size() + Together(distances_[1]).size();
}

std::string ErrorTable::Sentence() const {
  std::string text;
  for (int set = 0; set < 2; ++set) {
    const bool tip = !distances_[set].back().empty();
    const auto values = tip ? distances_[set].back() : Together(distances_[set]);
    if (values.empty()) continue;
    const Summary s = SummaryOf(values);
    text +=
        fmt::format("{}{}, {} of {}: mean {:.3g} mm ({:.2g} % of the length), largest {:.3g} mm",
                    text.empty() ? "" : "; ", kSets[set], tip ? "tip" : "disks", values.size(),
                    kMillimetres * s.mean, 100 * s.mean / length_, kMillimetres * s.max);
  }
  return "distance from measured points: " + text;
}

void ErrorTable::Write(const std::filesystem::path& path) const {
  Results results(
      {"set", "disk", "cases", "mae", "mape", "std", "min", "q1", "median", "q3", "max"});
  for (int set = 0; set < 2; ++set) {
    for (std::size_t i = 0; i < distances_[set].size(); ++i) {
      AddRow(kSets[set], std::to_string(i + 1), distances_[set][i], length_, results);
    }
    AddRow(kSets[set], "all", Together(distances_[set]), length_, results);
  }
  results.Write(path);
}

void ErrorTable::DrawBoxes(const std::string& title, Canvas& canvas) const {
  page::Range range;
  range.Add(0);
  for (const auto& set : distances_) {
    for (const double value : Together(set)) range.Add(kMillimetres * value);
  }
  const page::Scale up(range, kBottom, kTop);
  DrawScale(up, length_, canvas);
  canvas.Text({kLeft, 16}, title, {}, {9, true});
  const bool both = !Together(distances_[0]).empty() && !Together(distances_[1]).empty();
  const std::size_t disks = distances_[0].size(), every = (disks + 29) / 30;
  const double wide = (kRight - kLeft) / static_cast<double>(disks),
               half = wide * (both ? 0.17 : 0.3);
  for (std::size_t i = 0; i < disks; ++i) {
    const double x = kLeft + (static_cast<double>(i) + 0.5) * wide;
    if ((disks - 1 - i) % every == 0) {
      canvas.Text({x, kBottom + 12}, std::to_string(i + 1), {0.5, 0}, kSmall);
    }
    for (int set = 0; set < 2; ++set) {
      if (distances_[set][i].empty()) continue;
      const double aside = both ? (set == 0 ? -0.21 : 0.21) * wide : 0;
      DrawBox(distances_[set][i],
              {x + aside, half, up, CasePen(static_cast<std::size_t>(set)).colour}, canvas);
    }
  }
  if (!both) return;
  for (int set = 0; set < 2; ++set) {
    const Font font{7, true, false, CasePen(static_cast<std::size_t>(set)).colour};
    canvas.Text({kRight - 60 + 34 * set, kTop - 6}, kSets[set], {}, font);
  }
}

void ErrorTable::Draw(const std::filesystem::path& path, const std::string& title) const {
  const PageNames names{title, Sentence()};
  WriteFile(path, Render(path.extension().string(), {kWidth, kHeight}, names,
                         [&](Canvas& canvas) { DrawBoxes(title, canvas); }));
}

void CheckErrorOptions(const SolveRequest& request) {
  for (const auto& [option, path] :
       {std::pair("--errors", &request.errors), std::pair("--boxplot", &request.boxplot)}) {
    if (path->empty() || !request.measured.empty()) continue;
    throw Error::Input(option, "--measured beside it", "none");
  }
  RequireTable(request.errors, "--errors");
  if (!request.boxplot.empty()) {
    RequireExtension(request.boxplot, {".png", ".svg", ".pdf"}, "--boxplot");
  }
}

void ReportErrors(const SolveRequest& request, const ErrorTable& errors, const std::string& title) {
  if (errors.empty()) return;
  request.say(errors.Sentence());
  if (!request.errors.empty()) errors.Write(request.errors);
  if (!request.boxplot.empty()) errors.Draw(request.boxplot, title);
}

}  // namespace continuum::statics
