#include "sim/film/image.h"

#include <cstddef>
#include <memory>
#include <string>

#include <cairo.h>

#include "error.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

struct Destroy {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};

cairo_status_t Append(void* text, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

void WritePng(const std::filesystem::path& path, const Image& image) {
  const std::unique_ptr<cairo_surface_t, Destroy> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
  const auto check = [&](cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS)
      throw Error::Job(path.string() + ": " + cairo_status_to_string(status));
  };
  check(cairo_surface_status(surface.get()));
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  unsigned char* const pixels = cairo_image_surface_get_data(surface.get());
  const unsigned char* rgb = image.rgb.data();
  for (int y = 0; y < image.height; ++y) {
    auto* const row = reinterpret_cast<unsigned*>(pixels + stride * static_cast<std::size_t>(y));
    for (int x = 0; x < image.width; ++x, rgb += 3)
      row[x] = static_cast<unsigned>(rgb[0] << 16 | rgb[1] << 8 | rgb[2]);
  }
  cairo_surface_mark_dirty(surface.get());
  std::string bytes;
  check(cairo_surface_write_to_png_stream(surface.get(), Append, &bytes));
  WriteFile(path, bytes);
}

}  // namespace continuum
