#include "models/annelida/annelida.h"

#include <vector>

#include "error.h"
#include "models/mjcf/mjcf_builder.h"
#include "sim/io/decimal.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

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
  Holes(Mjcf& mjcf, const AnnelidaParameters& p) : mjcf_(mjcf), p_(p), names_(p.Cables()) {}

  // link: 0 at the base; a cable has holes up to the last link of its section.
  void Add(mjsBody* body, int link, const std::string& place, double z) {
    for (int j = 0; j < p_.Cables(); ++j) {
      if (link > p_.LinksOf(j)) continue;
      const auto [x, y] = p_.Direction(j);
      names_[j].push_back(Indexed("cable", j + 1, "_" + place));
      mjcf_.AddSite(body, names_[j].back(), {x * p_.a, y * p_.a, z}, 0.0015);
    }
  }
  const std::vector<std::string>& Of(int cable) const { return names_[cable]; }

 private:
  Mjcf& mjcf_;
  const AnnelidaParameters& p_;
  std::vector<std::vector<std::string>> names_;
};

void AddMaterials(Mjcf& mjcf) {
  mjcf.AddMaterial("plate", {0.66F, 0.69F, 0.73F, 1}, 0.5F);
  mjcf.AddMaterial("hub", {0.20F, 0.25F, 0.32F, 1});
  mjcf.AddMaterial("spring", {0.88F, 0.52F, 0.18F, 1});
  mjcf.AddMaterial("mount", {0.32F, 0.35F, 0.40F, 1});
}

// Drawn for an arm of 260 mm, and larger or smaller for others.
void AddScene(Mjcf& mjcf, const AnnelidaParameters& p) {
  const double size = std::round(1e3 * p.Length() / 0.26) / 1e3;
  mjcf.AddStudio(-0.42 * size, 0.6 * size);
  mjcf.AddCamera("side", {0.10 * size, -0.98 * size, 0.10 * size}, {0, 0, -0.15 * size}, 33);
}

void AddPlate(Mjcf& mjcf, const AnnelidaParameters& p, mjsBody* body, double from, double to) {
  mjcf.AddCylinder(body, {0, 0, from}, {0, 0, to}, p.R, "plate");
}

mjsBody* AddBase(Mjcf& mjcf, const AnnelidaParameters& p, Holes& holes) {
  mjsBody* const base = mjcf.AddBody(mjcf.world(), "base", {0, 0, 0});
  const double down[] = {0, 1, 0, 0};  // half a turn about x
  std::copy(down, down + 4, base->quat);
  holes.Add(base, 0, "lead", -p.lead);
  holes.Add(base, 0, "base", 0);
  AddPlate(mjcf, p, base, -kPlate, 0);
  mjcf.AddCylinder(base, {0, 0, -p.lead - 0.008}, {0, 0, -p.lead}, 1.25 * p.R, "mount");
  mjcf.AddCylinder(base, {0, 0, -p.lead}, {0, 0, -kPlate}, kHub, "hub");
  mjcf.AddCapsule(base, {0, 0, 0}, {0, 0, p.b1}, kBackbone, "spring");
  return base;
}

// One link with its joint at the origin.
mjsBody* AddLink(Mjcf& mjcf, const AnnelidaParameters& p, mjsBody* parent, int i, Holes& holes) {
  const bool last = i == p.Links();
  const double end = p.b1 + p.b2, I = last ? p.I_last : p.I;
  mjsBody* const link = mjcf.AddBody(parent, Indexed("link", i), {0, 0, i == 1 ? p.b1 : p.Pitch()});
  mjcf.SetInertia(link, last ? p.m_last : p.m, {0, 0, p.b1 + p.b2 / 2}, {I, I, I});
  mjcf.AddHinge(link, Indexed("bend", i, "_x"), {1, 0, 0}, p.K, p.Stop());
  mjcf.AddHinge(link, Indexed("bend", i, "_y"), {0, 1, 0}, p.K, p.Stop());
  if (p.torsion) mjcf.AddBend(link, Indexed("twist", i), {0, 0, 1}, p.torsion->K, p.torsion->d);
  holes.Add(link, i, Indexed("in", i), p.b1);
  holes.Add(link, i, Indexed("out", i), end);
  AddPlate(mjcf, p, link, p.b1, p.b1 + kPlate);
  AddPlate(mjcf, p, link, end - kPlate, end);
  mjcf.AddCylinder(link, {0, 0, p.b1 + kPlate}, {0, 0, end - kPlate}, kHub, "hub");
  mjcf.AddCapsule(link, {0, 0, 0}, {0, 0, p.b1}, kBackbone, "spring");
  if (!last) mjcf.AddCapsule(link, {0, 0, end}, {0, 0, end + p.b1}, kBackbone, "spring");
  return link;
}

void AddCables(Mjcf& mjcf, const AnnelidaParameters& p, const Holes& holes) {
  for (int j = 0; j < p.Cables(); ++j) {
    const std::string name = Indexed("cable", j + 1);
    mjcf.AddCable(name, holes.Of(j), 0.0014, {0.13F, 0.40F, 0.85F, 1});
    mjcf.AddTension(name, name, p.tension);
  }
}

