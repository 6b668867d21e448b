#pragma once

namespace continuum {

/// Loads the plugins that come with MuJoCo, as its Python package does: the libraries in the folder
/// `plugin` (wheel) or `bin/mujoco_plugin` (release archive) beside libmujoco. Ours is left out,
/// because its effects are part of this program. Loads nothing where there is no such folder.
void LoadMujocoPlugins();

}  // namespace continuum
