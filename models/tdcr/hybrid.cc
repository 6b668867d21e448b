#include "models/tdcr/hybrid.h"

#include <fmt/format.h>

#include <algorithm>

#include "error.h"
#include "models/tdcr/disks.h"

namespace continuum::tdcr {
namespace {

using Ends = Eigen::Matrix<double, 6, 1>;
constexpr int kFolds = 5;

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

// One modelled case with its measured disks in the base frame.
struct Sample {
  Ends ends;  ///< [1/m]
  Eigen::VectorXd features;
  Eigen::Matrix3Xd points;  ///< NaN: not measured
  const Pair* pair;
};

// Unknowns: weights times the features' sizes and L, column by column; residuals over L.
struct HybridProblem {
  const Robot& robot;
  std::vector<const Sample*> samples;
  Eigen::VectorXd sizes;

  Eigen::Index equations() const {
    Eigen::Index count = 0;
    for (const Sample* s : samples) count += 3 * s->pair->measured->count();
    return count;
  }
  Eigen::MatrixXd Weights(const Eigen::VectorXd& x) const {
    return sizes.cwiseInverse().asDiagonal() * x.reshaped(sizes.size(), 6) / robot.length;
  }
  bool operator()(const double* x, double* f) const {
    const auto weights = Weights(Eigen::Map<const Eigen::VectorXd>(x, 6 * sizes.size()));
    for (const Sample* s : samples) {
      const Ends ends = s->ends + weights.transpose() * s->features;
      const Eigen::Matrix3Xd disks = Positions(robot.arc(), Linear(ends, robot.disks));
      for (int i = 0; i < robot.disks; ++i) {
        if (!s->pair->measured->Has(i)) continue;
        for (int a = 0; a < 3; ++a) *f++ = (disks(a, i) - s->points(a, i)) / robot.length;
      }
    }
    return true;
  }
  bool Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd& f, Eigen::MatrixXd& jacobian) const {
    (*this)(x.data(), f.data());
    const auto weights = Weights(x);
    Eigen::Index row = 0;
    for (const Sample* s : samples) {
      const Ends ends = s->ends + weights.transpose() * s->features;
      const auto gradient = LinearGradient(robot.arc(), ends, robot.disks);
      const Eigen::VectorXd scaled = s->features.cwiseQuotient(sizes);
      for (int i = 0; i < robot.disks; ++i) {
        if (!s->pair->measured->Has(i)) continue;
        const auto g = gradient[static_cast<std::size_t>(i)] / (robot.length * robot.length);
        for (Eigen::Index c = 0; c < 6; ++c) {
          jacobian.block(row, c * sizes.size(), 3, sizes.size()) = g.col(c) * scaled.transpose();
        }
        row += 3;
      }
    }
    return true;
  }
};

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

std::vector<Eigen::Index> Varying(const Robot& robot, const std::vector<const Sample*>& samples) {
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

Eigen::MatrixXd FitWeights(const Robot& robot, const std::vector<const Sample*>& samples) {
  HybridProblem problem{robot, samples, {}};
  problem.sizes = Eigen::VectorXd::Zero(samples.front()->features.size());
  for (const Sample* s : samples) problem.sizes = problem.sizes.cwiseMax(s->features.cwiseAbs());
  problem.sizes = (problem.sizes.array() > 0).select(problem.sizes, 1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(6 * problem.sizes.size());
  solver::Options options;
  options.tolerance = 1e-13;
  options.gradient = 1e-9;
  options.decrease = 1e-6;  // along the flat valleys of weights that the shapes hardly tell apart
  options.step = 1e-10;
  options.max_iterations = 5000;
  const auto outcome =
      solver::LevenbergMarquardt<Eigen::VectorXd>(problem, x, problem.equations(), options);
  if (!outcome.ok()) throw Error::Job("hybrid training failed: " + outcome.why);
  return problem.Weights(x);
}

Ends Corrected(const Eigen::MatrixXd& weights, const Sample& sample) {
  return sample.ends + weights.transpose() * sample.features;
}

Eigen::Matrix3Xd Disks(const Robot& robot, const Ends& ends) {
  return Positions(robot.arc(), Linear(ends, robot.disks));
}

// Tip errors of every training case by weights that have not seen it.
std::vector<double> CrossValidate(const Robot& robot, const std::vector<const Sample*>& samples) {
  TipErrors errors;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    std::vector<const Sample*> kept;
    Eigen::Index residuals = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i % kFolds == fold) continue;
      kept.push_back(samples[i]);
      residuals += 3 * samples[i]->pair->measured->count();
    }
    if (kept.empty() || residuals < 6 * samples.front()->features.size()) return {};
    const Eigen::MatrixXd weights = FitWeights(robot, kept);
    for (std::size_t i = fold; i < samples.size(); i += kFolds) {
      errors.Add(robot, *samples[i]->pair->measured, Disks(robot, Corrected(weights, *samples[i])));
    }
  }
  return errors.train;
}

}  // namespace

std::vector<std::string> FeatureNames(int tendons) {
  std::vector<std::string> names{"tau_1", "tau_1^2", "tau_n", "tau_n^2", "fx", "fy", "fz"};
  for (int k = 1; k <= tendons; ++k) names.push_back(fmt::format("T{}", k));
  return names;
}

Hybrid Train(const Robot& robot, const std::vector<Pair>& pairs, const std::string& file) {
  std::vector<Sample> samples;
  for (const Pair& pair : pairs) samples.push_back(Model(robot, pair));
  std::vector<const Sample*> train;
  for (const Sample& s : samples) {
    if (!s.pair->measured->test) train.push_back(&s);
  }
  const auto varying = Varying(robot, train);
  const auto residuals = HybridProblem{robot, train, {}}.equations();
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
  hybrid.weights = FitWeights(robot, train);
  for (const Sample& s : samples) {
    hybrid.tips.Add(robot, *s.pair->measured, Disks(robot, Corrected(hybrid.weights, s)));
  }
  hybrid.left_out = CrossValidate(robot, train);
  return hybrid;
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
