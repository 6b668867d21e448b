#include "models/statics/shape_table.h"

#include <vector>

#include "models/statics/details.h"

namespace continuum::statics {
namespace {

std::vector<std::string> Columns(int cables) {
  std::vector<std::string> names = {"case", "s", "disk", "x", "y", "z"};
  for (const auto& more : {FrameColumns(), Numbered("T_", cables)}) {
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

}  // namespace

ShapeTable::ShapeTable(int cables) : results_(Columns(cables)) {}

void ShapeTable::Add(const std::string& name, const Place& place) {
  results_.Row();
  results_.Set("case", name);
  results_.Set("s", place.s);
  if (place.disk >= 0) results_.Set("disk", place.disk);
  const char* const axes[3] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) results_.Set(axes[i], place.point[i]);
  SetFrame(place.frame, results_);
  for (Eigen::Index k = 0; k < place.tension.size(); ++k) {
    results_.Set("T_" + std::to_string(k + 1), place.tension[k]);
  }
}

}  // namespace continuum::statics
