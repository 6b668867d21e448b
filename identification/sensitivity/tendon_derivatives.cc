#include "identification/sensitivity/tendon_derivatives.h"

#include <algorithm>
#include <span>

#include "sim/model/mujoco_handles.h"
#include "sim/model/point_jacobian.h"

namespace continuum {
namespace {

using Vector3 = Eigen::Vector3d;

Vector3 At(const double* x) { return {x[0], x[1], x[2]}; }

// The joints between a site and the world, from the root on.
std::vector<int> Chain(const mjModel& m, int site) {
  std::vector<int> dofs;
  for (int i = LastDof(m, m.site_bodyid[site]); i >= 0; i = m.dof_parentid[i]) dofs.push_back(i);
  std::reverse(dofs.begin(), dofs.end());
  return dofs;
}

bool IsDamped(const mjModel& m, int tendon) {
  if (m.tendon_damping[tendon] != 0) return true;
  for (int k = 0; k < m.nactuator; ++k) {
    if (m.actuator_trntype[k] != mjTRN_TENDON || m.actuator_trnid[2 * k] != tendon) continue;
    if (m.actuator_biasprm[mjNBIAS * k + 2] != 0 || m.actuator_gainprm[mjNGAIN * k + 2] != 0)
      return true;
  }
  return false;
}

// Whether one of two joints moves the other, or they are one.
bool AreInLine(const mjModel& m, int i, int j) {
  const int* const first = m.D_colind + m.D_rowadr[i];
  return std::find(first, first + m.D_rownnz[i], j) != first + m.D_rownnz[i];
}

}  // namespace

std::string TendonDerivatives::DampingObstacle(const mjModel& m) {
  for (int t = 0; t < m.ntendon; ++t) {
    if (!IsDamped(m, t)) continue;
    const std::span joints(m.ten_J_colind + m.ten_J_rowadr[t],
                           static_cast<std::size_t>(m.ten_J_rownnz[t]));
    for (const int i : joints) {
      for (const int j : joints) {
        if (!AreInLine(m, i, j))
          return "tendon " + Called(m, mjOBJ_TENDON, t) + " damps joints of two branches";
      }
    }
  }
  return "";
}

std::string TendonDerivatives::Obstacle(const mjModel& m) {
  for (int t = 0; t < m.ntendon; ++t) {
    for (int w = m.tendon_adr[t]; w < m.tendon_adr[t] + m.tendon_num[t]; ++w) {
      if (m.wrap_type[w] == mjWRAP_SITE || m.wrap_type[w] == mjWRAP_JOINT) continue;
      return "tendon " + Called(m, mjOBJ_TENDON, t) +
             (m.wrap_type[w] == mjWRAP_PULLEY ? " has a pulley" : " wraps around a geom");
    }
    if (m.tendon_armature[t] > 0)
      return "tendon " + Called(m, mjOBJ_TENDON, t) + " has an armature";
  }
  return "";
}

TendonDerivatives::TendonDerivatives(const mjModel& m) : route_(m.ntendon), bent_(m.nv) {
  for (int t = 0; t < m.ntendon; ++t) {
    const int first = m.tendon_adr[t];
    for (int w = first + 1; w < first + m.tendon_num[t]; ++w) {
      if (m.wrap_type[w] != mjWRAP_SITE) break;
      Segment segment{m.wrap_objid[w - 1], m.wrap_objid[w], w - first - 1};
      const auto before = Chain(m, segment.near), after = Chain(m, segment.far);
      const auto common = std::mismatch(before.begin(), before.end(), after.begin(), after.end());
      for (auto i = common.first; i != before.end(); ++i) segment.joints.push_back({*i, -1});
      for (auto i = common.second; i != after.end(); ++i) segment.joints.push_back({*i, 1});
      if (!segment.joints.empty()) route_[t].push_back(std::move(segment));
    }
  }
}

void TendonDerivatives::Update(const mjModel& m, const mjData& d) {
  for (auto& route : route_) {
    for (Segment& s : route) {
      const double *const near = d.site_xpos + 3 * s.near, *const far = d.site_xpos + 3 * s.far;
      s.along = At(far) - At(near);
      s.length = s.along.norm();
      if (s.length > mjMINVAL) s.along /= s.length;
      for (JointTerm& joint : s.joints) {
        joint.axis = At(d.cdof + 6 * joint.dof);
        joint.jacobian =
            joint.sign * PointJacobian(m, d, joint.dof, At(joint.sign > 0 ? far : near));
        joint.moment_arm = s.along.dot(joint.jacobian);
      }
    }
  }
}

double TendonDerivatives::Rate(const mjModel& m, const mjData& d, int tendon,
                               const double* v) const {
  double rate = 0;
  const int adr = m.ten_J_rowadr[tendon];
  for (int k = adr; k < adr + m.ten_J_rownnz[tendon]; ++k)
    rate += d.ten_J[k] * v[m.ten_J_colind[k]];
  return rate;
}

void TendonDerivatives::ForceAlong(const mjModel& m, const mjData& d, int tendon, double f,
                                   double* force) const {
  const int adr = m.ten_J_rowadr[tendon];
  for (int k = adr; k < adr + m.ten_J_rownnz[tendon]; ++k)
    force[m.ten_J_colind[k]] += f * d.ten_J[k];
}

template <class Fn>
void TendonDerivatives::ForEachCurvature(int tendon, Fn&& fn) const {
  for (const Segment& s : route_[tendon]) {
    if (s.length <= mjMINVAL) continue;  // it has no direction
    for (std::size_t a = 0; a < s.joints.size(); ++a) {
      const JointTerm& i = s.joints[a];
      for (std::size_t b = 0; b <= a; ++b) {
        const JointTerm& j = s.joints[b];
        double h = (i.jacobian.dot(j.jacobian) - i.moment_arm * j.moment_arm) / s.length;
        if (i.sign == j.sign) h += s.along.dot(j.axis.cross(i.jacobian));  // j is before i, or i
        fn(i.dof, j.dof, h, s.place);
      }
    }
  }
}

void TendonDerivatives::AddBend(int tendon, double factor, const double* x,
                                std::span<double> bend) const {
  ForEachCurvature(tendon, [&](int i, int j, double h, int) {
    bend[i] += factor * h * x[j];
    if (i != j) bend[j] += factor * h * x[i];
  });
}

void TendonDerivatives::AddBends(int tendon, std::span<const double> weight, const double* x,
                                 std::span<double> bend) const {
  ForEachCurvature(tendon, [&](int i, int j, double h, int place) {
    bend[i] += weight[place] * h * x[j];
    if (i != j) bend[j] += weight[place] * h * x[i];
  });
}

void TendonDerivatives::AddCurvature(int tendon, std::span<const double> weight,
                                     Matrix& curvature) const {
  ForEachCurvature(tendon, [&](int i, int j, double h, int place) {
    curvature(i, j) += weight[place] * h;
    if (i != j) curvature(j, i) += weight[place] * h;
  });
}

void TendonDerivatives::Add(const mjModel& m, const mjData& d, int tendon, double f,
                            double by_length, double by_rate, const double* v, Matrix& by_position,
                            Matrix& by_velocity) {
  std::fill(bent_.begin(), bent_.end(), 0.0);
  ForEachCurvature(tendon, [&](int i, int j, double h, int) {
    by_position(i, j) += f * h;
    bent_[i] += h * v[j];
    if (i == j) return;
    by_position(j, i) += f * h;
    bent_[j] += h * v[i];
  });
  const int adr = m.ten_J_rowadr[tendon], end = adr + m.ten_J_rownnz[tendon];
  for (int k = adr; k < end; ++k) {
    const int i = m.ten_J_colind[k];
    for (int l = adr; l < end; ++l) {
      const int j = m.ten_J_colind[l];
      by_position(i, j) += by_length * d.ten_J[k] * d.ten_J[l];
      by_velocity(i, j) += by_rate * d.ten_J[k] * d.ten_J[l];
    }
    if (by_rate == 0) continue;
    for (Eigen::Index j = 0; j < by_position.cols(); ++j)
      by_position(i, j) += by_rate * d.ten_J[k] * bent_[j];
  }
}

}  // namespace continuum
