#pragma once

#include <memory>

#include <mujoco/mujoco.h>

namespace continuum {

struct MujocoDeleter {
  void operator()(mjSpec* s) const { mj_deleteSpec(s); }
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};
template <class T>
using Owned = std::unique_ptr<T, MujocoDeleter>;

}  // namespace continuum
