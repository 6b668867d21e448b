#include "hidden_effects/suite.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "identification/diagnosis_output.h"
#include "sim/file.h"

namespace continuum::hidden {
namespace {

constexpr double kPeriod = 0.01;  // s
constexpr std::size_t kRows = 400;
constexpr int kTrials = 3, kReplicates = 2;
constexpr double kSigma[] = {1e-3, 1e-3, 3e-4, 3e-4};  // rad, rad, m, m

// Steps and sines that differ from trial to trial.
std::array<std::vector<double>, 2> Inputs(int trial, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> part;
  std::array<std::vector<double>, 2> u;
  for (int j = 0; j < 2; ++j) {
    const double high = j ? 0.5 : 1.0;
    const double slow = 1 + 2 * part(rng), fast = 5 + 6 * part(rng);
    double step = 0;
    for (std::size_t k = 0; k < kRows; ++k) {
      const double t = kPeriod * static_cast<double>(k);
      if (k % 80 == 20) step = high * (2 * part(rng) - 1);
      if (k > 340) step = 0;  // comes to rest
      const double sines =
          trial == 0 || k > 340 ? 0 : 0.5 * high * (std::sin(slow * t) + 0.4 * std::sin(fast * t));
      u[j].push_back(step + sines);
    }
  }
  return u;
}

std::string Csv(const std::array<std::vector<double>, 2>& u,
                const std::array<std::vector<double>, 4>& y) {
  std::string text = "time,u1,u2,q1,q2,x,z\n";
  for (std::size_t k = 0; k < kRows; ++k) {
    text += Decimal(kPeriod * static_cast<double>(k));
    for (const auto& c : u) text += "," + Decimal(c[k]);
    for (const auto& c : y) text += "," + Decimal(c[k]);
    text += "\n";
  }
  return text;
}

// Whether a name is in both.
bool Share(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

}  // namespace

const std::vector<Hidden>& HiddenEffects() {
  static const std::vector<Hidden> all{
      {"payload", "mass", 0.004, [](Arm& a, double v) { a.payload = v; }, 0, {"link_mass"}},
      {"armature", "armature", 0.0005, [](Arm& a, double v) { a.armature = v; }},
      {"coulomb", "tau_c", 0.005, [](Arm& a, double v) { a.tau_c = v; }},
      {"load_friction", "mu_l", 0.01, [](Arm& a, double v) { a.load = v; }},
      {"dahl", "f", 0.01, [](Arm& a, double v) { a.dahl = v; }},
      {"input_gain", "gain", 0.006, [](Arm& a, double v) { a.gain = 1 + v; }, 1},
      {"input_offset", "offset", 0.006, [](Arm& a, double v) { a.offset = v; }},
      {"dead_time", "delay", 0.004, [](Arm& a, double v) { a.dead_time = v; }},
      {"pt1", "T", 0.004, [](Arm& a, double v) { a.lag = v; }},
      {"cubic_stiffness", "k3", 0.06, [](Arm& a, double v) { a.k3 = v; }},
      {"maxwell", "k_m", 0.05, [](Arm& a, double v) { a.k_m = v; }},
      {"link_mass", "scale", 0.01, [](Arm& a, double v) { a.link = 1 + v; }, 1},
      {"gravity_tilt", "pitch", 0.004, [](Arm& a, double v) { a.tilt = -v; }},
      {"external_force", "fx", 0.02, [](Arm& a, double v) { a.push = v; }},
      {"sensor_bias", "bias", 0.001, [](Arm& a, double v) { a.bias = v; }},
      {"sensor_scale", "scale", 0.004, [](Arm& a, double v) { a.scale = 1 + v; }, 1},
      {"sensor_delay", "delay", 0.002, [](Arm& a, double v) { a.late = v; }},
      {"sensor_drift", "rate", 0.0006, [](Arm& a, double v) { a.drift = v; }},
  };
  return all;
}

const Hidden& HiddenNamed(const std::string& name) {
  for (const Hidden& h : HiddenEffects()) {
    if (h.name == name) return h;
  }
  throw std::out_of_range("hidden effect " + name);
}

std::string Case::Name() const {
  std::string text;
  for (const auto& e : effects) text += (text.empty() ? "" : "+") + e;
  if (text.empty()) text = "none";
  return fmt::format("{} x{:g} {} seed {}{}", text, factor, kNoiseNames[static_cast<int>(noise)],
                     seed,
                     told     ? " told"
                     : listed ? ""
                              : " unlisted");
}

std::filesystem::path WriteCase(const Case& c, const std::filesystem::path& folder) {
  std::mt19937_64 rng(c.seed);
  Arm arm;
  for (const auto& name : c.effects) {
    const Hidden& h = HiddenNamed(name);
    h.add(arm, h.size * c.factor);
  }
  MakeFolder(folder);
  WriteFile(folder / "arm.xml", ArmXml());
  std::string logs;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto u = Inputs(trial, rng);
    const auto y = arm.Run(u, kPeriod);
    for (int replicate = 0; replicate < kReplicates; ++replicate) {
      auto noisy = y;
      for (std::size_t i = 0; i < noisy.size(); ++i)
        noisy[i] = WithNoise(noisy[i], c.noise, kSigma[i], rng);
      const std::string name = fmt::format("trial{}_{}", trial, replicate);
      WriteFile(folder / (name + ".csv"), Csv(u, noisy));
      logs += fmt::format("  - {{file: {}.csv, trial: trial{}, use: {}}}\n", name, trial,
                          trial + 1 < kTrials ? "train" : "validate");
    }
  }
  std::string candidates;
  for (const EffectInfo& info : Catalog()) {
    const bool hidden = std::find(c.effects.begin(), c.effects.end(), info.name) != c.effects.end();
    if (hidden ? !c.listed : c.told) continue;
    candidates += (candidates.empty() ? "" : ", ") + std::string(info.name);
  }
  WriteFile(folder / "experiment.yaml", R"(format: 1
model: arm.xml
start: rest
inputs:
  - {column: u1, unit: N*m, actuator: u1}
  - {column: u2, unit: N*m, actuator: u2}
outputs:
  - {column: q1, unit: rad, sensor: q1}
  - {column: q2, unit: rad, sensor: q2}
  - {column: x, unit: m, sensor: "tip[0]"}
  - {column: z, unit: m, sensor: "tip[2]"}
parameters:
  - {name: stiffness, target: "joint:*", attribute: stiffness, initial: 1.9, lower: 0.2, upper: 20}
  - {name: damping, target: "joint:*", attribute: damping, initial: 0.06, lower: 0, upper: 1}
logs:
)" + logs + "candidates: [" + candidates + "]\n");
  return folder / "experiment.yaml";
}

Answer Solve(const Case& c, const std::filesystem::path& folder) {
  const Experiment e = Experiment::Read(WriteCase(c, folder));
  const Diagnosis d = Diagnose(e, System::Load(e.model));
  Answer a;
  a.verdict = d.verdict.text;
  a.seconds = d.seconds;
  a.explained = GainOf(d, d.after()).explainable;
  a.next = Separation(d);
  Told told;
  told.after = d.after();
  a.detail = Summary(e, d, told);
  for (const std::size_t i : d.verdict.named) {
    const CandidateResult& one = d.candidates[i];
    if (std::find(a.named.begin(), a.named.end(), one.hypothesis.effect) == a.named.end())
      a.named.push_back(one.hypothesis.effect);
    if (c.effects.empty() || one.hypothesis.effect != c.effects.front()) continue;
    const Hidden& h = HiddenNamed(c.effects.front());
    a.truth = h.null + h.size * c.factor;
    for (std::size_t k = 0; k < one.hypothesis.extra.size(); ++k) {
      if (one.hypothesis.extra[k].name != h.parameter) continue;
      const Eigen::Index at = one.own() + static_cast<Eigen::Index>(k);
      a.value = one.fitted.fit.x[at];
      a.low = one.fitted.uncertainty.lower[at], a.high = one.fitted.uncertainty.upper[at];
    }
  }
  if (d.partner && d.chosen()) {
    a.partner = {d.partner->hypothesis.effect};
    for (const auto& other : d.partner->equivalent) a.partner.push_back(other);
  }
  return a;
}

bool InSet(const Case& c, const Answer& a) {
  if (c.effects.empty()) return false;
  const std::vector<std::string> first{c.effects.front()}, last{c.effects.back()};
  if (c.effects.size() == 1) return a.partner.empty() && Share(a.named, first);
  return (Share(a.named, first) && Share(a.partner, last)) ||
         (Share(a.named, last) && Share(a.partner, first));
}

bool Sibling(const Case& c, const Answer& a) {
  return Share(a.named, HiddenNamed(c.effects.front()).siblings);
}

bool Unique(const Answer& a) { return a.verdict == "named" && a.named.size() == 1; }

}  // namespace continuum::hidden
