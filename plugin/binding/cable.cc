#include "binding/cable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "error.h"

namespace continuum {
namespace {

// Places of all bodies at qpos0, where no joint is displaced.
struct Rest {
  std::vector<std::array<double, 3>> pos;
  std::vector<std::array<double, 4>> quat;

  explicit Rest(const mjModel& m) : pos(m.nbody), quat(m.nbody) {
    pos[0] = {0, 0, 0}, quat[0] = {1, 0, 0, 0};
    for (int b = 1; b < m.nbody; ++b) {
      const int parent = m.body_parentid[b];
      mju_rotVecQuat(pos[b].data(), m.body_pos + 3 * b, quat[parent].data());
      mju_addTo3(pos[b].data(), pos[parent].data());
      mju_mulQuat(quat[b].data(), quat[parent].data(), m.body_quat + 4 * b);
    }
  }
  void Site(const mjModel& m, int site, double* out) const {
    At(m.site_bodyid[site], m.site_pos + 3 * site, out);
  }
  void At(int body, const double* local, double* out) const {
    mju_rotVecQuat(out, local, quat[body].data());
    mju_addTo3(out, pos[body].data());
  }
};

bool Carries(const mjModel& m, int ancestor, int body) {
  while (body > ancestor) body = m.body_parentid[body];
  return body == ancestor;
}

// dL_k/dq for one degree of freedom at rest; ball and free joints by their rotation axes.
double Lever(const mjModel& m, const Rest& rest, int dof, int a, int b) {
  const int j = m.dof_jntid[dof], body = m.jnt_bodyid[j];
  const bool moves_a = Carries(m, body, m.site_bodyid[a]);
  const bool moves_b = Carries(m, body, m.site_bodyid[b]);
  if (moves_a == moves_b) return 0;
  double pa[3], pb[3], u[3], axis[3], anchor[3], arm[3], velocity[3];
  rest.Site(m, a, pa), rest.Site(m, b, pb);
  mju_sub3(u, pb, pa);
  mju_normalize3(u);
  const int component = dof - m.jnt_dofadr[j];
  const bool single = m.jnt_type[j] == mjJNT_HINGE || m.jnt_type[j] == mjJNT_SLIDE;
  double local[3] = {0, 0, 0};
  if (single) {
    mju_copy3(local, m.jnt_axis + 3 * j);
  } else {
    local[component % 3] = 1;
  }
  mju_rotVecQuat(axis, local, rest.quat[body].data());
  const bool slides =
      m.jnt_type[j] == mjJNT_SLIDE || (m.jnt_type[j] == mjJNT_FREE && component < 3);
  rest.At(body, m.jnt_pos + 3 * j, anchor);
  mju_sub3(arm, moves_b ? pb : pa, anchor);
  if (slides) {
    mju_copy3(velocity, axis);
  } else {
    mju_cross(velocity, axis, arm);
  }
  return (moves_b ? 1 : -1) * mju_dot3(u, velocity);
}

double Compliance(const mjModel& m, const Cable& cable) {
  const Rest rest(m);
  double total = 0;
  for (int dof = 0; dof < m.nv; ++dof) {
    double distal = 0;
    for (int k = cable.segments() - 1; k >= 1; --k) {
      distal += Lever(m, rest, dof, cable.sites[k], cable.sites[k + 1]);
      total += distal * distal * m.dof_invweight0[dof];
    }
  }
  return total;
}

}  // namespace

Cable MakeCable(const mjModel& m, int tendon, const std::string& who) {
  const std::string where = who + ": tendon '" + mj_id2name(&m, mjOBJ_TENDON, tendon) + "'";
  Cable cable{tendon, {}, {}, 0};
  for (int w = m.tendon_adr[tendon]; w < m.tendon_adr[tendon] + m.tendon_num[tendon]; ++w) {
    if (m.wrap_type[w] != mjWRAP_SITE) {
      throw Error::Input(where, "a spatial tendon through sites only",
                         m.wrap_type[w] == mjWRAP_JOINT ? "a fixed tendon" : "a pulley or a geom");
    }
    cable.sites.push_back(m.wrap_objid[w]);
  }
  if (cable.sites.size() < 2) throw Error::Input(where, "at least two sites", "fewer");
  for (int a = 0; a < m.nu; ++a) {
    if (m.actuator_trntype[a] == mjTRN_TENDON && m.actuator_trnid[2 * a] == tendon) {
      cable.actuators.push_back(a);
    }
  }
  cable.compliance = Compliance(m, cable);
  return cable;
}

double BaseTension(const mjModel& m, const mjData& d, const Cable& cable) {
  double pull = 0;
  for (const int a : cable.actuators) {
    double f = d.actuator_force[a];
    if (m.actuator_forcelimited[a]) {
      f = std::clamp(f, m.actuator_forcerange[2 * a], m.actuator_forcerange[2 * a + 1]);
    }
    pull -= m.actuator_gear[6 * a] * f;
  }
  if (m.tendon_actfrclimited[cable.tendon]) {
    const double* const range = m.tendon_actfrcrange + 2 * cable.tendon;
    pull = -std::clamp(-pull, range[0], range[1]);
  }
  return pull;
}

void CableGeometry::Update(const mjModel& m, const mjData& d, const Cable& cable) {
  const int n = cable.segments();
  direction.resize(3 * n), theta.resize(n), slip.resize(n);
  double last[3];
  const auto velocity = [&](int site, double* v) {
    const int b = m.site_bodyid[site];
    double arm[3];
    mju_sub3(arm, d.site_xpos + 3 * site, d.subtree_com + 3 * m.body_rootid[b]);
    mju_cross(v, d.cvel + 6 * b, arm);
    mju_addTo3(v, d.cvel + 6 * b + 3);
  };
  velocity(cable.sites[0], last);
  for (int k = 0; k < n; ++k) {
    double* const u = direction.data() + 3 * k;
    mju_sub3(u, d.site_xpos + 3 * cable.sites[k + 1], d.site_xpos + 3 * cable.sites[k]);
    mju_normalize3(u);
    double next[3], relative[3];
    velocity(cable.sites[k + 1], next);
    mju_sub3(relative, next, last);
    slip[k] = -mju_dot3(u, relative);  // rate of this segment; summed below
    mju_copy3(last, next);
    if (k == 0) continue;
    double cross[3];
    mju_cross(cross, u - 3, u);
    theta[k] = std::atan2(mju_norm3(cross), mju_dot3(u - 3, u));
  }
  for (int k = n - 2; k >= 0; --k) slip[k] += slip[k + 1];
}

BodyWrenches::BodyWrenches(const mjModel& m, std::span<const Cable> cables) : wrench_(6 * m.nbody) {
  std::set<int> bodies;
  for (const Cable& cable : cables) {
    for (const int site : cable.sites) {
      for (int b = m.site_bodyid[site]; b > 0; b = m.body_parentid[b]) bodies.insert(b);
    }
  }
  bodies_.assign(bodies.begin(), bodies.end());
}

void BodyWrenches::Pull(const mjModel& m, const mjData& d, int a, int b, const double* u,
                        double tension) {
  for (const auto& [site, sign] : {std::pair{a, 1.0}, std::pair{b, -1.0}}) {
    const int body = m.site_bodyid[site];
    double arm[3], force[3], torque[3];
    mju_sub3(arm, d.site_xpos + 3 * site, d.subtree_com + 3 * m.body_rootid[body]);
    mju_scl3(force, u, sign * tension);
    mju_cross(torque, arm, force);
    mju_addTo3(wrench_.data() + 6 * body, torque);
    mju_addTo3(wrench_.data() + 6 * body + 3, force);
  }
}

void BodyWrenches::Collect(const mjModel& m, const mjData& d, std::span<double> force) {
  std::fill(force.begin(), force.end(), 0.0);
  for (auto b = bodies_.rbegin(); b != bodies_.rend(); ++b) {
    double* const w = wrench_.data() + 6 * *b;
    const int first = m.body_dofadr[*b];
    for (int dof = first; dof < first + m.body_dofnum[*b]; ++dof) {
      force[dof] = mju_dot(d.cdof + 6 * dof, w, 6);
    }
    const int parent = m.body_parentid[*b];
    if (parent > 0) mju_addTo(wrench_.data() + 6 * parent, w, 6);
    std::fill_n(w, 6, 0.0);
  }
  std::fill_n(wrench_.begin(), 6, 0.0);
}

}  // namespace continuum
