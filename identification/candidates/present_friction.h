#pragma once

#include <string>
#include <vector>

#include "binding/effect_catalog.h"

namespace continuum {

/// A dry friction law of ours that a model has already on some joints or tendons.
struct PresentFriction {
  const EffectInfo* effect = nullptr;  ///< none: the model has no such law there
  std::string instance;                ///< name of the plugin instance; may be empty
  bool same = false;                   ///< on exactly these objects

  explicit operator bool() const { return effect; }
};

/// The last one of a model that acts on at least one of the objects of these names at a place.
PresentFriction PresentFrictionOn(const mjModel& m, Place place,
                                  const std::vector<std::string>& names);

}  // namespace continuum
