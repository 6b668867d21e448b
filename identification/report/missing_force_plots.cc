#include "identification/report/missing_force_plots.h"

#include <algorithm>
#include <numeric>

#include "binding/expression.h"

namespace continuum {
namespace {

constexpr std::size_t kPoints = 1500, kBins = 20;

// Median and quartiles of f in bins of as many rows, along x.
Trend Quartiles(const std::vector<double>& x, const std::vector<double>& f) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return x[a] < x[b]; });
  Trend trend{"median", {}, {}, {}, {}, Style::kAfter};
  for (std::size_t b = 0; b < kBins; ++b) {
    std::vector<double> xs, ys;
    for (std::size_t k = b * order.size() / kBins; k < (b + 1) * order.size() / kBins; ++k) {
      xs.push_back(x[order[k]]), ys.push_back(f[order[k]]);
    }
    if (ys.size() < 4) continue;
    std::sort(ys.begin(), ys.end());
    trend.x.push_back(Median(xs));
    trend.y.push_back(Median(ys));
    trend.low.push_back(ys[ys.size() / 4]);
    trend.high.push_back(ys[3 * ys.size() / 4]);
  }
  return trend;
}

// Some of many rows.
PointGroup Points(const std::string& name, const std::vector<double>& x,
                  const std::vector<double>& y, Style style) {
  PointGroup points{name, {}, {}, style};
  const std::size_t stride = std::max<std::size_t>(1, x.size() / kPoints);
  for (std::size_t k = 0; k < x.size(); k += stride)
    points.x.push_back(x[k]), points.y.push_back(y[k]);
  return points;
}

ScatterSpec Over(const MissingForce& f, const Axis& axis) {
  const Axis missing{"missing force", f.slides ? "N" : "N*m"};
  return {"over " + axis.label, axis, missing, {}, {}, true};
}

void Scatter(Page& page, const MissingForce& f, const std::vector<double>& x, const Axis& axis) {
  ScatterSpec spec = Over(f, axis);
  spec.groups.push_back(Points("rows", x, f.force, Style::kResidual));
  spec.trends.push_back(Quartiles(x, f.force));
  page.Scatter(spec);
}

// What a joint's force may be drawn over.
struct Abscissa {
  const std::vector<double>& x;
  Axis axis;
};
Abscissa AngleOf(const MissingForce& f) {
  return {f.angle, f.slides ? Axis{"position", "m"} : Axis{"angle", "rad"}};
}
Abscissa SpeedOf(const MissingForce& f) {
  return {f.velocity, {"velocity", f.slides ? "m/s" : "rad/s"}};
}
Abscissa LoadOf(const MissingForce& f) {
  return {f.load, f.slides ? Axis{"actuator force", "N"} : Axis{"actuator torque", "N*m"}};
}
Abscissa TimeOf(const MissingForce& f) { return {f.time, {"time", "s"}}; }

// Those that a formula depends on; what other joints do is seen over time.
std::vector<Abscissa> AbscissasOf(const MissingForce& f, const std::string& formula) {
  const auto has = [&](const std::string& name) {
    return Expression::Renamed(formula, {name}, {""}) != formula;
  };
  std::vector<Abscissa> over;
  if (has("q") || has("weight")) over.push_back(AngleOf(f));
  if (has("v")) over.push_back(SpeedOf(f));
  if (has("motor")) over.push_back(LoadOf(f));
  if (over.empty() || has("time") || has("heat")) over.push_back(TimeOf(f));
  return over;
}

std::string AtRestInWords(const MissingForce& f) {
  constexpr std::size_t kShown = 6;
  std::string names;
  for (std::size_t i = 0; i < std::min(kShown, f.at_rest.size()); ++i)
    names += (i ? ", " : "") + f.at_rest[i];
  if (f.at_rest.size() > kShown) names += ", …";
  return "Not measured, and taken as at rest since the model does not move them: " + names + ".";
}

}  // namespace

void AddMissingForce(Page& page, const MissingForce& f) {
  if (f.joint.empty()) {
    page.Paragraph("The missing force cannot be shown: not every joint is measured.");
    return;
  }
  page.Paragraph("**On joint " + f.joint +
                 "**, where most is missing. Mass times the difference between the measured "
                 "acceleration and the model's at the measured "
                 "state. Line: median in bins, band: quartiles.");
  if (!f.at_rest.empty()) page.Paragraph(AtRestInWords(f));
  for (const Abscissa& over : {AngleOf(f), SpeedOf(f), LoadOf(f), TimeOf(f)})
    Scatter(page, f, over.x, over.axis);
}

void AddLaw(Page& page, const LawPicture& picture, const std::string& formula) {
  const MissingForce& f = picture.missing;
  page.Paragraph("On joint " + f.joint +
                 ": the force that is missing without it, and what the law gives at the same rows. "
                 "Measured accelerations scatter; the law does not.");
  for (const Abscissa& over : AbscissasOf(f, formula)) {
    ScatterSpec spec = Over(f, over.axis);
    spec.groups.push_back(Points("missing", over.x, f.force, Style::kResidual));
    spec.groups.push_back(Points("law", over.x, picture.law, Style::kAfter));
    page.Scatter(spec);
  }
}

}  // namespace continuum
