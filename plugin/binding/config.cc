#include "binding/config.h"

#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <set>
#include <sstream>

#include "binding/attachment.h"

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

// Ids of what all words of a text match between a prefix and an ending; none, and the word, where
// one of them matches nothing.
std::vector<int> MatchBetween(const mjModel& m, std::string_view text, const std::string& prefix,
                              const std::string& ending, Place place, std::string* missing) {
  const std::string all = prefix + std::string(text) + ending;
  const int whole = text.empty() ? -1 : mj_name2id(&m, ObjectType(place), all.c_str());
  if (whole >= 0) return {whole};  // also with spaces in it
  std::set<int> ids;
  for (const std::string& word : Words(text)) {
    const std::string glob = Escaped(prefix) + word + Escaped(ending);
    const bool bare = prefix.empty() && ending.empty();
    bool known = false;
    for (int i = 0; i < ObjectCount(m, place); ++i) {
      const std::string name = NameOf(m, place, i);
      const bool matches = bare ? GlobMatches(word, name)
                                : name == prefix + word + ending || GlobMatches(glob, name);
      if (!name.empty() && matches) known = true, ids.insert(i);
    }
    if (known) continue;
    if (missing) *missing = word;
    return {};
  }
  return {ids.begin(), ids.end()};
}

// "" where it has none.
std::string InstanceName(const mjModel& m, int i) {
  const char* const name = mj_id2name(&m, mjOBJ_PLUGIN, i);
  return name ? name : "";
}

// A body that an object hangs on; -1: not known.
int BodyOf(const mjModel& m, Place place, int id) {
  switch (place) {
    case Place::kBody:
      return id;
    case Place::kJoint:
      return m.jnt_bodyid[id];
    case Place::kSite:
      return m.site_bodyid[id];
    case Place::kTendon: {
      const int first = m.tendon_adr[id], object = m.wrap_objid[first];
      const bool site = m.wrap_type[first] == mjWRAP_SITE;
      return site ? m.site_bodyid[object] : m.jnt_bodyid[object];
    }
    case Place::kActuator: {
      const int type = m.actuator_trntype[id], object = m.actuator_trnid[2 * id];
      if (type == mjTRN_JOINT || type == mjTRN_JOINTINPARENT)
        return BodyOf(m, Place::kJoint, object);
      if (type == mjTRN_TENDON) return BodyOf(m, Place::kTendon, object);
      return type == mjTRN_SITE ? BodyOf(m, Place::kSite, object) : -1;
    }
    default:
      return -1;
  }
}

// The instance of the same effect that was attached together with an object of this name; "": none.
// mine: the prefix that the instance itself was attached with. body: of the object.
std::string CameWith(const mjModel& m, int instance, const Attachment& attachment,
                     const std::string& mine, const std::string& name, int body) {
  const std::string self = InstanceName(m, instance);
  for (int j = 0; j < m.nplugin; ++j) {
    const std::string other = InstanceName(m, j);
    if (self.empty() || m.plugin[j] != m.plugin[instance]) continue;
    if (other.size() <= self.size() || !other.ends_with(self)) continue;
    if (attachment.IsOwn(body, j)) continue;
    if (name.starts_with(other.substr(0, other.size() - self.size()) + mine)) return other;
  }
  return "";
}

// Attach may put a suffix behind all names, and replicate a number, but not into configurations:
// "friction_l" and "friction_r". What the name of such an instance may end with, the shortest
// first; none where no other instance is the same but for that.
std::vector<std::string> Endings(const mjModel& m, int instance) {
  const std::string mine = InstanceName(m, instance);
  std::size_t common = mine.size();
  bool copied = false;
  for (int j = 0; j < m.nplugin; ++j) {
    const std::string other = InstanceName(m, j);
    if (j == instance || m.plugin[j] != m.plugin[instance]) continue;
    if (ConfigBytes(m, j) != ConfigBytes(m, instance)) continue;
    const auto differ = std::mismatch(mine.begin(), mine.end(), other.begin(), other.end()).first;
    common = std::min(common, static_cast<std::size_t>(differ - mine.begin()));
    copied = true;
  }
  std::vector<std::string> endings;
  for (std::size_t k = copied ? std::min(common, mine.size() - 1) : 0; k > 0; --k)
    endings.push_back(mine.substr(k));
  return endings;
}

// Whether a key's text has this name, and not only a glob that matches it.
bool SaysName(std::string_view text, const std::string& name,
              const std::vector<std::string>& endings, const Attachment& attachment) {
  if (text == name) return true;
  for (const std::string& word : Words(text)) {
    const std::string plain = Unescaped(word);
    const bool glob = plain.find_first_of("*?[") != plain.npos;
    if (name == plain || (!glob && name.ends_with(plain))) return true;  // with a prefix
    for (const std::string& ending : endings) {
      if (!glob && name.ends_with(plain + ending)) return true;
    }
    for (const auto* const each : {&attachment.certain(), &attachment.possible()}) {
      for (const auto& [prefix, suffix] : *each) {
        if (!glob && name == prefix + plain + suffix) return true;
      }
    }
  }
  return false;
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
  return glob == name || fnmatch(glob.c_str(), name.c_str(), FNM_PERIOD) == 0;
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

std::vector<int> Config::MatchBehind(const std::string& prefix, Place place,
                                     std::string* missing) const {
  return MatchBetween(*m_, Get(PlaceName(place)), prefix, "", place, missing);
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

// With affixes that attach has put around all names of the robot.
std::vector<int> Config::MatchAttached(Place place, const std::vector<int>& written) const {
  const Attachment attachment(*m_, instance_);
  std::vector<Affixes> all = attachment.certain();
  const auto words = Words(Get(PlaceName(place)));
  const bool vague = std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return kMeaning.find(word[0]) != kMeaning.npos;
  });
  const bool own = std::any_of(written.begin(), written.end(), [&](int id) {
    const int body = BodyOf(*m_, place, id);
    return body < 0 || (vague ? attachment.IsOfRobot(body) : attachment.IsOfBranch(body));
  });
  if (!own) all.insert(all.end(), attachment.possible().begin(), attachment.possible().end());
  for (const Affixes& affixes : all) {
    const auto& [prefix, suffix] = affixes;
    auto ids = MatchBetween(*m_, Get(PlaceName(place)), prefix, suffix, place, nullptr);
    std::erase_if(ids, [&](int id) {
      const int body = BodyOf(*m_, place, id);
      return attachment.IsOfTwin(body) || !attachment.CanHave(body, affixes);
    });
    if (!ids.empty()) return ids;
  }
  return {};
}

