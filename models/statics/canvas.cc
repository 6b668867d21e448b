#include "models/statics/canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <memory>
#include <numbers>

#include "error.h"
#include "sim/page/text.h"

namespace continuum::statics {
namespace {

constexpr double kDotsPerPoint = 300.0 / 72;
constexpr char kFamily[] = "DejaVu Sans";

struct Destroy {
  void operator()(cairo_t* cairo) const { cairo_destroy(cairo); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};
template <class T>
using Owned = std::unique_ptr<T, Destroy>;

void Require(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw Error::Job(std::string("Cairo: ") + cairo_status_to_string(status));
}

// Cairo's callback: appends to the std::string behind `text`.
cairo_status_t Append(void* text, const unsigned char* bytes, unsigned count) noexcept {
  try {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

// Letters as designed, at any size and on any device.
void Unhinted(cairo_t* cairo) {
  const Owned<cairo_font_options_t> options(cairo_font_options_create());
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(cairo, options.get());
}

void DrawOn(cairo_surface_t* surface, const std::function<void(Canvas&)>& draw, bool ground,
            double scale = 1) {
  Require(cairo_surface_status(surface));
  const Owned<cairo_t> cairo(cairo_create(surface));
  Unhinted(cairo.get());
  if (ground) {
    cairo_set_source_rgb(cairo.get(), 1, 1, 1);
    cairo_paint(cairo.get());
  }
  cairo_scale(cairo.get(), scale, scale);
  Canvas canvas(cairo.get());
  draw(canvas);
  Require(cairo_status(cairo.get()));
}

std::string Png(const PagePoint& size, const std::function<void(Canvas&)>& draw) {
  const Eigen::Vector2i pixels = (kDotsPerPoint * size).array().round().cast<int>();
  const Owned<cairo_surface_t> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels.x(), pixels.y()));
  DrawOn(surface.get(), draw, true, kDotsPerPoint);
  std::string bytes;
  Require(cairo_surface_write_to_png_stream(surface.get(), Append, &bytes));
  return bytes;
}

void Finish(cairo_surface_t* surface) {
  cairo_surface_finish(surface);
  Require(cairo_surface_status(surface));
}

// Cairo numbers its surfaces over the life of the process: the name of the page is made the same.
void NameSurface(std::string& svg) {
  const std::string mark = "id=\"surface";
  const std::size_t begin = svg.find(mark);
  if (begin == svg.npos) return;
  const std::size_t number = begin + mark.size();
  svg.replace(number, svg.find('"', number) - number, "");
}

std::string Svg(const PagePoint& size, const PageNames& names,
                const std::function<void(Canvas&)>& draw) {
  std::string bytes;
  const Owned<cairo_surface_t> surface(
      cairo_svg_surface_create_for_stream(Append, &bytes, size.x(), size.y()));
  DrawOn(surface.get(), draw, true);
  Finish(surface.get());
  NameSurface(bytes);
  const std::size_t open = bytes.find("<svg");
  const std::size_t inside = bytes.find('>', open) + 1;
  bytes.insert(inside, "\n<title>" + page::Escape(names.title) + "</title>\n<desc>" +
                           page::Escape(names.description) + "</desc>");
  return bytes;
}

std::string Pdf(const PagePoint& size, const PageNames& names,
                const std::function<void(Canvas&)>& draw) {
  std::string bytes;
  const Owned<cairo_surface_t> surface(
      cairo_pdf_surface_create_for_stream(Append, &bytes, size.x(), size.y()));
  const auto set = [&](cairo_pdf_metadata_t key, const std::string& text) {
    cairo_pdf_surface_set_metadata(surface.get(), key, page::ValidUtf8(text).c_str());
  };
  set(CAIRO_PDF_METADATA_TITLE, names.title);
  set(CAIRO_PDF_METADATA_SUBJECT, names.description);
  set(CAIRO_PDF_METADATA_CREATE_DATE, "");
  DrawOn(surface.get(), draw, true);
  Finish(surface.get());
  return bytes;
}

}  // namespace

void Canvas::Trace(const std::vector<PagePoint>& line) {
  cairo_new_path(cairo_);
  for (const PagePoint& p : line) cairo_line_to(cairo_, p.x(), p.y());
}

namespace {

void Ink(cairo_t* cairo, const Colour& c) {
  cairo_set_source_rgba(cairo, c.red, c.green, c.blue, c.alpha);
}

void Apply(cairo_t* cairo, const Pen& pen) {
  Ink(cairo, pen.colour);
  cairo_set_line_width(cairo, pen.width);
  cairo_set_line_cap(cairo, pen.round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(cairo, pen.dash.data(), static_cast<int>(pen.dash.size()), 0);
}

}  // namespace

void Canvas::Stroke(const std::vector<PagePoint>& line, const Pen& pen) {
  Trace(line);
  Apply(cairo_, pen);
  cairo_stroke(cairo_);
}

void Canvas::Fill(const std::vector<PagePoint>& polygon, const Colour& colour) {
  Trace(polygon);
  Ink(cairo_, colour);
  cairo_close_path(cairo_);
  cairo_fill(cairo_);
}

void Canvas::Dot(const PagePoint& centre, double radius, const Colour& colour) {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, centre.x(), centre.y(), radius, 0, 2 * std::numbers::pi);
  Ink(cairo_, colour);
  cairo_fill(cairo_);
}

void Canvas::Circle(const PagePoint& centre, double radius, const Pen& pen) {
  cairo_new_path(cairo_);
  cairo_arc(cairo_, centre.x(), centre.y(), radius, 0, 2 * std::numbers::pi);
  Apply(cairo_, pen);
  cairo_stroke(cairo_);
}

void Canvas::Use(const Font& font) {
  cairo_select_font_face(cairo_, kFamily,
                         font.italic ? CAIRO_FONT_SLANT_OBLIQUE : CAIRO_FONT_SLANT_NORMAL,
                         font.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_, font.size);
  Ink(cairo_, font.colour);
}

double Canvas::TextWidth(const std::string& text, const Font& font) {
  Use(font);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_, page::ValidUtf8(text).c_str(), &extents);
  return extents.x_advance;
}

void Canvas::Text(const PagePoint& at, const std::string& text, const Anchor& anchor,
                  const Font& font, bool turned) {
  constexpr double kCapital = 0.73;  // height of a capital letter over the font's size
  const double width = TextWidth(text, font);
  cairo_save(cairo_);
  cairo_translate(cairo_, at.x(), at.y());
  if (turned) cairo_rotate(cairo_, -std::numbers::pi / 2);
  cairo_move_to(cairo_, -anchor.across * width, anchor.up * kCapital * font.size);
  cairo_show_text(cairo_, page::ValidUtf8(text).c_str());
  cairo_restore(cairo_);
}

void Canvas::Clipped(const PagePoint& corner, const PagePoint& size,
                     const std::function<void()>& draw) {
  cairo_save(cairo_);
  cairo_rectangle(cairo_, corner.x(), corner.y(), size.x(), size.y());
  cairo_clip(cairo_);
  draw();
  cairo_restore(cairo_);
}

std::string Render(const std::string& extension, const PagePoint& size, const PageNames& names,
                   const std::function<void(Canvas&)>& draw) {
  if (extension == ".png") return Png(size, draw);
  if (extension == ".svg") return Svg(size, names, draw);
  if (extension == ".pdf") return Pdf(size, names, draw);
  throw Error::Job("no picture of the format '" + extension + "'");
}

Eigen::Vector4d InkExtents(const std::function<void(Canvas&)>& draw) {
  const Owned<cairo_surface_t> surface(
      cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr));
  DrawOn(surface.get(), draw, false);
  double x = 0, y = 0, width = 0, height = 0;
  cairo_recording_surface_ink_extents(surface.get(), &x, &y, &width, &height);
  return {x, y, x + width, y + height};
}

}  // namespace continuum::statics
