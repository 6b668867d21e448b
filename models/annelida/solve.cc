#include "models/annelida/solve.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "error.h"
#include "models/annelida/cases.h"
#include "models/statics/details.h"
#include "models/statics/foreign_options.h"
#include "models/statics/results.h"
#include "models/statics/rows.h"
#include "models/statics/sweep.h"
#include "models/statics/write_figure.h"

namespace continuum {
namespace {

enum class Method { kArcs, kChain, kPulledChain };

struct Solved {
  AnnelidaCase row;
  AnnelidaShape shape;
};

void RefuseOptions(const SolveRequest& request) {
  statics::RefuseGiven("annelida", {{"--calibrate", request.calibrate},
                                    {"--hybrid", !request.hybrid.empty()},
                                    {"--lambda", request.lambda.has_value()},
                                    {"--cross-validate", request.cross_validate},
                                    {"--sensitivity", request.sensitivity},
                                    {"--parameters", !request.parameters.empty()},
                                    {"--equilibria", request.equilibria},
                                    {"--measured", !request.measured.empty()},
                                    {"--errors", !request.errors.empty()},
                                    {"--boxplot", !request.boxplot.empty()},
                                    {"--shape", !request.shape.empty()},
                                    {"--compliance", !request.compliance.empty()},
                                    {"--reach", !request.reach.empty()},
                                    {"--follow", !request.follow.empty()},
                                    {"--outlines", !request.outlines.empty()}});
  if (request.input.empty()) throw Error::Input("--input", "a CSV file", "nothing");
  statics::RequireExtension(request.out, {".csv", ".json"}, "--out");
  if (!request.plot.empty()) statics::RequireFigureEnding(request.plot);
}

Method ReadMethod(const std::string& name) {
  if (name.empty() || name == "constant_curvature") return Method::kArcs;
  if (name == "chain") return Method::kChain;
  if (name == "chain_friction") return Method::kPulledChain;
  throw Error::Input("--method", "constant_curvature, chain or chain_friction", "'" + name + "'");
}

AnnelidaShape SolveCase(const AnnelidaParameters& p, const AnnelidaCase& row, Method method) {
  if (row.length.size() > 0) return ArcsOfLengths(p, row.length);
  if (method == Method::kArcs) return SolveArcs(p, row.load);
  return SolveChain(p, row.load,
                    method == Method::kChain ? AnnelidaPull::kEven : AnnelidaPull::kSlowly);
}

void RefuseLengths(const SolveRequest& request, const std::vector<AnnelidaCase>& cases,
                   Method method) {
  if (cases.front().length.size() == 0 || method == Method::kArcs) return;
  throw Error::Input(request.input.string() + ":1", "tensions F1.. with --method " + request.method,
                     "'L1'");
}

std::vector<std::string> SectionColumns(int sections) {
  std::vector<std::string> columns;
  for (const char* what : {"angle_", "azimuth_", "curvature_"}) {
    for (const std::string& name : statics::Numbered(what, sections)) columns.push_back(name);
  }
  return columns;
}

// bend1_x, bend1_y (, twist1), ..
std::vector<std::string> JointColumns(const AnnelidaParameters& p) {
  std::vector<std::string> columns;
  for (int i = 1; i <= p.Links(); ++i) {
    columns.push_back(fmt::format("bend{}_x", i));
    columns.push_back(fmt::format("bend{}_y", i));
    if (p.torsion) columns.push_back(fmt::format("twist{}", i));
  }
  return columns;
}

std::vector<std::string> Columns(const AnnelidaParameters& p, Method method, bool by_length) {
  std::vector<std::string> columns{"case",   "status", "iterations", "residual",
                                   "micros", "x",      "y",          "z"};
  const auto append = [&](const std::vector<std::string>& names) {
    columns.insert(columns.end(), names.begin(), names.end());
  };
  append(statics::StabilityColumns());
  append(statics::FrameColumns());
  append(SectionColumns(static_cast<int>(p.sections.size())));
  if (method != Method::kArcs) append(JointColumns(p));
  append(statics::Numbered("l_", p.Cables()));
  if (by_length) append({"mismatch"});
  append({"largest_bend"});
  return columns;
}

void WriteRow(const AnnelidaParameters& p, const Solved& solved, statics::Results& results) {
  const AnnelidaShape& shape = solved.shape;
  results.Row();
  results.Set("case", solved.row.label);
  results.Set(shape.outcome, statics::StatusOf(shape.outcome, shape.stability));
  results.Set(shape.outcome, shape.stability);
  if (!shape.outcome.ok()) return;
  const Eigen::Isometry3d& tip = shape.frames.back();
  for (int i = 0; i < 3; ++i) results.Set(std::string(1, "xyz"[i]), tip.translation()[i]);
  statics::SetFrame(Eigen::Quaterniond(tip.linear()), results);
  for (std::size_t s = 0; s < shape.sections.size(); ++s) {
    const std::string number = std::to_string(s + 1);
    results.Set("angle_" + number, shape.sections[s].Angle());
    results.Set("azimuth_" + number, shape.sections[s].Azimuth());
    results.Set("curvature_" + number, shape.sections[s].Curvature());
  }
  const std::vector<std::string> joints = JointColumns(p);
  for (Eigen::Index k = 0; k < shape.joints.size(); ++k) {
    results.Set(joints[static_cast<std::size_t>(k)], shape.joints[k]);
  }
  for (Eigen::Index j = 0; j < shape.length.size(); ++j) {
    results.Set("l_" + std::to_string(j + 1), shape.length[j]);
  }
  if (solved.row.length.size() > 0) results.Set("mismatch", shape.mismatch);
  results.Set("largest_bend", shape.largest_bend);
}

// Beyond the angle at which the discs touch a shape is none of the arm's.
void WarnOfStops(const SolveRequest& request, const AnnelidaParameters& p,
                 const std::vector<Solved>& rows) {
  const auto bend = [](const Solved& a) { return a.shape.largest_bend; };
  const auto beyond =
      std::count_if(rows.begin(), rows.end(), [&](const Solved& s) { return bend(s) > p.Stop(); });
  if (beyond == 0) return;
  const auto& worst =
      *std::max_element(rows.begin(), rows.end(),
                        [&](const Solved& a, const Solved& b) { return bend(a) < bend(b); });
  request.warn(fmt::format(
      "{}: discs touch at {:.3g} rad and are not part of this. A joint at '{}' bends by {:.3g}, in "
      "{} of {} rows one is beyond",
      request.robot.string(), p.Stop(), worst.row.label, bend(worst), beyond, rows.size()));
}

statics::Shape ShapeOf(const AnnelidaParameters& p, const Solved& solved) {
  statics::Shape drawn;
  drawn.label = solved.row.label;
  for (const Eigen::Isometry3d& frame : solved.shape.frames) {
    drawn.backbone.push_back(frame.translation());
    drawn.discs.push_back({frame.translation(), frame.linear().col(2), p.R, 0.004});
  }
  const Eigen::VectorXd& tension = solved.row.load.tension;
  for (int j = 0; j < p.Cables(); ++j) {
    const auto& holes = solved.shape.holes[static_cast<std::size_t>(j)];
    drawn.drives.push_back({{holes.begin(), holes.end()}, tension.size() > 0 && tension[j] > 0});
  }
  drawn.force = solved.row.load.force;
  drawn.gravity = {0, 0, p.gravity};
  drawn.load = tension.size() > 0 ? tension.sum() : 0;
  return drawn;
}

void Draw(const SolveRequest& request, const AnnelidaParameters& p,
          const std::vector<Solved>& rows) {
  statics::Figure figure;
  figure.title = "annelida: " + request.robot.filename().string();
  figure.base_radius = 1.25 * p.R;
  figure.drive_name = "cable";
  figure.idle_drive_name = "slack cable";
  for (const Solved& solved : rows) {
    if (solved.shape.outcome.ok()) figure.shapes.push_back(ShapeOf(p, solved));
  }
  statics::WriteFigure(request.plot, figure);
}

}  // namespace

int SolveAnnelida(const SolveRequest& request) {
  RefuseOptions(request);
  const AnnelidaParameters p = ReadAnnelida(request.robot);
  const Method method = ReadMethod(request.method);
  const std::vector<AnnelidaCase> cases = ReadAnnelidaCases(statics::CasesOf(request), p);
  RefuseLengths(request, cases, method);
  std::vector<Solved> rows(cases.size());
  statics::ForRows(
      cases.size(), [](std::size_t) { return -1; },
      [&](std::size_t i) {
        rows[i] = {cases[i], SolveCase(p, cases[i], method)};
      });
  statics::Results results(Columns(p, method, cases.front().length.size() > 0));
  for (const Solved& solved : rows) WriteRow(p, solved, results);
  statics::Write(results, request);
  WarnOfStops(request, p, rows);
  if (!request.plot.empty()) Draw(request, p, rows);
  const bool all = std::all_of(rows.begin(), rows.end(), [](const Solved& solved) {
    return solved.shape.outcome.ok() && solved.shape.stability.stable();
  });
  return all ? 0 : 1;
}

}  // namespace continuum
