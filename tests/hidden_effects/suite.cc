#include "hidden_effects/suite.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "hidden_effects/families.h"
#include "hidden_effects/robots.h"
#include "identification/diagnosis/free_lengths.h"
#include "identification/diagnosis/gain.h"
#include "identification/report/diagnosis_summary.h"
#include "sim/io/decimal.h"
#include "sim/io/file.h"

namespace continuum::hidden {
namespace {

constexpr int kReplicates = 2;
constexpr double kOff = 0.01;  // of the masses and lengths of a machine of the outside suite

// The line of a log in the experiment.
std::string LogLine(const Robot& robot, int trial, const std::string& name) {
  const std::string set = robot.conditions.empty() ? "" : ", " + robot.conditions[trial];
  return fmt::format("  - {{file: {}.csv, trial: trial{}, use: {}{}}}\n", name, trial,
                     trial + robot.held_out < robot.trials ? "train" : "validate", set);
}

void Spoil(const std::string& how, Columns& u, Columns& y) {
  constexpr double kTurn = 5 * std::numbers::pi / 180;
  if (how == "flipped") {
    for (auto& column : u) {
      for (double& value : column) value = -value;
    }
  } else if (how == "late") {  // a row
    for (auto& column : y) {
      column.insert(column.begin(), column.front());
      column.pop_back();
    }
  } else if (how == "turned") {
    for (std::size_t k = 0; k < y[2].size(); ++k) {
      const double x = y[2][k], z = y[3][k];
      y[2][k] = std::cos(kTurn) * x - std::sin(kTurn) * z;
      y[3][k] = std::sin(kTurn) * x + std::cos(kTurn) * z;
    }
  }
}

Amounts AmountsOf(const Case& c) {
  const Robot& robot = RobotNamed(c.robot);
  Amounts hidden;
  for (const auto& name : c.effects) hidden.emplace_back(name, robot.Named(name).size * c.factor);
  if (!robot.outside) return hidden;
  std::mt19937_64 rng(c.seed);
  for (const char* const what : {"heavier", "longer"})
    hidden.emplace_back(what, rng() % 2 ? kOff : -kOff);
  hidden.emplace_back("law", static_cast<double>(c.law));
  if (c.one_joint) hidden.emplace_back("one joint", 1);
  return hidden;
}

// One motion as often as it is recorded, each time with noise of its own. Returns the logs' names.
std::vector<std::string> WriteReplicates(const Case& c, const std::string& trial, const Columns& u,
                                         const Columns& y, const std::filesystem::path& folder,
                                         std::mt19937_64& rng) {
  const Robot& robot = RobotNamed(c.robot);
  std::vector<std::string> names;
  for (int replicate = 0; replicate < kReplicates; ++replicate) {
    Columns noisy = y;
    for (std::size_t i = 0; i < noisy.size(); ++i)
      noisy[i] = WithNoise(noisy[i], c.noise, robot.sigma[i], rng);
    names.push_back(fmt::format("{}_{}", trial, replicate));
    WriteFile(folder / (names.back() + ".csv"), Csv(robot, u, noisy));
  }
  return names;
}

// Whether a name is in both.
bool Share(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
}

}  // namespace

std::string Csv(const Robot& robot, const Columns& u, const Columns& y) {
  std::string text = "time";
  for (const auto& name : robot.inputs) text += "," + name;
  for (const auto& name : robot.outputs) text += "," + name;
  for (std::size_t k = 0; k < u[0].size(); ++k) {
    text += "\n" + Decimal(robot.period * static_cast<double>(k));
    for (const auto& c : u) text += "," + Decimal(c[k]);
    for (const auto& c : y) text += "," + Decimal(c[k]);
  }
  return text + "\n";
}

std::string CandidatesOf(const Case& c) {
  std::string text;
  const auto has = [](const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const EffectInfo& info : Catalog()) {
    if (has(c.effects, info.name) ? !c.listed : c.told) continue;
    if (c.among.empty() ? info.only_listed : !has(c.among, info.name)) continue;
    text += (text.empty() ? "" : ", ") + std::string(info.name);
  }
  return text;
}

const Robot& RobotNamed(const std::string& name) {
  static const std::vector<Robot> all{ArmRobot(),      ServoRobot(),        SilverboxRobot(),
                                      BoucWenRobot(),  SoftActuatorRobot(), SnakeArmRobot(),
                                      PendulumRobot(), ValveRobot(),        TwoLinkRobot(),
                                      SnakeRobot(),    WinchSnakeRobot(),   SoftRobot()};
  for (const Robot& robot : all) {
    if (robot.name == name) return robot;
  }
  throw std::out_of_range("robot " + name);
}

const Hidden& Robot::Named(const std::string& effect) const {
  for (const Hidden& h : effects) {
    if (h.name == effect) return h;
  }
  throw std::out_of_range("hidden effect " + effect);
}

std::string Case::Name() const {
  std::string text;
  for (const auto& e : effects) text += (text.empty() ? "" : "+") + e;
  if (text.empty()) text = "none";
  if (robot != "arm") text = robot + " " + text;
  if (background) text = "background " + text;
  if (!spoilt.empty()) text = spoilt + " " + text;
  if (law != Law::kStick) text += " " + std::string(kLawNames[static_cast<int>(law)]);
  if (one_joint) text += " at one joint";
  return fmt::format("{} x{:g} {} seed {}{}", text, factor, kNoiseNames[static_cast<int>(noise)],
                     seed,
                     told     ? " told"
                     : listed ? ""
                              : " unlisted");
}

std::filesystem::path WriteCase(const Case& c, const std::filesystem::path& folder) {
  if (c.background) return WriteBackground(c, folder);
  std::mt19937_64 rng(c.seed);
  const Robot& robot = RobotNamed(c.robot);
  const Amounts hidden = AmountsOf(c);
  MakeFolder(folder);
  WriteFile(folder / "robot.xml", robot.model);
  std::string logs;
  std::mt19937_64 elsewhere(~c.seed);
  for (int trial = 0; trial < robot.trials; ++trial) {
    Columns u = robot.drive(trial, rng);
    Columns y = robot.run(hidden, trial, u);
    if (c.spoilt == "exchanged") u = robot.drive(trial, elsewhere);
    Spoil(c.spoilt, u, y);
    for (const auto& name : WriteReplicates(c, fmt::format("trial{}", trial), u, y, folder, rng))
      logs += LogLine(robot, trial, name);
  }
  const bool all = robot.outside && c.listed && !c.told && c.among.empty();
  const std::string candidates = all ? "all" : "[" + CandidatesOf(c) + "]";
  WriteFile(folder / "experiment.yaml", "format: 1\nmodel: robot.xml\nstart: rest\n" +
                                            robot.experiment + "logs:\n" + logs +
                                            "candidates: " + candidates + "\n");
  return folder / "experiment.yaml";
}

namespace {

double ClosestTo(const CandidateResult& lead, const Diagnosis& d) {
  double closest = 1e9;
  for (const CandidateResult& c : d.candidates) {
    if (c.hypothesis.effect != lead.hypothesis.effect && !c.probes.empty())
      closest = std::min(closest, c.lambda);
  }
  return closest;
}

// What the screen saw, to first order.
void ReadScreen(const Diagnosis& d, Answer& a) {
  double most = 0;
  const auto screen = [&](const std::string& effect, double explained, double p) {
    a.p = std::min(a.p, p);
    if (explained > most) most = explained, a.screened = effect;
  };
  for (const CandidateResult& one : d.candidates)
    screen(one.hypothesis.effect, one.explained, one.p);
  for (const Dismissed& one : d.dismissed) screen(one.effect, one.explained, one.p);
}

// The size that was found of what is hidden.
void ReadSize(const Case& c, const CandidateResult& one, Answer& a) {
  if (c.effects.empty() || c.background) return;  // its size is not c's
  if (one.hypothesis.effect != c.effects.front()) return;
  const Hidden& h = RobotNamed(c.robot).Named(c.effects.front());
  a.truth = h.null + h.size * c.factor;
  if (!one.fitted.complete()) return;
  for (std::size_t k = 0; k < one.hypothesis.extra.size(); ++k) {
    if (one.hypothesis.extra[k].name != h.parameter) continue;
    const Eigen::Index at = one.first_extra() + static_cast<Eigen::Index>(k);
    const Uncertainty& u = one.fitted.sensitivities->uncertainty;
    a.value = one.fitted.fit.x[at] + (u.step.size() > 0 ? u.step[at] : 0);  // no machine has a step
    a.low = u.lower[at], a.high = u.upper[at];
    if (u.by_numbers.size() > 0) a.by_numbers = u.by_numbers[at];
  }
}

void AddOnce(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

void ReadNames(const Case& c, const Diagnosis& d, Answer& a) {
  for (const std::size_t i : d.verdict.siblings) {
    ReadSize(c, d.candidates[i], a);
    AddOnce(d.candidates[i].hypothesis.effect, a.relatives);
  }
  std::vector<const CandidateResult*> set;
  for (const std::size_t i : d.verdict.named) set.push_back(&d.candidates[i]);
  for (const CandidateResult& one : d.unlisted) set.push_back(&one);
  for (const CandidateResult* const one : set) {
    ReadSize(c, *one, a);
    AddOnce(one->hypothesis.effect, a.named);
  }
  if (d.partner && d.chosen()) {
    a.partner = {d.partner->hypothesis.effect};
    for (const auto& other : d.partner->equivalent) a.partner.push_back(other);
    for (const auto& other : d.partner->relatives) AddOnce(other, a.relatives);
    for (const auto& other : d.partner->instead) AddOnce(other, a.named);
    a.corrects = d.partner->correction != Partner::Correction::kNone;
    if (d.partner->correction == Partner::Correction::kOther) std::swap(a.named, a.partner);
  }
  if (d.verdict.leading) a.leading = d.candidates[*d.verdict.leading].hypothesis.effect;
}

Answer AnswerTo(const Case& c, const std::filesystem::path& file) {
  Experiment e = Experiment::Read(file);
  const std::clock_t before = std::clock();
  DiagnosisOptions options;
  options.effort = c.effort;
  const Diagnosis d = DiagnoseWithLengths(e, ModelSpec::Load(e.model), options);
  Answer a;
  a.cpu = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  a.verdict = d.verdict.word(), a.complete = d.verdict.complete;
  a.seconds = d.seconds;
  const Gain gain = GainOf(d, d.after());
  a.removed = gain.removed, a.explained = gain.explainable;
  a.next = Separation(d);
  a.lack = d.lack_of_fit.smallest();
  a.next_experiment = d.next;
  ExtensionRun run;
  run.after = d.after();
  a.detail = Summary(e, d, run);
  ReadScreen(d, a);
  ReadNames(c, d, a);
  if (!d.noise_limited || !d.chosen()) return a;
  a.closest = ClosestTo(d.candidates.front(), d);
  for (const CandidateResult& one : d.candidates) {
    if (!d.partner) a.stated[one.hypothesis.effect] += one.probability;
  }
  return a;
}

// The arm under the inputs of an experiment and with the mass that it carries there.
void WriteNext(const Case& c, const Log& next, const std::filesystem::path& folder) {
  const Robot& robot = RobotNamed(c.robot);
  Amounts hidden = AmountsOf(c);
  std::string set;
  for (const Change& change : next.set) {
    set = fmt::format(", set: {{\"{}\": {{{}: {}}}}}", change.target, change.attribute,
                      Decimal(change.value));
    const auto payload = std::find_if(hidden.begin(), hidden.end(),
                                      [](const auto& h) { return h.first == "payload"; });
    if (payload == hidden.end()) {
      hidden.emplace_back("payload", change.value);
    } else {
      payload->second += change.value;
    }
  }
  std::mt19937_64 rng(c.seed + 1'000'000);
  const Columns y = robot.run(hidden, 0, next.input);
  std::string lines = "logs:\n";
  for (const auto& name : WriteReplicates(c, "next", next.input, y, folder, rng))
    lines += fmt::format("  - {{file: {}.csv, trial: next, use: train{}}}\n", name, set);
  std::string text = ReadFile(folder / "experiment.yaml");
  text.replace(text.find("logs:\n"), 6, lines);
  WriteFile(folder / "followed.yaml", text);
}

}  // namespace

Answer Solve(const Case& c, const std::filesystem::path& folder) {
  return AnswerTo(c, WriteCase(c, folder));
}

Answer SolveAndFollow(const Case& c, const std::filesystem::path& folder) {
  Answer first = Solve(c, folder);
  if (!first.next_experiment.log || c.robot != "arm" || c.background) return first;
  WriteNext(c, *first.next_experiment.log, folder);
  const Answer then = AnswerTo(c, folder / "followed.yaml");
  first.followed = {first.next_experiment.input, first.next_experiment.separation, then.named,
                    InSet(c, then), Unique(then)};
  return first;
}

namespace {

// What may stand beside the name of a single truth.
enum class Beside { kNothing, kCorrection, kAnything };

// A machine that is not its model may need a correction of that. Where other forces act as well a
// second name is of these.
Beside AllowedBeside(const Case& c) {
  if (c.background) return Beside::kAnything;
  return RobotNamed(c.robot).outside ? Beside::kCorrection : Beside::kNothing;
}

// Whether an answer holds one name of each. Relatives that fit as well belong to the answer.
bool Holds(const std::vector<std::vector<std::string>>& truths, const Answer& a, Beside allowed) {
  if (truths.empty()) return false;
  std::vector<std::string> set = a.named, beside = a.partner;
  set.insert(set.end(), a.relatives.begin(), a.relatives.end());
  beside.insert(beside.end(), a.relatives.begin(), a.relatives.end());
  const auto& first = truths.front();
  const auto& last = truths.back();
  if (truths.size() == 1) {
    if (!a.partner.empty() && allowed == Beside::kAnything)
      return Share(set, first) || Share(beside, first);
    const bool corrects = allowed != Beside::kNothing && a.corrects;
    return (a.partner.empty() || corrects) && Share(set, first);
  }
  if (a.partner.empty()) return false;
  return (Share(set, first) && Share(beside, last)) || (Share(set, last) && Share(beside, first));
}

}  // namespace

bool InSet(const Case& c, const Answer& a) {
  std::vector<std::vector<std::string>> truths;
  for (const auto& effect : c.effects) {
    const bool made_otherwise = c.law != Law::kStick && IsDryFriction(effect);
    truths.push_back(made_otherwise ? FamilyOf(effect) : std::vector{effect});
  }
  return Holds(truths, a, AllowedBeside(c));
}

bool InSetExactly(const Case& c, const Answer& a) {
  std::vector<std::vector<std::string>> truths;
  for (const auto& effect : c.effects) truths.push_back({effect});
  return Holds(truths, a, AllowedBeside(c));
}

bool Sibling(const Case& c, const Answer& a) {
  const std::string& effect = c.effects.front();
  const Robot& robot = RobotNamed(c.robot);
  return Share(a.named, robot.Named(effect).siblings) ||
         (robot.outside && Share(a.named, FamilyOf(effect)));
}

bool Unique(const Answer& a) { return a.verdict == "named" && a.named.size() == 1; }

}  // namespace continuum::hidden
