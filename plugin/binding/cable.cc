#include "binding/cable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <Eigen/Dense>

#include "binding/actuator_force.h"
#include "error.h"

namespace continuum {
namespace {

// Three numbers, inlined: MuJoCo's own vector functions are calls into another library.
struct Vector {
  double x = 0, y = 0, z = 0;
  Vector() = default;
  Vector(double a, double b, double c) : x(a), y(b), z(c) {}
  explicit Vector(const double* p) : x(p[0]), y(p[1]), z(p[2]) {}
  void Store(double* p) const { p[0] = x, p[1] = y, p[2] = z; }
  Vector operator+(const Vector& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Vector operator-(const Vector& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vector operator*(double f) const { return {f * x, f * y, f * z}; }
};
double Dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector Cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

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
  for (int a = 0; a < m.nactuator; ++a) {
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
    pull -= m.actuator_gear[6 * m.actuator_outadr[a]] * LimitedForce(m, d, a);
  }
  return pull;
}

void CableGeometry::Update(const mjModel& m, const mjData& d, const Cable& cable) {
  const int n = cable.segments();
  direction.resize(3 * n), theta.resize(n), slip.resize(n), arm.resize(3 * (n + 1));
  Vector last, point, u, before;
  for (int k = 0; k <= n; ++k) {
    const int site = cable.sites[k], body = m.site_bodyid[site];
    const Vector p(d.site_xpos + 3 * site);
    const Vector r = p - Vector(d.subtree_com + 3 * m.body_rootid[body]);
    const Vector velocity = Vector(d.cvel + 6 * body + 3) + Cross(Vector(d.cvel + 6 * body), r);
    r.Store(arm.data() + 3 * k);
    if (k > 0) {
      const Vector span = p - point;
      const double length = std::sqrt(Dot(span, span));
      u = length > mjMINVAL ? span * (1 / length) : Vector{1, 0, 0};
      u.Store(direction.data() + 3 * (k - 1));
      slip[k - 1] = -Dot(u, velocity - last);  // rate of this segment; summed below
      if (k > 1) {
        const Vector sine = Cross(before, u);
        theta[k - 1] = std::atan2(std::sqrt(Dot(sine, sine)), Dot(before, u));
      }
      before = u;
    }
    point = p, last = velocity;
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

void BodyWrenches::Add(const mjModel& m, const Cable& cable, const CableGeometry& at,
                       const double* tension) {
  const int n = cable.segments();
  Vector behind;  // what the segment before a site does to it
  for (int k = 0; k <= n; ++k) {
    const double beyond = k < n ? tension[k] - tension[0] : 0;
    const Vector ahead = k < n ? Vector(at.direction.data() + 3 * k) * beyond : Vector{};
    const Vector force = ahead - behind;
    const Vector torque = Cross(Vector(at.arm.data() + 3 * k), force);
    double* const w = wrench_.data() + 6 * m.site_bodyid[cable.sites[k]];
    w[0] += torque.x, w[1] += torque.y, w[2] += torque.z;
    w[3] += force.x, w[4] += force.y, w[5] += force.z;
    behind = ahead;
  }
}

void BodyWrenches::Collect(const mjModel& m, const mjData& d, std::span<double> force) {
  std::fill(force.begin(), force.end(), 0.0);
  for (auto b = bodies_.rbegin(); b != bodies_.rend(); ++b) {
    double* const w = wrench_.data() + 6 * *b;
    const int first = m.body_dofadr[*b];
    for (int dof = first; dof < first + m.body_dofnum[*b]; ++dof) {
      const double* const c = d.cdof + 6 * dof;
      force[dof] =
          c[0] * w[0] + c[1] * w[1] + c[2] * w[2] + c[3] * w[3] + c[4] * w[4] + c[5] * w[5];
    }
    const int parent = m.body_parentid[*b];
    double* const p = wrench_.data() + 6 * parent;
    for (int i = 0; i < 6; ++i) {
      if (parent > 0) p[i] += w[i];
      w[i] = 0;
    }
  }
  std::fill_n(wrench_.begin(), 6, 0.0);
}

}  // namespace continuum
