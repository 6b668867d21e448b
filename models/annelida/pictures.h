#pragma once

#include <filesystem>

#include "models/annelida/study.h"

namespace continuum {

/// The study in pictures: bend.png (the arm at 90° and, translucent, with equal angles), bend.svg
/// (its curvature and shape beside constant curvature), release.svg (joints and tip while it swings
/// out, and where friction holds it).
void WritePictures(const Study& study, const ModelSpec& annelida,
                   const std::filesystem::path& folder);

}  // namespace continuum
