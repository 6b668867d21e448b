#pragma once

#include <algorithm>
#include <string>

namespace continuum {

/// The beginning of a text in one line, at most `length` bytes, for messages.
inline std::string Excerpt(std::string text, std::size_t length = 60) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() <= length) return text;
  while (length > 0 && (text[length] & 0xC0) == 0x80) --length;  // not within a character
  return text.substr(0, length) + "...";
}

}  // namespace continuum
