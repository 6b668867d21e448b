#include "identification/study/row_selection.h"

#include <charconv>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "error.h"

namespace continuum {
namespace {

std::optional<std::size_t> Whole(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Two whole numbers with a character between them.
std::optional<std::pair<std::size_t, std::size_t>> Pair(const std::string& text, char between) {
  const std::size_t at = text.find(between);
  if (at == text.npos) return std::nullopt;
  const auto first = Whole(std::string_view(text).substr(0, at));
  const auto second = Whole(std::string_view(text).substr(at + 1));
  if (!first || !second) return std::nullopt;
  return std::pair(*first, *second);
}

void AddNamed(const StudyTable& study, const std::string& name, std::set<std::size_t>& chosen) {
  bool any = false;
  for (const StudyRow& row : study.rows) {
    if (row.name != name) continue;
    any = true;
    chosen.insert(row.number - 1);
  }
  if (!any) throw Error::Input("--rows", "numbers, ranges as 17:32, or names of rows", name);
}

void Add(const StudyTable& study, const std::string& word, std::set<std::size_t>& chosen) {
  const auto number = Whole(word);
  const auto range = number ? std::pair(*number, *number) : Pair(word, ':');
  if (!range) return AddNamed(study, word, chosen);
  const auto [first, last] = *range;
  if (first < 1 || last < first || last > study.rows.size())
    throw Error::Input("--rows", "rows 1 to " + std::to_string(study.rows.size()), word);
  for (std::size_t i = first; i <= last; ++i) chosen.insert(i - 1);
}

}  // namespace

std::vector<std::size_t> SelectRows(const StudyTable& study, const std::string& rows,
                                    const std::string& shard) {
  std::set<std::size_t> chosen;
  std::istringstream words(rows);
  for (std::string word; std::getline(words, word, ',');) Add(study, word, chosen);
  if (rows.empty()) Add(study, "1:" + std::to_string(study.rows.size()), chosen);
  if (shard.empty()) return {chosen.begin(), chosen.end()};
  const auto part = Pair(shard, '/');
  if (!part || part->first < 1 || part->first > part->second)
    throw Error::Input("--shard", "K/N with K from 1 to N", shard);
  std::vector<std::size_t> mine;
  std::size_t at = 0;
  for (const std::size_t row : chosen) {
    if (at++ % part->second == part->first - 1) mine.push_back(row);
  }
  return mine;
}

}  // namespace continuum
