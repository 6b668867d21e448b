#include "sim/page/text.h"

#include <fmt/core.h>

#include <algorithm>

namespace continuum::page {
namespace {

constexpr std::size_t kPalette = 6;
constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

bool Continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

// Length in bytes of the valid UTF-8 character at the front of `text`, 0 when there is none.
std::size_t CharacterSize(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < size) return 0;
  if (!std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(size), Continues)) {
    return 0;
  }
  const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
  const bool outside = (lead == 0xED && byte(1) > 0x9F) || (lead == 0xF4 && byte(1) > 0x8F);
  return overlong || outside ? 0 : size;
}

std::string_view EscapeByte(char c) {
  switch (c) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return {};
  }
}

bool IsControl(char c) {
  return (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7F;
}

}  // namespace

std::string ValidUtf8(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t size = CharacterSize(text);
    const bool valid = size > 1 || (size == 1 && !IsControl(text[0]));
    out += valid ? text.substr(0, size) : kReplacement;
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return out;
}

std::string Escape(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : ValidUtf8(text)) {
    const std::string_view escaped = EscapeByte(c);
    out += escaped.empty() ? std::string_view(&c, 1) : escaped;
  }
  return out;
}

std::string Inline(std::string_view text) {
  std::string out;
  std::size_t plain = 0, at = 0;
  while (at < text.size()) {
    const bool code = text[at] == '`', bold = text.substr(at, 2) == "**";
    const std::string_view mark = code ? "`" : "**";
    const std::size_t start = at + mark.size();
    const std::size_t end = code || bold ? text.find(mark, start) : text.npos;
    if (end == text.npos || end == start) {
      ++at;
      continue;
    }
    const std::string_view inner = text.substr(start, end - start);
    out += Escape(text.substr(plain, at - plain));
    out += code ? "<code>" + Escape(inner) + "</code>" : "<strong>" + Inline(inner) + "</strong>";
    plain = at = end + mark.size();
  }
  return out + Escape(text.substr(plain));
}

std::size_t Length(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !Continues(c); }));
}

std::string Shorten(std::string_view text, std::size_t length) {
  if (Length(text) <= length) return std::string(text);
  std::size_t end = 0;
  for (std::size_t seen = 0; end < text.size(); ++end) {
    if (!Continues(text[end]) && ++seen == length) break;
  }
  return std::string(text.substr(0, end)) + "…";
}

std::string AxisTitle(const Axis& axis) {
  return fmt::format("{} [{}]", axis.label, axis.unit.empty() ? "-" : axis.unit);
}

std::string Compact(double value, int digits) {
  return fmt::format("{:.{}g}", value == 0 ? 0.0 : value, digits);
}

std::string Readable(double value, int digits) {
  const std::string text = Compact(value, digits);
  return text.starts_with('-') ? "−" + text.substr(1) : text;
}

std::string StyleName(Style style, std::size_t index) {
  switch (style) {
    case Style::kMeasured:
      return "measured";
    case Style::kSimulated:
      return "simulated";
    case Style::kBefore:
      return "before";
    case Style::kAfter:
      return "after";
    case Style::kResidual:
      return "residual";
    case Style::kAuto:
      break;
  }
  return fmt::format("palette{}", index % kPalette);
}

std::string NothingToPlot() { return "<div class=\"nothing\">no finite value to plot</div>"; }

std::string LegendKey(const std::string& name, const std::string& style, const std::string& kind,
                      bool value) {
  return fmt::format("<span class=\"key {} {}\"><i></i>{}{}</span>", kind, style, Escape(name),
                     value ? "<output></output>" : "");
}

std::string Figure(const std::string& classes, const std::string& title, const std::string& legend,
                   const std::string& y_title, const std::string& plot, const std::string& x_title,
                   const std::string& note) {
  const auto part = [](const char* name, const std::string& html) {
    return html.empty() ? "" : fmt::format("<div class=\"{}\">{}</div>\n", name, html);
  };
  return fmt::format("<figure class=\"{}\">\n<figcaption>{}</figcaption>\n", classes,
                     Inline(title)) +
         part("legend", legend) + part("y-title", Escape(y_title)) + plot + "\n" +
         part("x-title", Escape(x_title)) + part("note", note) + "</figure>\n";
}

}  // namespace continuum::page
