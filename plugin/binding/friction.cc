#include "binding/friction.h"

#include <algorithm>
#include <set>

#include "effects/all.h"

namespace continuum {
namespace {

// Creates a row without saying how large the friction is: the level is written in every evaluation.
constexpr double kRowMarker = 1e-12;

// By so much the share of a ball joint's rows follows in a step: what it takes for a moment to stop
// the joint is no load.
constexpr double kShareStep = 0.02;

std::set<std::pair<bool, int>> RowsBelow(const mjModel& m, int instance) {
  std::set<std::pair<bool, int>> taken;
  for (int j = 0; j < instance; ++j) {
    const mjpPlugin* const plugin = mjp_getPluginAtSlot(m.plugin[j]);
    const auto add = [&]<class E>() {
      if constexpr (FrictionLaw<E> || std::same_as<E, FormulaFriction>) {
        if (!plugin || plugin->name != PluginName(E::kName)) return;
        const Config config(m, j);
        for (const FrictionRow& row : FrictionRowsOf(m, config, JointsOf<E>()))
          taken.insert({row.joint, row.index});
      }
    };
    All::ForEach(add);
    FormulaLaws::ForEach(add);
  }
  return taken;
}

// Impedance of a row, unless the model says how hard it is; under the discrete integrator, where
// the anchor does not act, whatever it says: as hard as the solver carries keeps the creep low.
constexpr double kImpedance = 0.99, kDiscreteImpedance = 0.9999;

void Harden(mjModel& m, const FrictionRow& row) {
  double* const solref = (row.joint ? m.dof_solref : m.tendon_solref_fri) + mjNREF * row.index;
  double* const solimp = (row.joint ? m.dof_solimp : m.tendon_solimp_fri) + mjNIMP * row.index;
  const auto assign = [](double& to, double value) {
    if (to != value) to = value;  // another thread may be reading it
  };
  double usual[mjNREF], soft[mjNIMP];
  mj_defaultSolRefImp(usual, soft);
  const bool discrete = m.opt.integrator == mjINT_DISCRETE;
  if (discrete) assign(solref[0], 2 * m.opt.timestep), assign(solref[1], 1);
  if (!discrete && !std::equal(soft, soft + mjNIMP, solimp)) return;
  const double impedance = discrete ? kDiscreteImpedance : kImpedance;
  assign(solimp[0], impedance), assign(solimp[1], impedance);
}

bool Saturated(const mjData& d, int r) {
  return std::abs(d.efc_force[r]) >= d.efc_frictionloss[r] * (1 - 1e-9);
}

// Deflection from the anchor at which the row at rest gives the force that it gives now.
double Yield(const mjData& d, int r) {
  const double stiffness = d.efc_KBIP[4 * r] * d.efc_KBIP[4 * r + 2];
  return stiffness > 0 ? -d.efc_R[r] * d.efc_force[r] / stiffness : 0;
}

}  // namespace

FrictionRows::FrictionRows(const mjModel& m, const Config& config, Joints types, int instance)
    : rows_(FrictionRowsOf(m, config, types)) {
  const auto taken = RowsBelow(m, instance);
  for (FrictionRow& row : rows_) row.owner = !taken.contains({row.joint, row.index});
}

int FrictionRows::StateSize(const mjModel& m, const Config& config, Joints types) {
  return 2 * static_cast<int>(FrictionRowsOf(m, config, types).size());
}

void FrictionRows::Impose(mjModel& m) const {
  for (const FrictionRow& row : rows_) {
    double& loss = (row.joint ? m.dof_frictionloss : m.tendon_frictionloss)[row.index];
    if (loss == 0) loss = kRowMarker;
    Harden(m, row);
  }
}

bool FrictionRows::Find(const mjData& d, const FrictionRow& row, int& r) {
  const int type = row.joint ? mjCNSTR_FRICTION_DOF : mjCNSTR_FRICTION_TENDON;
  for (int k = r; k < d.ne + d.nf; ++k) {
    if (d.efc_type[k] == type && d.efc_id[k] == row.index) {
      r = k;
      return true;
    }
  }
  return false;
}

double FrictionRows::OffAnchor(const mjModel& m, const mjData& d, const double* z,
                               const FrictionRow& row) {
  if (row.axis < 0) {
    const double q = row.joint ? d.qpos[m.jnt_qposadr[row.id]] : d.ten_length[row.id];
    return z[0] != 0 ? q - z[1] : 0;
  }
  const double* const ball = z - 2 * row.axis;  // the joint's first row
  double turn[3] = {0, 0, 0};
  if (ball[0] != 0) mju_subQuat(turn, d.qpos + m.jnt_qposadr[row.id], ball + 1);
  return turn[row.axis];
}

void FrictionRows::WriteRow(const mjModel& m, mjData& d, double off, Stage stage,
                            const FrictionRow& row, int r, double level) {
  if (row.owner) {
    const double native = (row.joint ? m.dof_frictionloss : m.tendon_frictionloss)[row.index];
    d.efc_frictionloss[r] = level + (native == kRowMarker ? 0 : native);
  } else {
    d.efc_frictionloss[r] += level;
  }
  if (d.nisland > 0) d.iefc_frictionloss[d.map_efc2iefc[r]] = d.efc_frictionloss[r];
  if (!row.owner || stage != Stage::kPassive) return;

  const double h = m.opt.timestep;
  d.efc_KBIP[4 * r] = 1 / (4 * h * h);  // (1)
  d.efc_KBIP[4 * r + 1] = 1 / h;
  d.efc_pos[r] = off;
}

FrictionRows::Sliding FrictionRows::SlidingOf(const mjData& d, const double* z,
                                              const FrictionRow& row) {
  if (row.axis < 0) return {z[0] == kHeld ? 0 : Speed(d, row), 1};
  const double* const ball = z - 2 * row.axis;  // the joint's first row
  if (ball[0] == kHeld) return {0, ball[5]};
  const double* const turn = d.qvel + row.index - row.axis;
  const double v = mju_norm3(turn);
  return {v, v > 0 ? std::abs(turn[row.axis]) / v : 1};
}

void FrictionRows::AdvanceLine(const mjModel& m, const mjData& d, const FrictionRow& row, double* z,
                               int& r) {
  if (!Find(d, row, r)) return;
  const bool slides = Saturated(d, r);
  const double q = row.joint ? d.qpos[m.jnt_qposadr[row.id]] : d.ten_length[row.id];
  if (z[0] == kUnknown || slides) z[1] = q - (slides ? Yield(d, r) : 0);  // (2)
  z[0] = slides ? kSlid : kHeld;
}

void FrictionRows::AdvanceBall(const mjModel& m, const mjData& d, const FrictionRow* rows,
                               double* z, int& r) {
  double yield[3], force[3], limit[3];
  bool slides = false;
  for (int k = 0; k < 3; ++k) {
    if (!Find(d, rows[k], r)) return;
    const bool full = Saturated(d, r) && d.efc_frictionloss[r] > 0;
    yield[k] = full ? -Yield(d, r) : -d.efc_pos[r];  // (2)
    slides |= full;
    force[k] = std::abs(d.efc_force[r]);
    limit[k] = d.efc_frictionloss[r];
  }
  if (z[0] == kUnknown || slides) {
    std::copy_n(d.qpos + m.jnt_qposadr[rows->id], 4, z + 1);
    mju_quatIntegrate(z + 1, yield, 1);
  }
  const double level = z[0] == kHeld ? limit[0] / z[5] : mju_norm3(limit), load = mju_norm3(force);
  const double share = load > level ? *std::max_element(force, force + 3) / load : 1;
  z[5] = z[0] == kUnknown ? 1 : z[5] + std::clamp(share - z[5], -kShareStep, kShareStep);  // (3)
  z[0] = slides ? kSlid : kHeld;
}

void FrictionRows::Advance(const mjModel& m, const mjData& d, double* z) const {
  int r = d.ne;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    if (rows_[k].axis < 0) {
      AdvanceLine(m, d, rows_[k], z + 2 * k, r);
    } else if (rows_[k].axis == 0) {
      AdvanceBall(m, d, &rows_[k], z + 2 * k, r);
    }
  }
}

