#include "models/tdcr/solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "error.h"
#include "models/statics/details.h"
#include "models/statics/path_error.h"
#include "models/statics/results.h"
#include "models/statics/rows.h"
#include "models/statics/shape_table.h"
#include "models/statics/sweep.h"
#include "models/statics/write_figure.h"
#include "models/tdcr/calibrate.h"
#include "models/tdcr/columns.h"
#include "models/tdcr/details.h"
#include "models/tdcr/disks.h"
#include "models/tdcr/document.h"
#include "models/tdcr/equilibria.h"
#include "models/tdcr/explained.h"
#include "models/tdcr/figure.h"
#include "models/tdcr/fit.h"
#include "models/tdcr/hybrid.h"
#include "models/tdcr/model.h"
#include "models/tdcr/plausible.h"
#include "models/tdcr/reach.h"
#include "models/tdcr/response.h"

namespace continuum {
namespace {

using namespace tdcr;  // the model behind this front

// One row of the results before it is written.
struct Solved {
  std::string name;
  Loads loads;
  Solution solution;
  const Measured* measured = nullptr;
  int equilibrium = 0;              ///< of the case, counted from 1; 0: no list of them
  std::optional<double> miss = {};  ///< distance from a target [m]
};

void Need(const std::filesystem::path& path, const std::string& option, const std::string& job) {
  if (path.empty()) throw Error::Input(option, "a file for " + job, "nothing");
}

void Refuse(bool given, const std::string& option, const std::string& job) {
  if (given) throw Error::Input(option, "not with " + job);
}

void Append(const std::vector<std::string>& more, std::vector<std::string>& columns) {
  columns.insert(columns.end(), more.begin(), more.end());
}

std::vector<std::string> Columns(const SolveRequest& request, const Robot& robot, bool by_length) {
  const int disks = robot.disks;
  std::vector<std::string> columns{"case",   "status", "iterations", "residual",
                                   "micros", "x",      "y",          "z"};
  Append(statics::StabilityColumns(), columns);
  for (int i = 1; i <= disks; ++i) {
    for (const char* axis : {"x", "y", "z"}) columns.push_back(fmt::format("{}_{}", axis, i));
  }
  for (int i = 1; i <= disks; ++i) {
    for (const char* u : {"kappa_x", "kappa_y", "tau"})
      columns.push_back(fmt::format("{}_{}", u, i));
  }
  if (request.method == "fit") return columns;
  const bool reaches = !request.reach.empty();
  Append(statics::DetailColumns{robot.tendons, by_length, reaches, request.equilibria}.Names(),
         columns);
  return columns;
}

// error_i of every disk that was measured in some case.
void AddErrorColumns(const std::vector<Solved>& solved, int disks,
                     std::vector<std::string>& columns) {
  for (int i = 0; i < disks; ++i) {
    for (const Solved& s : solved) {
      if (s.measured == nullptr || !s.measured->Has(i)) continue;
      columns.push_back(fmt::format("error_{}", i + 1));
      break;
    }
  }
}

void AddShape(const Robot& robot, const Solved& s, statics::Results& results) {
  const char* const axes[3] = {"x", "y", "z"};
  const char* const curvatures[3] = {"kappa_x", "kappa_y", "tau"};
  const Solution& solution = s.solution;
  for (int a = 0; a < 3; ++a) results.Set(axes[a], solution.disks(a, robot.disks - 1));
  for (int i = 0; i < robot.disks; ++i) {
    for (int a = 0; a < 3; ++a) {
      results.Set(fmt::format("{}_{}", axes[a], i + 1), solution.disks(a, i));
      results.Set(fmt::format("{}_{}", curvatures[a], i + 1), solution.u(a, i));
    }
  }
  if (s.measured == nullptr) return;
  const Eigen::VectorXd errors = Errors(robot, *s.measured, solution.disks);
  for (int i = 0; i < robot.disks; ++i) {
    if (s.measured->Has(i)) results.Set(fmt::format("error_{}", i + 1), errors[i]);
  }
}

void Draw(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& solved) {
  statics::Figure figure = EmptyFigure(robot);
  figure.title = "tdcr " + (request.method.empty() ? "eas" : request.method);
  for (const Solved& s : solved) {
    if (!s.solution.outcome.ok()) continue;
    figure.shapes.push_back(ShapeOf(robot, s.loads, s.solution, s.measured));
    figure.shapes.back().label = s.name;
  }
  statics::WriteFigure(request.plot, figure);
}

Method MethodOf(const SolveRequest& request) {
  return ParseMethod(request.method.empty() ? "eas" : request.method);
}

void WriteShapes(const SolveRequest& request, const Robot& robot,
                 const std::vector<Solved>& solved) {
  statics::ShapeTable table(robot.tendons);
  for (const Solved& s : solved) {
    if (!s.solution.outcome.ok()) continue;
    const Line line = LineOf(robot, s.loads, MethodOf(request), s.solution);
    for (Eigen::Index i = 0; i < line.s.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      table.Add(s.name, {line.s[i], line.disk[at], line.points.col(i), line.frames[at],
                         line.tension.row(i)});
    }
  }
  table.Write(request.shape);
}

void WriteCompliance(const SolveRequest& request, const Robot& robot,
                     const std::vector<Solved>& solved) {
  const bool by_length = !solved.empty() && solved.front().loads.length.size() > 0;
  statics::ComplianceTable table(robot.tendons, by_length);
  for (const Solved& s : solved) {
    if (!s.solution.outcome.ok()) continue;
    const auto response = Respond(robot, s.loads, MethodOf(request), s.solution);
    if (response) table.Add(s.name, *response);
  }
  table.Write(request.compliance);
}

int Report(const SolveRequest& request, const Robot& robot, const std::vector<Solved>& solved) {
  const bool by_length = !solved.empty() && solved.front().loads.length.size() > 0;
  auto columns = Columns(request, robot, by_length);
  AddErrorColumns(solved, robot.disks, columns);
  const auto failed = [](const Solved& s) { return !s.solution.outcome.ok(); };
  const bool all = std::none_of(solved.begin(), solved.end(), failed);
  statics::Results results(columns);
  for (const Solved& s : solved) {
    const bool ok = s.solution.outcome.ok();
    results.Row();
    results.Set("case", s.name);
    const bool missed = s.miss && s.solution.outcome.status == numerics::Status::kOutOfDomain;
    results.Set(
        s.solution.outcome,
        missed ? "out_of_reach" : statics::StatusOf(s.solution.outcome, s.solution.stability));
    if (ok) AddShape(robot, s, results);
    if (request.method == "fit") {
      results.Set("why", s.solution.outcome.why);
      continue;
    }
    results.Set(s.solution.outcome, s.solution.stability);
    if (!ok) continue;
    auto details = Describe(robot, s.loads, MethodOf(request), s.solution);
    details.miss = s.miss;
    Set(details, s.equilibrium, results);
  }
  results.Write(request.out);
  if (!request.shape.empty()) WriteShapes(request, robot, solved);
  if (!request.compliance.empty()) WriteCompliance(request, robot, solved);
  if (!request.plot.empty()) Draw(request, robot, solved);
  return all ? 0 : 1;
}

std::vector<Case> ReadInput(const SolveRequest& request, const Robot& robot) {
  const CsvTable table = statics::CasesOf(request);
  auto cases = ReadCases(table, robot);
  WarnOfImplausibleCases(request, table, robot, cases);
  return cases;
}

// Millimetres, or another origin: no disk is farther from the base than the rod is long.
void WarnOfFarPoints(const SolveRequest& request, const Robot& robot,
                     const std::vector<Measured>& measured) {
  double farthest = 0;
  for (const Measured& m : measured) {
    for (int i = 0; i < robot.disks; ++i) {
      if (m.Has(i)) farthest = std::max(farthest, m.disks.col(i).norm());
    }
  }
  if (farthest <= 2 * robot.length) return;
  request.warn(fmt::format("{}: points up to {:.3g} m from the base of a rod of {:.3g} m",
                           request.measured.string(), farthest, robot.length));
}

std::vector<Measured> ReadMeasurements(const SolveRequest& request, const Robot& robot) {
  if (request.measured.empty()) return {};
  const CsvTable table = CsvTable::Read(request.measured);
  RequireKnownMeasuredColumns(table, robot.disks);
  auto measured = ReadMeasured(table, robot.disks);
  WarnOfFarPoints(request, robot, measured);
  return measured;
}

// --lambda: weight of the fit's curvatures, penalty of the training; no other job has one.
void CheckLambda(const SolveRequest& request, const std::string& method) {
  const bool training = request.hybrid == "train";
  Refuse(request.cross_validate && !training, "--cross-validate", "other jobs than --hybrid train");
  if (!request.lambda) return;
  Refuse(!training && method != "fit", "--lambda", "other jobs than fit and --hybrid train");
  Refuse(request.cross_validate, "--lambda", "--cross-validate");
  if (!(*request.lambda >= 0 && std::isfinite(*request.lambda))) {
    throw Error::Input("--lambda", "a number of at least 0", fmt::format("{}", *request.lambda));
  }
}

// --equilibria, --shape and --compliance: of solved cases.
void CheckLists(const SolveRequest& request, const std::string& method) {
  const bool other = request.calibrate || !request.hybrid.empty() || method == "fit";
  const std::string jobs = "calibration, --hybrid and --method fit";
  const bool measured = !request.measured.empty();
  Refuse(request.equilibria && other, "--equilibria", jobs);
  Refuse(request.sweep != 0 && (other || measured), "--sweep", "--measured, " + jobs);
  Refuse(!request.reach.empty() && (other || request.equilibria || measured), "--reach",
         "--equilibria, --measured, " + jobs);
  for (const auto& [option, file] :
       {std::pair("--shape", &request.shape), std::pair("--compliance", &request.compliance)}) {
    Refuse(!file->empty() && other, option, jobs);
    statics::RequireTable(*file, option);
  }
}

// Nothing: to be chosen by cross-validation.
std::optional<double> Penalty(const SolveRequest& request) {
  if (request.cross_validate) return std::nullopt;
  return request.lambda.value_or(0);
}

// A case that has a reference goes on from its solution, which is among those solved before.
Solution SolveInOrder(const Robot& robot, const std::vector<Case>& cases, const Case& c,
                      Method method, const std::vector<Solution>& solved) {
  if (c.reference < 0) return SolveCase(robot, c.loads, method);
  const auto at = static_cast<std::size_t>(c.reference);
  if (solved[at].outcome.ok()) {
    return SolveFrom(robot, cases[at].loads, solved[at], c.loads, method);
  }
  Solution none;
  none.outcome.why = "its reference '" + cases[at].name + "' failed";
  return none;
}

// All of a case instead of its own answer `s`, which is one of them; alone when none is found.
void AddEquilibria(const Robot& robot, Method method, const Solved& s,
                   std::vector<Solved>& solved) {
  int count = 0;
  for (Solution& solution : Equilibria(robot, s.loads, method, s.solution)) {
    solved.push_back({s.name, s.loads, std::move(solution), s.measured, ++count});
  }
  if (!s.solution.outcome.ok()) solved.push_back(s);
}

std::vector<std::string> Names(const std::vector<Case>& cases) {
  std::vector<std::string> names;
  for (const Case& c : cases) names.push_back(c.name);
  return names;
}

// Of jobs that take tensions.
void RefuseLengths(const SolveRequest& request, const std::vector<Case>& cases,
                   const std::string& job) {
  if (cases.empty() || cases.front().loads.length.size() == 0) return;
  throw Error::Input(request.input.string() + ":1", "columns T1, T2, .. with " + job, "'L1'");
}

int SolveCases(const SolveRequest& request, const Robot& robot, Method method,
               const Hybrid* hybrid) {
  const auto cases = ReadInput(request, robot);
  if (hybrid != nullptr || request.equilibria) {
    RefuseLengths(request, cases, hybrid ? "--hybrid" : "--equilibria");
  }
  const auto measured = ReadMeasurements(request, robot);
  if (!request.measured.empty()) RequireShared(cases, measured, request.measured.string());
  std::vector<Solution> plain(cases.size());  // without the hybrid's correction
  statics::ForRows(
      cases.size(), [&](std::size_t i) { return cases[i].reference; },
      [&](std::size_t i) { plain[i] = SolveInOrder(robot, cases, cases[i], method, plain); });
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Case& c = cases[i];
    Solved s{c.name, c.loads, plain[i], Find(measured, c.name)};
    const Eigen::VectorXd& pull = plain[i].pull;
    if (pull.size() > 0) s.loads.tension.assign(pull.begin(), pull.end());
    if (hybrid != nullptr && s.solution.outcome.ok()) Apply(*hybrid, robot, c.loads, s.solution);
    const auto before = static_cast<std::size_t>(std::max(c.reference, 0));
    if (c.reference >= 0 && plain[before].outcome.ok()) {
      s.loads.from = LeftBy(robot, cases[before].loads, method, plain[before]);
    }
    if (request.equilibria) {
      AddEquilibria(robot, method, s, solved);
    } else {
      solved.push_back(std::move(s));
    }
  }
  return Report(request, robot, solved);
}

// The error of the path halfway to a target.
void AddHalfway(const Robot& robot, Method method, const Case& from, const Case& to,
                const Solution& before, const Solution& after, statics::PathError& error) {
  Loads half = to.loads;
  for (std::size_t k = 0; k < half.tension.size(); ++k) {
    half.tension[k] = 0.5 * (from.loads.tension[k] + to.loads.tension[k]);
  }
  const Solution s = SolveFrom(robot, from.loads, before, half, method);
  if (!s.outcome.ok()) return;
  error.Halfway(to.name, s.disks.rightCols<1>(), before.disks.rightCols<1>(),
                after.disks.rightCols<1>());
}

// The case whose target it is, with its tensions; its reference is among those solved before.
Solved ReachTarget(const Robot& robot, Method method, const statics::Target& target,
                   const std::vector<Case>& cases, const std::vector<Solved>& solved, Case& c) {
  std::optional<Before> before;
  if (c.reference >= 0) {
    const auto at = static_cast<std::size_t>(c.reference);
    before.emplace(Before{cases[at].loads, solved[at].solution});
  }
  Solved s{c.name, c.loads, {}};
  if (before && !before->solution.outcome.ok()) {
    s.solution.outcome.why = "its reference failed";
    return s;
  }
  const auto reached = Reach(robot, c.loads, method, target, before ? &*before : nullptr);
  s.miss = reached.miss;
  if (reached.outcome.ok()) {
    c.loads.tension.assign(reached.drives.begin(), reached.drives.end());
    s.loads = c.loads;
    s.solution = before ? SolveFrom(robot, before->loads, before->solution, c.loads, method)
                        : SolveCase(robot, c.loads, method);
    s.solution.pull = reached.drives;
    if (before) s.loads.from = LeftBy(robot, before->loads, method, before->solution);
  } else {
    s.solution.outcome = reached.outcome;
  }
  return s;
}

int ReachTargets(const SolveRequest& request, const Robot& robot, Method method) {
  auto cases = ReadInput(request, robot);
  RefuseLengths(request, cases, "--reach");
  const auto targets =
      statics::TargetsOf(statics::ReadTargets(CsvTable::Read(request.reach), robot.disks),
                         Names(cases), request.reach.string());
  statics::PathError error;
  std::vector<Solved> solved;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Case& c = cases[i];
    solved.push_back(ReachTarget(robot, method, targets[i], cases, solved, c));
    if (!solved[i].solution.outcome.ok()) {
      error.NotReached();
      continue;
    }
    error.AtTarget(c.name, *solved[i].miss);
    if (c.reference < 0) continue;
    const auto from = static_cast<std::size_t>(c.reference);
    AddHalfway(robot, method, cases[from], c, solved[from].solution, solved[i].solution, error);
  }
  request.say(error.Sentence());
  return Report(request, robot, solved);
}

