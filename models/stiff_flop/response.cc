#include "models/stiff_flop/response.h"

#include "models/stiff_flop/rod.h"

namespace continuum::stiff_flop {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kInputs = 6;

/// Unknown: M(0) per E J_0/l. Inputs: force at the mount's end over E J_0/l^2, pressures over E.
class RespondingModule : public statics::Responding {
 public:
  RespondingModule(const Module& module, const Method& method, const Case& row,
                   const Solution& solution)
      : module_(module), method_(method), row_(row), solution_(solution) {}

  VectorXd Units() const {
    VectorXd units(kInputs);
    const double force = module_.E * module_.SecondMoment() / (module_.l * module_.l);
    units << force, force, force, module_.E, module_.E, module_.E;
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
    Rod::State<double> tip;
    if (!rod.Integrate(Eigen::Vector3d(z), tip)) return std::nullopt;
    const Eigen::Quaterniond frame(tip[3], tip[4], tip[5], tip[6]);
    return statics::Shown{tip.head<3>(), frame.normalized(), {}, tip.head<3>()};
  }

 private:
  static constexpr int kSteps = 16;

  Case At(const VectorXd& w) const {
    const VectorXd change = Units().cwiseProduct(w);
    Case row = row_;
    row.load.force += change.head<3>();
    row.given += change.tail<3>();
    return row;
  }
  Rod RodOf(const Case& row) const {
    Rod rod(module_, method_, row, 1, kSteps);
    rod.StartFrom({solution_.base[0], solution_.base[1], solution_.base[2]});
    return rod;
  }

  const Module& module_;
  const Method& method_;
  const Case& row_;
  const Solution& solution_;
};

}  // namespace

std::optional<statics::TipResponse> Respond(const Module& module, const Method& method,
                                            const Case& row, const Solution& solution) {
  const RespondingModule responding(module, method, row, solution);
  const auto slopes = statics::Respond(responding, solution.moment, kInputs);
  if (!slopes) return std::nullopt;
  return statics::TipResponse{{"fx", "fy", "fz", "p1", "p2", "p3"},
                              3,
                              *slopes * responding.Units().cwiseInverse().asDiagonal()};
}

}  // namespace continuum::stiff_flop
