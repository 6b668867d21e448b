#pragma once

#include <functional>
#include <string>
#include <vector>

namespace continuum {

/// A part of a result or of its files that could not be made.
struct MissingPart {
  std::string name;  ///< "prediction error"
  std::string why;   ///< what the exception says

  std::string InWords() const { return name + ": " + why; }
};

/// Makes one part. An exception costs that part alone: its name and reason are added to `missing`.
/// Returns whether the part was made.
bool MakePart(const std::string& name, std::vector<MissingPart>& missing,
              const std::function<void()>& make);

}  // namespace continuum