int FitShapes(const SolveRequest& request, const Robot& robot) {
  Need(request.measured, "--measured", "--method fit");
  Refuse(!request.input.empty(), "--input", "--method fit");
  const auto measured = ReadMeasurements(request, robot);
  const double lambda = request.lambda.value_or(1e-7);
  std::vector<Solved> solved;
  for (const Measured& m : measured) {
    Solution solution = FitShape(robot, robot.MeasuringToBase() * m.disks, lambda);
    solved.push_back({m.name, NoLoads(robot), std::move(solution), &m});
  }
  return Report(request, robot, solved);
}

std::vector<Pair> ReadPairs(const SolveRequest& request, const std::vector<Case>& cases,
                            const std::vector<Measured>& measured) {
  RefuseLengths(request, cases, "calibration and training");
  for (const Case& c : cases) {
    if (c.reference < 0) continue;
    throw Error::Input(request.input.string() + ", column 'reference'",
                       "empty cells in calibration and training", "case '" + c.name + "'");
  }
  return Match(cases, measured, request.measured.string());
}

void AddExplained(const Explained& explained, bool poor, YAML::Node& node) {
  node["status"] = poor ? "poor" : "ok";
  node["rmse"] = Number(explained.rmse());
  node["deflection"] = Number(explained.deflection());
  node["scatter"] = Number(explained.scatter());
}

