#include "sim/page/table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/core.h>

#include "error.h"
#include "sim/page/text.h"

namespace continuum::page {
namespace {

bool StartsLikeNumber(std::string_view text) {
  for (const std::string_view sign : {"+", "-", "−", "±", "<", ">", "≤", "≥", "≈"}) {
    if (text.starts_with(sign)) text.remove_prefix(sign.size());
  }
  while (text.starts_with(' ')) text.remove_prefix(1);
  if (text == "nan" || text == "inf") return true;
  return !text.empty() && text[0] >= '0' && text[0] <= '9';
}

bool IsFilled(const std::string& cell) { return !cell.empty() && cell != "-" && cell != "–"; }

bool IsNumeric(const std::vector<std::vector<std::string>>& rows, std::size_t column) {
  bool any = false;
  for (const auto& row : rows) {
    if (!IsFilled(row[column])) continue;
    if (!StartsLikeNumber(row[column])) return false;
    any = true;
  }
  return any;
}

void CheckTable(const std::vector<std::string>& header,
                const std::vector<std::vector<std::string>>& rows, const TableOptions& options) {
  const std::string where = fmt::format("table '{}'", options.caption);
  for (const auto& row : rows) {
    if (row.size() == header.size()) continue;
    throw Error::Input(where, fmt::format("{} cells per row", header.size()),
                       std::to_string(row.size()));
  }
  for (const auto* extras : {&options.bars, &options.heat}) {
    for (const auto& [column, values] : *extras) {
      if (column < header.size() && values.size() == rows.size()) continue;
      throw Error::Input(where, fmt::format("{} cell colours", rows.size()),
                         fmt::format("{} in column {}", values.size(), column));
    }
  }
  for (const auto& [column, links] : options.links) {
    if (column < header.size() && links.size() == rows.size()) continue;
    throw Error::Input(where, fmt::format("{} links", rows.size()),
                       fmt::format("{} in column {}", links.size(), column));
  }
}

// Value of a cell's bar or heat in percent, 0 when it has none.
double Percent(const std::map<std::size_t, std::vector<double>>& extras, std::size_t row,
               std::size_t column) {
  const auto found = extras.find(column);
  if (found == extras.end() || !std::isfinite(found->second[row])) return 0;
  return 100 * std::clamp(found->second[row], -1.0, 1.0);
}

std::string Cell(const std::string& content, bool number, double bar, double heat) {
  std::string classes = number ? "number" : "", style;
  if (bar > 0) {
    classes += " share";
    style = fmt::format(" style=\"--share:{:.3g}%\"", bar);
  } else if (heat != 0) {
    classes += heat > 0 ? " hot" : " cold";
    style = fmt::format(" style=\"--share:{:.3g}%\"", 0.7 * std::abs(heat));
  }
  return fmt::format("<td class=\"{}\"{}>{}</td>", classes, style, content);
}

// The text of a cell, as a link where it has one.
std::string Content(const TableOptions& options, std::size_t row, std::size_t column,
                    const std::string& text) {
  const auto found = options.links.find(column);
  if (found == options.links.end() || found->second[row].empty()) return Inline(text);
  return fmt::format("<a href=\"{}\">{}</a>", Escape(found->second[row]), Inline(text));
}

std::string HeadHtml(const std::vector<std::string>& header, const std::vector<bool>& numeric) {
  std::string out = "<thead><tr>";
  for (std::size_t column = 0; column < header.size(); ++column)
    out += fmt::format("<th class=\"{}\">{}</th>", numeric[column] ? "number" : "",
                       Inline(header[column]));
  return out + "</tr></thead>\n";
}

}  // namespace

std::string TableHtml(const std::vector<std::string>& header,
                      const std::vector<std::vector<std::string>>& rows,
                      const TableOptions& options) {
  CheckTable(header, rows, options);
  std::string out = options.sortable ? "<div class=\"table sortable\">" : "<div class=\"table\">";
  out += "<table>\n";
  if (!options.caption.empty()) out += "<caption>" + Inline(options.caption) + "</caption>\n";
  std::vector<bool> numeric;
  for (std::size_t column = 0; column < header.size(); ++column)
    numeric.push_back(IsNumeric(rows, column));
  out += HeadHtml(header, numeric) + "<tbody>\n";
  const auto& chosen = options.highlighted_rows;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const bool highlighted = std::find(chosen.begin(), chosen.end(), row) != chosen.end();
    out += highlighted ? "<tr class=\"chosen\">" : "<tr>";
    for (std::size_t column = 0; column < header.size(); ++column) {
      out += Cell(Content(options, row, column, rows[row][column]), numeric[column],
                  Percent(options.bars, row, column), Percent(options.heat, row, column));
    }
    out += "</tr>\n";
  }
  return out + "</tbody>\n</table></div>\n";
}

}  // namespace continuum::page
