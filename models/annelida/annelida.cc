#include "models/annelida/annelida.h"

#include <limits>
#include <vector>

#include "models/mjcf/mjcf_builder.h"
#include "sim/io/decimal.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

constexpr int kCables = 4;

// What is only drawn.
constexpr double kPlate = 0.004, kHub = 0.014, kBackbone = 0.008;

const char* const kComment =
    "Written by: continuum make models/annelida/annelida.yaml. Values, their sources "
    "and conventions: annelida.yaml and README.md";

std::string Indexed(const std::string& stem, int i, const std::string& end = "") {
  return stem + std::to_string(i) + end;
}

// A cable's holes: "cable1_lead", "cable1_base", "cable1_in1", "cable1_out1", ...
class Holes {
 public:
  Holes(Mjcf& mjcf, double radius) : mjcf_(mjcf), radius_(radius), names_(kCables) {}

  void Add(mjsBody* body, const std::string& place, double z) {
    constexpr int kX[] = {1, 0, -1, 0}, kY[] = {0, 1, 0, -1};
    for (int j = 0; j < kCables; ++j) {
      names_[j].push_back(Indexed("cable", j + 1, "_" + place));
      mjcf_.AddSite(body, names_[j].back(), {kX[j] * radius_, kY[j] * radius_, z}, 0.0015);
    }
  }
  const std::vector<std::string>& Of(int cable) const { return names_[cable]; }

 private:
  Mjcf& mjcf_;
  double radius_;
  std::vector<std::vector<std::string>> names_;
};

void AddScene(Mjcf& mjcf) {
  mjcf.AddMaterial("plate", {0.66F, 0.69F, 0.73F, 1}, 0.5F);
  mjcf.AddMaterial("hub", {0.20F, 0.25F, 0.32F, 1});
  mjcf.AddMaterial("spring", {0.88F, 0.52F, 0.18F, 1});
  mjcf.AddMaterial("mount", {0.32F, 0.35F, 0.40F, 1});
  mjcf.AddStudio(-0.42, 0.6);
  mjcf.AddCamera("side", {0.10, -0.98, 0.10}, {0, 0, -0.15}, 33);
}

void AddPlate(Mjcf& mjcf, const AnnelidaParameters& p, mjsBody* body, double from, double to) {
  mjcf.AddCylinder(body, {0, 0, from}, {0, 0, to}, p.R, "plate");
}

mjsBody* AddBase(Mjcf& mjcf, const AnnelidaParameters& p, Holes& holes) {
  mjsBody* const base = mjcf.AddBody(mjcf.world(), "base", {0, 0, 0});
  const double down[] = {0, 1, 0, 0};  // half a turn about x
  std::copy(down, down + 4, base->quat);
  holes.Add(base, "lead", -p.lead);
  holes.Add(base, "base", 0);
  AddPlate(mjcf, p, base, -kPlate, 0);
  mjcf.AddCylinder(base, {0, 0, -p.lead - 0.008}, {0, 0, -p.lead}, 1.25 * p.R, "mount");
  mjcf.AddCylinder(base, {0, 0, -p.lead}, {0, 0, -kPlate}, kHub, "hub");
  mjcf.AddCapsule(base, {0, 0, 0}, {0, 0, p.b1}, kBackbone, "spring");
  return base;
}

// One link with its joint at the origin.
mjsBody* AddLink(Mjcf& mjcf, const AnnelidaParameters& p, mjsBody* parent, int i, Holes& holes) {
  const bool last = i == kAnnelidaLinks;
  const double end = p.b1 + p.b2, I = last ? p.I_last : p.I;
  mjsBody* const link = mjcf.AddBody(parent, Indexed("link", i), {0, 0, i == 1 ? p.b1 : p.Pitch()});
  mjcf.SetInertia(link, last ? p.m_last : p.m, {0, 0, p.b1 + p.b2 / 2}, {I, I, I});
  mjcf.AddHinge(link, Indexed("bend", i, "_x"), {1, 0, 0}, p.K, p.Stop());
  mjcf.AddHinge(link, Indexed("bend", i, "_y"), {0, 1, 0}, p.K, p.Stop());
  holes.Add(link, Indexed("in", i), p.b1);
  holes.Add(link, Indexed("out", i), end);
  AddPlate(mjcf, p, link, p.b1, p.b1 + kPlate);
  AddPlate(mjcf, p, link, end - kPlate, end);
  mjcf.AddCylinder(link, {0, 0, p.b1 + kPlate}, {0, 0, end - kPlate}, kHub, "hub");
  mjcf.AddCapsule(link, {0, 0, 0}, {0, 0, p.b1}, kBackbone, "spring");
  if (!last) mjcf.AddCapsule(link, {0, 0, end}, {0, 0, end + p.b1}, kBackbone, "spring");
  return link;
}

