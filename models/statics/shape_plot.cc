#include "models/statics/shape_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "models/statics/font.h"
#include "models/statics/results.h"
#include "sim/film/image.h"
#include "sim/io/file.h"
#include "sim/numerics/round_number.h"

namespace continuum::statics {
namespace {

constexpr double kWidth = 1260, kHeight = 540, kMargin = 70, kLegend = 250;
constexpr std::size_t kNamed = 18;  // so many cases fit into the legend, and a line about the rest
constexpr double kLetter = 2;       // pixels per dot of a letter

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kInk = {40, 40, 40}, kFaint = {215, 215, 215};

// Everything that is drawn, in pixels with y down, for both formats.
struct Mark {
  enum class Kind { kLine, kDot, kText } kind;
  std::vector<std::array<double, 2>> points;
  double size;  // width of a line, radius of a dot
  Colour colour;
  std::string text = {};
};

// A hue per case, evenly round the circle, dark enough for a white ground.
Colour Hue(std::size_t i, std::size_t count) {
  const double turn = static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(count, 1));
  Colour colour;
  for (std::size_t c = 0; c < 3; ++c) {
    const double angle = 2 * 3.14159265358979 * (turn - static_cast<double>(c) / 3);
    colour[c] = static_cast<std::uint8_t>(std::lround(105 + 95 * std::cos(angle)));
  }
  return colour;
}

struct Box {
  double lower[2] = {std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};
  double upper[2] = {-lower[0], -lower[1]};

  void Add(double right, double up) {
    lower[0] = std::min(lower[0], right);
    upper[0] = std::max(upper[0], right);
    lower[1] = std::min(lower[1], up);
    upper[1] = std::max(upper[1], up);
  }
};

Box Extent(const Picture& picture, const std::array<int, 2>& view) {
  Box box;
  box.Add(0, 0);
  for (const Shape& shape : picture.shapes) {
    for (const auto* points : {&shape.line, &shape.markers, &shape.measured}) {
      for (const auto& p : *points) {
        box.Add(p[static_cast<std::size_t>(view[0])], p[static_cast<std::size_t>(view[1])]);
      }
    }
  }
  return box;
}

// One view: a square of pixels that shows `span` metres around the middle of the box.
struct View {
  double left, top, side, span;
  double corner[2];  // metres at the lower left
  std::array<int, 2> axes;

