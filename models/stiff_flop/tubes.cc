#include "models/stiff_flop/tubes.h"

#include <numbers>

namespace continuum::stiff_flop {

double Margin(const Module& module, const Method& method, const Axis<double>& axis) {
  if (!(axis.lambda > 0)) return axis.lambda;
  double margin = Body<double>(method.body, axis.bend()).Margin(module.r_2);
  const double r_od = TubeDistance(module, method.body, axis.lambda);
  for (std::size_t i = 0; i < module.lines.size(); ++i) {
    margin = std::min(margin, RelativeLength(module, axis, r_od, i));
    if (margin <= 0) return margin;
    const Bend<double> bend = TubeBend(module, axis, r_od, i);
    margin = std::min(margin, Tube(module, method.chamber, module.gamma, bend).Margin());
  }
  return margin;
}

BaseSection Describe(const Module& module, const Method& method, const Axis<double>& axis) {
  BaseSection section;
  section.r_o = TubeDistance(module, method.body, axis.lambda);
  for (std::size_t i = 0; i < module.lines.size(); ++i) {
    const Bend<double> bend = TubeBend(module, axis, section.r_o, i);
    const auto tube = Tube(module, method.chamber, module.gamma, bend);
    section.r_G.push_back(std::sqrt(tube.GasArea() / std::numbers::pi));
    section.gamma_e.push_back(method.chamber == ChamberLaw::kFixed
                                  ? std::numbers::pi / 2
                                  : std::acos(bend.lambda * std::cos(module.gamma)));
  }
  const Body<double> body(method.body, axis.bend());
  section.x_in = body.Shifted(module.r_2);
  section.x_out = -body.Shifted(-module.r_2);
  return section;
}

}  // namespace continuum::stiff_flop
