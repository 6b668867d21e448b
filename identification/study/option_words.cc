#include "identification/study/option_words.h"

#include "error.h"

namespace continuum {

std::vector<std::string> OptionWords(std::string_view text, const std::string& where) {
  std::vector<std::string> words;
  char quote = 0;
  bool inside = false;  // of a word, which may be empty: ""
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\n';
    if (!quote && blank) {
      inside = false;
      continue;
    }
    if (!inside) words.emplace_back();
    inside = true;
    if (!quote && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    } else {
      words.back() += c;
    }
  }
  if (quote) throw Error::Input(where, std::string("a closing ") + quote, std::string(text));
  return words;
}

}  // namespace continuum
