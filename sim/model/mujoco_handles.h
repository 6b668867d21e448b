#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <mujoco/mujoco.h>

namespace continuum {

/// Frees what MuJoCo allocates.
struct MujocoDeleter {
  void operator()(mjSpec* s) const { mj_deleteSpec(s); }
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};
template <class T>
using Owned = std::unique_ptr<T, MujocoDeleter>;

/// Whether a model has an instance of an effect ("capstan").
inline bool HasEffect(const mjModel& m, std::string_view effect) {
  const std::string plugin = "continuum." + std::string(effect);
  for (int i = 0; i < m.nplugin; ++i) {
    if (mjp_getPluginAtSlot(m.plugin[i])->name == plugin) return true;
  }
  return false;
}

/// An object of a model as messages name it: 'name', or its number where it has none.
inline std::string Called(const mjModel& m, mjtObj kind, int id) {
  const char* const name = mj_id2name(&m, kind, id);
  return name ? "'" + std::string(name) + "'" : std::to_string(id);
}

}  // namespace continuum