std::vector<std::string> JointsOf(const AnnelidaParameters& p, int link) {
  std::vector<std::string> joints{Indexed("bend", link, "_x"), Indexed("bend", link, "_y")};
  if (p.torsion) joints.push_back(Indexed("twist", link));
  return joints;
}

void AddSensors(Mjcf& mjcf, const AnnelidaParameters& p) {
  for (const auto& [type, end] : {std::pair{mjSENS_JOINTPOS, ""}, {mjSENS_JOINTVEL, "_rate"}}) {
    for (int i = 1; i <= p.Links(); ++i) {
      for (const std::string& joint : JointsOf(p, i)) {
        mjcf.AddSensor(type, joint + end, mjOBJ_JOINT, joint);
      }
    }
  }
  mjcf.AddSensor(mjSENS_FRAMEPOS, "tip_pos", mjOBJ_SITE, "tip");
  mjcf.AddSensor(mjSENS_FRAMELINVEL, "tip_vel", mjOBJ_SITE, "tip");
}

// One section of the paper's five modules where the file says nothing.
std::vector<int> Sections(const Yaml& y) {
  const auto list = y.Find("sections");
  if (!list) return {kAnnelidaLinks};
  std::vector<int> sections;
  for (const Yaml& item : list->Items()) {
    sections.push_back(item.Integer());
    if (sections.back() >= 1) continue;
    throw Error::Input(item.Where(), "a number of modules, at least 1", item.Found());
  }
  if (!sections.empty()) return sections;
  throw Error::Input(list->Where(), "the number of modules of each section", "an empty list");
}

std::optional<AnnelidaTorsion> Torsion(const Yaml& y, double smallest, double largest) {
  if (!y.Has("K_t")) {
    if (const auto damping = y.Find("d_t")) {
      throw Error::Input(damping->Where(), "the key 'K_t' beside it", "none");
    }
    return std::nullopt;
  }
  return AnnelidaTorsion{y.At("K_t").Parameter(smallest, largest),
                         y.Has("d_t") ? y.At("d_t").Parameter(0, largest) : 0};
}

}  // namespace

AnnelidaParameters ReadAnnelida(const std::filesystem::path& file) {
  const Yaml y = Yaml::Read(file);
  y.Only({"format", "robot",   "a",       "b1",       "b2",  "m",   "I",  "m_last",
          "I_last", "K",       "tau_mu",  "tau_c",    "S",   "v_d", "mu", "R",
          "lead",   "tension", "gravity", "sections", "K_t", "d_t"});
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
  p.sections = Sections(y);
  p.torsion = Torsion(y, kSmallest, kLargest);
  return p;
}

std::array<double, 2> AnnelidaParameters::Direction(int cable) const {
  constexpr int kX[] = {1, 0, -1, 0}, kY[] = {0, 1, 0, -1};
  const int j = cable % kCablesOfSection, section = cable / kCablesOfSection;
  const double turn = M_PI / 2 * section / static_cast<double>(sections.size());
  const double c = std::cos(turn), s = std::sin(turn);
  return {kX[j] * c - kY[j] * s, kX[j] * s + kY[j] * c};
}

Mjcf AnnelidaArm(const AnnelidaParameters& p) {
  Mjcf mjcf("annelida", kComment);
  mjcf.spec().option.timestep = 0.002;
  mjcf.spec().option.integrator = mjINT_IMPLICITFAST;
  mjcf.spec().option.gravity[2] = -p.gravity;
  AddMaterials(mjcf);
  Holes holes(mjcf, p);
  mjsBody* body = AddBase(mjcf, p, holes);
  for (int i = 1; i <= p.Links(); ++i) body = AddLink(mjcf, p, body, i, holes);
  mjsBody* const tip = mjcf.AddBody(body, "tip", {0, 0, p.b1 + p.b2});
  // Said explicitly, because MuJoCo puts the centre of a body without inertial and geoms elsewhere.
  mjcf.SetInertia(tip, 0, {0, 0, 0}, {0, 0, 0});
  mjcf.AddSite(tip, "tip", {0, 0, 0}, 0.003);
  AddCables(mjcf, p, holes);
  AddSensors(mjcf, p);
  return mjcf;
}

std::vector<EffectInstance> AnnelidaEffects(const AnnelidaParameters& p) {
  return {{"stribeck",
           "joint_friction",
           {{"joint", "bend*"},
            {"tau_mu", Decimal(p.tau_mu)},
            {"tau_c", Decimal(p.tau_c)},
            {"S", Decimal(p.S)},
            {"v_d", Decimal(p.v_d)}}},
          {"capstan", "cable_friction", {{"tendon", "cable*"}, {"mu", Decimal(p.mu)}}}};
}

std::string AnnelidaMjcf(const AnnelidaParameters& p) {
  Mjcf mjcf = AnnelidaArm(p);
  AddScene(mjcf, p);
  return mjcf.Text(AnnelidaEffects(p));
}

}  // namespace continuum
