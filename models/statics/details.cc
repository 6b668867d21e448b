#include "models/statics/details.h"

namespace continuum::statics {
namespace {

using Texts = std::vector<std::string>;

const Texts kWrench = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};

void Append(const Texts& more, Texts& names) {
  names.insert(names.end(), more.begin(), more.end());
}

}  // namespace

void AddDead(const Eigen::Vector3d& force, const Eigen::Vector3d& p,
             const Eigen::Vector3d& straight, Details& details) {
  details.force += force;
  details.moment += p.cross(force);
  details.energy -= force.dot(p - straight);
}

void SetEach(const std::string& prefix, const Eigen::VectorXd& values, Results& results) {
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    results.Set(prefix + std::to_string(k + 1), values[k]);
  }
}

Texts FrameColumns() { return {"qw", "qx", "qy", "qz"}; }

void SetFrame(Eigen::Quaterniond frame, Results& results) {
  if (frame.w() < 0) frame.coeffs() *= -1;
  results.Set("qw", frame.w());
  results.Set("qx", frame.x());
  results.Set("qy", frame.y());
  results.Set("qz", frame.z());
}

Texts DetailColumns::Names() const {
  Texts names = FrameColumns();
  Append(kWrench, names);
  names.emplace_back("strain_max");
  if (by_length || reaches) Append(Numbered("T_", cables), names);
  if (!by_length || reaches) Append(Numbered("l_", cables), names);
  if (reaches) names.emplace_back("miss");
  if (list) Append({"equilibrium", "energy"}, names);
  return names;
}

void Set(const Details& details, int equilibrium, Results& results) {
  SetFrame(details.tip, results);
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    results.Set(kWrench[at], details.force[i]);
    results.Set(kWrench[at + 3], details.moment[i]);
  }
  results.Set("strain_max", details.strain);
  SetEach("T_", details.pull, results);
  if (details.pull.size() == 0 || details.miss) SetEach("l_", details.length, results);
  if (details.miss) results.Set("miss", *details.miss);
  if (equilibrium == 0) return;
  results.Set("equilibrium", equilibrium);
  results.Set("energy", details.energy);
}

}  // namespace continuum::statics