void AddCables(Mjcf& mjcf, const AnnelidaParameters& p, const Holes& holes) {
  for (int j = 0; j < kCables; ++j) {
    const std::string name = Indexed("cable", j + 1);
    mjcf.AddCable(name, holes.Of(j), 0.0014, {0.13F, 0.40F, 0.85F, 1});
    mjcf.AddTension(name, name, p.tension);
  }
}

void AddSensors(Mjcf& mjcf) {
  for (const auto& [type, end] : {std::pair{mjSENS_JOINTPOS, ""}, {mjSENS_JOINTVEL, "_rate"}}) {
    for (int i = 1; i <= kAnnelidaLinks; ++i) {
      for (const char* axis : {"_x", "_y"}) {
        const std::string joint = Indexed("bend", i, axis);
        mjcf.AddSensor(type, joint + end, mjOBJ_JOINT, joint);
      }
    }
  }
  mjcf.AddSensor(mjSENS_FRAMEPOS, "tip_pos", mjOBJ_SITE, "tip");
  mjcf.AddSensor(mjSENS_FRAMELINVEL, "tip_vel", mjOBJ_SITE, "tip");
}

}  // namespace

AnnelidaParameters ReadAnnelida(const std::filesystem::path& file) {
  const Yaml y = Yaml::Read(file);
  y.Only({"format", "robot", "a", "b1", "b2", "m", "I", "m_last", "I_last", "K", "tau_mu", "tau_c",
          "S", "v_d", "mu", "R", "lead", "tension", "gravity"});
  constexpr double kLargest = 1e6, kSmallest = 1e-9;
  const auto positive = [&](const char* key) { return y.At(key).Parameter(kSmallest, kLargest); };
  const auto magnitude = [&](const char* key) { return y.At(key).Parameter(0, kLargest); };
  AnnelidaParameters p;
  p.a = positive("a"), p.b1 = positive("b1"), p.b2 = positive("b2");
  p.m = positive("m"), p.I = positive("I");
  p.m_last = positive("m_last"), p.I_last = positive("I_last");
  p.K = magnitude("K"), p.tau_mu = magnitude("tau_mu"), p.tau_c = magnitude("tau_c");
  p.S = magnitude("S"), p.v_d = positive("v_d"), p.mu = magnitude("mu");
  p.R = positive("R"), p.lead = positive("lead"), p.tension = positive("tension"),
  p.gravity = magnitude("gravity");
  return p;
}

std::string AnnelidaMjcf(const AnnelidaParameters& p) {
  Mjcf mjcf("annelida", kComment);
  mjcf.spec().option.timestep = 0.002;
  mjcf.spec().option.integrator = mjINT_IMPLICITFAST;
  mjcf.spec().option.gravity[2] = -p.gravity;
  AddScene(mjcf);
  Holes holes(mjcf, p.a);
  mjsBody* body = AddBase(mjcf, p, holes);
  for (int i = 1; i <= kAnnelidaLinks; ++i) body = AddLink(mjcf, p, body, i, holes);
  mjsBody* const tip = mjcf.AddBody(body, "tip", {0, 0, p.b1 + p.b2});
  // Said explicitly, because MuJoCo puts the centre of a body without inertial and geoms elsewhere.
  mjcf.SetInertia(tip, 0, {0, 0, 0}, {0, 0, 0});
  mjcf.AddSite(tip, "tip", {0, 0, 0}, 0.003);
  AddCables(mjcf, p, holes);
  AddSensors(mjcf);
  const std::vector<EffectInstance> effects{
      {"stribeck",
       "joint_friction",
       {{"joint", "bend*"},
        {"tau_mu", Decimal(p.tau_mu)},
        {"tau_c", Decimal(p.tau_c)},
        {"S", Decimal(p.S)},
        {"v_d", Decimal(p.v_d)}}},
      {"capstan", "cable_friction", {{"tendon", "cable*"}, {"mu", Decimal(p.mu)}}}};
  return mjcf.Text(effects);
}

}  // namespace continuum
