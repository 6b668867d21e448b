#pragma once

#include <string>
#include <vector>

#include <pugixml.hpp>

#include "sim/model/effect_instance.h"

namespace continuum {

/// Edits the plugin instances of a model in MJCF as MuJoCo writes it. What is not edited keeps its
/// text byte for byte; names and values that are written are escaped.
class MjcfDocument {
 public:
  /// Throws Error (kJob) when the text is no XML with an element `mujoco`.
  explicit MjcfDocument(const std::string& xml);

  /// Adds an instance in a `plugin` element of its own, at the end of `extension`.
  void AddInstance(const EffectInstance& effect);
  /// Sets `<config key= value=>` of an instance. Throws Error when there is no such instance.
  void SetConfig(const std::string& instance, const std::string& key, const std::string& value);
  /// Removes an instance, and its `plugin` element when that has no other; bodies no longer refer
  /// to it. Throws Error when there is no such instance.
  void RemoveInstance(const std::string& instance);
  /// The same with an instance that bodies refer to in its place.
  void ReplaceInstance(const std::string& instance, const EffectInstance& by);

  std::string Text() const;

 private:
  pugi::xml_node Root() const { return document_.child("mujoco"); }
  pugi::xml_node Instance(const std::string& name) const;
  std::vector<pugi::xml_node> References(const std::string& instance) const;
  void EraseInstance(const std::string& instance);

  pugi::xml_document document_;
};

/// Throws Error (file:line) where the MJCF of a file gives a plugin's key an empty value. MuJoCo
/// keeps no trace of it: the plugin would read the key as absent.
void RefuseEmptyConfig(const std::string& xml, const std::string& file);

}  // namespace continuum
