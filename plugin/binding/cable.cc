#include "binding/cable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <Eigen/Dense>

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

// Rotation and velocity at a point of one degree of freedom at rest.
struct Motion {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), move = Eigen::Vector3d::Zero();
};
Motion MotionOf(const mjModel& m, const Rest& rest, int dof, const Eigen::Vector3d& point) {
  const int j = m.dof_jntid[dof], body = m.jnt_bodyid[j], component = dof - m.jnt_dofadr[j];
  const int type = m.jnt_type[j];
  double local[3] = {0, 0, 0};
  if (type == mjJNT_HINGE || type == mjJNT_SLIDE) {
    mju_copy3(local, m.jnt_axis + 3 * j);
  } else {
    local[component % 3] = 1;
  }
  Eigen::Vector3d axis, anchor;
  mju_rotVecQuat(axis.data(), local, rest.quat[body].data());
  rest.At(body, m.jnt_pos + 3 * j, anchor.data());
  Motion motion;
  if (type == mjJNT_SLIDE || (type == mjJNT_FREE && component < 3)) {
    motion.move = axis;
  } else {
    motion.turn = axis;
    motion.move = axis.cross(point - anchor);
  }
  return motion;
}

// The inertia matrix at rest.
Eigen::MatrixXd InertiaAtRest(const mjModel& m, const Rest& rest) {
  const auto nv = static_cast<int>(m.nv);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(nv, nv);
  for (int dof = 0; dof < nv; ++dof) M(dof, dof) = m.dof_armature[dof];
  for (int b = 1; b < m.nbody; ++b) {
    Eigen::Vector3d com;
    rest.At(b, m.body_ipos + 3 * b, com.data());
    double quat[4], mat[9];
    mju_mulQuat(quat, rest.quat[b].data(), m.body_iquat + 4 * b);
    mju_quat2Mat(mat, quat);
    const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(mat);
    const Eigen::Matrix3d I =
        R * Eigen::Map<const Eigen::Vector3d>(m.body_inertia + 3 * b).asDiagonal() * R.transpose();
    std::vector<int> dofs;
    std::vector<Motion> motions;
    for (int a = b; a > 0; a = m.body_parentid[a]) {
      for (int dof = m.body_dofadr[a]; dof >= 0 && dof < m.body_dofadr[a] + m.body_dofnum[a];
           ++dof) {
        dofs.push_back(dof);
        motions.push_back(MotionOf(m, rest, dof, com));
      }
    }
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      for (std::size_t k = 0; k < dofs.size(); ++k) {
        M(dofs[i], dofs[k]) += m.body_mass[b] * motions[i].move.dot(motions[k].move) +
                               motions[i].turn.dot(I * motions[k].turn);
      }
    }
  }
  return M;
}

// Largest eigenvalue of D M⁻¹ Dᵀ, D_i the gradient of the cable length distal of contact i.
double Compliance(const mjModel& m, const Cable& cable) {
  const int contacts = cable.segments() - 1, nv = static_cast<int>(m.nv);
  if (contacts < 1 || nv == 0) return 0;
  const Rest rest(m);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(contacts, nv);
  for (int k = cable.segments() - 1; k >= 1; --k) {
    const int a = cable.sites[k], b = cable.sites[k + 1];
    if (k < contacts) D.row(k - 1) = D.row(k);
    Eigen::Vector3d pa, pb;
    rest.Site(m, a, pa.data()), rest.Site(m, b, pb.data());
    const Eigen::Vector3d u = (pb - pa).normalized();
    for (int dof = 0; dof < nv; ++dof) {
      const int body = m.dof_bodyid[dof];
      const bool moves_a = Carries(m, body, m.site_bodyid[a]),
                 moves_b = Carries(m, body, m.site_bodyid[b]);
      if (moves_a == moves_b) continue;
      D(k - 1, dof) += (moves_b ? 1 : -1) * u.dot(MotionOf(m, rest, dof, moves_b ? pb : pa).move);
    }
  }
  const Eigen::MatrixXd M = InertiaAtRest(m, rest);
  const Eigen::MatrixXd A = D * M.ldlt().solve(D.transpose());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
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
