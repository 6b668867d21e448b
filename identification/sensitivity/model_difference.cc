#include "identification/sensitivity/model_difference.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <mujoco/mjxmacro.h>

#include <Eigen/Core>

namespace continuum {
namespace {

// Fields that are distinguished by the lists of a difference, and those that no motion without
// contacts depends on, or that follow from others at compile time.
bool IsSeen(std::string_view field) {
  static const std::set<std::string_view> seen{"jnt_stiffness",
                                               "qpos_spring",
                                               "dof_damping",
                                               "dof_armature",
                                               "dof_frictionloss",
                                               "tendon_stiffness",
                                               "tendon_damping",
                                               "tendon_lengthspring",
                                               "actuator_gainprm",
                                               "actuator_biasprm",
                                               "actuator_gear",
                                               "actuator_forcerange",
                                               "actuator_ctrlrange",
                                               "actuator_dynprm",
                                               "body_mass",
                                               "body_ipos",
                                               "body_iquat",
                                               "body_inertia",
                                               "body_subtreemass",
                                               "body_invweight0",
                                               "body_sameframe",
                                               "body_simple",
                                               "dof_invweight0",
                                               "dof_M0",
                                               "dof_length",
                                               "dof_simplenum",
                                               "tendon_length0",
                                               "tendon_invweight0",
                                               "actuator_acc0",
                                               "actuator_length0",
                                               "actuator_lengthrange",
                                               "plugin_attr",
                                               "plugin_attradr",
                                               "npluginattr",
                                               "nbuffer"};
  return seen.contains(field) || field.starts_with("geom_") || field.starts_with("bvh_") ||
         field.starts_with("cam_") || field.starts_with("light_") || field.starts_with("mat_");
}

template <class T>
bool Same(const T* a, const T* b, std::size_t n) {
  return std::equal(a, a + n, b);
}

// By MuJoCo's own lists of the sizes and the arrays of a model.
std::string OtherSize(const mjModel* m, const mjModel* other) {
#define X(name) \
  if (!IsSeen(#name) && m->name != other->name) return #name;
  MJMODEL_SIZES
#undef X
  return "";
}

std::string OtherField(const mjModel* m, const mjModel* other) {
#undef MJ_M
#define MJ_M(n) m->n
#define X(type, name, count, each)                                                                \
  if (!IsSeen(#name) && !Same(m->name, other->name, static_cast<std::size_t>(m->count) * (each))) \
    return #name;
#define XNV X
  MJMODEL_POINTERS
#undef XNV
#undef X
  mjOption mine = m->opt, theirs = other->opt;
  std::copy_n(theirs.gravity, 3, mine.gravity);
  if (!std::equal(reinterpret_cast<const char*>(&mine), reinterpret_cast<const char*>(&mine + 1),
                  reinterpret_cast<const char*>(&theirs)))
    return "opt";
  return "";
}

// About the body's origin, as ModelDifference::Body orders it.
std::array<double, 10> InertiaOf(const mjModel& m, int b) {
  double r[9];
  mju_quat2Mat(r, m.body_iquat + 4 * b);
  const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r);
  const Eigen::Vector3d c(m.body_ipos + 3 * b);
  const double mass = m.body_mass[b];
  const Eigen::Matrix3d I =
      R * Eigen::Vector3d(m.body_inertia + 3 * b).asDiagonal() * R.transpose() +
      mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  return {mass,    mass * c[0], mass * c[1], mass * c[2], I(0, 0),
          I(1, 1), I(2, 2),     I(0, 1),     I(0, 2),     I(1, 2)};
}

}  // namespace

ModelDifference::ModelDifference(const mjModel& m, const mjModel& other)
    : field(OtherSize(&m, &other)), alike(field.empty()) {
  if (alike) field = OtherField(&m, &other);
  const auto differs = [](const double* a, const double* b, int i, int size = 1) {
    return !Same(a + i * size, b + i * size, static_cast<std::size_t>(size));
  };
  for (int j = 0; j < m.njnt; ++j) {
    const int q = m.jnt_qposadr[j], v = m.jnt_dofadr[j];
    if (differs(m.jnt_stiffness, other.jnt_stiffness, j) ||
        differs(m.qpos_spring, other.qpos_spring, q) ||
        differs(m.dof_damping, other.dof_damping, v))
      joints.push_back(j);
  }
  for (int i = 0; i < m.nv; ++i) {
    if (differs(m.dof_armature, other.dof_armature, i)) armatures.push_back(i);
    if (differs(m.dof_frictionloss, other.dof_frictionloss, i)) frictions.push_back(i);
  }
  for (int t = 0; t < m.ntendon; ++t) {
    if (differs(m.tendon_stiffness, other.tendon_stiffness, t) ||
        differs(m.tendon_damping, other.tendon_damping, t) ||
        differs(m.tendon_lengthspring, other.tendon_lengthspring, t, 2))
      tendons.push_back(t);
  }
  for (int a = 0; a < m.nactuator; ++a) {
    const bool input = differs(m.actuator_ctrlrange, other.actuator_ctrlrange, a, 2);
    const bool lag = differs(m.actuator_dynprm, other.actuator_dynprm, a, mjNDYN);
    if (input || lag || differs(m.actuator_gainprm, other.actuator_gainprm, a, mjNGAIN) ||
        differs(m.actuator_biasprm, other.actuator_biasprm, a, mjNBIAS) ||
        differs(m.actuator_gear, other.actuator_gear, m.actuator_outadr[a], 6) ||
        differs(m.actuator_forcerange, other.actuator_forcerange, a, 2))
      actuators.push_back(a);
    if (m.actuator_actadr[a] >= 0 && (input || lag)) activations.push_back(a);
  }
  for (int b = 1; b < m.nbody; ++b) {
    Body body{b, InertiaOf(other, b)};
    const auto mine = InertiaOf(m, b);
    if (body.inertia == mine) continue;
    for (std::size_t i = 0; i < mine.size(); ++i) body.inertia[i] -= mine[i];
    bodies.push_back(body);
  }
  gravity = !Same(m.opt.gravity, other.opt.gravity, 3);
}

void ModelDifference::AddGated(const Wiring& wiring) {
  for (std::size_t i = 0; i < wiring.actuator.size(); ++i) {
    const int a = wiring.actuator[i];
    if (wiring.gated[i] && std::find(actuators.begin(), actuators.end(), a) == actuators.end())
      actuators.push_back(a);
  }
}

}  // namespace continuum
