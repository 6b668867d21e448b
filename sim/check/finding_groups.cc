#include "sim/check/finding_groups.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <tuple>

namespace continuum {
namespace {

// A text cut at its numbers: words[0] numbers[0] words[1] … words[n].
struct Cut {
  std::vector<std::string> words{""};
  std::vector<std::string> numbers;
};

bool InWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '^'; }

// Length of the number that a text has at a place, 0: none. Digits of names and units are none.
std::size_t NumberAt(const std::string& text, std::size_t at) {
  if (at > 0 && (InWord(text[at - 1]) || text[at - 1] == '.')) return 0;
  if (!std::isdigit(static_cast<unsigned char>(text[at])) && text[at] != '-') return 0;
  double value = 0;
  const char *const begin = text.data() + at, *const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || (stop != end && InWord(*stop))) return 0;
  return static_cast<std::size_t>(stop - begin);
}

Cut CutAtNumbers(const std::string& text) {
  Cut cut;
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t length = NumberAt(text, k);
    if (length == 0) {
      cut.words.back() += text[k++];
      continue;
    }
    cut.numbers.push_back(text.substr(k, length));
    cut.words.emplace_back();
    k += length;
  }
  return cut;
}

// "4.6..5", or the number that all have.
std::string RangeOf(const std::vector<Cut>& cuts, std::size_t number) {
  const auto less = [&](const Cut& a, const Cut& b) {
    return std::stod(a.numbers[number]) < std::stod(b.numbers[number]);
  };
  const auto [least, most] = std::minmax_element(cuts.begin(), cuts.end(), less);
  const std::string &from = least->numbers[number], &to = most->numbers[number];
  return from == to ? from : from + ".." + to;
}

std::string Merged(const std::vector<const Finding*>& members) {
  if (members.size() == 1) return members.front()->text;
  std::vector<Cut> cuts;
  for (const Finding* f : members) cuts.push_back(CutAtNumbers(f->summary));
  std::string text = cuts.front().words.front();
  for (std::size_t i = 0; i < cuts.front().numbers.size(); ++i)
    text += RangeOf(cuts, i) + cuts.front().words[i + 1];
  return text;
}

void AddOnce(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

std::vector<FindingGroup> Grouped(const std::vector<Finding>& findings) {
  std::vector<FindingGroup> groups;
  std::map<std::tuple<Finding::Severity, std::string, std::vector<std::string>>, std::size_t> known;
  for (const Finding& f : findings) {
    const auto [it, added] =
        known.try_emplace({f.severity, f.what, CutAtNumbers(f.summary).words}, groups.size());
    if (added) groups.emplace_back();
    FindingGroup& group = groups[it->second];
    group.members.push_back(&f);
    AddOnce(group.logs, f.log);
    AddOnce(group.channels, f.channel);
  }
  for (FindingGroup& group : groups) group.text = Merged(group.members);
  return groups;
}

}  // namespace continuum
