#include "models/statics/palette.h"

#include <algorithm>
#include <array>

namespace continuum::statics {
namespace {

constexpr Colour Hex(unsigned rgb) {
  return {(rgb >> 16 & 255) / 255.0, (rgb >> 8 & 255) / 255.0, (rgb & 255) / 255.0, 1};
}

constexpr std::array kColours = {Hex(0x0072b2), Hex(0xd55e00), Hex(0x009e73), Hex(0xcc79a7),
                                 Hex(0x56b4e9), Hex(0xe69f00), Hex(0x000000)};
constexpr std::array kViridis = {Hex(0x440154), Hex(0x482878), Hex(0x3e4989), Hex(0x31688e),
                                 Hex(0x26828e), Hex(0x1f9e89), Hex(0x35b779), Hex(0x6ece58),
                                 Hex(0xb5de2b), Hex(0xfde725)};

}  // namespace

Pen CasePen(std::size_t index) {
  const std::array<std::vector<double>, 4> dashes = {{{}, {5, 2}, {7, 1.8, 1.5, 1.8}, {1.8, 1.8}}};
  return {kColours[index % kColours.size()], 1.3, dashes[index % dashes.size()], false};
}

Colour Viridis(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const std::size_t at = std::min(static_cast<std::size_t>(place), kViridis.size() - 2);
  const double t = place - static_cast<double>(at);
  const Colour &a = kViridis[at], &b = kViridis[at + 1];
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green),
          a.blue + t * (b.blue - a.blue), 1};
}

}  // namespace continuum::statics