// The exit code of a calibration or training.
int Judge(const SolveRequest& request, bool poor, const std::string& job,
          const std::string& sentence) {
  if (!poor) return 0;
  request.warn(request.measured.string() + ": the " + job + " is poor: " + sentence);
  return 1;
}

// R.yaml with the values found.
YAML::Node CalibrationDocument(const SolveRequest& request, const Yaml& file,
                               const Calibration& c) {
  const std::string method = request.method.empty() ? "eas" : request.method;
  const bool friction = c.standard.size() > 4;
  const YAML::Node base = List(c.robot.base_rotation);
  YAML::Node standard;
  standard["E"] = Number(c.standard[0]);
  if (friction) standard["mu"] = Number(c.standard[4]);
  standard["base_rotation"] = List(Eigen::VectorXd(c.standard.segment<3>(1)));

  YAML::Node document = YAML::Clone(file.node());
  const auto set = [&](const char* key, const YAML::Node& value) {
    SetParameter(document, key, value, YAML::Clone(standard[key]),
                 fmt::format("calibrated by {} on {} cases of {}", method, c.cases,
                             request.measured.filename().string()));
  };
  set("E", Number(c.robot.E));
  if (friction) set("mu", Number(c.robot.mu));
  set("base_rotation", base);

  YAML::Node node;
  node["method"] = method;
  node["cases"] = c.cases;
  node["E"] = Number(c.robot.E);
  if (friction) node["mu"] = Number(c.robot.mu);
  node["base_rotation"] = YAML::Clone(base);
  node["standard_error"] = standard;
  node["at_bound"] = List(c.at_bound);
  AddExplained(c.explained, c.explained.poor(), node);
  node["tip_error_percent"] = Document(c.tips);
  document["calibration"] = node;
  return document;
}

