#include "models/mjcf/soft_segment.h"

#include <cmath>

#include "sim/io/decimal.h"

namespace continuum {
namespace {

constexpr double kRotary = 1e-9;  // [kg m^2]: MuJoCo wants some

}  // namespace

mjsBody* SoftChain::Add(mjsBody* base, const std::string& base_name) {
  base_ = base_name;
  mjsBody* link = base;
  for (int k = 0; k <= n_; ++k) link = AddLink(link, k);
  mjcf_.AddSite(link, prefix_ + "tip", {0, 0, 0}, 0.003);
  std::isinf(s_.evenness) ? Couple() : Spread();
  for (int i = 1; i <= 3; ++i) {
    mjcf_.AddPressure(Named("p", i), Named("stretch", 1), s_.lag, s_.supply);
  }
  mjcf_.AddSensor(mjSENS_FRAMEPOS, prefix_ + "tip_pos", mjOBJ_SITE, prefix_ + "tip");
  return link;
}

void SoftChain::AddWrench(mjsBody* base) {
  mjcf_.AddSite(base, prefix_ + "base", {0, 0, 0}, 0.001);
  mjcf_.AddSensor(mjSENS_FORCE, prefix_ + "base_force", mjOBJ_SITE, prefix_ + "base");
  mjcf_.AddSensor(mjSENS_TORQUE, prefix_ + "base_torque", mjOBJ_SITE, prefix_ + "base");
}

EffectInstance SoftChain::Effect() const {
  EffectInstance effect{PccSegmentLaw::kName.data(),
                        prefix_ + "segment",
                        {{"body", base_ + " " + TipName()},
                         {"actuator", Named("p", 1) + " " + Named("p", 2) + " " + Named("p", 3)},
                         {"actuation", s_.actuation}}};
  for (std::size_t i = 0; i < s_.law.size(); ++i) {
    effect.config.emplace_back(PccSegmentLaw::kParams[i].name, Decimal(s_.law[i]));
  }
  return effect;
}

EffectSensor SoftChain::Delta() const {
  return {prefix_ + "delta", PccSegmentLaw::kName.data(), prefix_ + "segment"};
}

mjsBody* SoftChain::AddLink(mjsBody* parent, int k) {
  const double pitch = s_.length() / n_, armature = s_.mass / n_ * pitch * pitch / 12;
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

void SoftChain::Draw(mjsBody* link, int k, double pitch) {
  const double ring = AtEnd(k) ? s_.rim : s_.fibre, radius = (AtEnd(k) ? 1.06 : 1.01) * s_.radius();
  mjcf_.AddCylinder(link, {0, 0, -ring}, {0, 0, ring}, radius, AtEnd(k) ? "plate" : "fibre");
  if (k < n_) mjcf_.AddCylinder(link, {0, 0, 0}, {0, 0, pitch}, s_.radius(), "silicone");
}

void SoftChain::Couple() {
  for (int k = 0; k <= n_; ++k) {
    if (k == 1) continue;
    for (const char* axis : {"_x", "_y"}) {
      mjcf_.AddCoupling(Named("bend", k, axis), Named("bend", 1, axis), AtEnd(k) ? 0.5 : 1);
    }
    if (k > 1) mjcf_.AddCoupling(Named("stretch", k), Named("stretch", 1), 1);
  }
}

void SoftChain::Spread() {
  const auto& [L0, d, r_ch, x_m, y_m, A, d_theta, d_dL, k_theta, k_theta3, k_dL1, k_dL3] = s_.law;
  Spread("bend", "_x", 0, k_theta * d * d, d_theta * d * d);
  Spread("bend", "_y", 0, k_theta * d * d, d_theta * d * d);
  Spread("stretch", "", 1, k_dL1, d_dL);
}

void SoftChain::Spread(const std::string& stem, const std::string& axis, int first,
                       double stiffness, double damping) {
  const auto share = [&](int k) { return (first == 0 && AtEnd(k) ? 0.5 : 1.0) / n_; };
  for (int k = first; k <= n_; ++k) {
    std::vector<std::pair<std::string, double>> uneven;
    for (int j = first; j <= n_; ++j) {
      uneven.emplace_back(Named(stem, j, axis), (j == k ? 1 : 0) - share(k));
    }
    const double times = s_.evenness / share(k);
    mjcf_.AddSpring(uneven, times * stiffness, times * damping);
  }
}

void AddSoftMaterials(Mjcf& mjcf) {
  mjcf.AddMaterial("plate", {0.32F, 0.35F, 0.40F, 1}, 0.5F);
  mjcf.AddMaterial("fibre", {0.25F, 0.30F, 0.36F, 1});
  mjcf.AddMaterial("silicone", {0.93F, 0.90F, 0.84F, 0.35F});
}

}  // namespace continuum
