#include "sim/model/plugin_config_check.h"

#include <algorithm>
#include <optional>

#include "error.h"

namespace continuum {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

// The value of an attribute within a tag.
std::optional<std::string_view> Attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != tag.npos; at = tag.find(name, at + 1)) {
    if (at == 0 || kBlank.find(tag[at - 1]) == kBlank.npos) continue;
    const std::size_t equals = tag.find_first_not_of(kBlank, at + name.size());
    if (equals == tag.npos || tag[equals] != '=') continue;
    const std::size_t quote = tag.find_first_not_of(kBlank, equals + 1);
    if (quote == tag.npos || (tag[quote] != '"' && tag[quote] != '\'')) continue;
    const std::size_t end = tag.find(tag[quote], quote + 1);
    if (end != tag.npos) return tag.substr(quote + 1, end - quote - 1);
  }
  return {};
}

}  // namespace

void RefuseEmptyConfig(std::string_view xml, const std::string& file) {
  for (std::size_t at = xml.find('<'); at != xml.npos; at = xml.find('<', at + 1)) {
    const std::string_view rest = xml.substr(at);
    if (rest.starts_with("<!--")) {
      at = std::min(xml.find("-->", at), xml.size());
      continue;
    }
    if (!rest.starts_with("<config")) continue;
    const std::string_view tag = rest.substr(0, rest.find('>'));
    const auto value = Attribute(tag, "value");
    if (!value || !value->empty()) continue;
    const auto line =
        1 + std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw Error::Input(file + ":" + std::to_string(line) + ": config '" +
                           std::string(Attribute(tag, "key").value_or("")) + "'",
                       "a value", "''");
  }
}

}  // namespace continuum
