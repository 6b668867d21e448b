#include "binding/native_damping.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "effects/all.h"

namespace continuum {
namespace {

constexpr double kPrinted = 1e-5;  // MuJoCo saves models with six digits

// The damping that the laws of a model give to each degree of freedom, as its MJCF says.
std::map<int, double> SumsOf(const mjModel& m) {
  std::map<int, double> sums;
  for (int i = 0; i < m.nplugin; ++i) {
    const mjpPlugin* const plugin = mjp_getPluginAtSlot(m.plugin[i]);
    if (!plugin) continue;
    All::ForEach([&]<class E>() {
      if constexpr (requires { E::kDamping; }) {
        if (plugin->name != PluginName(E::kName)) return;
        const Config config(m, i);
        const double damping = config.Read(E::kParams[E::kDamping]);
        for (const FrictionRow& row : FrictionRowsOf(m, config, JointsOf<E>()))
          sums[row.index] += damping;
      }
    });
  }
  return sums;
}

}  // namespace

void NativeDamping::Refuse(const mjModel& m, const FrictionRow& row, double allowed) const {
  throw Error::Input(effect_ + ": joint '" + mj_id2name(&m, mjOBJ_JOINT, row.id) + "'",
                     "native damping 0 or equal to " + parameter_ + " = " + std::to_string(allowed),
                     std::to_string(m.dof_damping[row.index]));
}

void NativeDamping::ImposeSums(mjModel& m, const std::vector<FrictionRow>& rows) const {
  const auto sums = SumsOf(m);
  for (const FrictionRow& row : rows) {
    double& native = m.dof_damping[row.index];
    const double sum = sums.at(row.index);
    foreign_.push_back(sum == 0 && native != 0);
    if (native != 0 && std::abs(native - sum) > kPrinted * sum && sum != 0) Refuse(m, row, sum);
    if (sum != 0) native = sum;
  }
}

void NativeDamping::Impose(mjModel& m, const std::vector<FrictionRow>& rows, double own) const {
  if (foreign_.empty()) ImposeSums(m, rows);
  if (own == mine_) return;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (foreign_[k]) Refuse(m, rows[k], own);
    double& native = m.dof_damping[rows[k].index];
    native = own + std::max(0.0, native - mine_);
  }
  mine_ = own;
}

}  // namespace continuum
