#include "identification/report/missing_force_plots.h"

#include <algorithm>
#include <numeric>

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

void Scatter(Page& page, const MissingForce& f, const std::vector<double>& x, const Axis& axis) {
  const Axis missing{"missing force", f.slides ? "N" : "N*m"};
  ScatterSpec spec{"over " + axis.label, axis, missing, {}, {}, true};
  PointGroup points{"rows", {}, {}, Style::kResidual};
  const std::size_t stride = std::max<std::size_t>(1, x.size() / kPoints);
  for (std::size_t k = 0; k < x.size(); k += stride)
    points.x.push_back(x[k]), points.y.push_back(f.force[k]);
  spec.groups.push_back(points);
  spec.trends.push_back(Quartiles(x, f.force));
  page.Scatter(spec);
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
  Scatter(page, f, f.angle, f.slides ? Axis{"position", "m"} : Axis{"angle", "rad"});
  Scatter(page, f, f.velocity, {"velocity", f.slides ? "m/s" : "rad/s"});
  Scatter(page, f, f.load, f.slides ? Axis{"actuator force", "N"} : Axis{"actuator torque", "N*m"});
  Scatter(page, f, f.time, {"time", "s"});
}

}  // namespace continuum
