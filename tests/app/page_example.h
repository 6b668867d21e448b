#pragma once

#include <string>

#include <gtest/gtest.h>

#include "support/scratch.h"

namespace continuum::testing {

/// The first block of docs/many-logs.md that has a text.
inline std::string PageExample(const std::string& text, const std::string& language = "bash") {
  const std::string page = Scratch::Text(CONTINUUM_SOURCE "/docs/many-logs.md");
  const std::string fence = "```" + language + "\n";
  for (std::size_t at = 0; (at = page.find(fence, at)) != page.npos; at += 3) {
    const std::size_t begin = at + fence.size();
    const std::string block = page.substr(begin, page.find("```", begin) - begin);
    at = begin + block.size();
    if (block.find(text) != block.npos) return block;
  }
  ADD_FAILURE() << "docs/many-logs.md has no example with " << text;
  return "";
}

}  // namespace continuum::testing
