#include "models/spa/chain.h"

#include <algorithm>
#include <vector>

#include "error.h"
#include "models/mjcf/soft_segment.h"
#include "sim/io/decimal.h"

namespace continuum {
namespace {

constexpr double kSupply = 75e3;   // [Pa]
constexpr double kSpacing = 0.16;  // of arms in a row [m]

const char* const kComment =
    "Written by: continuum make models/spa/spa.yaml. Values, their sources and conventions: "
    "spa.yaml and README.md";

SoftSegment Actuator(const SpaFile& file, const SpaLayout& layout) {
  const SpaParameters<double>& p = file.parameters;
  const bool tip = file.options.actuation == SpaActuation::kTip;
  return {p.Law(), tip ? "tip" : "volume", p.m, p.T_PT1, kSupply, layout.links, 0.003,
          0.0012,  layout.evenness};
}

void AddScene(Mjcf& mjcf, double length, bool standing) {
  AddSoftMaterials(mjcf);
  mjcf.AddStudio(standing ? -0.2 * length : -1.5 * length, 0.6);
  mjcf.AddCamera("side", {0, -3.5 * length, standing ? length : 0},
                 {0, 0, (standing ? 0.56 : -0.56) * length}, 33);
}

void Check(const SpaLayout& layout) {
  if (layout.links < 2 || layout.links % 2 != 0) {
    throw Error::Input("soft actuator: links", "an even number from 2 on",
                       std::to_string(layout.links));
  }
  if (layout.series < 1 || layout.row < 1) {
    throw Error::Input("soft actuator", "at least one in series and row",
                       std::to_string(std::min(layout.series, layout.row)));
  }
  if (!(layout.evenness > 0)) {
    throw Error::Input("soft actuator: evenness", "above 0", Decimal(layout.evenness));
  }
}

}  // namespace

std::string SpaMjcf(const SpaFile& file, const SpaLayout& layout) {
  Check(layout);
  const SpaParameters<double>& p = file.parameters;
  const SoftSegment actuator = Actuator(file, layout);
  const bool alone = layout.series * layout.row == 1;
  Mjcf mjcf("spa", kComment);
  mjcf.spec().option.timestep = 0.002;
  mjcf.spec().option.integrator = mjINT_IMPLICITFAST;
  std::copy_n(file.options.gravity.data(), 3, mjcf.spec().option.gravity);
  AddScene(mjcf, p.L0 * layout.series, layout.standing);
  std::vector<EffectInstance> effects;
  std::vector<EffectSensor> sensors;
  for (int i = 0; i < layout.row; ++i) {
    std::string base_name = layout.row == 1 ? "base" : "base" + std::to_string(i + 1);
    mjsBody* const base = mjcf.AddBody(mjcf.world(), base_name, {kSpacing * i, 0, 0});
    const double down[] = {0, 1, 0, 0};  // half a turn about x
    if (!layout.standing) std::copy(down, down + 4, base->quat);
    mjsBody* body = base;
    for (int k = 0; k < layout.series; ++k) {
      const std::string number = std::to_string(i * layout.series + k + 1);
      SoftChain segment(mjcf, actuator, alone ? "" : "seg" + number + "_");
      body = segment.Add(body, base_name);
      if (k == 0) segment.AddWrench(base);
      base_name = segment.TipName();
      effects.push_back(segment.Effect());
      sensors.push_back(segment.Delta());
    }
  }
  return mjcf.Text(effects, sensors);
}

}  // namespace continuum
