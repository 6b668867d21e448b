#pragma once

#include <vector>

#include "models/tdcr/section.h"
#include "sim/io/yaml.h"

namespace continuum::tdcr {

/// Reads `sections` of a robot's file, with 1 to 1000 disks together. @throws Error with file, line
/// and key for what is missing, unknown or contradicts itself, such as disks beyond their section.
std::vector<Section> ReadSections(const Yaml& file);

/// Reads `tendons` of the same file. @throws Error for a tendon outside its disks or inside the
/// rod, and for one that ends nowhere.
std::vector<Route> ReadRoutes(const Yaml& file, const std::vector<Section>& sections);

}  // namespace continuum::tdcr
