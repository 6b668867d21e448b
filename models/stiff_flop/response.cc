#include "models/stiff_flop/response.h"

#include "models/stiff_flop/rod.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Unknown: M(0) per unit. Inputs: force at the end of the last mount over unit/length, pressures
/// over E.
class RespondingModule : public statics::Responding {
 public:
  RespondingModule(const ModuleSeries& series, const Method& method, const Case& row,
                   const Solution& solution)
      : series_(series), method_(method), row_(row), solution_(solution) {}

  Eigen::Index inputs() const { return 3 + series_.lines(); }
  VectorXd Units() const {
    VectorXd units = VectorXd::Constant(inputs(), series_.first().E);
    units.head<3>().setConstant(series_.unit() / series_.length());
    return units;
  }

  bool Residual(const VectorXd& z, const VectorXd& w, VectorXd& f) const override {
    const Case row = At(w);
    Rod rod = RodOf(row);
    Rod::State<double> tip;
    if (!rod.Integrate(Eigen::Vector3d(z), tip)) return false;
    f = rod.Mismatch(tip);
    return true;
  }
  bool Tangent(const VectorXd& z, MatrixXd& k) const override {
    Rod rod = RodOf(row_);
    Rod::State<Rod::Dual> tip;
    if (!rod.Integrate(Eigen::Vector3d(z), tip)) return false;
    const Eigen::Matrix<Rod::Dual, 3, 1> mismatch = rod.Mismatch(tip);
    for (int i = 0; i < 3; ++i) k.row(i) = mismatch[i].v.head<3>().transpose();
    return true;
  }
  std::optional<statics::Shown> Show(const VectorXd& z, const VectorXd& w) const override {
    const Case row = At(w);
    Rod rod = RodOf(row);
    const auto stations = rod.States(z);
    if (stations.empty()) return std::nullopt;
    VectorXd ends(3 * static_cast<Eigen::Index>(stations.size()));
    for (std::size_t i = 0; i < stations.size(); ++i) {
      ends.segment<3>(3 * static_cast<Eigen::Index>(i)) = stations[i].back().head<3>();
    }
    const Rod::State<double>& tip = stations.back().back();
    const Eigen::Quaterniond frame(tip[3], tip[4], tip[5], tip[6]);
    return statics::Shown{tip.head<3>(), frame.normalized(), {}, ends};
  }

 private:
  static constexpr int kSteps = 4;

  Case At(const VectorXd& w) const {
    const VectorXd change = Units().cwiseProduct(w);
    Case row = row_;
    row.load.force += change.head<3>();
    row.given += change.tail(series_.lines());
    return row;
  }
  Rod RodOf(const Case& row) const {
    Rod rod(series_, method_, row, 1, kSteps);
    rod.StartFrom(solution_.bases);
    return rod;
  }

  const ModuleSeries& series_;
  const Method& method_;
  const Case& row_;
  const Solution& solution_;
};

}  // namespace

std::optional<statics::TipResponse> Respond(const ModuleSeries& series, const Method& method,
                                            const Case& row, const Solution& solution) {
  const RespondingModule responding(series, method, row, solution);
  const auto slopes = statics::Respond(responding, solution.moment, responding.inputs());
  if (!slopes) return std::nullopt;
  std::vector<std::string> names = {"fx", "fy", "fz"};
  for (const std::string& p : statics::Numbered("p", static_cast<int>(series.lines()))) {
    names.push_back(p);
  }
  return statics::TipResponse{std::move(names), 3,
                              *slopes * responding.Units().cwiseInverse().asDiagonal()};
}

}  // namespace continuum::stiff_flop
