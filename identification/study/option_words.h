#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace continuum {

/// The words of a line of options, with quotes as a shell has them: `--seed 2 --from "old
/// fit.json"`. Throws Error (where) for an open quote.
std::vector<std::string> OptionWords(std::string_view text, const std::string& where);

}  // namespace continuum
