#include "binding/config.h"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <set>
#include <sstream>

namespace continuum {
namespace {

constexpr std::string_view kSpaces = " \t\n\v\f\r";
constexpr std::string_view kMeaning = "*?[\\";  // characters that a glob does not take as they are

std::string Short(double x) {
  std::ostringstream out;
  out << x;
  return out.str();
}

std::string NameOf(const mjModel& m, Place place, int id) {
  const char* const name = mj_id2name(&m, ObjectType(place), id);
  return name ? name : "";
}

// How an object is named that a word did not find.
std::string Hint(const mjModel& m, Place place) {
  bool spaces = false, names = false;
  for (int i = 0; i < ObjectCount(m, place); ++i) {
    const std::string name = NameOf(m, place, i);
    names |= !name.empty();
    spaces |= name.find(' ') != name.npos;
  }
  if (spaces) return "; a space in a name is written '\\ '";
  return names || ObjectCount(m, place) == 0 ? "" : "; give it a name: here none has one";
}

}  // namespace

mjtObj ObjectType(Place place) {
  constexpr std::array types{mjOBJ_JOINT, mjOBJ_TENDON, mjOBJ_ACTUATOR, mjOBJ_BODY,
                             mjOBJ_SITE,  mjOBJ_SENSOR, mjOBJ_UNKNOWN};
  return types[static_cast<std::size_t>(place)];
}

int ObjectCount(const mjModel& m, Place place) {
  const std::array<long long, 7> counts{m.njnt,    m.ntendon, m.nactuator, m.nbody, m.nsite,
                                        m.nsensor, 0};
  return static_cast<int>(counts[static_cast<std::size_t>(place)]);
}

std::string_view JointType(int type) {
  switch (type) {
    case mjJNT_HINGE:
      return "a hinge joint";
    case mjJNT_SLIDE:
      return "a slide joint";
    case mjJNT_BALL:
      return "a ball joint";
    default:
      return "a free joint";
  }
}

bool GlobMatches(const std::string& glob, const std::string& name) {
  return glob == name || fnmatch(glob.c_str(), name.c_str(), 0) == 0;
}

std::vector<std::string> Words(std::string_view text) {
  std::vector<std::string> words;
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool space = kSpaces.find(text[i]) != kSpaces.npos;
    if (!space && !inside) words.emplace_back();
    inside = !space;
    if (space) continue;
    words.back() += text[i];
    if (text[i] == '\\' && i + 1 < text.size()) words.back() += text[++i];
  }
  return words;
}

bool AnyGlobMatches(std::string_view globs, const std::string& name) {
  const auto all = Words(globs);
  return globs == name || std::any_of(all.begin(), all.end(), [&](const std::string& glob) {
           return GlobMatches(glob, name);
         });
}

std::string Escaped(const std::string& name) {
  std::string word;
  for (const char c : name) {
    if (kSpaces.find(c) != kSpaces.npos || kMeaning.find(c) != kMeaning.npos) word += '\\';
    word += c;
  }
  return word;
}

std::string Unescaped(const std::string& word) {
  std::string name;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (word[i] == '\\' && i + 1 < word.size()) ++i;
    name += word[i];
  }
  return name;
}

std::string_view Config::Get(std::string_view key) const {
  const char* value = mj_getPluginConfig(m_, instance_, std::string(key).c_str());
  return value ? value : "";
}

std::string Config::Who() const {
  const mjpPlugin* plugin = mjp_getPluginAtSlot(m_->plugin[instance_]);
  const char* name = mj_id2name(m_, mjOBJ_PLUGIN, instance_);
  std::string who = plugin ? plugin->name : "continuum";
  if (name && *name) who += " '" + std::string(name) + "'";
  return who;
}

double Config::Read(const Param& param) const {
  const std::string_view text = Get(param.name);
  if (text.empty()) return param.Omitted();
  const char* const last = text.data() + text.size();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), last, value);
  const bool number = error == std::errc{} && end == last;
  const bool usable = std::isfinite(value) || value == param.null;
  if (number && usable && param.lower <= value && value <= param.upper) return value;
  const std::string lower =
      param.lower == std::numeric_limits<double>::min() ? "]0" : "[" + Short(param.lower);
  throw Error::Input(
      Who() + ": " + std::string(param.name),
      "a finite number in " + lower + ", " + Short(param.upper) + "] " + std::string(param.unit),
      "'" + std::string(text) + "'");
}

int Config::Read(const Choice& choice) const {
  const std::string_view text = Get(choice.name);
  if (text.empty()) return 0;
  std::string all;
  for (std::size_t i = 0; i < choice.options.size(); ++i) {
    if (text == choice.options[i]) return static_cast<int>(i);
    all += (i ? " | " : "") + std::string(choice.options[i]);
  }
  throw Error::Input(Who() + ": " + std::string(choice.name), all, "'" + std::string(text) + "'");
}

