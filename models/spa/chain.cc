#include "models/spa/chain.h"

#include <algorithm>
#include <vector>

#include "error.h"
#include "models/generator/mjcf.h"
#include "sim/file.h"

namespace continuum {
namespace {

constexpr double kSupply = 75e3;   // [Pa]
constexpr double kRotary = 1e-9;   // [kg m^2]: MuJoCo wants some
constexpr double kSpacing = 0.16;  // of arms in a row [m]

const char* const kComment =
    "Written by: continuum_generate spa (or spa_series) models/spa/spa.yaml. Values, their sources "
    "and conventions: spa.yaml and README.md";

// One actuator being written. Names of all its parts begin alike.
class Segment {
 public:
  Segment(Mjcf& mjcf, const SpaFile& file, int links, std::string prefix)
      : mjcf_(mjcf), file_(file), n_(links), prefix_(std::move(prefix)) {}

  /// From `base` on; its last link is returned.
  mjsBody* Add(mjsBody* base, const std::string& base_name) {
    base_ = base_name;
    mjsBody* link = base;
    for (int k = 0; k <= n_; ++k) link = AddLink(link, k);
    mjcf_.AddSite(link, prefix_ + "tip", {0, 0, 0}, 0.003);
    Couple();
    for (int i = 1; i <= 3; ++i) {
      mjcf_.AddPressure(Named("p", i), Named("stretch", 1), p_.T_PT1, kSupply);
    }
    mjcf_.AddSensor(mjSENS_FRAMEPOS, prefix_ + "tip_pos", mjOBJ_SITE, prefix_ + "tip");
    return link;
  }

  void AddWrench(mjsBody* base) {
    mjcf_.AddSite(base, prefix_ + "base", {0, 0, 0}, 0.003);
    mjcf_.AddSensor(mjSENS_FORCE, prefix_ + "base_force", mjOBJ_SITE, prefix_ + "base");
    mjcf_.AddSensor(mjSENS_TORQUE, prefix_ + "base_torque", mjOBJ_SITE, prefix_ + "base");
  }

  EffectInstance Effect() const {
    EffectInstance effect{
        PccSegmentLaw::kName.data(),
        prefix_ + "segment",
        {{"body", base_ + " " + TipName()},
         {"actuator", Named("p", 1) + " " + Named("p", 2) + " " + Named("p", 3)},
         {"actuation", file_.options.actuation == SpaActuation::kTip ? "tip" : "volume"}}};
    const auto values = p_.Law();
    for (std::size_t i = 0; i < values.size(); ++i) {
      effect.config.emplace_back(PccSegmentLaw::kParams[i].name, Decimal(values[i]));
    }
    return effect;
  }
  EffectSensor Delta() const {
    return {prefix_ + "delta", PccSegmentLaw::kName.data(), prefix_ + "segment"};
  }
  std::string TipName() const { return Named("link", n_); }

 private:
  std::string Named(const std::string& stem, int i, const std::string& end = "") const {
    return prefix_ + stem + std::to_string(i) + end;
  }
  bool AtEnd(int k) const { return k == 0 || k == n_; }
  double Mass(int k) const { return p_.m / (3 * n_) * (AtEnd(k) ? 1 : k % 2 == 1 ? 4 : 2); }

  mjsBody* AddLink(mjsBody* parent, int k) {
    const double pitch = p_.L0 / n_, armature = p_.m / n_ * pitch * pitch / 12;
    mjsBody* const link = mjcf_.AddBody(parent, Named("link", k), {0, 0, k == 0 ? 0 : pitch});
    mjcf_.SetInertia(link, Mass(k), {0, 0, 0}, {kRotary, kRotary, kRotary});
    if (k > 0) mjcf_.AddFreeJoint(link, Named("stretch", k), mjJNT_SLIDE, {0, 0, 1}, 0);
    for (int turn = 0; turn < 2; ++turn) {
      const bool about_x = (k + turn) % 2 == 0;
      mjcf_.AddFreeJoint(link, Named("bend", k, about_x ? "_x" : "_y"), mjJNT_HINGE,
                         {about_x ? 1.0 : 0.0, about_x ? 0.0 : 1.0, 0}, armature);
    }
    Draw(link, k, pitch);
    return link;
  }

  void Draw(mjsBody* link, int k, double pitch) {
    const double ring = AtEnd(k) ? 0.003 : 0.0012, radius = AtEnd(k) ? 1.06 * p_.d : 1.01 * p_.d;
    mjcf_.AddCylinder(link, {0, 0, -ring}, {0, 0, ring}, radius, AtEnd(k) ? "plate" : "fibre");
    if (k < n_) mjcf_.AddCylinder(link, {0, 0, 0}, {0, 0, pitch}, p_.d, "silicone");
  }

  void Couple() {
    for (int k = 0; k <= n_; ++k) {
      if (k == 1) continue;
      for (const char* axis : {"_x", "_y"}) {
        mjcf_.AddCoupling(Named("bend", k, axis), Named("bend", 1, axis), AtEnd(k) ? 0.5 : 1);
      }
      if (k > 1) mjcf_.AddCoupling(Named("stretch", k), Named("stretch", 1), 1);
    }
  }

  Mjcf& mjcf_;
  const SpaFile& file_;
  const SpaParameters<double>& p_ = file_.parameters;
  int n_;
  std::string prefix_, base_;
};

void AddScene(Mjcf& mjcf, double length) {
  mjcf.AddMaterial("plate", {0.32F, 0.35F, 0.40F, 1}, 0.5F);
  mjcf.AddMaterial("fibre", {0.25F, 0.30F, 0.36F, 1});
  mjcf.AddMaterial("silicone", {0.93F, 0.90F, 0.84F, 0.35F});
  mjcf.AddStudio(-1.5 * length, 0.6);
  mjcf.AddCamera("side", {0, -2.9 * length, -0.56 * length}, {0, 0, -0.56 * length}, 32);
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
}

}  // namespace

std::string SpaMjcf(const SpaFile& file, const SpaLayout& layout) {
  Check(layout);
  const SpaParameters<double>& p = file.parameters;
  const bool alone = layout.series * layout.row == 1;
  Mjcf mjcf("spa", kComment);
  mjcf.spec().option.timestep = 0.002;
  mjcf.spec().option.integrator = mjINT_IMPLICITFAST;
  std::copy_n(file.options.gravity.data(), 3, mjcf.spec().option.gravity);
  AddScene(mjcf, p.L0 * layout.series);
  std::vector<EffectInstance> effects;
  std::vector<EffectSensor> sensors;
  for (int i = 0; i < layout.row; ++i) {
    std::string base_name = layout.row == 1 ? "base" : "base" + std::to_string(i + 1);
    mjsBody* const base = mjcf.AddBody(mjcf.world(), base_name, {kSpacing * i, 0, 0});
    const double down[] = {0, 1, 0, 0};  // half a turn about x
    std::copy(down, down + 4, base->quat);
    mjsBody* body = base;
    for (int k = 0; k < layout.series; ++k) {
      const std::string number = std::to_string(i * layout.series + k + 1);
      Segment segment(mjcf, file, layout.links, alone ? "" : "seg" + number + "_");
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
