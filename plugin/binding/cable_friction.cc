#include "binding/cable_friction.h"

#include <algorithm>
#include <cmath>

#include "binding/applied_force.h"
#include "error.h"

namespace continuum {
namespace {

constexpr double kFull = 20;  // tension drawn in red [N]

std::vector<Cable> MatchCables(const mjModel& m, const Config& config) {
  std::vector<Cable> cables;
  for (const int t : config.Match(Place::kTendon)) {
    cables.push_back(MakeCable(m, t, config.Who()));
  }
  return cables;
}

// Tensions change in proportion: what two instances add to one cable is no friction law.
void RequireAlone(const mjModel& m, const Config& config) {
  for (int j = 0; j < m.nplugin; ++j) {
    const Config other(m, j);
    if (m.plugin[j] != m.plugin[config.instance()] || j == config.instance()) continue;
    const auto theirs = other.Match(Place::kTendon);
    for (const int t : config.Match(Place::kTendon)) {
      if (std::find(theirs.begin(), theirs.end(), t) == theirs.end()) continue;
      throw Error::Input(config.Who() + ": tendon '" + mj_id2name(&m, mjOBJ_TENDON, t) + "'",
                         "one instance on a cable (with the sum of their mu)",
                         other.Who() + " on it too");
    }
  }
}

// MuJoCo applies no passive forces then.
bool Silent(const mjModel& m) {
  return (m.opt.disableflags & mjDSBL_SPRING) && (m.opt.disableflags & mjDSBL_DAMPER);
}

// e^x, where all are small by the series, which is then good to 1e-17: without branches, so that
// the compiler works on several numbers at once.
void Exponential(std::span<const double> x, std::span<double> y) {
  bool large = false;
  for (const double v : x) large |= !(v <= 0.25);
  for (std::size_t k = 0; k < x.size(); ++k) {
    double sum = 1;
    for (int n = 12; n > 0; --n) sum = 1 + x[k] * (sum * (1.0 / n));
    y[k] = sum;
  }
  for (std::size_t k = 0; large && k < x.size(); ++k) y[k] = std::exp(x[k]);
}

}  // namespace

CableFriction::CableFriction(const mjModel& m, const Config& config, std::vector<double> parameters)
    : BoundLaw(std::move(parameters)),
      cables_(MatchCables(m, config)),
      geometry_(m, cables_),
      sliding_(m, geometry_),
      base_(cables_.size()),
      last_(cables_.size()),
      force_(m.nv) {
  RequireAlone(m, config);
  for (int c = 0; c < geometry_.cables(); ++c) {
    int begin = geometry_.first[c] + 1;
    for (int s = begin; s < geometry_.first[c + 1]; ++s) {
      if (geometry_.begin[s] == geometry_.begin[s + 1]) continue;  // nothing changes its length
      groups_.push_back({c, begin, s + 1});
      begin = s + 1;
    }
  }
  bends_.resize(groups_.size()), active_.resize(groups_.size());
  for (auto* const each : {&band_, &grown_, &rho_, &tension_})
    each->assign(geometry_.segments(), 0);
  ratio_.assign(geometry_.segments(), 1);
}

// As parameters leave 0, contacts remember how far they gave way, which nobody knows at 0.
std::string CableFriction::WhyNoSlopes(const mjModel&) const {
  const bool none = std::all_of(p_.begin(), p_.end(), [](double p) { return p == 0; });
  return none ? "without friction nobody knows which contacts would rest" : "";
}

bool CableFriction::Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                             std::span<double> force) {
  if (stage == Stage::kPassive) {
    geometry_.Update(d);
    Bands(geometry_.theta, band_);
  } else if (Silent(m)) {
    return false;
  }
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    base_[c] = std::max(0.0, BaseTension(m, d, cables_[c]));
  }
  if (stage == Stage::kActuator) Remember(z);
  if (stage == Stage::kAfterAll) Solve(m, d, z);
  Add(force);
  return true;
}

void CableFriction::Remember(const double* z) {
  for (std::size_t k = 0; k < rho_.size(); ++k) {
    rho_[k] = std::clamp(z[k], -band_[k], band_[k]);  // 0 where band_ is: before the first contact
    ratio_[k] = rho_[k] == 0 ? 1 : std::exp(rho_[k]);
  }
}

void CableFriction::Solve(const mjModel& m, mjData& d, const double* z) {
  std::fill(rho_.begin(), rho_.end(), 0.0);
  std::fill(ratio_.begin(), ratio_.end(), 1.0);
  if (!Collect(z)) return;
  AppliedForces(m, d, force_.data());
  for (const int dof : sliding_.inertia().dofs()) force_[dof] += z[m.nwrap + dof];
  sliding_.Solve({m, d, geometry_, base_, last_, force_}, {bends_.data(), count_});
  Share(z);
}