std::string FrictionRows::WhyNoSlopes(const mjModel& m) const {
  if (m.opt.integrator == mjINT_DISCRETE) return "its rows are folded into the inertia";
  const auto ball = [](const FrictionRow& row) { return row.axis >= 0; };
  return std::any_of(rows_.begin(), rows_.end(), ball) ? "it acts on a ball joint" : "";
}

void FrictionRows::DifferentiateAnchor(const mjData& d, const FrictionRow& row, int r, double grasp,
                                       int state, LawSlopes& slopes) {
  using Kind = Number::Kind;
  const Number anchor{Kind::kState, state}, next{Kind::kNext, state};
  const int at = row.joint ? row.index : row.id;
  if (row.owner && grasp != kUnknown) {
    slopes.levels.push_back(
        {{Kind::kOffset, r}, {row.joint ? Kind::kPosition : Kind::kLength, at}, 1});
    slopes.levels.push_back({{Kind::kOffset, r}, anchor, -1});
  }
  const bool slides = Saturated(d, r);
  if (grasp != kUnknown && !slides) {
    slopes.next.push_back({next, anchor, 1});
    return;
  }
  slopes.next.push_back({next, {row.joint ? Kind::kPositionAfter : Kind::kLength, at}, 1});
  if (slides) slopes.next.push_back({next, {Kind::kYield, r}, -1});  // (2)
}

}  // namespace continuum
