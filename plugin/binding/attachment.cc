#include "binding/attachment.h"

#include <algorithm>
#include <string_view>

namespace continuum {
namespace {

std::string NameOf(const mjModel& m, mjtObj type, int id) {
  const char* const name = mj_id2name(&m, type, id);
  return name ? name : "";
}

bool IsBelow(const mjModel& m, int body, int top) {
  while (body > top) body = m.body_parentid[body];
  return body == top;
}

// The child of the world that a body hangs on.
int RobotOf(const mjModel& m, int body) {
  while (m.body_parentid[body] > 0) body = m.body_parentid[body];
  return body;
}

int ReferringBody(const mjModel& m, int instance) {
  for (int b = 1; b < m.nbody; ++b) {
    if (m.body_plugin[b] == instance) return b;
  }
  return -1;
}

// Names of bodies, joints, geoms and sites of a branch.
std::vector<std::string> NamesBelow(const mjModel& m, int top) {
  std::vector<std::string> names;
  const auto add = [&](mjtObj type, long long count, const int* body) {
    for (int id = 0; id < static_cast<int>(count); ++id) {
      if (!IsBelow(m, body ? body[id] : id, top)) continue;
      if (const std::string name = NameOf(m, type, id); !name.empty()) names.push_back(name);
    }
  };
  add(mjOBJ_BODY, m.nbody, nullptr);
  add(mjOBJ_JOINT, m.njnt, m.jnt_bodyid);
  add(mjOBJ_GEOM, m.ngeom, m.geom_bodyid);
  add(mjOBJ_SITE, m.nsite, m.site_bodyid);
  return names;
}

std::size_t CommonStart(std::string_view a, std::string_view b) {
  const std::size_t most = std::min(a.size(), b.size());
  std::size_t n = 0;
  while (n < most && a[n] == b[n]) ++n;
  return n;
}

std::size_t CommonEnd(std::string_view a, std::string_view b) {
  const std::size_t most = std::min(a.size(), b.size());
  std::size_t n = 0;
  while (n < most && a[a.size() - 1 - n] == b[b.size() - 1 - n]) ++n;
  return n;
}

// All pairs of what a name and several others begin and end with, the longest first. Something of
// the name is left between.
std::vector<Affixes> CommonAffixes(const std::string& name,
                                   const std::vector<std::string>& others) {
  std::size_t start = name.size() - 1, end = name.size() - 1;
  for (const std::string& other : others) {
    start = std::min(start, CommonStart(name, other));
    end = std::min(end, CommonEnd(name, other));
  }
  std::vector<Affixes> all;
  for (std::size_t total = start + end; total > 0; --total) {
    for (std::size_t p = std::min(total, start) + 1; p-- > 0;) {
      if (total - p > end || total >= name.size()) continue;
      all.push_back({name.substr(0, p), name.substr(name.size() - (total - p))});
    }
  }
  return all;
}

}  // namespace

std::string_view ConfigBytes(const mjModel& m, int instance) {
  const int begin = m.plugin_attradr[instance];
  int end = static_cast<int>(m.npluginattr);
  for (int j = 0; j < m.nplugin; ++j) {
    if (m.plugin_attradr[j] > begin) end = std::min(end, m.plugin_attradr[j]);
  }
  return {m.plugin_attr + begin, static_cast<std::size_t>(end - begin)};
}

Attachment::Attachment(const mjModel& m, int instance)
    : m_(&m), name_(NameOf(m, mjOBJ_PLUGIN, instance)), body_(ReferringBody(m, instance)) {
  if (body_ < 0 || name_.empty()) return;
  for (int j = 0; j < m.nplugin; ++j) {
    if (j == instance || m.plugin[j] != m.plugin[instance]) continue;
    const int theirs = ReferringBody(m, j);
    if (theirs >= 0 && ConfigBytes(m, j) == ConfigBytes(m, instance))
      twins_.push_back({theirs, NameOf(m, mjOBJ_PLUGIN, j)});
  }
  const auto names = NamesBelow(m, body_);
  if (names.empty()) return;
  const auto robot = NamesBelow(m, RobotOf(m, body_));
  for (const Affixes& affixes : CommonAffixes(name_, names)) {
    const auto has = [&](const std::string& name) {
      return name.starts_with(affixes.prefix) && name.ends_with(affixes.suffix);
    };
    const bool whole = robot.size() > 1 && std::all_of(robot.begin(), robot.end(), has);
    (whole || IsTwinOf(affixes) ? certain_ : possible_).push_back(affixes);
  }
}

bool Attachment::IsTwinOf(const Affixes& affixes) const {
  const std::size_t begin = affixes.prefix.size();
  const std::string own = name_.substr(begin, name_.size() - begin - affixes.suffix.size());
  return std::any_of(twins_.begin(), twins_.end(), [&](const Twin& twin) {
    return twin.name != name_ && twin.name.find(own) != twin.name.npos;
  });
}

bool Attachment::IsOfRobot(int body) const {
  return body_ >= 0 && body > 0 && IsBelow(*m_, body, RobotOf(*m_, body_));
}

bool Attachment::CanHave(int body, const Affixes& affixes) const {
  const std::string name = body > 0 ? NameOf(*m_, mjOBJ_BODY, body) : "";
  if (name.empty()) return true;
  const std::string &prefix = affixes.prefix, &suffix = affixes.suffix;
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return false;
  const std::string own = name_.substr(prefix.size(), name_.size() - prefix.size() - suffix.size());
  return std::none_of(twins_.begin(), twins_.end(), [&](const Twin& twin) {
    const std::size_t at = twin.name.find(own);
    if (at == twin.name.npos) return false;
    const std::string theirs = twin.name.substr(0, at), end = twin.name.substr(at + own.size());
    const bool longer = theirs.size() + end.size() > prefix.size() + suffix.size();
    return longer && theirs.starts_with(prefix) && end.ends_with(suffix) &&
           name.starts_with(theirs) && name.ends_with(end);
  });
}

bool Attachment::IsOfBranch(int body) const {
  return body_ >= 0 && body > 0 && IsBelow(*m_, body, body_);
}

bool Attachment::IsOwn(int body, int other) const {
  const int theirs = ReferringBody(*m_, other);
  return IsOfRobot(body) && theirs >= 0 && !IsOfRobot(theirs);
}

bool Attachment::IsOfTwin(int body) const {
  if (body_ < 0 || body < 0) return false;
  return std::any_of(twins_.begin(), twins_.end(), [&](const Twin& twin) {
    return IsBelow(*m_, body, twin.body) && !IsBelow(*m_, body_, twin.body) &&
           (!IsBelow(*m_, body, body_) || IsBelow(*m_, twin.body, body_));
  });
}

}  // namespace continuum
