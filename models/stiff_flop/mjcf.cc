#include "models/stiff_flop/mjcf.h"

#include <ceres/jet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "effects/braid.h"
#include "error.h"
#include "models/stiff_flop/elastic.h"
#include "sim/io/decimal.h"

namespace continuum::stiff_flop {
namespace {

constexpr int kLinks = 6;
constexpr double kSupply = 150e3;  // [Pa]
constexpr double kStep = 2e-3;     // [s]

std::string Comment(Threads threads) {
  return fmt::format(
      "Written by: continuum make models/stiff_flop/no_load.yaml{}. Values, their sources and "
      "conventions: no_load.yaml and README.md",
      threads == Threads::kRings ? "" : " --variant braid");
}

// E a [N] and E K [N m^2] of the unloaded straight section.
struct Stiffness {
  double stretch, bend;
};
Stiffness StiffnessOf(const Module& module) {
  using Dual = ceres::Jet<double, 2>;
  const Axis<Dual> axis{Dual(1.0, 0), Dual(0.0, 1), Dual(0.0)};
  const Reaction<Dual> reaction =
      ReactionOf(module, {BodyLaw::kFixed, ChamberLaw::kFixed}, Eigen::Vector3d::Zero(),
                 Dual(module.E), Dual(module.gamma), axis);
  return {reaction.n_y.v[0], -reaction.M_z.v[1]};
}

void AddLines(Mjcf& mjcf, const std::string& prefix) {
  for (const char* name : {"p1", "p2", "p3"}) {
    mjsActuator* const line =
        mjs_asActuator(mjs_findElement(&mjcf.spec(), mjOBJ_ACTUATOR, (prefix + name).c_str()));
    line->biastype = mjBIAS_AFFINE;
    line->forcelimited = mjLIMITED_TRUE;
    line->forcerange[1] = kSupply;
  }
}

mjsBody* AddMount(Mjcf& mjcf, mjsBody* tip, const Module& module, const std::string& name) {
  mjsBody* const mount = mjcf.AddBody(tip, name, {0, 0, 0});
  const double R2 = module.r_2 * module.r_2, h2 = module.l_fs * module.l_fs;
  const double across = module.m_fs * (3 * R2 + h2) / 12;
  mjcf.SetInertia(mount, module.m_fs, {0, 0, module.l_fs / 2},
                  {across, across, module.m_fs * R2 / 2});
  mjcf.AddCylinder(mount, {0, 0, 0}, {0, 0, module.l_fs}, 0.8 * module.r_2, "plate");
  return mount;
}

void AddMarkerSensors(Mjcf& mjcf) {
  mjcf.AddPosition("marker_pos", "marker", "frame");
  mjsSensor* const turn = mjcf.AddSensor(mjSENS_FRAMEQUAT, "marker_quat", mjOBJ_SITE, "marker");
  turn->reftype = mjOBJ_SITE;
  mjs_setString(turn->refname, "frame");
}

void AddScene(Mjcf& mjcf, double length) {
  AddSoftMaterials(mjcf);
  mjcf.AddStudio(-1.4 * length, 0.25);
  // Across the whole cone of light the shadow map is too coarse for a module of 25 mm: stripes.
  mjcf.spec().visual.map.shadowscale = 0.15F;
  mjsLight* const light = mjs_asLight(mjs_firstElement(&mjcf.spec(), mjOBJ_LIGHT));
  std::copy_n(std::array{0.25, -1.0, 1.5}.begin(), 3, light->pos);  // a shadow beside the legend
  std::copy_n(std::array{-0.2, 0.65, -1.0}.begin(), 3, light->dir);
  mjcf.AddCamera("side", {0, -3.2 * length, -0.2 * length}, {0, 0, -0.65 * length}, 32);
}

// The damping of (3) is explicit: modules in series that stretch against each other take up to
// 8 omega of it [1/s], as a chain of equal masses and dampers does, and 2 is the limit.
double StepOf(const ModuleSeries& series) {
  double step = kStep;
  if (series.size() == 1) return step;
  for (const Module& module : series.modules) {
    const double omega = std::sqrt(SegmentOf(module).law[10] / (module.m / 3 + module.m_fs));
    while (8 * omega * step > 1.6) step /= 2;
  }
  return step;
}

void SetOptions(mjOption& option, const Eigen::Vector3d& gravity) {
  option.integrator = mjINT_IMPLICITFAST;
  // Robot's y is z of the base, which points down.
  const double world[] = {-gravity.x() + 0.0, -gravity.z() + 0.0, -gravity.y() + 0.0};
  std::copy(world, world + 3, option.gravity);
}

// The threads beside the segment, on its bodies and lines and with its measures.
EffectInstance BraidBeside(const EffectInstance& beside, const SoftSegment& segment, double gamma,
                           const std::string& prefix) {
  EffectInstance braid{std::string(Braid::kName), prefix + "threads", {}};
  for (const auto& setting : beside.config) {
    if (setting.first == "body" || setting.first == "actuator") braid.config.push_back(setting);
  }
  const double cot = std::tan(std::numbers::pi / 2 - gamma);
  for (std::size_t i = 0; i < Braid::kParams.size(); ++i) {
    const std::string name(Braid::kParams[i].name);
    const double value = name == "cot2_gamma" ? cot * cot : segment.law[i];
    braid.config.emplace_back(name, Decimal(value));
  }
  return braid;
}

// The law of the segment has three chambers.
void RequireThreeEvenLines(const Module& module, const std::string& name) {
  constexpr double kSame = 1e-9;
  const auto even = EvenLines(3);
  bool same = module.lines.size() == even.size();
  for (std::size_t i = 0; same && i < even.size(); ++i) {
    same = std::hypot(module.lines[i][0] - even[i][0], module.lines[i][1] - even[i][1]) < kSame;
  }
  if (same) return;
  throw Error::Input("continuum make: module '" + name + "'", "three lines at even angles",
                     fmt::format("{} lines, or angles psi", module.lines.size()));
}

}  // namespace

SoftSegment SegmentOf(const Module& module) {
  const auto [stretch, bend] = StiffnessOf(module);
  const double d = module.r_2, l = module.l;
  const double A = module.n_c * std::numbers::pi * module.r_c1 * module.r_c1;
  const double k_theta = bend / (l * d * d), k_dL1 = stretch / l;  // (1)
  const double swing = (l + module.l_fs) / 2;
  const double m_theta = (module.m * l * l / 20 + module.m_fs * swing * swing) / (d * d);
  const double m_dL = module.m / 3 + module.m_fs;
  return {{l, d, module.r_o, 0, 0, A, 2 * std::sqrt(k_theta * m_theta), 2 * std::sqrt(k_dL1 * m_dL),
           k_theta, 0, k_dL1, 0},
          "volume",
          module.m,
          0,
          kSupply,
          kLinks,
          0.0012,
          0.0004};
}

std::string ModuleMjcf(const Robot& robot, Threads threads) {
  const ModuleSeries& series = robot.series;
  const bool alone = series.size() == 1;
  Mjcf mjcf("stiff_flop", Comment(threads));
  SetOptions(mjcf.spec().option, robot.gravity);
  mjcf.spec().option.timestep = StepOf(series);
  AddScene(mjcf, series.length() + series.mounts());
  mjsBody* const base = mjcf.AddBody(mjcf.world(), "base", {0, 0, 0});
  const double down[] = {0, 1, 0, 0};  // half a turn about x
  std::copy(down, down + 4, base->quat);
  mjcf.AddSite(base, "frame", {0, 0, 0}, 0.001);
  std::vector<EffectInstance> effects, braids;
  std::vector<EffectSensor> sensors;
  std::string creeping;
  mjsBody* below = base;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Module& module = series[i];
    RequireThreeEvenLines(module, robot.names[i]);
    const std::string prefix = alone ? "" : fmt::format("m{}_", i + 1);
    const SoftSegment segment = SegmentOf(module);
    SoftChain chain(mjcf, segment, prefix);
    mjsBody* const end = chain.Add(below, i == 0 ? "base" : prefix + "base");
    mjsBody* const mount = AddMount(mjcf, end, module, prefix + "mount");
    if (i == 0) chain.AddWrench(base);
    AddLines(mjcf, prefix);
    effects.push_back(chain.Effect());
    sensors.push_back(chain.Delta());
    creeping += fmt::format("{0}{1}bend1_x {1}bend1_y", i == 0 ? "" : " ", prefix);
    if (threads == Threads::kBraid) {
      braids.push_back(BraidBeside(effects.back(), segment, module.gamma, prefix));
    }
    if (i + 1 < series.size()) {
      below = mjcf.AddBody(mount, fmt::format("m{}_base", i + 2), {0, 0, module.l_fs});
    } else {
      mjcf.AddSite(mount, "marker", {0, 0, module.l_fs}, 0.0015);
    }
  }
  AddMarkerSensors(mjcf);
  effects.push_back({"maxwell", "creep", {{"joint", creeping}, {"k_m", "0"}, {"tau_m", "2"}}});
  effects.insert(effects.end(), braids.begin(), braids.end());
  return mjcf.Text(effects, sensors);
}

}  // namespace continuum::stiff_flop