int CalibrateRobot(const SolveRequest& request, const Yaml& file, const Robot& robot,
                   Method method) {
  Need(request.input, "--input", "--calibrate");
  Need(request.measured, "--measured", "--calibrate");
  Refuse(!request.plot.empty(), "--plot", "--calibrate");
  statics::RequireExtension(request.out, {".yaml", ".yml"}, "--out");
  const auto cases = ReadInput(request, robot);
  const auto measured = ReadMeasurements(request, robot);
  const Calibration c =
      Calibrate(robot, method, ReadPairs(request, cases, measured), request.measured.string());
  WriteDocument(request.out, CalibrationDocument(request, file, c));
  return Judge(request, c.explained.poor(), "calibration", c.explained.Sentence());
}

int TrainHybrid(const SolveRequest& request, const Yaml& file, const Robot& robot) {
  Need(request.input, "--input", "--hybrid train");
  Need(request.measured, "--measured", "--hybrid train");
  Refuse(!request.plot.empty(), "--plot", "--hybrid train");
  statics::RequireExtension(request.out, {".yaml", ".yml"}, "--out");
  const auto cases = ReadInput(request, robot);
  const auto measured = ReadMeasurements(request, robot);
  const Hybrid h = Train(robot, ReadPairs(request, cases, measured), request.measured.string(),
                         Penalty(request));

  YAML::Node node;
  node["features"] = List(h.features);
  YAML::Node weights(YAML::NodeType::Sequence);
  for (Eigen::Index i = 0; i < h.weights.rows(); ++i) {
    weights.push_back(List(Eigen::VectorXd(h.weights.row(i).transpose())));
  }
  node["weights"] = weights;
  node["penalty"] = Number(h.penalty);
  AddExplained(h.explained, h.poor(), node);
  if (h.left_out) node["rmse_left_out"] = Number(h.left_out->explained.rmse());
  node["tip_error_percent"] = Document(h.tips);
  if (const auto spread = h.left_out ? Statistics(h.left_out->tips) : std::nullopt) {
    node["tip_error_percent"]["five_fold"] = Document(*spread);
  }
  YAML::Node document = YAML::Clone(file.node());
  document["hybrid"] = node;
  WriteDocument(request.out, document);
  return Judge(request, h.poor(), "training", h.Sentence());
}

}  // namespace

