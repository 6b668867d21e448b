#pragma once

#include <array>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "sim/film/image.h"
#include "sim/film/overlay.h"

namespace continuum {

/// The glyphs of MuJoCo's font, read back once: to lay text over finished pixels costs far less
/// than to have OpenGL draw it into every frame.
struct Font {
  int line = 0;                                       ///< height of a line [px]
  std::array<int, 127> width{};                       ///< [px]
  std::array<std::vector<unsigned char>, 127> cover;  ///< line rows from the top, 0..255

  explicit Font(const mjrContext& context);
  int Width(const std::string& text) const;
};

/// Lays an overlay's caption, time, ruler and bar over a finished picture, on dark translucent
/// plates. Where no pixel is known there is no ruler.
void Paint(const Overlay& overlay, const Font& font, Image& image);

}  // namespace continuum
