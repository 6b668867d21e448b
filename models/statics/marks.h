#pragma once

#include <string>
#include <vector>

#include "models/statics/canvas.h"

namespace continuum::statics {

inline constexpr Colour kInk = {0.1, 0.1, 0.1};
inline constexpr Font kSmall = {7};

/// A number of a scale, with a true minus sign.
std::string ScaleNumber(double value);

/// The text, its end replaced by an ellipsis where it is wider [pt].
std::string Fitting(std::string text, double width, const Font& font, Canvas& canvas);

/// From tail to head; nothing for one shorter than a point.
void DrawArrow(const PagePoint& tail, const PagePoint& head, const Pen& pen, Canvas& canvas);

/// A vector that points away from the viewer (a cross in a circle) or towards it (a dot).
void DrawAcross(const PagePoint& at, bool away, const Pen& pen, Canvas& canvas);

/// A measured place.
void DrawCross(const PagePoint& at, double half, const Colour& colour, Canvas& canvas);

/// The convex hull of points, as a polygon.
std::vector<PagePoint> Hull(std::vector<PagePoint> points);

}  // namespace continuum::statics