int SolveTdcr(const SolveRequest& request) {
  const Yaml file = Yaml::Read(request.robot);
  const Robot robot = ReadRobot(file);
  RequireKnownKeys(file);
  WarnOfImplausibleRobot(request, file, robot);
  const std::string method = request.method.empty() ? "eas" : request.method;
  Refuse(request.sensitivity, "--sensitivity", "the robot tdcr");
  Need(request.out, "--out", "the results");
  CheckLists(request, method);
  CheckLambda(request, method);
  if (!request.hybrid.empty()) {
    Refuse(request.calibrate, "--calibrate", "--hybrid");
    if (method != "eas") throw Error::Input("--method", "eas with --hybrid", "'" + method + "'");
    if (request.hybrid == "train") return TrainHybrid(request, file, robot);
    if (request.hybrid != "apply") {
      throw Error::Input("--hybrid", "train or apply", "'" + request.hybrid + "'");
    }
  }
  if (request.calibrate) {
    if (method == "fit") {
      throw Error::Input("--method", "eas, pcca, crt or crt_friction with --calibrate",
                         "'" + method + "'");
    }
    return CalibrateRobot(request, file, robot, ParseMethod(method));
  }
  statics::RequireExtension(request.out, {".csv", ".json"}, "--out");
  if (!request.plot.empty()) statics::RequireFigureEnding(request.plot);
  if (method == "fit") return FitShapes(request, robot);
  const Method parsed = ParseMethod(method);
  Need(request.input, "--input", "the cases");
  if (!request.reach.empty()) return ReachTargets(request, robot, parsed);
  if (request.hybrid.empty()) return SolveCases(request, robot, parsed, nullptr);
  const Hybrid hybrid = ReadHybrid(file, robot);
  return SolveCases(request, robot, parsed, &hybrid);
}

}  // namespace continuum
