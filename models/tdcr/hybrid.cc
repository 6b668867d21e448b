#include "models/tdcr/hybrid.h"

#include <fmt/format.h>

#include <algorithm>

#include "error.h"
#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

Eigen::VectorXd AllFeatures(const Robot& robot, const Loads& loads, const Ends& ends) {
  Eigen::VectorXd features(7 + robot.tendons);
  features.head<4>() << ends[2], ends[2] * ends[2], ends[5], ends[5] * ends[5];
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

Sample Model(const Robot& robot, const Pair& pair) {
  Sample sample;
  const Solution solution = SolveCase(robot, pair.loads->loads, Method::kEas);
  if (!solution.outcome.ok()) {
    throw Error::Job("case '" + pair.loads->name + "': " + solution.outcome.why);
  }
  sample.ends = solution.x / robot.length;
  sample.features = AllFeatures(robot, pair.loads->loads, sample.ends);
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

}  // namespace

std::vector<std::string> FeatureNames(int tendons) {
  std::vector<std::string> names{"tau_1", "tau_1^2", "tau_n", "tau_n^2", "fx", "fy", "fz"};
  for (int k = 1; k <= tendons; ++k) names.push_back(fmt::format("T{}", k));
  return names;
}

Hybrid Train(const Robot& robot, const std::vector<Pair>& pairs, const std::string& file,
             std::optional<double> penalty) {
  std::vector<Sample> samples;
  for (const Pair& pair : pairs) samples.push_back(Model(robot, pair));
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
  const auto names = FeatureNames(robot.tendons);
  for (const auto j : varying) hybrid.features.push_back(names[static_cast<std::size_t>(j)]);
  for (Sample& s : samples) s.features = Eigen::VectorXd(s.features(varying));
  hybrid.penalty = penalty ? *penalty : ChoosePenalty(robot, train);
  const Weights fitted = FitWeights(robot, train, hybrid.penalty);
  if (!fitted.converged) throw Error::Job("hybrid training did not converge");
  hybrid.weights = fitted.values;
  for (const Sample& s : samples) {
    const Eigen::Matrix3Xd disks = Disks(robot, Corrected(hybrid.weights, s));
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
  const Ends ends = solution.x / robot.length;
  const Eigen::VectorXd all = AllFeatures(robot, loads, ends);
  Ends corrected = ends;
  for (std::size_t i = 0; i < hybrid.features.size(); ++i) {
    const auto at = std::find(names.begin(), names.end(), hybrid.features[i]) - names.begin();
    corrected += all[at] * hybrid.weights.row(static_cast<Eigen::Index>(i)).transpose();
  }
  solution.u = Linear(corrected, robot.disks);
  solution.disks = Positions(robot.arc(), solution.u);
}

}  // namespace continuum::tdcr
