#include "models/statics/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace continuum::statics {

using Eigen::Vector2d;

std::string ScaleNumber(double value) {
  const std::string text = fmt::format("{:.4g}", std::abs(value));
  return value < 0 ? "\u2212" + text : text;
}

std::string Fitting(std::string text, double width, const Font& font, Canvas& canvas) {
  if (canvas.TextWidth(text, font) <= width) return text;
  while (!text.empty() && canvas.TextWidth(text + "\u2026", font) > width) {
    do {
      text.pop_back();
    } while (!text.empty() && (text.back() & 0xc0) == 0x80);
    // The first byte of a letter whose other bytes went.
    if (!text.empty() && (text.back() & 0xc0) == 0xc0) text.pop_back();
  }
  return text + "\u2026";
}

void DrawArrow(const PagePoint& tail, const PagePoint& head, const Pen& pen, Canvas& canvas) {
  const Vector2d along = head - tail;
  const double length = along.norm();
  if (length < 1) return;
  const double tip = std::min(5.0, 0.5 * length);
  const Vector2d back = along * (tip / length), side = 0.38 * Vector2d(-back.y(), back.x());
  canvas.Stroke({tail, head - 0.8 * back}, pen);
  canvas.Fill({head, head - back + side, head - back - side}, pen.colour);
}

void DrawAcross(const PagePoint& at, bool away, const Pen& pen, Canvas& canvas) {
  constexpr double kRadius = 4;
  canvas.Circle(at, kRadius, pen);
  if (!away) return canvas.Dot(at, 1.2, pen.colour);
  const double r = kRadius / std::numbers::sqrt2;
  canvas.Stroke({at + Vector2d(-r, -r), at + Vector2d(r, r)}, pen);
  canvas.Stroke({at + Vector2d(-r, r), at + Vector2d(r, -r)}, pen);
}

void DrawCross(const PagePoint& at, double half, const Colour& colour, Canvas& canvas) {
  const Pen pen{colour, 0.28 * half};
  canvas.Stroke({at + Vector2d(-half, -half), at + Vector2d(half, half)}, pen);
  canvas.Stroke({at + Vector2d(-half, half), at + Vector2d(half, -half)}, pen);
}

// Andrew's monotone chain.
std::vector<PagePoint> Hull(std::vector<PagePoint> points) {
  std::sort(points.begin(), points.end(), [](const PagePoint& a, const PagePoint& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<PagePoint> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t least = hull.size() + 2;
    for (const PagePoint& p : points) {
      const auto turns_right = [&] {
        const Vector2d a = hull.back() - hull[hull.size() - 2], b = p - hull.back();
        return a.x() * b.y() - a.y() * b.x() <= 0;
      };
      while (hull.size() >= least && turns_right()) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace continuum::statics