  std::array<double, 2> At(double right, double up) const {
    return {left + (right - corner[0]) / span * side, top + side - (up - corner[1]) / span * side};
  }
  std::array<double, 2> At(const std::array<double, 3>& p) const {
    return At(p[static_cast<std::size_t>(axes[0])], p[static_cast<std::size_t>(axes[1])]);
  }
};

void AddText(std::vector<Mark>& marks, double x, double y, const std::string& text) {
  marks.push_back({Mark::Kind::kText, {{x, y}}, kLetter, kInk, text});
}

double TextWidth(const std::string& text) { return 6 * kLetter * static_cast<double>(text.size()); }

void AddAxes(const View& view, std::vector<Mark>& marks) {
  const double step = RoundUp(view.span / 5);
  const double bottom = view.top + view.side, right = view.left + view.side;
  for (int a = 0; a < 2; ++a) {
    const double first = std::ceil(view.corner[a] / step) * step;
    for (double value = first; value <= view.corner[a] + view.span * (1 + 1e-9); value += step) {
      const double shown = std::abs(value) < step / 2 ? 0 : value;
      const std::string text = fmt::format("{:.6g}", 1e3 * shown);
      if (a == 0) {
        const double x = view.At(value, view.corner[1])[0];
        marks.push_back({Mark::Kind::kLine, {{x, view.top}, {x, bottom}}, 1, kFaint});
        AddText(marks, x - TextWidth(text) / 2, bottom + 8, text);
      } else {
        const double y = view.At(view.corner[0], value)[1];
        marks.push_back({Mark::Kind::kLine, {{view.left, y}, {right, y}}, 1, kFaint});
        AddText(marks, view.left - TextWidth(text) - 6, y - 7, text);
      }
    }
  }
  marks.push_back({Mark::Kind::kLine,
                   {{view.left, view.top},
                    {right, view.top},
                    {right, bottom},
                    {view.left, bottom},
                    {view.left, view.top}},
                   1,
                   kInk});
  const char* const names[3] = {"x [mm]", "y [mm]", "z [mm]"};
  const std::string across = names[view.axes[0]], up = names[view.axes[1]];
  AddText(marks, view.left + view.side / 2 - TextWidth(across) / 2, bottom + 30, across);
  AddText(marks, view.left - 20, view.top - 22, up);
}

void AddShapes(const Picture& picture, const View& view, std::vector<Mark>& marks) {
  for (std::size_t i = 0; i < picture.shapes.size(); ++i) {
    const Shape& shape = picture.shapes[i];
    const Colour colour = Hue(i, picture.shapes.size());
    Mark line{Mark::Kind::kLine, {}, 2.5, colour};
    for (const auto& p : shape.line) line.points.push_back(view.At(p));
    marks.push_back(std::move(line));
    for (const auto& p : shape.markers)
      marks.push_back({Mark::Kind::kDot, {view.At(p)}, 3.5, colour});
    for (const auto& p : shape.measured) {
      const auto at = view.At(p);
      constexpr double r = 4;
      marks.push_back(
          {Mark::Kind::kLine, {{at[0] - r, at[1] - r}, {at[0] + r, at[1] + r}}, 1.5, kInk});
      marks.push_back(
          {Mark::Kind::kLine, {{at[0] - r, at[1] + r}, {at[0] + r, at[1] - r}}, 1.5, kInk});
    }
  }
}

// As much of a label as the legend has room for, no letter of UTF-8 cut in two.
std::string Short(const std::string& label) {
  std::size_t length = std::min<std::size_t>(label.size(), 18);
  while (length < label.size() && length > 0 && (label[length] & 0xc0) == 0x80) --length;
  return label.substr(0, length);
}

void AddLegend(const Picture& picture, std::vector<Mark>& marks) {
  const std::size_t shown = std::min(picture.shapes.size(), kNamed);
  const double x = kWidth - kLegend;
  for (std::size_t i = 0; i < shown; ++i) {
    const double y = kMargin + 24 * static_cast<double>(i);
    marks.push_back(
        {Mark::Kind::kLine, {{x, y + 7}, {x + 18, y + 7}}, 3, Hue(i, picture.shapes.size())});
    AddText(marks, x + 24, y, Short(picture.shapes[i].label));
  }
  if (shown < picture.shapes.size()) {
    AddText(marks, x, kMargin + 24 * static_cast<double>(shown),
            fmt::format("and {} more", picture.shapes.size() - shown));
  }
}

std::vector<Mark> Layout(const Picture& picture) {
  std::vector<Mark> marks;
  AddText(marks, kMargin, 18, picture.title);
  const double side = (kWidth - kLegend - 3 * kMargin) / 2;
  std::array<Box, 2> boxes;
  double span = 0;
  for (std::size_t v = 0; v < 2; ++v) {
    boxes[v] = Extent(picture, picture.views[v]);
    for (int a = 0; a < 2; ++a) span = std::max(span, boxes[v].upper[a] - boxes[v].lower[a]);
  }
  span = span > 0 ? 1.1 * span : 1;
  for (std::size_t v = 0; v < 2; ++v) {
    View view{kMargin + static_cast<double>(v) * (side + kMargin),
              kMargin,
              side,
              span,
              {},
              picture.views[v]};
    for (int a = 0; a < 2; ++a) {
      view.corner[a] = (boxes[v].lower[a] + boxes[v].upper[a] - span) / 2;
    }
    AddAxes(view, marks);
    AddShapes(picture, view, marks);
  }
  AddLegend(picture, marks);
  return marks;
}

std::string Escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '&')
      safe += "&amp;";
    else
      safe += c;
  }
  return safe;
}

// Pixels drawn at three times the size, then averaged: smooth edges without further ado.
class Raster {
 public:
  static constexpr int kFine = 3;

  void Draw(const Mark& mark) {
    if (mark.kind == Mark::Kind::kText) return Text(mark);
    if (mark.kind == Mark::Kind::kDot)
      return Stroke(mark.points[0], mark.points[0], mark.size, mark.colour);
    for (std::size_t i = 1; i < mark.points.size(); ++i) {
      Stroke(mark.points[i - 1], mark.points[i], mark.size / 2, mark.colour);
    }
  }