// The bends of the tight cables; returns whether one of them has friction.
bool CableFriction::Collect(const double* z) {
  Exponential(band_, grown_);
  bool friction = false;
  double level = 0;
  count_ = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& group = groups_[i];
    const int first = geometry_.first[group.cable];
    if (base_[group.cable] == 0) continue;
    if (group.begin == first + 1) level = 0, last_[group.cable] = z[first];
    active_[count_] = static_cast<int>(i);
    Bend& bend = bends_[count_++];
    bend.cable = group.cable, bend.segment = group.end - 1;
    bend.band = bend.memory = 0, bend.grown = 1;
    for (int k = group.begin; k < group.end; ++k) {
      level += z[k];
      bend.band += band_[k], bend.grown *= grown_[k];
      bend.memory += std::clamp(z[k], -band_[k], band_[k]);
    }
    bend.speed = geometry_.slip[bend.segment];
    bend.level = level;
    bend.fresh = z[first] == 0;
    bend.given = false;
    friction |= bend.band > 0;
  }
  return friction;
}

void CableFriction::Share(const double* z) {
  for (std::size_t g = 0; g < count_; ++g) {
    const Bend& bend = bends_[g];
    const double rho = bend.side != 0 ? bend.side * bend.band : std::log(bend.ratio);
    const Group& group = groups_[active_[g]];
    rho_[group.begin] = rho, ratio_[group.begin] = bend.ratio;
    if (group.end > group.begin + 1) Spread(group, rho, z);
  }
}

// Shares ρ of a group: every contact moves from what it was by the same part of the way to its
// band.
void CableFriction::Spread(const Group& group, double rho, const double* z) {
  double memory = 0, band = 0;
  for (int k = group.begin; k < group.end; ++k) {
    memory += std::clamp(z[k], -band_[k], band_[k]);
    band += band_[k];
  }
  const double sign = rho < memory ? -1 : 1, room = band - sign * memory;
  const double part = room > 0 ? std::min(1.0, std::abs(rho - memory) / room) : 0;
  for (int k = group.begin; k < group.end; ++k) {
    const double old = std::clamp(z[k], -band_[k], band_[k]);
    rho_[k] = old + part * (sign * band_[k] - old);
    ratio_[k] = std::exp(rho_[k]);
  }
}

void CableFriction::Add(std::span<double> force) {
  std::fill(force.begin(), force.end(), 0.0);
  for (int c = 0; c < geometry_.cables(); ++c) {
    double tension = base_[c];
    for (int s = geometry_.first[c]; s < geometry_.first[c + 1]; ++s) {
      tension_[s] = tension *= ratio_[s];
      if (tension != base_[c]) geometry_.Add(s, base_[c] - tension, force.data());
    }
  }
}

void CableFriction::Advance(const mjModel& m, const mjData& d, double* z) {
  std::copy(rho_.begin(), rho_.end(), z);
  for (std::size_t c = 0; c < base_.size(); ++c) z[geometry_.first[c]] = base_[c];
  for (const int dof : sliding_.inertia().dofs()) z[m.nwrap + dof] = d.qfrc_constraint[dof];
}

std::string_view CableFriction::SensorPlace(const mjModel&, mjtObj kind, int id) const {
  const bool known = kind == mjOBJ_SITE && Index(id) >= 0;
  return known ? "" : "objtype=\"site\" and a site of the tendons";
}

void CableFriction::Visualize(const mjModel& m, const mjData& d, mjvScene& scene) const {
  std::size_t s = 0;
  for (const Cable& cable : cables_) {
    const double width = 1.05 * m.tendon_width[cable.tendon];
    for (int k = 0; k < cable.segments(); ++k, ++s) {
      if (scene.ngeom >= scene.maxgeom) return;
      const float x = static_cast<float>(std::clamp(tension_[s] / kFull, 0.0, 1.0));
      const float rgba[4] = {0.13f + 0.80f * x, 0.40f - 0.25f * x, 0.85f - 0.75f * x, 1};
      mjvGeom* const geom = scene.geoms + scene.ngeom++;
      mjv_initGeom(geom, mjGEOM_CAPSULE, nullptr, nullptr, nullptr, rgba);
      mjv_connector(geom, mjGEOM_CAPSULE, width, d.site_xpos + 3 * cable.sites[k],
                    d.site_xpos + 3 * cable.sites[k + 1]);
      geom->objtype = mjOBJ_TENDON;
      geom->objid = cable.tendon;
      geom->category = mjCAT_DECOR;
    }
  }
}

void CableFriction::CopyFrom(const BoundLaw& other) {
  const auto& from = static_cast<const CableFriction&>(other);
  geometry_ = from.geometry_, base_ = from.base_;
  band_ = from.band_, rho_ = from.rho_, ratio_ = from.ratio_, tension_ = from.tension_;
}

// The segment just distal of a site; the last one for the end of a cable.
int CableFriction::Index(int site) const {
  int s = 0;
  for (const Cable& cable : cables_) {
    for (int k = 0; k <= cable.segments(); ++k) {
      if (cable.sites[k] == site) return s + std::min(k, cable.segments() - 1);
    }
    s += cable.segments();
  }
  return -1;
}

}  // namespace continuum
