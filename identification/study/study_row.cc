#include "identification/study/study_row.h"

#include <algorithm>
#include <cctype>

#include "error.h"

namespace continuum {
namespace {

constexpr std::size_t kLongest = 180;  // bytes; a file system takes 255, names of ours are longer

bool MayStand(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) ||
         std::string_view("._+=@-").find(c) != std::string_view::npos;
}

bool IsRange(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
}

}  // namespace

const std::vector<std::string>& RowCommands() {
  static const std::vector<std::string> all{"check", "replay", "identify", "diagnose"};
  return all;
}

std::string RowName(const std::string& experiment, const std::string& command) {
  std::string name =
      std::filesystem::path(experiment).lexically_normal().replace_extension().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !MayStand(c); }, '_');
  name.erase(0, name.find_first_not_of("._+=@-"));  // "../robots/a"
  if (name.size() > kLongest) name.erase(0, name.size() - kLongest);
  return (name.empty() ? "row" : name) + "-" + command;
}

void CheckRowName(const std::string& name, const std::string& where) {
  const bool good = !name.empty() && std::isalnum(static_cast<unsigned char>(name[0])) &&
                    std::all_of(name.begin(), name.end(), MayStand) && name.size() <= 200;
  if (!good)
    throw Error::Input(where,
                       "a name of letters, digits and ._+=@- that begins with a letter or "
                       "digit",
                       "'" + name + "'");
  if (IsRange(name)) throw Error::Input(where, "a name that is no number", "'" + name + "'");
  if (name.starts_with("study.") || name.ends_with(".failed"))
    throw Error::Input(where, "a name that the study has no use for", "'" + name + "'");
}

}  // namespace continuum
