#include "identification/result/missing_parts.h"

#include <exception>

namespace continuum {

bool MakePart(const std::string& name, std::vector<MissingPart>& missing,
              const std::function<void()>& make) {
  try {
    make();
    return true;
  } catch (const std::exception& error) {
    missing.push_back({name, error.what()});
    return false;
  }
}

}  // namespace continuum