std::vector<int> Config::Match(Place place) const {
  const std::string key(PlaceName(place));
  std::string missing;
  const std::vector<int> written = MatchBehind("", place, &missing);
  if (missing.empty() && written.empty())
    throw Error::Input(Who(), "the key '" + key + "'", "none");
  if (const auto ids = MatchAttached(place, written); !ids.empty()) return ids;
  const std::vector<std::string> endings = Endings(*m_, instance_);
  std::vector<std::string> prefixes = endings.empty() ? endings : Prefixes(place);
  prefixes.emplace_back();
  for (const std::string& ending : endings) {
    for (const std::string& prefix : prefixes) {
      const auto ids = MatchBetween(*m_, Get(key), prefix, ending, place, nullptr);
      if (!ids.empty()) return ids;
    }
  }
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
  const Attachment attachment(*m_, instance_);
  std::vector<Affixes> all = attachment.certain();
  const int body = written < 0 ? 0 : BodyOf(*m_, place, written);
  if (body >= 0 && !attachment.IsOfBranch(body))
    all.insert(all.end(), attachment.possible().begin(), attachment.possible().end());
  for (const auto& [prefix, suffix] : all) {
    if (const int found = id(prefix + name + suffix); found >= 0) return found;
  }
  for (const std::string& ending : Endings(*m_, instance_)) {
    if (const int found = id(name + ending); found >= 0) return found;
  }
  for (const std::string& prefix : Prefixes(place)) {
    if (written >= 0 && !IsAttached(prefix)) continue;
    if (const int found = id(prefix + name); found >= 0) return found;
  }
  return written;
}

std::vector<int> Config::MatchFit(Place place, const std::function<Misfit(int)>& judge) const {
  const std::string key(PlaceName(place));
  std::vector<int> fit;
  std::string left;
  const std::vector<int> matched = Match(place);
  std::vector<std::string> prefixes = Prefixes(place);
  std::erase_if(prefixes,
                [&](const std::string& p) { return MatchBehind(p, place, nullptr) != matched; });
  const std::string mine = prefixes.empty() ? "" : prefixes.front();
  const Attachment attachment(*m_, instance_);
  const std::vector<std::string> endings = Endings(*m_, instance_);
  for (const int id : matched) {
    Misfit misfit = judge(id);
    const std::string name = NameOf(*m_, place, id);
    const bool all = id == matched.back() && fit.empty(),
               written = SaysName(Get(key), name, endings, attachment);
    const std::string owner =
        written ? "" : CameWith(*m_, instance_, attachment, mine, name, BodyOf(*m_, place, id));
    if (!owner.empty())
      misfit = {"one that came with no other instance", "that of '" + owner + "'"};
    if (misfit.found.empty()) {
      fit.push_back(id);
    } else if (all || written) {
      throw Error::Input(Who() + ": " + key + " '" + name + "'", misfit.expected, misfit.found);
    } else {
      left += (left.empty() ? "'" : ", '") + name + "' (" + misfit.found + ")";
    }
  }
  left_out_ = left.empty() ? "" : "it leaves out " + key + "s " + left;
  LeaveOutUnnamed(place, [&](int id) { return judge(id).found.empty(); });
  return fit;
}

// What has no name no glob finds. "*" says that all are meant.
void Config::LeaveOutUnnamed(Place place, const std::function<bool(int)>& fits) const {
  const std::string key(PlaceName(place));
  const auto words = Words(Get(key));
  if (std::find(words.begin(), words.end(), "*") == words.end()) return;
  int count = 0;
  for (int id = 0; id < ObjectCount(*m_, place); ++id)
    count += NameOf(*m_, place, id).empty() && fits(id);
  if (count == 0) return;
  left_out_ += left_out_.empty() ? "" : "; ";
  left_out_ += "it leaves out " + std::to_string(count) + " " + key +
               (count > 1 ? "s without names: give them names" : " without a name: give it one");
}

Lines Config::MatchLines(Joints types) const {
  const bool joints = !Get("joint").empty(), tendons = !Get("tendon").empty();
  if (joints == tendons) {
    throw Error::Input(Who(), "one of the keys 'joint' and 'tendon'", joints ? "both" : "none");
  }
  if (tendons) {
    left_out_.clear();
    LeaveOutUnnamed(Place::kTendon, [](int) { return true; });
    return {false, Match(Place::kTendon)};
  }
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
