#include "models/tdcr/measured.h"

#include <algorithm>
#include <cmath>

#include "error.h"

namespace continuum::tdcr {
Eigen::VectorXd Errors(const Robot& robot, const Measured& measured,
                       const Eigen::Matrix3Xd& disks) {
  return (robot.MeasuringToBase() * measured.disks - disks).colwise().norm().transpose();
}

std::optional<Spread> Statistics(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto v =
      Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  Spread spread{v.mean(), 0, v.minCoeff(), v.maxCoeff()};
  if (v.size() > 1) {
    spread.std = std::sqrt((v - spread.mean).square().sum() / static_cast<double>(v.size() - 1));
  }
  return spread;
}

void TipErrors::Add(const Robot& robot, const Measured& measured, const Eigen::Matrix3Xd& disks) {
  if (!measured.Has(robot.disks - 1)) return;
  const double error = Errors(robot, measured, disks)[robot.disks - 1];
  (measured.test ? test : train).push_back(100 * error / robot.length);
}

std::vector<std::string> Names(const std::vector<Case>& cases) {
  std::vector<std::string> names;
  for (const Case& c : cases) names.push_back(c.name);
  return names;
}

std::vector<Pair> Match(const std::vector<Case>& cases, const std::vector<Measured>& measured,
                        const std::string& file) {
  statics::RequireShared(Names(cases), measured, file);
  std::vector<Pair> pairs;
  bool train = false;
  for (const Case& c : cases) {
    const Measured* const m = Find(measured, c.name);
    if (m == nullptr) continue;
    pairs.push_back({&c, m});
    train = train || !m->test;
  }
  if (!train) throw Error::Input(file, "a measured case with 'use' train", "only test");
  return pairs;
}

}  // namespace continuum::tdcr
