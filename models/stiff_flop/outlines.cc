#include "models/stiff_flop/outlines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "models/statics/palette.h"
#include "models/stiff_flop/rod.h"
#include "models/stiff_flop/tubes.h"
#include "sim/io/file.h"

namespace continuum::stiff_flop {
namespace {

constexpr int kPoints = 72;            // of an outline
constexpr std::size_t kMostDrawn = 6;  // cases

std::string HexOf(const statics::Colour& colour) {
  const auto byte = [](double share) { return static_cast<int>(std::lround(255 * share)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green),
                     byte(colour.blue));
}

// A ring of the body at undeformed radius r; x of the section points along `phi`.
Outline BodyRing(const std::string& part, const Body<double>& body, double r, double phi,
                 int points) {
  Outline outline{part, {}, {}, {}};
  for (int j = 0; j <= points; ++j) {
    const double psi = 2 * std::numbers::pi * j / points;
    const double toward = r * std::cos(psi - phi), across = r * std::sin(psi - phi);
    const double x = body.Shifted(toward), y = across * body.Width(toward);
    outline.psi.push_back(psi);
    outline.x.push_back(x * std::cos(phi) - y * std::sin(phi));
    outline.z.push_back(-(x * std::sin(phi) + y * std::cos(phi)));
  }
  return outline;
}

// A ring of a tube at undeformed radius r, about its own axis at `centre`.
Outline TubeRing(const std::string& part, const Chamber<double>& tube, double r, double phi,
                 const Eigen::Vector2d& centre, int points) {
  Outline outline{part, {}, {}, {}, {}};
  for (int j = 0; j <= points; ++j) {
    const double psi = 2 * std::numbers::pi * j / points, cosine = std::cos(psi);
    const double radius = r * tube.Radius(cosine, r);
    outline.psi.push_back(psi);
    outline.x.push_back(centre[0] + radius * std::cos(phi + psi));
    outline.z.push_back(-(centre[1] + radius * std::sin(phi + psi)));
    outline.gamma.push_back(tube.LeadAngle(cosine, r));
  }
  return outline;
}

}  // namespace

std::vector<Outline> OutlinesOf(const Module& module, const Method& method,
                                const Axis<double>& axis, int points) {
  const double phi = std::atan2(axis.k_2, axis.k_1);
  const Body<double> body(method.body, axis.bend());
  std::vector<Outline> outlines = {BodyRing("body", body, module.r_2, phi, points)};
  if (module.r_1 > 0) outlines.push_back(BodyRing("hole", body, module.r_1, phi, points));
  const double r_od = TubeDistance(module, method.body, axis.lambda);
  for (std::size_t i = 0; i < module.lines.size(); ++i) {
    const auto bend = TubeBend(module, axis, r_od, i);
    const auto tube = Tube(module, method.chamber, module.gamma, bend);
    const Eigen::Vector2d centre(r_od * module.lines[i][0], r_od * module.lines[i][1]);
    const auto ring = [&](const char* part, double r) {
      outlines.push_back(TubeRing(fmt::format("{}_{}", part, i + 1), tube, r, phi, centre, points));
    };
    ring("bore", module.r_c1);
    ring("wall", module.r_c2);
  }
  return outlines;
}

OutlineTable::OutlineTable(std::filesystem::path path)
    : path_(std::move(path)), results_({"case", "module", "s", "part", "psi", "x", "z", "gamma"}) {
  statics::RequireExtension(path_, {".csv", ".json", ".svg"}, "--outlines");
}

void OutlineTable::Add(const ModuleSeries& series, const Method& method, Direction direction,
                       const Case& row, const Solution& solution) {
  if (direction == Direction::kInverse) {
    const double kappa = row.given[0], phi = row.given[1];
    const Axis<double> axis{row.given[2], kappa * std::cos(phi), kappa * std::sin(phi)};
    AddSection(row.label, series.first(), method, 0, 0, axis);
    return;
  }
  constexpr std::size_t kSteps = 8;
  Rod rod(series, method, row, 1, kSteps);
  rod.StartFrom(solution.bases);
  const std::vector<Axes> sections = rod.Sections(solution.moment);
  for (std::size_t j = 0; j < sections.size(); ++j) {
    for (const std::size_t i : {std::size_t{0}, kSteps / 2, kSteps}) {
      const double s = series[j].l * static_cast<double>(i) / kSteps;
      AddSection(row.label, series[j], method, j, s, sections[j][i]);
    }
  }
}

void OutlineTable::AddSection(const std::string& name, const Module& module, const Method& method,
                              std::size_t number, double s, const Axis<double>& axis) {
  const std::vector<Outline> outlines = OutlinesOf(module, method, axis, kPoints);
  if (s == 0) Draw(name, number, outlines);
  for (const Outline& outline : outlines) {
    for (std::size_t k = 0; k < outline.psi.size(); ++k) {
      results_.Row();
      results_.Set("case", name);
      results_.Set("module", static_cast<int>(number) + 1);
      results_.Set("s", s);
      results_.Set("part", outline.part);
      results_.Set("psi", outline.psi[k]);
      results_.Set("x", outline.x[k]);
      results_.Set("z", outline.z[k]);
      if (!outline.gamma.empty()) results_.Set("gamma", outline.gamma[k]);
    }
  }
}

void OutlineTable::Draw(const std::string& name, std::size_t module,
                        const std::vector<Outline>& outlines) {
  constexpr double kMillimetres = 1e3, kDegrees = 180 / std::numbers::pi;
  if (charts_.size() < 2 * (module + 1)) {
    const std::string of = fmt::format("module {}", module + 1);
    charts_.push_back({of + ", section at its base", {"x", "mm"}, {"z", "mm"}, {}, true});
    charts_.push_back({of + ", angle of the threads", {"psi", "deg"}, {"gamma", "deg"}, {}});
  }
  const auto found = std::find(cases_.begin(), cases_.end(), name);
  const auto at = static_cast<std::size_t>(found - cases_.begin());
  if (found == cases_.end()) {
    if (cases_.size() == kMostDrawn) return;
    cases_.push_back(name);
  }
  const std::string colour = HexOf(statics::CasePen(at).colour);
  bool first = true;
  for (const Outline& outline : outlines) {
    ChartLine line{first ? name : "", colour, outline.x, outline.z};
    for (double& value : line.x) value *= kMillimetres;
    for (double& value : line.y) value *= kMillimetres;
    charts_[2 * module].lines.push_back(std::move(line));
    first = false;
    if (outline.part.rfind("bore", 0) != 0) continue;
    ChartLine angle{"", colour, outline.psi, outline.gamma};
    for (double& value : angle.x) value *= kDegrees;
    for (double& value : angle.y) value *= kDegrees;
    charts_[2 * module + 1].lines.push_back(std::move(angle));
  }
}

void OutlineTable::Write() const {
  if (path_.extension() != ".svg") return results_.Write(path_);
  if (charts_.empty()) return;
  WriteFile(path_, ChartsSvg(charts_));
}

}  // namespace continuum::stiff_flop
