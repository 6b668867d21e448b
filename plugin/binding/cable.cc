#include "binding/cable.h"

#include <algorithm>
#include <cmath>

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
  Vector operator-(const Vector& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vector operator*(double f) const { return {f * x, f * y, f * z}; }
};
double Dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector Cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Degrees of freedom that move one of two bodies only.
void AddLevers(const mjModel& m, int near, int far, std::vector<Lever>& levers) {
  while (near != far) {
    const bool outer = far > near;  // the higher index is no ancestor of the other
    int& body = outer ? far : near;
    for (int dof = m.body_dofadr[body]; dof < m.body_dofadr[body] + m.body_dofnum[body]; ++dof) {
      levers.push_back({dof, outer ? 1.0 : -1.0});
    }
    body = m.body_parentid[body];
  }
}

// The angle between two unit vectors. Small ones by the series of the arcsine, to 1e-16.
double Angle(const Vector& a, const Vector& b) {
  const Vector change = b - a;
  const double s = 0.25 * Dot(change, change);  // sin²(θ/2)
  if (s > 0.01) {
    const Vector sine = Cross(a, b);
    return std::atan2(std::sqrt(Dot(sine, sine)), Dot(a, b));
  }
  const double series =
      1 +
      s * (1.0 / 6 +
           s * (3.0 / 40 +
                s * (5.0 / 112 + s * (35.0 / 1152 + s * (63.0 / 2816 + s * (231.0 / 13312 +
                                                                            s * 143.0 / 10240))))));
  return 2 * std::sqrt(s) * series;
}

}  // namespace

Cable MakeCable(const mjModel& m, int tendon, const std::string& who) {
  const std::string where = who + ": tendon '" + mj_id2name(&m, mjOBJ_TENDON, tendon) + "'";
  Cable cable{tendon, {}, {}, {}, {0}};
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
  for (int k = 0; k < cable.segments(); ++k) {
    AddLevers(m, m.site_bodyid[cable.sites[k]], m.site_bodyid[cable.sites[k + 1]], cable.levers);
    cable.begin.push_back(static_cast<int>(cable.levers.size()));
  }
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
  theta.resize(n), slip.resize(n), arm.resize(cable.levers.size());
  Vector point(d.site_xpos + 3 * cable.sites[0]), before;
  for (int k = 0; k < n; ++k) {
    const int site = cable.sites[k + 1];
    const Vector p(d.site_xpos + 3 * site), span = p - point;
    const double length = std::sqrt(Dot(span, span));
    const Vector u = length > mjMINVAL ? span * (1 / length) : Vector{1, 0, 0};
    if (k > 0) theta[k] = Angle(before, u);
    for (int l = cable.begin[k]; l < cable.begin[k + 1]; ++l) {
      const Lever& lever = cable.levers[l];
      const int root = m.body_rootid[m.dof_bodyid[lever.dof]];
      const Vector moment = Cross(p - Vector(d.subtree_com + 3 * root), u);
      const double* const c = d.cdof + 6 * lever.dof;  // rotation, translation at that centre
      arm[l] = lever.sign * (Dot(Vector(c), moment) + Dot(Vector(c + 3), u));
    }
    slip[k] = -Rate(cable, k, d.qvel);
    point = p, before = u;
  }
  for (int k = n - 2; k >= 0; --k) slip[k] += slip[k + 1];
}

double CableGeometry::Rate(const Cable& cable, int segment, const double* v) const {
  double rate = 0;
  for (int l = cable.begin[segment]; l < cable.begin[segment + 1]; ++l) {
    rate += arm[l] * v[cable.levers[l].dof];
  }
  return rate;
}

void CableGeometry::Add(const Cable& cable, int segment, double f, double* force) const {
  for (int l = cable.begin[segment]; l < cable.begin[segment + 1]; ++l) {
    force[cable.levers[l].dof] += arm[l] * f;
  }
}

}  // namespace continuum
