#include "sim/io/decimal.h"

#include <array>
#include <charconv>

namespace continuum {

std::string Decimal(double value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

}  // namespace continuum
