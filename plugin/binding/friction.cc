#include "binding/friction.h"

#include <algorithm>
#include <set>

#include "binding/row_softness.h"
#include "effects/all.h"
#include "error.h"
#include "mujoco_compat.h"

namespace continuum {
namespace {

// By so much the share of a ball joint's rows follows in a step: what it takes for a moment to stop
// the joint is no load.
constexpr double kShareStep = 0.02;

// Rows of the instances [begin, end).
std::set<std::pair<bool, int>> RowsOf(const mjModel& m, int begin, int end) {
  std::set<std::pair<bool, int>> taken;
  for (int j = begin; j < end; ++j) {
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

// Of a row under the discrete integrator, where the anchor does not act: as hard as the solver
// carries keeps the creep low.
constexpr double kDiscreteImpedance = 0.9999;

// How many joints of these rows stand one behind the other, at most, in each tree.
std::vector<int> LongestChains(const mjModel& m, const std::vector<bool>& rows) {
  std::vector<int> most(m.ntree), count(m.nv);
  for (int dof = 0; dof < m.nv; ++dof) {
    const int parent = m.dof_parentid[dof];
    count[dof] = rows[dof] + (parent < 0 ? 0 : count[parent]);
    int& longest = most[m.dof_treeid[dof]];
    longest = std::max(longest, count[dof]);
  }
  return most;
}

// (4)
double Impedance(int joints) {
  constexpr double kSoft = 0.01, kHard = 1e-5, kFew = 10;
  const double part = std::min(1.0, kFew / std::max(1, joints));
  return 1 - std::max(kHard, kSoft * part * part * part);
}

// Under the discrete integrator, which reads the model.
void HardenModel(mjModel& m, const FrictionRow& row) {
  double* const solref = (row.joint ? m.dof_solref : m.tendon_solref_fri) + mjNREF * row.index;
  double* const solimp = (row.joint ? m.dof_solimp : m.tendon_solimp_fri) + mjNIMP * row.index;
  const auto assign = [](double& to, double value) {
    if (to != value) to = value;  // another thread may be reading it
  };
  assign(solref[0], 2 * m.opt.timestep), assign(solref[1], 1);
  assign(solimp[0], kDiscreteImpedance), assign(solimp[1], kDiscreteImpedance);
}

bool HasDefaultImpedance(const mjModel& m, const FrictionRow& row) {
  const double* const solimp =
      (row.joint ? m.dof_solimp : m.tendon_solimp_fri) + mjNIMP * row.index;
  double usual[mjNREF], soft[mjNIMP];
  mj_defaultSolRefImp(usual, soft);
  return std::equal(soft, soft + mjNIMP, solimp);
}

// Deflection from the anchor at which the row at rest gives the force that it gives now.
double Yield(const mjData& d, int r) {
  const double stiffness = d.efc_KBIP[4 * r] * d.efc_KBIP[4 * r + 2];
  return stiffness > 0 ? -d.efc_R[r] * d.efc_force[r] / stiffness : 0;
}

}  // namespace

FrictionRows::FrictionRows(const mjModel& m, const Config& config, Joints types, int instance)
    : rows_(FrictionRowsOf(m, config, types)) {
  const auto below = RowsOf(m, 0, instance),
             above = RowsOf(m, instance + 1, static_cast<int>(m.nplugin));
  for (FrictionRow& row : rows_) {
    row.owner = !below.contains({row.joint, row.index});
    row.alone = row.owner && !above.contains({row.joint, row.index});
  }
  std::vector<bool> all(m.nv);
  for (const auto& [joint, index] : RowsOf(m, 0, static_cast<int>(m.nplugin))) {
    if (joint) all[index] = true;
  }
  const std::vector<int> longest = LongestChains(m, all);
  for (FrictionRow& row : rows_) {
    if (row.joint) row.impedance = Impedance(longest[m.dof_treeid[row.index]]);
  }
}

int FrictionRows::StateSize(const mjModel& m, const Config& config, Joints types) {
  return static_cast<int>(kStates * FrictionRowsOf(m, config, types).size());
}

void FrictionRows::Impose(mjModel& m) const {
  for (const FrictionRow& row : rows_) {
    double& loss = (row.joint ? m.dof_frictionloss : m.tendon_frictionloss)[row.index];
    if (loss == 0) loss = kRowMarker;
    if (IsDiscrete(m)) HardenModel(m, row);
  }
}

bool FrictionRows::Saturated(const mjData& d, int r) {
  return std::abs(d.efc_force[r]) >= d.efc_frictionloss[r] * (1 - 1e-9);
}

bool FrictionRows::IsNative(const mjModel& m, const FrictionRow& row) {
  const double native = (row.joint ? m.dof_frictionloss : m.tendon_frictionloss)[row.index];
  return row.alone && native > kRowMarker;
}

// Where the model says how soft they are.
std::string FrictionRows::WhySoft(const mjModel& m) const {
  constexpr int kMany = 30;
  constexpr double kHard = 0.999;
  if (IsDiscrete(m)) return "";
  std::vector<bool> soft(m.nv);
  for (const FrictionRow& row : rows_) {
    if (row.joint && !HasDefaultImpedance(m, row))
      soft[row.index] = m.dof_solimp[mjNIMP * row.index] < kHard;
  }
  const std::vector<int> longest = LongestChains(m, soft);
  const int most = longest.empty() ? 0 : *std::max_element(longest.begin(), longest.end());
  if (most < kMany) return "";
  return std::to_string(most) +
         " joints one behind the other: those at rest are springs on which the chain swings, and "
         "as soft as their solimpfriction makes them loads near breakaway make it creep; without "
         "solimpfriction it holds";
}

// MuJoCo: R = (1 − d)/d diag(A), D = 1/R.
void FrictionRows::Harden(const mjModel& m, mjData& d, const FrictionRow& row, int r) {
  double& impedance = d.efc_KBIP[4 * r + 2];
  if (impedance == row.impedance || IsDiscrete(m) || !HasDefaultImpedance(m, row)) return;
  const double wanted = (1 - row.impedance) / row.impedance;
  const double R = d.efc_R[r] * (impedance / (1 - impedance)) * wanted;
  SetSoftness(m, d, r, std::max(mjMINVAL, R));
  impedance = row.impedance, d.efc_KBIP[4 * r + 3] = 0;
}

bool FrictionRows::IsAnotherPose(const mjModel& m, double speed, double change) {
  constexpr double kLeast = 1e-5;  // a difference of mjd_transitionFD is none
  return std::abs(change) > kLeast + 2 * m.opt.timestep * std::abs(speed);
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
    if (z[0] == kUnknown) return 0;
    const double off = PositionOf(m, d, row) - z[1];
    return IsAnotherPose(m, Speed(d, row), off - z[2]) ? z[2] : off;
  }
  const double* const ball = z - kStates * row.axis;  // the joint's first row
  if (ball[0] == kUnknown) return 0;
  double turn[3];
  mju_subQuat(turn, d.qpos + m.jnt_qposadr[row.id], ball + 1);
  for (int k = 0; k < 3; ++k) {
    FrictionRow each = row;
    each.index += k - row.axis;
    if (IsAnotherPose(m, Speed(d, each), turn[k] - ball[6 + k])) return ball[6 + row.axis];
  }
  return turn[row.axis];
}

void FrictionRows::Soften(const mjModel& m, mjData& d, int r, double give) {
  const double level = d.efc_frictionloss[r], impedance = d.efc_KBIP[4 * r + 2];
  if (!(level > 0)) return;
  const double hard = d.efc_diagA[r] * (1 - impedance) / impedance;
  SetSoftness(m, d, r, std::max({mjMINVAL, hard, d.efc_KBIP[4 * r] * impedance * give / level}));
}

void FrictionRows::RequireAlone(const mjModel& m, const std::string& who) const {
  for (const FrictionRow& row : rows_) {
    const double native = (row.joint ? m.dof_frictionloss : m.tendon_frictionloss)[row.index];
    if (row.alone && native <= kRowMarker) continue;
    const char* const name = mj_id2name(&m, row.joint ? mjOBJ_JOINT : mjOBJ_TENDON, row.id);
    throw Error::Input(who + ": give", "no other dry friction on its joints",
                       std::string("some on '") + (name ? name : "") + "'");
  }
}

void FrictionRows::WriteRow(const mjModel& m, mjData& d, double off, Stage stage,
                            const FrictionRow& row, int r, double level) {
  if (row.owner) Harden(m, d, row, r);
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

// The solver begins with the acceleration of the last step, and needs an iteration for each time
// that it finds another set of rows that slide. A row that held most often holds.
void FrictionRows::Foresee(mjData& d, bool held, const FrictionRow& row, int r) {
  constexpr double kInside = 0.99;
  const double level = kInside * d.efc_frictionloss[r], *const kbip = d.efc_KBIP + 4 * r;
  if (!held || !(level > 0)) return;
  const double aref = -kbip[1] * d.qvel[row.index] - kbip[0] * kbip[2] * d.efc_pos[r];
  double& acceleration = d.qacc_warmstart[row.index];
  const double yield = d.efc_R[r] * level;
  acceleration = std::clamp(acceleration, aref - yield, aref + yield);
}

double FrictionRows::FreeAcceleration(const mjModel& m, const mjData& d, const FrictionRow& row) {
  if (row.joint) return d.qacc_smooth[row.index];
  double a = 0;
  const int adr = m.ten_J_rowadr[row.index];
  for (int k = adr; k < adr + m.ten_J_rownnz[row.index]; ++k)
    a += d.ten_J[k] * d.qacc_smooth[m.ten_J_colind[k]];
  return a;
}

// At the first stage qacc_smooth is still 0, at the others that of the stage before.
bool FrictionRows::MayHaveJustBegun(const mjModel& m, double grasp) {
  return grasp == kUnknown && m.opt.integrator == mjINT_RK4;
}

FrictionRows::Sliding FrictionRows::SlidingOf(const mjModel& m, const mjData& d, const double* z,
                                              const FrictionRow& row) {
  const double h = m.opt.timestep;
  if (row.axis < 0) {
    const double v = Speed(d, row);
    const bool rests = z[0] == kHeld || (MayHaveJustBegun(m, z[0]) &&
                                         std::abs(v) <= h * std::abs(FreeAcceleration(m, d, row)));
    return {rests ? 0 : v, 1};
  }
  const double* const ball = z - kStates * row.axis;  // the joint's first row
  if (ball[0] == kHeld) return {0, ball[5]};
  const int first = row.index - row.axis;
  const double* const turn = d.qvel + first;
  const double v = mju_norm3(turn), share = v > 0 ? std::abs(turn[row.axis]) / v : 1;
  const bool rests = MayHaveJustBegun(m, ball[0]) && v <= h * mju_norm3(d.qacc_smooth + first);
  return {rests ? 0 : v, share};
}

void FrictionRows::AdvanceLine(const mjModel& m, const mjData& d, const FrictionRow& row, double* z,
                               int& r) {
  if (!Find(d, row, r)) return;
  const bool slides = Saturated(d, r);
  const double q = PositionOf(m, d, row);
  if (z[0] == kUnknown || slides) {
    z[1] = q - (slides ? Yield(d, r) : 0);  // (2)
  } else if (IsAnotherPose(m, Speed(d, row), q - z[1] - z[2])) {
    z[1] = q - z[2];
  }
  z[0] = slides ? kSlid : kHeld;
  z[2] = q - z[1];
}

void FrictionRows::AdvanceBall(const mjModel& m, const mjData& d, const FrictionRow* rows,
                               double* z, int& r) {
  double yield[3], force[3], limit[3], turn[3];
  bool slides = false, moved = false;
  mju_subQuat(turn, d.qpos + m.jnt_qposadr[rows->id], z + 1);
  for (int k = 0; k < 3; ++k) {
    if (!Find(d, rows[k], r)) return;
    const bool full = Saturated(d, r) && d.efc_frictionloss[r] > 0;
    yield[k] = full ? -Yield(d, r) : -d.efc_pos[r];  // (2)
    slides |= full;
    moved |= IsAnotherPose(m, Speed(d, rows[k]), turn[k] - z[6 + k]);
    force[k] = std::abs(d.efc_force[r]);
    limit[k] = d.efc_frictionloss[r];
  }
  if (z[0] == kUnknown || slides || moved) {
    std::copy_n(d.qpos + m.jnt_qposadr[rows->id], 4, z + 1);
    mju_quatIntegrate(z + 1, yield, 1);
  }
  mju_subQuat(z + 6, d.qpos + m.jnt_qposadr[rows->id], z + 1);
  const double level = z[0] == kHeld ? limit[0] / z[5] : mju_norm3(limit), load = mju_norm3(force);
  const double share = load > level ? *std::max_element(force, force + 3) / load : 1;
  z[5] = z[0] == kUnknown ? 1 : z[5] + std::clamp(share - z[5], -kShareStep, kShareStep);  // (3)
  z[0] = slides ? kSlid : kHeld;
}

void FrictionRows::Advance(const mjModel& m, const mjData& d, double* z) const {
  int r = d.ne;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    if (rows_[k].axis < 0) {
      AdvanceLine(m, d, rows_[k], z + kStates * k, r);
    } else if (rows_[k].axis == 0) {
      AdvanceBall(m, d, &rows_[k], z + kStates * k, r);
    }
  }
}

std::string FrictionRows::WhyNoSlopes(const mjModel& m) const {
  return IsDiscrete(m) ? "its rows are folded into the inertia" : WhyNoBristles();
}

std::string FrictionRows::WhyNoBristles() const {
  const auto ball = [](const FrictionRow& row) { return row.axis >= 0; };
  return std::any_of(rows_.begin(), rows_.end(), ball) ? "it acts on a ball joint" : "";
}

std::vector<int> FrictionRows::BristleStates() const {
  std::vector<int> states;
  for (std::size_t k = 0; k < rows_.size(); ++k)
    states.push_back(static_cast<int>(kStates * k + kBristle));
  return states;
}

void FrictionRows::Oppose(const mjModel& m, const mjData& d, const FrictionRow& row, double f,
                          std::span<double> force) {
  if (row.joint) {
    force[row.index] -= f;
    return;
  }
  const int adr = m.ten_J_rowadr[row.index];
  for (int k = adr; k < adr + m.ten_J_rownnz[row.index]; ++k)
    force[m.ten_J_colind[k]] -= f * d.ten_J[k];
}

void FrictionRows::DifferentiateAnchor(const mjModel& m, const mjData& d, const StepTaken& step,
                                       const FrictionRow& row, int r, int first,
                                       LawSlopes& slopes) {
  using Kind = Number::Kind;
  const double* const z = step.z + first;
  const Number anchor{Kind::kState, first + 1}, last{Kind::kState, first + 2};
  const int at = row.joint ? row.index : row.id;
  if (row.owner && z[0] != kUnknown) {
    const Number offset{Kind::kOffset, r};
    if (IsAnotherPose(m, Speed(d, row), PositionOf(m, d, row) - z[1] - z[2])) {
      slopes.levels.push_back({offset, last, 1});
    } else {
      slopes.levels.push_back({offset, {row.joint ? Kind::kPosition : Kind::kLength, at}, 1});
      slopes.levels.push_back({offset, anchor, -1});
    }
  }
  const bool slides = Saturated(d, r);
  if (z[0] != kUnknown && !slides) return DifferentiateHeldAnchor(m, d, step, row, first, slopes);
  const Number next{Kind::kNext, first + 1}, off{Kind::kNext, first + 2};
  slopes.next.push_back({next, {row.joint ? Kind::kPositionAfter : Kind::kLength, at}, 1});
  if (!slides) return;
  slopes.next.push_back({next, {Kind::kYield, r}, -1});  // (2)
  slopes.next.push_back({off, {Kind::kYield, r}, 1});
}

void FrictionRows::DifferentiateHeldAnchor(const mjModel& m, const mjData& d, const StepTaken& step,
                                           const FrictionRow& row, int first, LawSlopes& slopes) {
  using Kind = Number::Kind;
  const double* const z = step.z + first;
  const Number anchor{Kind::kState, first + 1}, last{Kind::kState, first + 2},
      next{Kind::kNext, first + 1}, off{Kind::kNext, first + 2};
  const Number end{row.joint ? Kind::kPositionAfter : Kind::kLength,
                   row.joint ? row.index : row.id};
  const double q = row.joint ? step.qpos[m.jnt_qposadr[row.id]] : PositionOf(m, d, row),
               v = row.joint ? step.qvel[row.index] : Speed(d, row);
  const bool moved = IsAnotherPose(m, v, q - z[1] - z[2]);
  const Number kept = moved ? last : anchor, other = moved ? next : off;
  slopes.next.push_back({moved ? off : next, kept, 1});
  slopes.next.push_back({other, end, 1});
  slopes.next.push_back({other, kept, -1});
}

}  // namespace continuum
