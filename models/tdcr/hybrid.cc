#include "models/tdcr/hybrid.h"

#include <fmt/format.h>

#include <algorithm>

#include "error.h"
#include "models/tdcr/linear_curvature.h"

namespace continuum::tdcr {
namespace {

Eigen::VectorXd AllFeatures(const Robot& robot, const Loads& loads, const Eigen::Matrix3Xd& u) {
  const double first = u(2, 0), last = u(2, u.cols() - 1);
  Eigen::VectorXd features(7 + robot.tendons);
  features.head<4>() << first, first * first, last, last * last;
  features.segment<3>(4) = loads.tip_force;
  for (int k = 0; k < robot.tendons; ++k) {
    features[7 + k] = loads.tension[static_cast<std::size_t>(k)];
  }
  return features;
}

// What counts as a change: twists below this are rounding of a rod that stays in its plane.
double Resolution(const Robot& robot, Eigen::Index feature) {
  if (feature >= 4) return 1e-12;
  return 1e-9 / (feature % 2 == 0 ? robot.length : robot.length * robot.length);
}

// The arcs of a solution, without measured points.
Sample ArcsOf(const Robot& robot, const Loads& loads, const Solution& solution) {
  Sample sample;
  sample.u = solution.u;
  sample.beside = solution.disks - Positions(EqualArcs(robot), solution.u);
  sample.features = AllFeatures(robot, loads, solution.u);
  return sample;
}

Sample Model(const Robot& robot, Method method, const Pair& pair) {
  const Solution solution = SolveCase(robot, pair.loads->loads, method);
  if (!solution.outcome.ok()) {
    throw Error::Job("case '" + pair.loads->name + "': " + solution.outcome.why);
  }
  Sample sample = ArcsOf(robot, pair.loads->loads, solution);
  sample.points = robot.MeasuringToBase() * pair.measured->disks;
  sample.pair = &pair;
  return sample;
}

std::vector<Eigen::Index> Varying(const Robot& robot, const Samples& samples) {
  std::vector<Eigen::Index> varying;
  const Eigen::VectorXd& first = samples.front()->features;
  for (Eigen::Index j = 0; j < first.size(); ++j) {
    double lowest = first[j], highest = first[j];
    for (const Sample* s : samples) {
      lowest = std::min(lowest, s->features[j]);
      highest = std::max(highest, s->features[j]);
    }
    const double size = std::max(std::abs(lowest), std::abs(highest));
    if (highest - lowest > Resolution(robot, j) + 1e-12 * size) varying.push_back(j);
  }
  return varying;
}

// Turns every part of a line by what its arc is corrected by.
void Correct(const Eigen::Matrix3Xd& more, Line& line) {
  const Line before = line;
  Eigen::Index arc = 0;
  for (Eigen::Index i = 0; i < line.s.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i > 0) {
      const double h = line.s[i] - line.s[i - 1];
      const Eigen::Quaterniond turn = before.frames[at - 1].conjugate() * before.frames[at];
      const Eigen::AngleAxisd angle(turn);
      const Eigen::Vector3d w = angle.angle() * angle.axis();
      const Eigen::Vector3d old(w.y() / h, -w.x() / h, w.z() / h), u = old + more.col(arc);
      const Arc from(h, old), to(h, u);
      const Eigen::Vector3d way =
          before.frames[at - 1].conjugate() * (before.points.col(i) - before.points.col(i - 1));
      const Eigen::Matrix3d R = line.frames[at - 1].toRotationMatrix();
      line.points.col(i) = line.points.col(i - 1) + R * (way + to.p() - from.p());
      const Eigen::Matrix3d relative = turn.toRotationMatrix() * from.Twisted(from.Q()).transpose();
      line.frames[at] = Eigen::Quaterniond(Eigen::Matrix3d(R * relative * to.Twisted(to.Q())));
      const int disk = line.disk[at];
      if (disk > 0) arc = std::min<Eigen::Index>(disk, more.cols() - 1);
    }
    line.u.col(i) += Eigen::Vector3d(-more(1, arc), more(0, arc), more(2, arc));
  }
}

}  // namespace

std::vector<std::string> FeatureNames(int tendons) {
  std::vector<std::string> names{"tau_1", "tau_1^2", "tau_n", "tau_n^2", "fx", "fy", "fz"};
  for (int k = 1; k <= tendons; ++k) names.push_back(fmt::format("T{}", k));
  return names;
}

