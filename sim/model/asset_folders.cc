#include "sim/model/asset_folders.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

template <class NeedsFile>
bool Any(mjSpec& spec, mjtObj type, NeedsFile needs_file) {
  for (mjsElement* e = mjs_firstElement(&spec, type); e; e = mjs_nextElement(&spec, e)) {
    if (needs_file(e)) return true;
  }
  return false;
}

bool IsNamed(const mjString* file) { return *mjs_getString(file) != '\0'; }

// meshdir holds height fields and skins too.
bool NeedsMeshes(mjSpec& spec) {
  return Any(spec, mjOBJ_MESH, [](mjsElement* e) { return IsNamed(mjs_asMesh(e)->file); }) ||
         Any(spec, mjOBJ_HFIELD, [](mjsElement* e) { return IsNamed(mjs_asHField(e)->file); }) ||
         Any(spec, mjOBJ_SKIN, [](mjsElement* e) { return IsNamed(mjs_asSkin(e)->file); });
}

bool NeedsTextures(mjSpec& spec) {
  return Any(spec, mjOBJ_TEXTURE,
             [](mjsElement* e) { return mjs_asTexture(e)->builtin == mjBUILTIN_NONE; });
}

void Lead(mjString* folder, const fs::path& from, const fs::path& to) {
  const fs::path present = mjs_getString(folder);
  if (present.is_absolute()) return;
  mjs_setString(folder, RelativePath(from / present, to).c_str());
}

}  // namespace

fs::path RelativePath(const fs::path& file, const fs::path& folder) {
  std::error_code failed;
  const auto real = [&](const fs::path& p) {
    return fs::weakly_canonical(fs::absolute(p, failed), failed);
  };
  const fs::path to = real(file);
  const fs::path path = to.lexically_relative(real(folder));
  return path.empty() ? to : path;
}

AssetFolders::AssetFolders(mjSpec& spec, const fs::path& from, const fs::path& to)
    : compiler_(spec.compiler),
      meshes_(mjs_getString(compiler_.meshdir)),
      textures_(mjs_getString(compiler_.texturedir)) {
  if (RelativePath(from, to) == ".") return;
  if (NeedsMeshes(spec)) Lead(compiler_.meshdir, from, to);
  if (NeedsTextures(spec)) Lead(compiler_.texturedir, from, to);
}

AssetFolders::~AssetFolders() {
  mjs_setString(compiler_.meshdir, meshes_.c_str());
  mjs_setString(compiler_.texturedir, textures_.c_str());
}

}  // namespace continuum
