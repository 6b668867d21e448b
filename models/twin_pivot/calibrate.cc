#include "models/twin_pivot/calibrate.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include <Eigen/QR>

#include "error.h"
#include "models/statics/columns.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"

namespace continuum::twin_pivot {
namespace {

constexpr double kGravity = 9.81;
// Angles closer than this [rad] are one angle: no protractor tells them apart, nor does the fit.
constexpr double kSameAngle = 1e-9;

void RequireColumns(const CsvTable& table) {
  const std::vector<std::string> columns{"theta", "m", "F_SC"};
  statics::RefuseOtherColumns(table, columns, "the columns theta, m, F_SC");
  statics::RequireColumns(table, columns);
}

double InRange(const CsvTable& table, std::size_t row, const std::string& column, bool inside,
               const std::string& range) {
  if (inside) return table.Number(row, column);
  throw Error::Input(table.Where(row) + ", column '" + column + "'", range,
                     Decimal(table.Number(row, column)));
}

int DifferentAngles(std::vector<double> theta) {
  std::sort(theta.begin(), theta.end());
  int count = 0;
  for (std::size_t i = 0; i < theta.size(); ++i) {
    if (i == 0 || theta[i] - theta[i - 1] > kSameAngle) ++count;
  }
  return count;
}

nlohmann::ordered_json Named(const Friction& f) { return {{"a", f.a}, {"b", f.b}, {"c", f.c}}; }

}  // namespace

std::string FrictionFit::Json() const {
  nlohmann::ordered_json json = Named(value);
  json["stderr"] = Named(stderror);
  json["rms"] = rms;
  json["n"] = n;
  return json.dump(1) + "\n";
}

FrictionFit FitFriction(const std::vector<double>& theta, const std::vector<double>& mu) {
  const auto n = static_cast<Eigen::Index>(theta.size());
  const Eigen::Map<const Eigen::ArrayXd> t(theta.data(), n);
  const Eigen::Map<const Eigen::VectorXd> measured(mu.data(), n);
  Eigen::MatrixXd x(n, 3);
  x << t.square(), t, Eigen::ArrayXd::Ones(n);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(x);
  const Eigen::Vector3d fit = qr.solve(measured);
  const Eigen::Matrix3d r = qr.matrixQR().topRows<3>().triangularView<Eigen::Upper>();
  const Eigen::Matrix3d inverse =
      r.triangularView<Eigen::Upper>().solve(Eigen::Matrix3d::Identity());
  const double ssr = (measured - x * fit).squaredNorm();
  const Eigen::Vector3d error =
      inverse.rowwise().norm() * std::sqrt(ssr / static_cast<double>(n - 3));
  return {{fit[0], fit[1], fit[2]},
          {error[0], error[1], error[2]},
          std::sqrt(ssr / static_cast<double>(n)),
          static_cast<int>(n)};
}

FrictionFit CalibrateFriction(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::Read(file);
  RequireColumns(table);
  std::vector<double> theta, mu;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double angle = table.Number(row, "theta");
    const double mass = table.Number(row, "m");
    const double sensor = table.Number(row, "F_SC");
    theta.push_back(
        InRange(table, row, "theta", angle > 0 && angle <= M_PI_2, "an angle in (0, pi/2] rad"));
    const double weight = kGravity * InRange(table, row, "m", mass > 0, "a mass > 0");
    InRange(table, row, "F_SC", sensor >= 0, "a tension >= 0");
    mu.push_back(std::abs(sensor - weight) / (weight * std::sin(angle)));
  }
  const std::string rows = std::to_string(table.rows());
  if (table.rows() < 4) throw Error::Input(table.name(), "four rows or more", rows);
  const int angles = DifferentAngles(theta);
  if (angles < 3) {
    throw Error::Input(table.name() + ", column 'theta'", "three different angles or more",
                       std::to_string(angles));
  }
  return FitFriction(theta, mu);
}

}  // namespace continuum::twin_pivot
