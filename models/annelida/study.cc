#include "models/annelida/study.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "error.h"
#include "models/annelida/constant_curvature.h"

namespace continuum {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2, kLargestTension = 100;

// A plant: joint angles after the next step under this tension of cable 1.
using Plant = std::function<PlanarJoints(double tension)>;

BendResult Run(
    const Plant& plant, const BendAndRelease& plan, double h,
    const std::function<void()>& held = [] {}) {
  const long stride = std::lround(plan.period / h);
  BendResult result;
  // The k-th step of a course; returns the angle by which the tip has turned.
  const auto step = [&](Course& course, long k, double tension) {
    const PlanarJoints q = plant(tension);
    if (k % stride == 0) {
      course.time.push_back(double(k) * h);
      course.tension.push_back(tension);
      course.q.push_back(q);
    }
    return q.sum();
  };
  long k = 0;
  for (double turned = 0; turned < kRightAngle;) {
    result.tension = plan.rate * h * double(k);
    if (result.tension > kLargestTension) throw Error::Job("annelida: no 90 degree bend to 100 N");
    turned = step(result.bend, ++k, result.tension);
  }
  for (const long end = k + std::lround(plan.hold / h); k < end;) {
    step(result.bend, ++k, result.tension);
  }
  held();
  for (long i = 0; i < std::lround(plan.after / h);) step(result.release, ++i, 0);
  return result;
}

}  // namespace

BendResult BendMujoco(const ModelSpec& annelida, const BendAndRelease& plan, double h,
                      const std::function<void(const mjModel&, const mjData&)>& held) {
  const Change step{"option", "timestep", h};
  const ModelAndData machine = annelida.Build(std::span(&step, 1));
  const mjModel& m = *machine.model;
  mjData& d = *machine.data;
  std::array<int, kAnnelidaLinks> address;
  for (int i = 0; i < kAnnelidaLinks; ++i) {
    const std::string joint = "bend" + std::to_string(i + 1) + "_y";
    address[i] = m.jnt_qposadr[mj_name2id(&m, mjOBJ_JOINT, joint.c_str())];
  }
  const int cable = mj_name2id(&m, mjOBJ_ACTUATOR, "cable1");
  const auto plant = [&](double tension) {
    d.ctrl[cable] = tension;
    mj_step(&m, &d);
    PlanarJoints q;
    for (int i = 0; i < kAnnelidaLinks; ++i) q[i] = d.qpos[address[i]];
    return q;
  };
  return Run(plant, plan, h, [&] {
    if (held) held(m, d);
  });
}

BendResult BendChain(const PlanarChain& chain, const BendAndRelease& plan, double h) {
  PlanarState state;
  const auto plant = [&](double tension) {
    chain.Step(state, {tension, 0}, h);
    return state.q;
  };
  return Run(plant, plan, h);
}

PlanarJoints Even(const PlanarJoints& q) { return PlanarJoints::Constant(q.mean()); }

Eigen::Matrix2Xd ArcPoints(const AnnelidaParameters& p, const PlanarJoints& q, int n) {
  Eigen::Matrix2Xd points(2, n);
  for (int i = 0; i < n; ++i) {
    const double share = double(i) / double(n - 1);
    const Eigen::Vector3d at = ArcPose(Arc{0, share * q.sum(), share * p.Length()}).translation();
    points.col(i) << at.x(), -at.z();
  }
  return points;
}

PlanarJoints At(const Course& course, double time) {
  std::size_t i = 0;
  while (i + 1 < course.time.size() && course.time[i] < time - 1e-6) ++i;
  return course.q[i];
}

}  // namespace continuum