// Ids of what all words match behind a prefix; none, and the word, where one of them matches
// nothing.
std::vector<int> Config::MatchBehind(const std::string& prefix, Place place,
                                     std::string* missing) const {
  const std::string text = prefix + std::string(Get(PlaceName(place)));
  const int whole = mj_name2id(m_, ObjectType(place), text.c_str());
  if (whole >= 0 && text.size() > prefix.size()) return {whole};  // also with spaces in it
  std::set<int> ids;
  for (const std::string& word : Words(Get(PlaceName(place)))) {
    const std::string glob = Escaped(prefix) + word;
    bool known = false;
    for (int i = 0; i < ObjectCount(*m_, place); ++i) {
      const std::string name = NameOf(*m_, place, i);
      const bool matches = prefix.empty() ? GlobMatches(word, name)
                                          : name == prefix + word || GlobMatches(glob, name);
      if (!name.empty() && matches) known = true, ids.insert(i);
    }
    if (known) continue;
    if (missing) *missing = word;
    return {};
  }
  return {ids.begin(), ids.end()};
}

// What the name of the instance and the name of an object both begin with, the longest first.
std::vector<std::string> Config::Prefixes(Place place) const {
  const char* const given = mj_id2name(m_, mjOBJ_PLUGIN, instance_);
  const std::string instance = given ? given : "";
  std::size_t longest = 0;
  for (int i = 0; i < ObjectCount(*m_, place); ++i) {
    const std::string name = NameOf(*m_, place, i);
    const std::size_t most = std::min(name.size(), instance.size());
    std::size_t n = 0;
    while (n < most && name[n] == instance[n]) ++n;
    longest = std::max(longest, n);
  }
  std::vector<std::string> prefixes;
  for (std::size_t n = std::min(longest, instance.size() - 1) + 1; n-- > 1;)
    prefixes.push_back(instance.substr(0, n));
  return prefixes;
}

// Where names as written are there too, a prefix must look like one: "left_", and a body has it.
bool Config::IsAttached(const std::string& prefix) const {
  if (std::isalnum(static_cast<unsigned char>(prefix.back()))) return false;
  for (int b = 1; b < m_->nbody; ++b) {
    if (NameOf(*m_, Place::kBody, b).starts_with(prefix)) return true;
  }
  return false;
}

std::vector<int> Config::Match(Place place) const {
  const std::string key(PlaceName(place));
  std::string missing;
  const std::vector<int> written = MatchBehind("", place, &missing);
  if (missing.empty() && written.empty())
    throw Error::Input(Who(), "the key '" + key + "'", "none");
  for (const std::string& prefix : Prefixes(place)) {
    if (!written.empty() && !IsAttached(prefix)) continue;
    const auto ids = MatchBehind(prefix, place, nullptr);
    if (!ids.empty()) return ids;
  }
  if (!written.empty()) return written;
  throw Error::Input(Who() + ": " + key,
                     "no " + key + " '" + missing + "' in the model" + Hint(*m_, place));
}

int Config::Find(Place place, const std::string& name) const {
  const auto id = [&](const std::string& whole) {
    return mj_name2id(m_, ObjectType(place), whole.c_str());
  };
  const int written = id(name);
  for (const std::string& prefix : Prefixes(place)) {
    if (written >= 0 && !IsAttached(prefix)) continue;
    if (const int found = id(prefix + name); found >= 0) return found;
  }
  return written;
}

// Whether the key has this name, and not only a glob that matches it.
bool Config::IsWritten(Place place, const std::string& name) const {
  const std::string text(Get(PlaceName(place)));
  if (text == name) return true;
  for (const std::string& word : Words(text)) {
    const std::string plain = Unescaped(word);
    const bool glob = plain.find_first_of("*?[") != plain.npos;
    if (name == plain || (!glob && name.ends_with(plain))) return true;  // with a prefix
  }
  return false;
}

std::vector<int> Config::MatchFit(Place place, const std::function<Misfit(int)>& judge) const {
  const std::string key(PlaceName(place));
  std::vector<int> fit;
  std::string left;
  const std::vector<int> matched = Match(place);
  for (const int id : matched) {
    const Misfit misfit = judge(id);
    const std::string name = NameOf(*m_, place, id);
    const bool all = id == matched.back() && fit.empty();
    if (misfit.found.empty()) {
      fit.push_back(id);
    } else if (all || IsWritten(place, name)) {
      throw Error::Input(Who() + ": " + key + " '" + name + "'", misfit.expected, misfit.found);
    } else {
      left += (left.empty() ? "'" : ", '") + name + "' (" + misfit.found + ")";
    }
  }
  left_out_ = left.empty() ? "" : "it leaves out " + key + "s " + left;
  return fit;
}

Lines Config::MatchLines(Joints types) const {
  const bool joints = !Get("joint").empty(), tendons = !Get("tendon").empty();
  if (joints == tendons) {
    throw Error::Input(Who(), "one of the keys 'joint' and 'tendon'", joints ? "both" : "none");
  }
  if (tendons) return {false, Match(Place::kTendon)};
  const bool ball = types == Joints::kHingeSlideBall;
  return {true, MatchFit(Place::kJoint, [&](int j) -> Misfit {
            const int type = m_->jnt_type[j];
            if (type == mjJNT_HINGE || type == mjJNT_SLIDE || (ball && type == mjJNT_BALL))
              return {};
            return {ball ? "a hinge, slide or ball joint" : "a hinge or slide joint",
                    std::string(JointType(type))};
          })};
}

}  // namespace continuum
