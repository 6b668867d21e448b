#include "binding/cable_friction.h"

#include <algorithm>
#include <cmath>

#include "binding/applied_force.h"
#include "binding/bristle.h"
#include "binding/cable_doubts.h"
#include "binding/cable_drawing.h"
#include "binding/exponential.h"
#include "binding/row_softness.h"
#include "binding/tree_groups.h"
#include "error.h"
#include "mujoco_compat.h"

namespace continuum {
namespace {

constexpr double kLeastPull = 1e-12;  // of a cable that was never tight, or is not yet [N]

Driven DrivenEnd(const Config& config) {
  const std::string_view text = config.Get("driven");
  if (text.empty() || text == "first") return Driven::kFirst;
  if (text == "last") return Driven::kLast;
  if (text == "both") return Driven::kBoth;
  throw Error::Input(config.Who() + ": driven", "first | last | both",
                     "'" + std::string(text) + "'");
}

// Cables of one robot one after the other, as CableSliding needs them.
std::vector<Cable> Grouped(const mjModel& m, std::vector<Cable> cables) {
  std::vector<std::vector<int>> dofs;
  for (const Cable& cable : cables) {
    dofs.emplace_back();
    for (const JacobianEntry& entry : cable.entries) dofs.back().push_back(entry.dof);
  }
  const std::vector<int> group = TreeGroups(m, dofs);
  std::vector<Cable> sorted;
  for (int g = 0; sorted.size() < cables.size(); ++g) {
    for (std::size_t c = 0; c < cables.size(); ++c) {
      if (group[c] == g) sorted.push_back(std::move(cables[c]));
    }
  }
  return sorted;
}

std::vector<int> TendonsOf(const mjModel& m, const Config& config) {
  return config.MatchFit(Place::kTendon, [&](int t) { return WhyNoCable(m, t); });
}

std::vector<Cable> MatchCables(const mjModel& m, const Config& config) {
  std::vector<Cable> cables;
  const Driven driven = DrivenEnd(config);
  for (const int t : TendonsOf(m, config)) {
    const auto branches = MakeCables(m, t, driven);
    cables.insert(cables.end(), branches.begin(), branches.end());
  }
  return Grouped(m, std::move(cables));
}

// Tensions change in proportion: what two instances add to one cable is no friction law.
void RequireAlone(const mjModel& m, const Config& config) {
  for (int j = 0; j < m.nplugin; ++j) {
    const Config other(m, j);
    if (m.plugin[j] != m.plugin[config.instance()] || j == config.instance()) continue;
    const auto theirs = TendonsOf(m, other);
    for (const int t : TendonsOf(m, config)) {
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

}  // namespace

CableFriction::CableFriction(const mjModel& m, const Config& config, std::vector<double> parameters)
    : BoundLaw(std::move(parameters)),
      cables_(MatchCables(m, config)),
      doubts_(DoubtsOf(m, config, cables_)),
      tension_rows_(m, cables_),
      geometry_(m, cables_),
      sliding_(m, geometry_),
      trees_(m.ntree),
      native_(cables_.size()),
      base_(cables_.size()),
      last_(cables_.size()),
      answer_(cables_.size(), -1),
      force_(m.nv) {
  RequireAlone(m, config);
  for (const int dof : geometry_.dof) trees_[m.dof_treeid[dof]] = true;
  for (int c = 0; c < geometry_.cables(); ++c) {
    int begin = geometry_.first[c] + 1;
    for (int s = begin; s < geometry_.first[c + 1]; ++s) {
      const bool runs = geometry_.both[c] && s + 1 == geometry_.first[c + 1];
      if (geometry_.begin[s] == geometry_.begin[s + 1] && !runs) continue;  // nothing moves it
      groups_.push_back({c, begin, s + 1});
      begin = s + 1;
    }
  }
  bends_.resize(groups_.size()), active_.resize(groups_.size());
  for (auto* const each : {&band_, &grown_, &rho_, &tension_})
    each->assign(geometry_.segments(), 0);
  ratio_.assign(geometry_.segments(), 1);
}

std::string CableFriction::WhyIdle(const mjModel&) const { return doubts_; }

// As parameters leave 0, contacts remember how far they gave way, which nobody knows at 0.
std::string CableFriction::WhyNoSlopes(const mjModel& m) const {
  const bool none = std::all_of(p_.begin(), p_.end(), [](double p) { return p == 0; });
  if (none) return "without friction nobody knows which contacts would rest";
  if (tension_rows_.any()) return "a limit or an equality pulls a cable";
  if (std::ranges::count(geometry_.both, true) > 0) return "a cable is pulled at both ends";
  if (sliding_.islands() > 1) return "its cables belong to several robots";
  for (const Cable& cable : cables_) {
    const int t = cable.tendon;
    if (cable.Wraps()) return "a cable wraps a geom";
    if (cable.segments() + 1 != m.tendon_num[t]) return "a cable runs over a pulley";
    if (Yields(m, t)) return "the spring of a tendon yields";
    for (int k = 0; k < mjNPOLY; ++k) {
      if (m.tendon_stiffnesspoly[mjNPOLY * t + k] != 0 ||
          m.tendon_dampingpoly[mjNPOLY * t + k] != 0)
        return "the spring or damper of a tendon is not linear";
    }
  }
  return "";
}

bool CableFriction::Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                             std::span<double> force) {
  if (stage == Stage::kPassive) {
    geometry_.Update(m, d);
    Bands(geometry_.theta, band_);
    RunAlong(geometry_.slip);
    const bool null = std::all_of(p_.begin(), p_.end(), [](double p) { return p == 0; });
    if (!null && !IsDiscrete(m)) SoftenContacts(m, d, trees_);
  } else if (Silent(m)) {
    return false;
  }
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    native_[c] = NativeTension(m, d, cables_[c]) / cables_[c].divisor;
    base_[c] = std::max(0.0, native_[c]);
  }
  if (tension_rows_.any()) FindRows(m, d, z, stage);
  if (stage == Stage::kActuator) Remember(z);
  if (stage == Stage::kAfterAll) Solve(m, d, z), answer_ = base_;
  Add(force);
  return true;
}

// A cable that is pulled at both ends runs along itself so that the friction of its contacts
// cancels
// ((3a) of CableSliding): by the median of their speeds, weighted by their bands. Nothing else
// would have as much friction one way as the other.
void CableFriction::RunAlong(std::span<double> slip) const {
  for (int c = 0; c < geometry_.cables(); ++c) {
    if (!geometry_.both[c]) continue;
    const int begin = geometry_.first[c] + 1, end = geometry_.first[c + 1];
    double median = 0, least = kInfinity;
    for (int s = begin; s < end; ++s) {
      double slower = 0, faster = 0;
      for (int k = begin; k < end; ++k) {
        if (slip[k] < slip[s]) slower += band_[k];
        if (slip[k] > slip[s]) faster += band_[k];
      }
      if (const double more = std::max(slower, faster); more < least)
        least = more, median = slip[s];
    }
    for (int s = begin - 1; s < end; ++s) slip[s] -= median;
  }
}

void CableFriction::Remember(const double* z) {
  for (std::size_t k = 0; k < rho_.size(); ++k) {
    rho_[k] = std::clamp(z[k], -band_[k], band_[k]);  // 0 where band_ is: before the first contact
    ratio_[k] = rho_[k] == 0 ? 1 : std::exp(rho_[k]);
  }
}

// Constraint rows that pull cables: the tension that they give is that of the last step until it is
// solved for. mj_inverse solves for none and keeps the last answer.
void CableFriction::FindRows(const mjModel& m, mjData& d, const double* z, Stage stage) {
  rows_.Clear();
  for (const TensionRow& row : tension_rows_.At(m, d)) {
    SolvedRow& solved = rows_.Add(m, d, row.row, row.limit);
    for (const Cable& cable : cables_) solved.on.push_back(row.On(cable.tendon) / cable.divisor);
  }
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const auto all = rows_.all();
    const bool pulled =
        std::any_of(all.begin(), all.end(), [&](const SolvedRow& row) { return row.On(c) != 0; });
    if (!pulled) continue;
    const bool answered = stage == Stage::kPassive && answer_[c] >= 0;
    base_[c] = answered ? answer_[c] : std::max(z[geometry_.first[c]], kLeastPull);
  }
}

void CableFriction::Solve(const mjModel& m, mjData& d, const double* z) {
  std::fill(rho_.begin(), rho_.end(), 0.0);
  std::fill(ratio_.begin(), ratio_.end(), 1.0);
  if (!Collect(z)) return;
  AppliedForces(m, d, force_.data());
  for (int dof = 0; dof < m.nv; ++dof) force_[dof] += z[m.nwrap + dof];
  if (!tension_rows_.any()) rows_.Clear();
  AddContactRows(m, d, rows_);
  sliding_.Solve({m, d, geometry_, native_, base_, last_, force_, rows_.all(), Give()},
                 {bends_.data(), count_});
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
    bend.given = false, bend.turned = 0;
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
    if (group.end == group.begin + 1) continue;
    if (bend.side != 0 && bend.turned == 0) {
      for (int k = group.begin; k < group.end; ++k) {
        rho_[k] = bend.side * band_[k];
        ratio_[k] = bend.side > 0 ? grown_[k] : 1 / grown_[k];
      }
      continue;
    }
    Spread(group, rho, z);
    const double share = bend.turned > 0 ? std::log(bend.ratio) / rho : 1;
    for (int k = group.begin; share != 1 && k < group.end; ++k)
      ratio_[k] = std::exp(share * rho_[k]);
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
  double largest = largest_;
  for (int c = 0; c < geometry_.cables(); ++c) {
    const double base = base_[c];
    double tension = base;
    for (int s = geometry_.first[c]; s < geometry_.first[c + 1]; ++s) {
      tension_[s] = tension *= ratio_[s];
      if (tension != base) geometry_.Add(s, base - tension, force.data());
      largest = std::max(largest, tension);
    }
  }
  largest_ = largest;
}

double CableFriction::LargestTension() const {
  return tension_.empty() ? 0 : *std::max_element(tension_.begin(), tension_.end());
}

// Nothing presses a slack cable on its contacts. What they remember goes as it came, by the sliding
// over which friction builds up: |ρ| falls by band · |v| h/give.
void CableFriction::Fade(const mjModel& m, int cable, double* z) const {
  const double give_way = CableSliding::GiveWay(Give(), m.opt.timestep);  // give/h
  for (int s = geometry_.first[cable] + 1; s < geometry_.first[cable + 1]; ++s) {
    const double rest = std::abs(z[s]) - band_[s] * std::abs(geometry_.slip[s]) / give_way;
    z[s] = std::copysign(std::max(0.0, rest), z[s]);
  }
}

void CableFriction::Advance(const mjModel& m, const mjData& d, double* z) {
  for (std::size_t c = 0; c < base_.size(); ++c) {
    const int first = geometry_.first[c], end = geometry_.first[c + 1];
    if (base_[c] > 0) {
      std::copy(rho_.begin() + first, rho_.begin() + end, z + first);
      z[first] = base_[c];
    } else {
      if (z[first] == 0) z[first] = kLeastPull;  // no longer fresh
      Fade(m, static_cast<int>(c), z);
    }
  }
  std::vector<int> rows;
  for (const TensionRow& row : tension_rows_.At(m, d)) rows.push_back(row.row);
  OtherConstraintForces(m, d, rows, force_);
  std::copy(force_.begin(), force_.end(), z + m.nwrap);
}

std::string CableFriction::WhyNoBristles(const mjModel&) const {
  if (tension_rows_.any()) return "a limit or an equality pulls a cable";
  if (std::ranges::count(geometry_.both, true) > 0) return "a cable is pulled at both ends";
  return "";
}

std::vector<int> CableFriction::BristleStates() const {
  std::vector<int> contacts;
  for (int c = 0; c < geometry_.cables(); ++c) {
    for (int s = geometry_.first[c] + 1; s < geometry_.first[c + 1]; ++s) contacts.push_back(s);
  }
  return contacts;
}

void CableFriction::Bristles(const mjModel&, const mjData&, const double* z, double* rate,
                             std::span<double> force) const {
  const double give = Give() > 0 ? Give() : Bristle::kGive;
  std::vector<double> band(geometry_.segments());
  Bands(geometry_.theta, band);
  for (int c = 0; c < geometry_.cables(); ++c) {
    double tension = base_[c];
    tension_[geometry_.first[c]] = tension;
    for (int s = geometry_.first[c] + 1; s < geometry_.first[c + 1]; ++s) {
      const Bristle bristle(z[s], geometry_.slip[s], give);
      rate[s] = bristle.rate;
      tension_[s] = tension *= std::exp(-band[s] * bristle.u);
      geometry_.Add(s, base_[c] - tension, force.data());
    }
  }
}

std::string_view CableFriction::SensorPlace(const mjModel&, mjtObj kind, int id) const {
  const bool known = (kind == mjOBJ_SITE || kind == mjOBJ_GEOM) && Index(kind, id) >= 0;
  return known ? "" : "objtype=\"site\" or \"geom\" and a site or wrapped geom of the tendons";
}

// Each segment pulls its two ends together; the native tendon does so with t_0.
void CableFriction::PointForces(const mjModel&, const mjData& d, const TakeForce& take) const {
  int s = 0;
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    for (const Cable::Segment& segment : cables_[c].path) {
      const double more = tension_[s] - base_[c];
      double pull[3], back[3];
      geometry_.Along(s, pull);
      mju_scl3(back, pull, -more), mju_scl3(pull, pull, more);
      take(segment.near.body, geometry_.Near(d, s), pull);
      take(segment.far.body, geometry_.Far(d, s), back);
      ++s;
    }
  }
}

void CableFriction::Visualize(const mjModel& m, const mjData& d, mjvScene& scene) const {
  const double full = red_at_ > 0 ? red_at_ : std::max(largest_, kLeastPull);
  DrawCables(m, d, cables_, geometry_, tension_, full, scene);
}

void CableFriction::CopyFrom(const BoundLaw& other) {
  const auto& from = static_cast<const CableFriction&>(other);
  geometry_ = from.geometry_, base_ = from.base_, answer_ = from.answer_;
  band_ = from.band_, rho_ = from.rho_, ratio_ = from.ratio_, tension_ = from.tension_;
  red_at_ = from.red_at_, largest_ = from.largest_;
}

// The segment just distal of a site or geom; the last one for the end of a cable.
int CableFriction::Index(mjtObj kind, int id) const {
  const auto is = [&](const CablePoint& point) {
    return (kind == mjOBJ_SITE ? point.site : point.geom) == id;
  };
  int s = 0, end = -1;
  for (const Cable& cable : cables_) {
    for (int k = 0; k < cable.segments(); ++k, ++s) {
      if (is(cable.path[k].near)) return s;
      if (is(cable.path[k].far) && end < 0) end = s;
    }
  }
  return end;
}

}  // namespace continuum
