#include "models/twin_pivot/details.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/twin_pivot/balance.h"
#include "models/twin_pivot/geometry.h"

namespace continuum::twin_pivot {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using statics::Details;

struct Body {
  double mass;
  Vector3d place;
};

// Everything that weighs, in the base frame.
std::vector<Body> Bodies(const Task& task, const VectorXd& beta) {
  const Robot& robot = task.robot;
  const auto discs = DiscFrames(robot, beta);
  const auto joint = JointsAt(robot, beta);
  std::vector<Body> bodies = {{task.payload, discs.back().translation()}};
  for (int m = 0; m < task.joints; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const Eigen::Isometry3d& before = discs[at];
    bodies.push_back({task.m_D[m], discs[at + 1].translation()});
    bodies.push_back(
        {task.m_NiTi[m], before * Vector3d(joint[at].centre.x, joint[at].centre.y, 0)});
    for (int j = 0; j < task.cables; ++j) {
      const auto cable = static_cast<std::size_t>(j);
      if (m >= task.anchor[cable]) continue;
      const double y = task.Y(m, j);
      const auto hole = joint[at].Hole(y);
      const Vector3d middle(0.5 * (task.links[at].before + hole.x), 0.5 * (y + hole.y),
                            task.Z(m, j));
      bodies.push_back({task.rho[j] * joint[at].Length(y), before * middle});
      if (task.anchor[cable] != m + 1) continue;
      const Vector3d lock(task.links[at].after, task.hole_y[cable], task.hole_z[cable]);
      bodies.push_back({task.m_CL[j], discs[at + 1] * lock});
    }
  }
  return bodies;
}

// All but strain and tensions.
Details DescribeAt(const Task& task, const VectorXd& beta) {
  const Robot& robot = task.robot;
  const VectorXd straight = VectorXd::Zero(beta.size());
  Details details;
  details.length = CableLengths(robot, beta).colwise().sum();
  details.energy = 0.5 * task.stiffness.dot(beta.cwiseAbs2());
  const VectorXd before = CableLengths(robot, straight).colwise().sum();
  for (int j = 0; j < task.cables; ++j) {
    const double tension = task.tension[static_cast<std::size_t>(j)];
    details.energy += tension * (details.length[j] - before[j]);
  }
  const auto bodies = Bodies(task, beta), first = Bodies(task, straight);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    AddDead(bodies[i].mass * task.gravity, bodies[i].place, first[i].place, details);
  }
  const auto discs = DiscFrames(robot, beta), unbent = DiscFrames(robot, straight);
  details.tip = Eigen::Quaterniond(discs.back().rotation());
  const auto add = [&](const DiscLoad& load) {
    const auto m = static_cast<std::size_t>(load.disc);
    AddDead(load.force, discs[m].translation(), unbent[m].translation(), details);
    details.moment += load.moment;
    if (!load.moment.isZero(0)) details.energy = std::numeric_limits<double>::quiet_NaN();
  };
  add({task.joints, task.force, task.moment});
  for (const DiscLoad& load : task.loads) add(load);
  return details;
}

}  // namespace

double Energy(const Robot& robot, const Load& load, const VectorXd& beta) {
  return DescribeAt(Task(robot, load, Method::kVirtualWork), beta).energy;
}

double Strain(const Robot& robot, const VectorXd& beta) {
  double strain = 0;
  Eigen::Index first = 0;
  for (int section = 0; section < robot.Sections(); ++section) {
    const int joints = robot.discs[static_cast<std::size_t>(section)];
    const double bent = beta.segment(first, joints).cwiseAbs().maxCoeff();
    strain = std::max(strain, 0.5 * robot.RodDiameter(section) / robot.L[section] * bent);
    first += joints;
  }
  return strain;
}

Details Describe(const Robot& robot, const Load& load, const Solution& solution) {
  Details details = DescribeAt(Task(robot, load, Method::kVirtualWork), solution.beta);
  details.pull = solution.pull;
  details.strain = Strain(robot, solution.beta);
  return details;
}

std::vector<statics::Place> Places(const Robot& robot, const Solution& solution, int per_rod) {
  const auto discs = DiscFrames(robot, solution.beta);
  const auto points = CentreLine(robot, solution.beta, per_rod);
  const std::vector<Link> links = robot.Links();
  std::vector<statics::Place> places;
  std::size_t point = 0;
  for (int m = 0; m <= robot.Joints(); ++m) {
    const auto at = static_cast<std::size_t>(m);
    const bool last = m == robot.Joints();
    const VectorXd tension = last ? VectorXd(VectorXd::Zero(robot.Cables()))
                                  : VectorXd(solution.tension.row(m).transpose());
    const Eigen::Quaterniond frame(discs[at].rotation());
    const double place = robot.Place(m);
    places.push_back({place, m, points[point++], frame, tension});
    if (last) break;
    for (int i = 0; i < per_rod; ++i) {
      const double share = static_cast<double>(i) / (per_rod - 1);
      const Eigen::AngleAxisd bent(share * solution.beta[m], Vector3d::UnitZ());
      places.push_back({place + links[at].before + share * links[at].L, -1, points[point++],
                        frame * Eigen::Quaterniond(bent), tension});
    }
  }
  return places;
}

}  // namespace continuum::twin_pivot