  Image Averaged() const {
    Image image{static_cast<int>(kWidth), static_cast<int>(kHeight), {}};
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          int sum = 0;
          for (int k = 0; k < kFine * kFine; ++k) {
            sum += fine_[Index(kFine * x + k % kFine, kFine * y + k / kFine)][c];
          }
          image.rgb.push_back(static_cast<std::uint8_t>(sum / (kFine * kFine)));
        }
      }
    }
    return image;
  }

 private:
  static constexpr int kColumns = kFine * static_cast<int>(kWidth);
  static constexpr int kRows = kFine * static_cast<int>(kHeight);

  static std::size_t Index(int x, int y) { return static_cast<std::size_t>(y * kColumns + x); }

  // All fine pixels within `radius` of the segment.
  void Stroke(std::array<double, 2> a, std::array<double, 2> b, double radius, Colour colour) {
    const double r = kFine * radius;
    for (double* v : {&a[0], &a[1], &b[0], &b[1]}) *v *= kFine;
    const auto range = [&](double p, double q, int limit) {
      const double low = std::clamp(std::min(p, q) - r, 0., limit - 1.);
      const double high = std::clamp(std::max(p, q) + r, 0., limit - 1.);
      return std::array{static_cast<int>(low), static_cast<int>(high)};
    };
    const auto columns = range(a[0], b[0], kColumns), rows = range(a[1], b[1], kRows);
    const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
    for (int y = rows[0]; y <= rows[1]; ++y) {
      for (int x = columns[0]; x <= columns[1]; ++x) {
        const double px = x + 0.5 - a[0], py = y + 0.5 - a[1];
        const double t = square > 0 ? std::clamp((px * dx + py * dy) / square, 0., 1.) : 0;
        const double aside = px - t * dx, along = py - t * dy;
        if (aside * aside + along * along <= r * r) fine_[Index(x, y)] = colour;
      }
    }
  }

  void Text(const Mark& mark) {
    double left = mark.points[0][0];
    for (const char letter : mark.text) {
      const Glyph* const glyph = FindGlyph(letter);
      for (int row = 0; glyph != nullptr && row < kGlyphRows; ++row) {
        for (int column = 0; column < 5; ++column) {
          if (!(glyph->rows[row] >> (4 - column) & 1)) continue;
          const std::array dot{left + mark.size * (column + 0.5),
                               mark.points[0][1] + mark.size * (row + 0.5)};
          Stroke(dot, dot, 0.6 * mark.size, mark.colour);
        }
      }
      left += 6 * mark.size;
    }
  }

  std::vector<Colour> fine_ = std::vector<Colour>(Index(0, kRows), Colour{255, 255, 255});
};

}  // namespace

std::string Svg(const Picture& picture) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
      "viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"15\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      kWidth, kHeight);
  for (const Mark& mark : Layout(picture)) {
    const auto [r, g, b] = mark.colour;
    const auto& p = mark.points.front();
    if (mark.kind == Mark::Kind::kText) {
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", p[0], p[1] + 7 * kLetter,
                         Escaped(mark.text));
    } else if (mark.kind == Mark::Kind::kDot) {
      svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\" fill=\"rgb({},{},{})\"/>\n",
                         p[0], p[1], mark.size, r, g, b);
    } else {
      svg += "<polyline fill=\"none\" points=\"";
      for (const auto& q : mark.points) svg += fmt::format("{:.2f},{:.2f} ", q[0], q[1]);
      svg += fmt::format("\" stroke=\"rgb({},{},{})\" stroke-width=\"{}\"/>\n", r, g, b, mark.size);
    }
  }
  return svg + "</svg>\n";
}

void WritePicture(const std::filesystem::path& path, const Picture& picture) {
  RequireExtension(path, {".png", ".svg"}, "--plot");
  if (path.extension() == ".svg") return WriteFile(path, Svg(picture));
  Raster raster;
  for (const Mark& mark : Layout(picture)) raster.Draw(mark);
  WritePng(path, raster.Averaged());
}

}  // namespace continuum::statics
