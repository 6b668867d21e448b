#include "models/statics/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "models/statics/marks.h"
#include "models/statics/palette.h"
#include "sim/numerics/round_number.h"

namespace continuum::statics {
namespace {

using Eigen::Vector2d;

class Legend {
 public:
  Legend(const Figure& figure, const Layout& layout, Canvas& canvas)
      : figure_(figure), layout_(layout), canvas_(canvas), at_(layout.legend) {}

  void Draw() {
    at_.y() += 4;
    Many(figure_) ? ColourBar() : Cases();
    at_.y() += 4;
    if (!Many(figure_)) Drives();
    if (!Many(figure_) && Any([](const Shape& s) { return !s.mount.empty(); })) Mount();
    if (Any([](const Shape& s) { return !s.measured.empty(); })) Measured();
    if (!Many(figure_)) Forces();
  }

 private:
  static constexpr double kSample = 20, kTextWidth = 88;

  bool Any(const std::function<bool(const Shape&)>& is) const {
    return std::any_of(figure_.shapes.begin(), figure_.shapes.end(), is);
  }

  // A sample and its text, one line.
  void Row(const std::function<void(const PagePoint& left, const PagePoint& right)>& sample,
           const std::string& text) {
    sample(at_, at_ + Vector2d(kSample, 0));
    canvas_.Text(at_ + Vector2d(kSample + 5, 0), Fitting(text, kTextWidth, kSmall, canvas_),
                 {0, 0.5}, kSmall);
    at_.y() += kLegendLine;
  }

  void Cases() {
    for (std::size_t i = 0; i < figure_.shapes.size(); ++i) {
      Row(
          [&](const auto& left, const auto& right) {
            canvas_.Stroke({left, right}, CasePen(i));
          },
          figure_.shapes[i].label);
    }
  }

  void Drives() {
    for (const bool active : {true, false}) {
      const auto is = [&](const Drive& d) { return d.active == active; };
      if (!Any([&](const Shape& s) { return std::any_of(s.drives.begin(), s.drives.end(), is); }))
        continue;
      Row(
          [&](const auto& left, const auto& right) {
            canvas_.Stroke({left, right}, {kInk.Faded(active ? 0.75 : 0.25), active ? 0.5 : 0.4});
          },
          active ? figure_.drive_name : figure_.idle_drive_name);
    }
  }

  void Mount() {
    Row(
        [&](const auto& left, const auto& right) {
          canvas_.Stroke({left, right}, {kInk.Faded(0.6), 0.7});
        },
        "mount beyond the tip");
  }

  void Measured() {
    Row([&](const auto& left,
            const auto& right) { DrawCross(0.5 * (left + right), 2.2, kInk, canvas_); },
        "measured");
  }

  // An arrow of a round force: the scale of all of them.
  void Forces() {
    const double largest = LargestForce(figure_);
    if (largest == 0) return;
    const double newtons = RoundDown(largest);
    const double length = newtons * layout_.metres_per_newton * layout_.panels[0].scale;
    at_.y() += 2;
    DrawArrow(at_, at_ + Vector2d(length, 0), {kInk, 1.1, {}, false}, canvas_);
    canvas_.Text(at_ + Vector2d(std::max(length, kSample) + 5, 0),
                 fmt::format("force of {} N", ScaleNumber(newtons)), {0, 0.5}, kSmall);
    at_.y() += kLegendLine;
  }

  void ColourBar() {
    constexpr double kWidth = 9, kHeight = 110;
    canvas_.Text(at_, fmt::format("{} cases", figure_.shapes.size()), {0, 0.5}, kSmall);
    at_.y() += kLegendLine;
    canvas_.Text(at_, Fitting(figure_.load_name, kTextWidth + 25, kSmall, canvas_), {0, 0.5},
                 kSmall);
    at_.y() += 9;
    Gradient({kWidth, kHeight});
    const LoadRange loads = LoadsOf(figure_);
    const double span = loads.high - loads.low;
    const double step = span > 0 ? RoundUp(span / 5) : 1;
    for (double n = std::ceil(loads.low / step - 1e-9); n * step <= loads.high + 1e-9 * step; ++n) {
      const PagePoint at = at_ + Vector2d(kWidth, kHeight * (1 - loads.Share(n * step)));
      canvas_.Stroke({at, at + Vector2d(2.5, 0)}, {kInk, 0.5});
      canvas_.Text(at + Vector2d(5, 0), ScaleNumber(n * step), {0, 0.5}, kSmall);
    }
    at_.y() += kHeight + kLegendLine;
  }

  // The colours from the lowest to the highest load, in a frame. Steps overlap: no white shows.
  void Gradient(const Vector2d& size) {
    constexpr int kSteps = 64;
    const Vector2d across(size.x(), 0);
    for (int i = 0; i < kSteps; ++i) {
      const Vector2d low(0, size.y() * (1 - static_cast<double>(i) / kSteps));
      const Vector2d high(0, size.y() * std::max(0.0, 1 - (i + 1.3) / kSteps));
      canvas_.Fill({at_ + low, at_ + low + across, at_ + high + across, at_ + high},
                   Viridis((i + 0.5) / kSteps));
    }
    const Vector2d down(0, size.y());
    canvas_.Stroke({at_, at_ + across, at_ + size, at_ + down, at_}, {kInk, 0.5});
  }

  const Figure& figure_;
  const Layout& layout_;
  Canvas& canvas_;
  PagePoint at_;
};

}  // namespace

void DrawLegend(const Figure& figure, const Layout& layout, Canvas& canvas) {
  Legend(figure, layout, canvas).Draw();
}

}  // namespace continuum::statics
