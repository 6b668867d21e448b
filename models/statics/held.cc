#include "models/statics/held.h"

namespace continuum::statics {
namespace {

using Names = std::vector<std::string>;

const Names kTurn = {"qw", "qx", "qy", "qz"};
const Names kWrench = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};

// Of the two quaternions of a turn, the one with w >= 0.
void SetTurn(Eigen::Quaterniond turn, Results& results) {
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double values[] = {turn.w(), turn.x(), turn.y(), turn.z()};
  for (std::size_t i = 0; i < 4; ++i) results.Set(kTurn[i], values[i]);
}

Names ShapeColumns(int cables) {
  Names names = {"case", "s", "disk", "x", "y", "z"};
  names.insert(names.end(), kTurn.begin(), kTurn.end());
  const Names tensions = Numbered("T_", cables);
  names.insert(names.end(), tensions.begin(), tensions.end());
  return names;
}

}  // namespace

Names HoldColumns() {
  Names names = kTurn;
  names.insert(names.end(), kWrench.begin(), kWrench.end());
  names.emplace_back("strain_max");
  return names;
}

void Set(const Hold& hold, Results& results) {
  SetTurn(hold.tip, results);
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    results.Set(kWrench[at], hold.force[i]);
    results.Set(kWrench[at + 3], hold.moment[i]);
  }
  results.Set("strain_max", hold.strain);
}

Names EquilibriumColumns() { return {"equilibrium", "energy"}; }

std::string StatusOf(const numerics::Outcome& outcome, const Stability& stability) {
  if (!outcome.ok()) return "no_convergence";
  return stability.stable() ? "ok" : "saddle";
}

ShapeTable::ShapeTable(int cables) : results_(ShapeColumns(cables)) {}

void ShapeTable::Add(const std::string& name, const Place& place) {
  results_.Row();
  results_.Set("case", name);
  results_.Set("s", place.s);
  if (place.disk >= 0) results_.Set("disk", place.disk);
  const char* const axes[3] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) results_.Set(axes[i], place.point[i]);
  SetTurn(place.frame, results_);
  for (Eigen::Index k = 0; k < place.tension.size(); ++k) {
    results_.Set("T_" + std::to_string(k + 1), place.tension[k]);
  }
}

}  // namespace continuum::statics
