#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

typedef struct _cairo cairo_t;

namespace continuum::statics {

/// A place on the page: x to the right, y down [pt, 1/72 inch].
using PagePoint = Eigen::Vector2d;

struct Colour {
  double red = 0, green = 0, blue = 0;  ///< sRGB, 0 to 1
  double alpha = 1;                     ///< 0 invisible, 1 opaque

  Colour Faded(double share) const { return {red, green, blue, share * alpha}; }
};

struct Pen {
  Colour colour;
  double width = 1;               ///< [pt]
  std::vector<double> dash = {};  ///< lengths on and off in turn [pt]; empty: solid
  bool round = true;              ///< ends of the line
};

struct Font {
  double size = 8;  ///< [pt]
  bool bold = false, italic = false;
  Colour colour = {0.1, 0.1, 0.1};
};

/// Where a text stands relative to its point, as shares of its size: across 0 starts there, 0.5 is
/// centred, 1 ends there; up 0 puts the line of writing there, 0.5 the middle of capitals, 1 their
/// top.
struct Anchor {
  double across = 0, up = 0;
};

/// A page to draw on, the same for PNG, SVG and PDF (Cairo, https://cairographics.org).
class Canvas {
 public:
  explicit Canvas(cairo_t* cairo) : cairo_(cairo) {}

  void Stroke(const std::vector<PagePoint>& line, const Pen& pen);
  void Fill(const std::vector<PagePoint>& polygon, const Colour& colour);
  void Dot(const PagePoint& centre, double radius, const Colour& colour);
  void Circle(const PagePoint& centre, double radius, const Pen& pen);
  /// `turned`: reads upwards.
  void Text(const PagePoint& at, const std::string& text, const Anchor& anchor = {},
            const Font& font = {}, bool turned = false);
  /// [pt]
  double TextWidth(const std::string& text, const Font& font = {});
  /// Whatever `draw` draws shows inside the rectangle only.
  void Clipped(const PagePoint& corner, const PagePoint& size, const std::function<void()>& draw);

 private:
  void Trace(const std::vector<PagePoint>& line);
  void Use(const Font& font);

  cairo_t* cairo_;
};

/// What a file carries beside its lines: a search or a screen reader finds it.
struct PageNames {
  std::string title;
  std::string description;
};

/// The bytes of a file that shows a page of `size` [pt] on white. The same drawing gives the same
/// bytes: no dates. PNG: 300 dots per inch.
/// @param extension .png, .svg or .pdf. @throws Error when Cairo fails.
std::string Render(const std::string& extension, const PagePoint& size, const PageNames& names,
                   const std::function<void(Canvas&)>& draw);

/// Lower left and upper right of all ink on an endless page [pt], y down: (x0, y0, x1, y1).
Eigen::Vector4d InkExtents(const std::function<void(Canvas&)>& draw);

}  // namespace continuum::statics
