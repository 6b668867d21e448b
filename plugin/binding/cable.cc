#include "binding/cable.h"

#include <algorithm>
#include <cmath>

#include "binding/actuator_force.h"
#include "binding/damper.h"
#include "binding/force.h"
#include "mujoco_compat.h"

namespace continuum {
namespace {

// Degrees of freedom that move one of two bodies only.
void AddEntries(const mjModel& m, int near, int far, std::vector<JacobianEntry>& entries) {
  while (near != far) {
    const bool outer = far > near;  // the higher index is no ancestor of the other
    int& body = outer ? far : near;
    for (int dof = m.body_dofadr[body]; dof < m.body_dofadr[body] + m.body_dofnum[body]; ++dof) {
      entries.push_back({dof, outer ? 1.0 : -1.0});
    }
    body = m.body_parentid[body];
  }
}

// What the path of a tendon is made of between two pulleys: [begin, end).
struct Branch {
  int begin, end;
  double divisor;
};

std::vector<Branch> BranchesOf(const mjModel& m, int tendon) {
  const int first = m.tendon_adr[tendon], end = first + m.tendon_num[tendon];
  std::vector<Branch> branches{{first, first, 1}};
  for (int w = first; w < end; ++w) {
    if (m.wrap_type[w] == mjWRAP_PULLEY) {
      branches.push_back({w + 1, w + 1, m.wrap_prm[w]});
    } else {
      branches.back().end = w + 1;
    }
  }
  return branches;
}

// Interior sites and geoms; below 0 where there is no cable at all.
int Contacts(const Branch& branch) { return branch.end - branch.begin - 2; }

// Sites, and each geom as its two tangent points.
std::vector<CablePoint> PointsOf(const mjModel& m, const Branch& branch) {
  std::vector<CablePoint> points;
  for (int w = branch.begin; w < branch.end; ++w) {
    const int id = m.wrap_objid[w];
    if (m.wrap_type[w] == mjWRAP_SITE) {
      points.push_back({id, -1, m.site_bodyid[id], w});
    } else {
      points.insert(points.end(), 2, {-1, id, m.geom_bodyid[id], w});
    }
  }
  return points;
}

Cable MakeCable(const mjModel& m, int tendon, const Branch& branch, Driven driven) {
  Cable cable{};
  cable.tendon = tendon, cable.begin = {0}, cable.divisor = branch.divisor;
  cable.from_last = driven == Driven::kLast, cable.both = driven == Driven::kBoth;
  std::vector<CablePoint> points = PointsOf(m, branch);
  if (cable.from_last) std::reverse(points.begin(), points.end());
  for (const CablePoint& point : points) {
    if (point.site >= 0) cable.sites.push_back(point.site);
  }
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const CablePoint &near = points[k], &far = points[k + 1];
    if (near.geom >= 0 && near.geom == far.geom) continue;  // on the geom
    cable.path.push_back({near, far});
    AddEntries(m, near.body, far.body, cable.entries);
    cable.begin.push_back(static_cast<int>(cable.entries.size()));
  }
  for (int a = 0; a < m.nactuator; ++a) {
    if (m.actuator_trntype[a] == mjTRN_TENDON && m.actuator_trnid[2 * a] == tendon)
      cable.actuators.push_back(a);
  }
  return cable;
}

// Of the spring, which has play between its two rest lengths, and of the dampers: the tendon's own
// and those that its actuators bring along.
double PassiveTension(const mjModel& m, const mjData& d, const Cable& cable) {
  const int t = cable.tendon;
  double tension = 0;
  const double* const k = m.tendon_stiffnesspoly + mjNPOLY * t;
  const double x = BeyondRest(m, t, d.ten_length[t] - PlasticSet(m, d, t));
  if (!(m.opt.disableflags & mjDSBL_SPRING))
    tension += x * (m.tendon_stiffness[t] + x * (k[0] + x * k[1]));
  if (m.opt.disableflags & mjDSBL_DAMPER) return tension;
  tension += TendonDamper(m, t).Force(d.ten_velocity[t]);
  for (const int a : cable.actuators) tension += ActuatorDamper(m, a).Force(d.ten_velocity[t]);
  return tension;
}

}  // namespace

bool Cable::Wraps() const {
  return std::any_of(path.begin(), path.end(), [](const Segment& s) { return s.far.geom >= 0; });
}

Misfit WhyNoCable(const mjModel& m, int tendon) {
  if (m.wrap_type[m.tendon_adr[tendon]] == mjWRAP_JOINT)
    return {"a spatial tendon", "a fixed tendon"};
  int contacts = 0;
  for (const Branch& branch : BranchesOf(m, tendon)) {
    if (!(branch.divisor > 0))
      return {"a spatial tendon", "a pulley with divisor " + std::to_string(branch.divisor)};
    contacts += std::max(0, Contacts(branch));
  }
  if (contacts > 0) return {};
  return {"a contact, which is a site or a wrapped geom between two sites",
          std::to_string(m.tendon_num[tendon]) + " sites"};
}

std::vector<Cable> MakeCables(const mjModel& m, int tendon, Driven driven) {
  std::vector<Cable> cables;
  for (const Branch& branch : BranchesOf(m, tendon)) {
    if (Contacts(branch) >= 0) cables.push_back(MakeCable(m, tendon, branch, driven));
  }
  return cables;
}

double NativeTension(const mjModel& m, const mjData& d, const Cable& cable) {
  double pull = PassiveTension(m, d, cable);
  for (const int a : cable.actuators) {
    pull -= m.actuator_gear[6 * m.actuator_outadr[a]] * LimitedForce(m, d, a);
  }
  return pull;
}

}  // namespace continuum