Hybrid Train(const Robot& robot, Method method, const std::vector<Pair>& pairs,
             const std::string& file, std::optional<double> penalty) {
  std::vector<Sample> samples;
  for (const Pair& pair : pairs) samples.push_back(Model(robot, method, pair));
  Samples train;
  for (const Sample& s : samples) {
    if (!s.pair->measured->test) train.push_back(&s);
  }
  const auto varying = Varying(robot, train);
  const auto residuals = Residuals(train);
  const auto weights = static_cast<Eigen::Index>(6 * varying.size());
  if (varying.empty()) {
    throw Error::Input(file, "a feature that changes over the training cases", "none");
  }
  if (residuals < weights) {
    throw Error::Input(file, fmt::format("at least {} residuals for {} weights", weights, weights),
                       fmt::format("{}", residuals));
  }
  Hybrid hybrid;
  hybrid.method = method;
  const auto names = FeatureNames(robot.tendons);
  for (const auto j : varying) hybrid.features.push_back(names[static_cast<std::size_t>(j)]);
  for (Sample& s : samples) s.features = Eigen::VectorXd(s.features(varying));
  hybrid.penalty = penalty ? *penalty : ChoosePenalty(robot, train);
  const Weights fitted = FitWeights(robot, train, hybrid.penalty);
  if (!fitted.converged) throw Error::Job("hybrid training did not converge");
  hybrid.weights = fitted.values;
  for (const Sample& s : samples) {
    const Eigen::Matrix3Xd disks = Disks(robot, Corrected(robot, hybrid.weights, s), s);
    const Measured& measured = *s.pair->measured;
    hybrid.tips.Add(robot, measured, disks);
    if (!measured.test) hybrid.explained.Add(robot, measured, disks);
  }
  hybrid.left_out = CrossValidate(robot, train, hybrid.penalty);
  return hybrid;
}

bool Hybrid::poor() const { return explained.poor() || !left_out || left_out->explained.poor(); }

std::string Hybrid::Sentence() const {
  if (explained.poor()) return explained.Sentence();
  if (!left_out) return "too few cases to leave some out of the training and predict them";
  return "of the cases left out of a training, " + left_out->explained.Sentence();
}

Hybrid ReadHybrid(const Yaml& file, const Robot& robot) {
  const Yaml node = file.At("hybrid");
  const auto names = FeatureNames(robot.tendons);
  Hybrid hybrid;
  if (const auto method = node.Find("method")) hybrid.method = ParseMethod(method->Text());
  for (const Yaml& item : node.At("features").Items()) {
    hybrid.features.push_back(item.Text());
    if (std::find(names.begin(), names.end(), item.Text()) == names.end()) {
      throw Error::Input(item.Where(), "one of " + fmt::format("{}", fmt::join(names, ", ")),
                         "'" + item.Text() + "'");
    }
  }
  const auto rows = node.At("weights").Items();
  if (rows.size() != hybrid.features.size()) {
    throw Error::Input(node.At("weights").Where(), fmt::format("{} rows", hybrid.features.size()),
                       fmt::format("{}", rows.size()));
  }
  hybrid.weights.resize(static_cast<Eigen::Index>(rows.size()), 6);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto values = rows[i].Numbers();
    if (values.size() != 6) {
      throw Error::Input(rows[i].Where(), "six numbers", fmt::format("{}", values.size()));
    }
    hybrid.weights.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::Matrix<double, 1, 6>>(values.data());
  }
  return hybrid;
}

void Apply(const Hybrid& hybrid, const Robot& robot, const Loads& loads, Solution& solution) {
  const auto names = FeatureNames(robot.tendons);
  const Sample sample = ArcsOf(robot, loads, solution);
  Eigen::VectorXd ends = Eigen::VectorXd::Zero(6);
  for (std::size_t i = 0; i < hybrid.features.size(); ++i) {
    const auto at = std::find(names.begin(), names.end(), hybrid.features[i]) - names.begin();
    ends += sample.features[at] * hybrid.weights.row(static_cast<Eigen::Index>(i)).transpose();
  }
  const Eigen::Matrix3Xd more = LinearCurvature(robot).Curvatures(ends);
  solution.u += more;
  solution.disks = Disks(robot, solution.u, sample);
  if (solution.line.s.size() > 0) Correct(more, solution.line);
}

}  // namespace continuum::tdcr
