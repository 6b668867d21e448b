#include "models/tdcr/solve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "models/statics/error_table.h"
#include "models/statics/foreign_options.h"
#include "models/statics/limited_search.h"
#include "models/statics/path_error.h"
#include "models/statics/rows.h"
#include "models/statics/sweep.h"
#include "models/statics/write_figure.h"
#include "models/tdcr/calibration_document.h"
#include "models/tdcr/columns.h"
#include "models/tdcr/equilibria.h"
#include "models/tdcr/fit.h"
#include "models/tdcr/hybrid.h"
#include "models/tdcr/inputs.h"
#include "models/tdcr/learn.h"
#include "models/tdcr/plausible.h"
#include "models/tdcr/reach.h"
#include "models/tdcr/response.h"
#include "models/tdcr/solved.h"

namespace continuum {
namespace {

using namespace tdcr;  // the model behind this front

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

void CheckParameters(const SolveRequest& request) {
  Refuse(!request.parameters.empty() && !request.calibrate, "--parameters",
         "other jobs than --calibrate");
}

// --equilibria, --shape and --compliance: of solved cases.
void CheckLists(const SolveRequest& request, const std::string& method) {
  const bool other = request.calibrate || !request.hybrid.empty() || method == "fit";
  const std::string jobs = "calibration, --hybrid and --method fit";
  const bool measured = !request.measured.empty();
  Refuse(request.equilibria && other, "--equilibria", jobs);
  Refuse(request.sweep != 0 && (other || measured), "--sweep", "--measured, " + jobs);
  statics::RefuseGiven("tdcr", {{"--follow", !request.follow.empty()},
                                {"--outlines", !request.outlines.empty()},
                                {"--sensitivity", request.sensitivity}});
  Refuse(!request.reach.empty() && (other || request.equilibria || measured), "--reach",
         "--equilibria, --measured, " + jobs);
  for (const auto& [option, file] :
       {std::pair("--shape", &request.shape), std::pair("--compliance", &request.compliance)}) {
    Refuse(!file->empty() && other, option, jobs);
    statics::RequireTable(*file, option);
  }
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

int SolveCases(const SolveRequest& request, const Robot& robot, Method method, const Hybrid* hybrid,
               const std::optional<Prediction>& prediction) {
  const auto cases = ReadInput(request, robot);
  if (hybrid != nullptr || request.equilibria) {
    RefuseLengths(request, cases, hybrid ? "--hybrid" : "--equilibria");
  }
  const auto measured = ReadMeasurements(request, robot);
  if (!request.measured.empty()) {
    statics::RequireShared(Names(cases), measured, request.measured.string());
  }
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
    s.loads.from = s.solution.from;
    if (request.equilibria) {
      AddEquilibria(robot, method, s, solved);
    } else {
      solved.push_back(std::move(s));
    }
  }
  return Report(request, robot, solved, prediction);
}

// What calibration says of predictions by this method.
std::optional<Prediction> PredictionBy(const Yaml& file, const Robot& robot,
                                       const std::string& method) {
  const auto calibration = file.Find("calibration");
  if (!calibration || calibration->At("method").Text() != method) return std::nullopt;
  return ReadPrediction(file, robot);
}

// By the method that the hybrid was trained with.
int ApplyHybrid(const SolveRequest& request, const Yaml& file, const Robot& robot) {
  const Hybrid hybrid = ReadHybrid(file, robot);
  const std::string trained = NameOf(hybrid.method);
  if (!request.method.empty() && request.method != trained) {
    throw Error::Input("--method", trained + ", by which the hybrid was trained",
                       "'" + request.method + "'");
  }
  SolveRequest named = request;
  named.method = trained;
  return SolveCases(named, robot, hybrid.method, &hybrid, std::nullopt);
}

// The error of the path halfway to a target.
void AddHalfway(const Robot& robot, Method method, const Case& from, const Case& to,
                const Solution& before, const Solution& after, statics::PathError& error) {
  Loads half = to.loads;
  for (std::size_t k = 0; k < half.tension.size(); ++k) {
    half.tension[k] = 0.5 * (from.loads.tension[k] + to.loads.tension[k]);
  }
  half.length = 0.5 * (from.loads.length + to.loads.length);
  const Solution s = SolveFrom(robot, from.loads, before, half, method);
  if (!s.outcome.ok()) return;
  error.Halfway(to.name, s.disks.rightCols<1>(), before.disks.rightCols<1>(),
                after.disks.rightCols<1>());
}

// The case whose target it is, with its tensions or lengths; its reference is among those solved
// before.
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
  const bool by_length = c.loads.length.size() > 0;
  const auto reached = statics::LimitedSearch(kMostOfReach, [&] {
    return (by_length ? ReachByLengths : Reach)(robot, c.loads, method, target,
                                                before ? &*before : nullptr);
  });
  s.miss = reached.miss;
  if (reached.outcome.ok()) {
    if (by_length) {
      c.loads.length = reached.drives;
    } else {
      c.loads.tension.assign(reached.drives.begin(), reached.drives.end());
    }
    s.solution = before ? SolveFrom(robot, before->loads, before->solution, c.loads, method)
                        : SolveCase(robot, c.loads, method);
    if (!by_length) s.solution.pull = reached.drives;
    if (s.solution.outcome.ok()) {
      c.loads.tension.assign(s.solution.pull.begin(), s.solution.pull.end());
    }
    s.loads = c.loads;
    s.loads.from = s.solution.from;
  } else {
    s.solution.outcome = reached.outcome;
  }
  return s;
}

int ReachTargets(const SolveRequest& request, const Robot& robot, Method method) {
  auto cases = ReadInput(request, robot);
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

// A robot with sections: the Cosserat rod alone knows it.
void RequireSolvable(const SolveRequest& request, const Yaml& file, const Robot& robot,
                     const std::string& method) {
  const std::string where = file.At("sections").Where();
  if (method == "fit") return;
  if (!request.hybrid.empty()) {
    throw Error::Input(where, "a robot of one section (keys length, diameter, ..) with --hybrid",
                       "sections");
  }
  RequireTaken(robot, NoLoads(robot), ParseMethod(method), where);
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

}  // namespace

int SolveTdcr(const SolveRequest& request) {
  const Yaml file = Yaml::Read(request.robot);
  const Robot robot = ReadRobot(file);
  RequireKnownKeys(file);
  WarnOfImplausibleRobot(request, file, robot);
  const std::string method = MethodName(request, robot);
  if (robot.has_sections()) RequireSolvable(request, file, robot, method);
  Need(request.out, "--out", "the results");
  const bool learns = request.calibrate || request.hybrid == "train";
  CheckLists(request, method);
  CheckLambda(request, method);
  CheckParameters(request);
  statics::CheckErrorOptions(request);
  Refuse(!request.errors.empty() && learns, "--errors", "calibration and training");
  Refuse(!request.boxplot.empty() && learns, "--boxplot", "calibration and training");
  if (!request.hybrid.empty()) {
    Refuse(request.calibrate, "--calibrate", "--hybrid");
    if (method == "fit") throw Error::Input("--method", "a model with --hybrid", "'fit'");
    if (request.hybrid == "train") return TrainHybrid(request, file, robot, ParseMethod(method));
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
  if (request.hybrid.empty()) {
    return SolveCases(request, robot, parsed, nullptr, PredictionBy(file, robot, method));
  }
  return ApplyHybrid(request, file, robot);
}

}  // namespace continuum
