#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sim/model/change.h"
#include "sim/model/effect_instance.h"
#include "sim/model/mujoco_handles.h"

namespace continuum {

/// A compiled model and its data, owned together.
struct ModelAndData {
  Owned<mjModel> model;
  Owned<mjData> data;
};

/// A model specification that compiles with other values and effects. Not thread-safe: every thread
/// builds from its own copy.
class ModelSpec {
 public:
  /// Reads an MJCF file, with our effects registered. Throws Error with MuJoCo's text.
  static ModelSpec Load(const std::filesystem::path& model);
  /// Takes MJCF as a file of this folder would be taken. Throws Error (name) with MuJoCo's text.
  static ModelSpec Parse(const std::string& xml, const std::filesystem::path& folder = ".",
                         const std::string& name = "MJCF");
  ModelSpec(const ModelSpec& other);
  ModelSpec(ModelSpec&&) = default;
  ModelSpec& operator=(ModelSpec&&) = default;

  /// The model as it stands, compiled once; for names and sizes.
  const mjModel& model() const { return *compiled_; }
  const std::string& name() const { return name_; }

  /// Leaves out textures and visual geoms from now on: compiling is much faster, motion the same.
  void DropVisuals();

  /// Compiles with changes, later ones after earlier ones. Throws Error (where the change came from
  /// is the caller's to say) for unknown targets and attributes, or with MuJoCo's text.
  ModelAndData Build(std::span<const Change> changes = {}) const;
  /// The value that a change would replace.
  double Value(const std::string& target, const std::string& attribute) const;
  /// The value of an attribute after changes. It includes what lies on top of the element
  /// (LiesOnTop): whoever lists such a change beside the value counts it twice.
  double ValueAfter(std::span<const Change> changes, const std::string& target,
                    const std::string& attribute) const;
  /// Names of the elements that a target names ("option" and "plugin:NAME" are their own), in the
  /// order of the model. Throws Error as Build does.
  std::vector<std::string> Named(const std::string& target) const;
  /// MJCF of the specification with changes and plugin instances, as authored. folder: where the
  /// text is going to lie, so that it finds its meshes and textures; empty: beside the model.
  std::string Xml(std::span<const Change> changes = {}, std::span<const EffectInstance> added = {},
                  const std::filesystem::path& folder = {}) const;
  /// The same with another effect under an instance's name; keys that the other effect lacks go.
  ModelSpec Replacing(const std::string& instance, const EffectInstance& by) const;
  /// The same with changes and instances inside.
  ModelSpec With(std::span<const Change> changes, std::span<const EffectInstance> added) const;

 private:
  ModelSpec() = default;

  Owned<mjModel> CompileWith(std::span<const Change> changes) const;
  std::string SavedXml() const;

  // Edits of the specification that are taken back at the end of a scope (mj_copySpec would lose
  // plugin instances that nothing refers to).
  class Edits;

  std::string name_, folder_;
  Owned<mjSpec> spec_;
  Owned<mjModel> compiled_;
  // The model that was compiled last, and its changes without those of plugins. Logs of one fit
  // share it.
  struct Compiled {
    std::vector<Change> changes;
    Owned<mjModel> model;
  };
  mutable Compiled last_;
};

/// Whether a change lies on top of an element, which does not show it as a value of its own: a
/// native effect, a point_mass or a force_scale.
bool LiesOnTop(const Change& change);

}  // namespace continuum
